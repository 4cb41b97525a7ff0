/// moving_solver.h: an engine on its way through the poses of a moving world.
///
///     MovingSolver solver(world, engine);
///     for (...) {
///         world.pose(second);
///         solver.place();
///         solver.solve();
///         ... solver.values() ...
///     }
#pragma once

#include "bake/moving_world.h"
#include "engines/moving.h"
#include "surfels/progress.h"

#include <span>
#include <vector>

namespace surfelao {

class MovingSolver {
public:
    /// world must outlive it, and have had no pose yet. engine: on the CPU, its definition made.
    /// Throws as MovingScene.
    MovingSolver(const MovingWorld& world, const EngineSettings& engine);

    /// After each pose: bodies and receivers to where the world stands.
    void place() { world_.place(scene_, &receivers_); }

    /// Throws as MovingReceivers::solve().
    FrameReport solve(const Progress& progress = {}) { return receivers_.solve(progress); }

    /// One per receiver of the world.
    [[nodiscard]] const std::vector<Occlusion>& answers() const { return receivers_.occlusion(); }

    /// One per scene vertex. answers: one per receiver.
    [[nodiscard]] const std::vector<Occlusion>& values_of(std::span<const Occlusion> answers)
    {
        return values_.of(answers);
    }

    /// Of any other receivers.
    [[nodiscard]] std::vector<Occlusion> solve_others(std::span<const Receiver> receivers) const
    {
        return scene_.solve(receivers, settings_).occlusion;
    }

private:
    const MovingWorld& world_;
    MovingSettings settings_;
    MovingScene scene_;
    MovingReceivers receivers_;
    MovingValues values_;
};

}  // namespace surfelao
