/// moving_engine.h: what MovingScene and MovingReceivers ask of an engine.
///
/// Internal to engines/; moving.h is its door.
#pragma once

#include "engines/moving.h"
#include "surfels/bodies.h"

#include <glm/vec3.hpp>

#include <cstddef>
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
    /// The engine has been moved to the bodies. Writes the answers that may have changed, and what
    /// is said of them in the report; adds what of the time is no solving to `place` and `tree`.
    /// After an exception the next call answers all.
    virtual void solve(std::span<Occlusion> answers, FrameReport& report,
                       const Progress& progress) = 0;
};

/// What occludes, as one engine has it. At first all bodies stand as they were prepared.
class MovingEngine {
public:
    MovingEngine(const EngineChoice& choice, std::size_t bodies)
        : choice_(choice), versions_(bodies, 0)
    {
    }
    virtual ~MovingEngine() = default;

    /// Brings the bodies, one MovingBody each, to where they stand now; adds the seconds that it
    /// takes to `place` and `tree`. After an exception the next call does what is left.
    void move(std::span<const MovingBody> bodies, FrameReport& report);
    /// As solve(Prepared): any number of threads.
    [[nodiscard]] Solution solve(std::span<const Receiver> receivers, const SolveSettings& settings,
                                 const Progress& progress) const;
    /// Null: all receivers are to be answered by solve() in each frame. The engine must outlive it.
    [[nodiscard]] virtual std::unique_ptr<MovingMemory> remember(
        std::span<const Receiver> /*at_rest*/, std::span<const std::uint32_t> /*body_of_receiver*/,
        const MovingSettings& /*settings*/) const
    {
        return nullptr;
    }

protected:
    [[nodiscard]] const EngineChoice& choice() const { return choice_; }

private:
    virtual void hide(std::uint32_t body) = 0;
    virtual void place(std::uint32_t body, const Placement& placement) = 0;
    virtual void deform(std::uint32_t body, const std::vector<glm::vec3>& positions) = 0;
    /// After the last of these.
    virtual void settle() {}
    /// Settings and receivers have been checked. Need not tell the seconds.
    [[nodiscard]] virtual Solution answer(std::span<const Receiver> receivers,
                                          const SolveSettings& settings,
                                          const Progress& progress) const = 0;

    EngineChoice choice_;
    std::vector<std::uint64_t> versions_;  ///< of the bodies, as the engine has them
};

[[nodiscard]] std::unique_ptr<MovingEngine> moving_masks(const Geometry& at_rest,
                                                         std::vector<BodyMesh> bodies,
                                                         const EngineChoice& choice);
[[nodiscard]] std::unique_ptr<MovingEngine> moving_disks(const Geometry& at_rest,
                                                         std::vector<BodyMesh> bodies,
                                                         const EngineChoice& choice);
[[nodiscard]] std::unique_ptr<MovingEngine> moving_rays(const Geometry& at_rest,
                                                        std::vector<BodyMesh> bodies,
                                                        const EngineChoice& choice);

}  // namespace surfelao
