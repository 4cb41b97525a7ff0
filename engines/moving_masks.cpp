#include "engines/moving_engine.h"
#include "engines/options.h"
#include "surfels/stopwatch.h"
#include "tree/masks/forest.h"
#include "tree/masks/memory.h"
#include "tree/masks/solver.h"

namespace surfelao {
namespace {

class MaskReceiverMemory : public MovingMemory {
public:
    MaskReceiverMemory(const MaskForest& forest, std::span<const Receiver> at_rest,
                       std::span<const std::uint32_t> body_of_receiver, const MaskOptions& options,
                       float tolerance)
        : memory_(forest, at_rest, body_of_receiver, options, tolerance)
    {
    }
    void deform(std::uint32_t body, std::span<const Receiver> at_rest) override
    {
        memory_.deform(body, at_rest);
    }
    void solve(std::span<const MovingBody> /*bodies*/, std::span<const Receiver> now,
               std::span<Occlusion> answers, FrameReport& report, const Progress& progress) override
    {
        check_receivers(now);
        const MaskFrame frame = memory_.solve(now, answers, progress);
        report.solved = frame.solved;
        report.bound = frame.bound;
    }

private:
    MaskMemory memory_;
};

class MovingMasks : public MovingEngine {
public:
    MovingMasks(const MovingParts& parts, const EngineChoice& choice)
        : choice_(choice),
          forest_(parts.at_rest, parts.body_of_triangle, parts.bodies),
          versions_(parts.bodies, 0)
    {
        static_cast<void>(kernel_set_of(choice.instructions));
    }

    void move(std::span<const MovingBody> bodies, FrameReport& report) override
    {
        Stopwatch watch;
        for (std::uint32_t k = 0; k < bodies.size(); ++k) {
            const MovingBody& body = bodies[k];
            if (body.version == versions_[k])
                continue;
            if (body.form != nullptr)
                forest_.deform(k, *body.form);
            else if (body.placement)
                forest_.place(k, *body.placement);
            else
                forest_.hide(k);
            versions_[k] = body.version;
        }
        report.tree += watch.lap();
        forest_.settle();
        report.place += watch.lap();
    }

    [[nodiscard]] Solution solve(std::span<const Receiver> receivers, const SolveSettings& settings,
                                 const Progress& progress) const override
    {
        check_settings(choice_, settings);
        check_receivers(receivers);
        Stopwatch watch;
        Solution solution;
        solution.occlusion = solve_masks(forest_.nodes(), forest_.roots(), receivers,
                                         mask_options(choice_, settings), progress);
        solution.seconds = watch.lap();
        return solution;
    }

    [[nodiscard]] std::unique_ptr<MovingMemory> remember(
        std::span<const Receiver> at_rest, std::span<const std::uint32_t> body_of_receiver,
        const MovingSettings& settings) const override
    {
        return std::make_unique<MaskReceiverMemory>(forest_, at_rest, body_of_receiver,
                                                    mask_options(choice_, settings),
                                                    settings.tolerance);
    }

private:
    EngineChoice choice_;
    MaskForest forest_;
    std::vector<std::uint64_t> versions_;  ///< of the bodies, as the forest has them
};

}  // namespace

std::unique_ptr<MovingEngine> moving_masks(const MovingParts& parts, const EngineChoice& choice)
{
    return std::make_unique<MovingMasks>(parts, choice);
}

}  // namespace surfelao
