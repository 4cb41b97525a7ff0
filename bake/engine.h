/// engine.h: the engines behind one door, so that a job or a comparison is one loop.
#pragma once

#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

enum class Engine {
    masks,  ///< visibility as bits (tree/masks.h): the default
    disks,  ///< summed form factors (tree/disks.h): preview quality
    rays,   ///< ray casting (reference/rays.h): any exactness, slowest
};

/// Where the engine runs.
enum class Device {
    cpu,
    gpu,  ///< OpenGL without a window (gpu/context.h); software where there is no GPU
};

/// One control for exactness against time, the same for every scene: 0, 1 and 2 are `draft`, `good`
/// and `best`, and numbers between them lie between. Rays have their number instead.
inline constexpr float kDraft = 0.0f, kGood = 1.0f, kBest = 2.0f;

/// Which instructions the inner loops of masks and rays may use.
enum class Instructions {
    all,   ///< the widest that the processor has
    avx2,  ///< at most AVX2: what most machines have
};

struct EngineSettings {
    Engine engine = Engine::masks;
    Device device = Device::cpu;  ///< gpu: masks and disks
    Definition definition = {};
    float quality = kGood;     ///< masks, disks: least_quality to most_quality
    int passes = 2;            ///< disks: >= 1 (tree/disks.h)
    float strength = 1.0f;     ///< disks: >= 0
    std::uint32_t rays = 256;  ///< rays: 1 to kMostRays
    bool smoothed = false;     ///< rays: one smoothing step afterwards (reference/smoothing.h)
    Instructions instructions = Instructions::all;
};

struct EngineResult {
    std::vector<Occlusion> occlusion;  ///< one per receiver
    std::uint64_t surfels = 0;         ///< disks; 0 for engines that have none
    double surfels_s = 0.0;            ///< seconds: what the engine makes of the geometry first
    double tree_s = 0.0;               ///< seconds: its hierarchy
    double solve_s = 0.0;
    std::optional<double> residual;  ///< disks: last RMS change of the emitters' visibility
};

/// Builds and solves. progress: of the solving. Throws Cancelled, and std::runtime_error where the
/// processor lacks the instructions asked for.
/// Device::gpu: one OpenGL context serves all calls, which must come from one thread; throws
/// std::runtime_error where there is none, or the scene does not fit the device.
/// With settings.smoothed the receivers must be the geometry's vertices.
[[nodiscard]] EngineResult run_engine(const Geometry& geometry, std::span<const Receiver> receivers,
                                      const EngineSettings& settings,
                                      const Progress& progress = {});

/// "masks", "disks", "rays"
[[nodiscard]] std::string name_of(Engine engine);
/// The ends of `quality`; both 0 for rays, which have none.
[[nodiscard]] float least_quality(Engine engine);
[[nodiscard]] float most_quality(Engine engine);
/// Whether the engine can weigh directions so.
[[nodiscard]] bool knows_kernel(Engine engine, Kernel kernel);
/// Whether the engine runs there.
[[nodiscard]] bool runs_on(Engine engine, Device device);
/// What distinguishes settings of one engine: "good", "good on GPU", "quality 1.5", "256 rays", "64
/// rays, smoothed".
[[nodiscard]] std::string setting_of(const EngineSettings& settings);

/// How far an occluder may be, as a user says it.
struct DistanceLimit {
    double value = std::numeric_limits<double>::infinity();  ///< > 0, the file's units or percent
    bool percent = false;                                    ///< of the bounding-box diagonal
    Falloff falloff = Falloff::none;                         ///< `none` where there is no limit
};

/// The definition in the unit frame. Throws InputError where the limit vanishes beside the scene.
[[nodiscard]] Definition definition_of(const DistanceLimit& limit, Kernel kernel,
                                       const Frame& frame);

}  // namespace surfelao
