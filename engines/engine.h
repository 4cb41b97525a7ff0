/// engine.h: the engines behind one door: prepare once, solve often.
///
///     const Prepared prepared = prepare(geometry, {.engine = Engine::masks});
///     const Solution draft = solve(prepared, receivers, {.quality = kDraft});
///     const Solution good  = solve(prepared, others,    {.quality = kGood});
///
/// prepare() makes what an engine builds of the geometry and no setting changes: a tree, an octree
/// with its sides, a ray scene, their copies on a device. solve() answers any number of receivers,
/// any number of times. Equal input gives equal bytes, whatever the number of threads.
#pragma once

#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"
#include "surfels/share.h"

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

class GlContext;
struct PointCloud;

enum class Engine {
    masks,  ///< visibility as bits (tree/masks/masks.h): the default
    disks,  ///< summed form factors (tree/disks/disks.h): preview quality
    rays,   ///< ray casting (reference/rays.h): any exactness, slowest
};

/// Where the engine runs.
enum class Device {
    cpu,
    gpu,  ///< OpenGL without a window (gpu/context.h); software where there is no GPU
};

/// Which instructions the inner loops of masks and rays may use.
enum class Instructions {
    all,   ///< the widest that the processor has
    avx2,  ///< at most AVX2: what most machines have
};

/// One control for exactness against time, the same for every scene: 0, 1 and 2 are `draft`, `good`
/// and `best`, and numbers between them lie between. Rays have their number instead.
inline constexpr float kDraft = 0.0f, kGood = 1.0f, kBest = 2.0f;

/// Who answers: everything that prepare() needs to know.
struct EngineChoice {
    Engine engine = Engine::masks;
    Device device = Device::cpu;  ///< gpu: masks and disks
    Instructions instructions = Instructions::all;
    /// gpu: where it computes; must outlive what is prepared, and prepare() and solve() make it
    /// current in the calling thread, where it stays so. Null: a context of its own, which is
    /// current in no thread afterwards, nor is any other. One is dear: give several engines the
    /// same.
    const GlContext* context = nullptr;
    bool operator==(const EngineChoice&) const = default;
};

/// What is asked, and how exactly.
struct SolveSettings {
    Definition definition = {};
    float quality = kGood;     ///< masks, disks: least_quality to most_quality
    int passes = 3;            ///< disks: >= 1 (tree/disks/disks.h)
    float strength = 1.0f;     ///< disks: >= 0
    std::uint32_t rays = 256;  ///< rays: 1 to kMostRays
    std::uint32_t seed = 0;    ///< rays: another seed, another independent estimate
    Share share = {};          ///< cpu: only these receivers, as the whole list would be solved
    bool operator==(const SolveSettings&) const = default;
};

/// An engine with its settings: one row of a table, or what a command line asks for.
struct EngineSettings : EngineChoice, SolveSettings {
    bool operator==(const EngineSettings&) const = default;
};

/// Seconds of preparing.
struct PrepareSeconds {
    double surfels = 0.0;  ///< what the engine makes of the geometry first
    double tree = 0.0;     ///< its hierarchy, and the copy on the device
};

/// What an engine has built. Immutable: on the CPU any number of threads may solve with it at once;
/// on the GPU one at a time. The geometry is not needed any more. On the GPU its end makes its
/// context current in the calling thread, to take its copies off the device.
class Prepared {
public:
    struct Impl;
    explicit Prepared(std::unique_ptr<const Impl> impl);
    ~Prepared();
    Prepared(Prepared&&) noexcept;
    Prepared& operator=(Prepared&&) noexcept;

    const EngineChoice& choice() const;
    const PrepareSeconds& seconds() const;
    std::uint64_t surfel_count() const;  ///< disks; 0 for engines that have none
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<const Impl> impl_;
};

struct Solution {
    std::vector<Occlusion> occlusion;  ///< one per receiver
    double seconds = 0.0;
    std::optional<double> residual;  ///< disks: last RMS change of the emitters' visibility
};

/// O(n log n) time, O(n) memory. Throws SettingsError where the engine does not run on the device,
/// std::runtime_error where the processor lacks the instructions asked for, there is no device, or
/// the scene does not fit it.
[[nodiscard]] Prepared prepare(const Geometry& geometry, const EngineChoice& choice = {});

/// The same of points, which are disks without having to be made so. squares: squares_of(cloud).
[[nodiscard]] Prepared prepare(const PointCloud& cloud, const Geometry& squares,
                               const EngineChoice& choice = {});

/// One answer per receiver, in their order: kUnsolved for those of other shares. Throws
/// SettingsError for settings out of their ranges, InputError for a receiver that is not finite,
/// farther than kFarthestReceiver, or whose normal is neither of unit length (to kUnitLength) nor
/// zero, Cancelled, and std::runtime_error where the device refuses. forget: with masks on
/// the CPU called for all receivers before they are answered; else maybe never.
[[nodiscard]] Solution solve(const Prepared& prepared, std::span<const Receiver> receivers,
                             const SolveSettings& settings = {}, const Progress& progress = {},
                             const ForgetReceivers& forget = {});

/// In diagonals from the centre, along each axis: farther out a float no longer tells the corners
/// of the scene apart, and squares of distances leave their range.
inline constexpr float kFarthestReceiver = 1e6f;
/// A normal's length may be off by so much (what eight bits an axis make of it): an answer is then
/// off by the same share.
inline constexpr float kUnitLength = 5e-3f;

/// solve() for several lists of receivers, each answered as if it were asked alone; what no list
/// changes is found once (disks on the CPU: what lies beyond the emitters). One solution per list;
/// the first one's seconds are of all.
[[nodiscard]] std::vector<Solution> solve_lists(const Prepared& prepared,
                                                std::span<const std::span<const Receiver>> lists,
                                                const SolveSettings& settings = {},
                                                const Progress& progress = {});

/// Throws SettingsError where solve() would.
void check_settings(const EngineChoice& choice, const SolveSettings& settings);

/// "masks", "disks", "rays"
[[nodiscard]] std::string name_of(Engine engine);
/// The ends of `quality`; both 0 for rays, which have none.
[[nodiscard]] float least_quality(Engine engine);
[[nodiscard]] float most_quality(Engine engine);
/// Whether the engine can weigh directions so.
[[nodiscard]] bool knows_kernel(Engine engine, Kernel kernel);
/// Whether the engine runs there.
[[nodiscard]] bool runs_on(Engine engine, Device device);
/// What distinguishes settings of one engine: "good", "good on GPU", "quality 1.5", "256 rays".
[[nodiscard]] std::string setting_of(const EngineSettings& settings);

/// How far an occluder may be, as a user says it.
struct DistanceLimit {
    double value = std::numeric_limits<double>::infinity();  ///< > 0, the file's units or percent
    bool percent = false;                                    ///< of the bounding-box diagonal
    Falloff falloff = Falloff::none;                         ///< `none` where there is no limit
    bool operator==(const DistanceLimit&) const = default;
};

/// A ground as a user says it.
struct GroundPlane {
    glm::vec3 up{0.0f, 1.0f, 0.0f};     ///< unit length
    std::optional<double> height = {};  ///< along up, in the file's units; empty: just below
                                        ///< the lowest point
    bool operator==(const GroundPlane&) const = default;
};

/// The definition in the unit frame. Throws InputError where the limit vanishes beside the scene.
[[nodiscard]] Definition definition_of(const DistanceLimit& limit, Kernel kernel,
                                       const Frame& frame);

/// The ground in the unit frame of these geometries, which all have the same: what occludes and
/// what is asked. Just below their lowest point is two offsets below it, so that what stands on the
/// ground does not stand in it; a height within two offsets of the lowest point means that place
/// too. offset: the largest of the receivers. None where none is asked for. Throws InputError where
/// it lies farther off than kFarthestReceiver.
[[nodiscard]] std::optional<Ground> ground_of(
    const std::optional<GroundPlane>& plane,
    std::initializer_list<std::reference_wrapper<const Geometry>> geometries, float offset);

/// Back: where it lies in the file's units.
[[nodiscard]] GroundPlane plane_of(const Ground& ground, const Frame& frame);

/// "y:-0.25", "z:lowest"; other directions than these two as "0.6:0:0.8:lowest".
[[nodiscard]] std::string text_of(const GroundPlane& plane);
/// "y = -0.25": where it lies in the file's units, to six digits.
[[nodiscard]] std::string text_of(const Ground& ground, const Frame& frame);

}  // namespace surfelao
