/// moving_engine.h: what MovingScene and MovingReceivers ask of an engine.
///
/// Internal to engines/; moving.h is its door. An engine that knows no motion is rebuilt in every
/// frame (moving_rebuilt.h).
#pragma once

#include "engines/moving.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// Where a body stands. Body 0 is as it was prepared, for ever.
struct MovingBody {
    std::optional<Placement> placement = Placement{};  ///< empty: hidden
    /// Its triangles over other positions, one per vertex of the geometry, in the unit frame; null:
    /// as it was prepared.
    std::shared_ptr<const std::vector<glm::vec3>> form;
    std::uint64_t version = 0;  ///< another one, another place or form
};

/// Receivers with a memory of what was found for them.
class MovingMemory {
public:
    virtual ~MovingMemory() = default;
    /// at_rest: all receivers; those of the body have changed.
    virtual void deform(std::uint32_t body, std::span<const Receiver> at_rest) = 0;
    /// now: where the receivers stand, those of hidden bodies anywhere; the engine has been moved
    /// to the bodies. Writes the answers that may have changed, and what is said of them in the
    /// report. After an exception the next call answers all.
    virtual void solve(std::span<const MovingBody> bodies, std::span<const Receiver> now,
                       std::span<Occlusion> answers, FrameReport& report,
                       const Progress& progress) = 0;
};

/// What occludes, as one engine has it. At first all bodies stand as they were prepared.
class MovingEngine {
public:
    virtual ~MovingEngine() = default;
    /// Brings the bodies, one MovingBody each, to where they stand now; adds the seconds that it
    /// takes to `place` and `tree`.
    virtual void move(std::span<const MovingBody> bodies, FrameReport& report) = 0;
    /// As solve(Prepared): any number of threads.
    [[nodiscard]] virtual Solution solve(std::span<const Receiver> receivers,
                                         const SolveSettings& settings,
                                         const Progress& progress) const = 0;
    /// Null: all receivers are to be answered by solve() in each frame. The engine must outlive it.
    [[nodiscard]] virtual std::unique_ptr<MovingMemory> remember(
        std::span<const Receiver> /*at_rest*/, std::span<const std::uint32_t> /*body_of_receiver*/,
        const MovingSettings& /*settings*/) const
    {
        return nullptr;
    }
};

/// body_of_triangle: one per triangle; bodies: how many there are.
struct MovingParts {
    const Geometry& at_rest;
    std::span<const std::uint32_t> body_of_triangle;
    std::uint32_t bodies;
};

[[nodiscard]] std::unique_ptr<MovingEngine> moving_masks(const MovingParts& parts,
                                                         const EngineChoice& choice);
[[nodiscard]] std::unique_ptr<MovingEngine> moving_disks(const MovingParts& parts,
                                                         const EngineChoice& choice);
[[nodiscard]] std::unique_ptr<MovingEngine> moving_rays(const MovingParts& parts,
                                                        const EngineChoice& choice);

}  // namespace surfelao
