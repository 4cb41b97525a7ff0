/// moving.h: scenes whose bodies move: prepared once, placed often, solved again where it changed.
///
///     MovingScene scene(geometry, body_of_triangle, {.engine = Engine::masks});
///     MovingReceivers receivers(scene, at_rest, body_of_receiver, {.quality = kDraft});
///     for (...) {
///         scene.place(1, placement);
///         const FrameReport report = receivers.solve();
///         ... receivers.occlusion() ...
///     }
///
/// A body is what moves as one: triangles, and the receivers on them. Body 0 is what never moves;
/// what it shows of itself is found once. The unit frame is that of the whole motion: the box of
/// all that is there in any frame, so that lengths mean the same from first to last.
///
/// The answer of a frame depends on that frame alone: bodies that together cover no more of a
/// receiver's hemisphere than the tolerance are not looked at (FrameReport::bound), wherever they
/// were before, so receivers that nothing nears keep their bytes and errors do not add up. What
/// moved away and back gives the first frame's bytes. Equal input gives equal bytes, whatever the
/// number of threads.
///
/// Masks ask receivers in the space of their own body, where the body's own tree stands still: its
/// masks are found once and kept (some 840 bytes a receiver and distance limit, a gigabyte at
/// most), and in a frame only the other bodies are drawn. Receivers on bodies that are deformed are
/// answered anew.
///
/// Related work: Bunnell. Dynamic Ambient Occlusion and Indirect Lighting. GPU Gems 2, ch. 14.
/// 2005.
#pragma once

#include "engines/engine.h"
#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/placement.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// What occludes. One thread at a time may place and deform, while none solves; any number may
/// solve at once.
class MovingScene {
public:
    struct Impl;
    /// body_of_triangle: one per triangle of the geometry, which shows all bodies at rest. Each
    /// body gets a tree of its own, in its own space. O(n log n). Throws as prepare(), and
    /// SettingsError for a device that is not the CPU.
    MovingScene(const Geometry& geometry, std::span<const std::uint32_t> body_of_triangle,
                const EngineChoice& choice = {});
    ~MovingScene();
    MovingScene(MovingScene&&) noexcept;
    MovingScene& operator=(MovingScene&&) noexcept;

    [[nodiscard]] std::uint32_t body_count() const;  ///< >= 1
    [[nodiscard]] const EngineChoice& choice() const;

    /// body: from 1 on. Costs its nodes, not its vertices: O(nodes) at the next solve().
    void place(std::uint32_t body, const Placement& placement);
    /// It does not occlude until it is placed again (an animated scale of zero).
    void hide(std::uint32_t body);
    /// Its triangles over other positions, one per vertex of the geometry (others than the body's
    /// are not looked at), unit frame; the placement then is the identity. The tree is refitted and
    /// built anew where it has grown too far apart. O(n).
    void deform(std::uint32_t body, std::span<const glm::vec3> positions);

    /// Any receivers, as solve(Prepared).
    [[nodiscard]] Solution solve(std::span<const Receiver> receivers,
                                 const SolveSettings& settings = {},
                                 const Progress& progress = {}) const;

    [[nodiscard]] Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

struct MovingSettings : SolveSettings {
    /// What the other bodies that a receiver does not look at may cover together: a ball of radius
    /// b at a distance d covers at most (b / d)^2 of a cosine-weighted hemisphere. An eighth of the
    /// masks' error at draft. >= 0; 0: all that reach over the horizon are looked at. Masks alone;
    /// others answer all receivers.
    float tolerance = 0.002f;
};

/// What a frame took.
struct FrameReport {
    double place = 0.0;        ///< seconds: bodies and receivers to their places
    double tree = 0.0;         ///< seconds: refitting or building
    double solve = 0.0;        ///< seconds
    std::uint64_t solved = 0;  ///< receivers that were answered anew, none of them hidden
    std::optional<double> residual = {};  ///< disks: as in Solution
    float bound = 0.0f;  ///< what is not looked at covers at most: no receiver is off by more,
                         ///< besides the engine's error
};

/// Receivers with a memory.
class MovingReceivers {
public:
    /// at_rest: on body body_of_receiver[i] as it was prepared. scene must outlive it, here or
    /// where it is moved to.
    MovingReceivers(const MovingScene& scene, std::vector<Receiver> at_rest,
                    std::vector<std::uint32_t> body_of_receiver, const MovingSettings& settings);
    ~MovingReceivers();
    MovingReceivers(MovingReceivers&&) noexcept;
    MovingReceivers& operator=(MovingReceivers&&) noexcept;

    /// Those of a deformed body, in the place of its own, in their order; where they are now.
    void deform(std::uint32_t body, std::span<const Receiver> receivers);

    /// Brings the answers to where the scene stands now. After an exception the next call solves
    /// all. Throws as solve(Prepared).
    FrameReport solve(const Progress& progress = {});

    /// One per receiver, in their order; of the last frame that was solved. Those of hidden bodies
    /// are as they were.
    [[nodiscard]] const std::vector<Occlusion>& occlusion() const;
    /// Where they stand now.
    [[nodiscard]] const std::vector<Receiver>& receivers() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace surfelao
