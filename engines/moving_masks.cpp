#include "engines/moving_engine.h"
#include "engines/options.h"
#include "tree/masks/forest.h"
#include "tree/masks/memory.h"
#include "tree/masks/solver.h"

#include <optional>
#include <utility>

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
    void solve(std::span<Occlusion> answers, FrameReport& report, const Progress& progress) override
    {
        const MaskFrame frame = memory_.solve(answers, progress);
        report.place += frame.place;
        report.solved = frame.solved;
        report.bound = frame.bound;
    }

private:
    MaskMemory memory_;
};

class MovingMasks : public MovingEngine {
public:
    MovingMasks(const Geometry& at_rest, std::vector<BodyMesh> bodies, const EngineChoice& choice)
        : MovingEngine(choice, bodies.size()), forest_(at_rest, std::move(bodies))
    {
        static_cast<void>(kernel_set_of(choice.instructions));
    }

    [[nodiscard]] std::unique_ptr<MovingMemory> remember(
        std::span<const Receiver> at_rest, std::span<const std::uint32_t> body_of_receiver,
        const MovingSettings& settings) const override
    {
        return std::make_unique<MaskReceiverMemory>(forest_, at_rest, body_of_receiver,
                                                    mask_options(choice(), settings),
                                                    settings.tolerance);
    }

private:
    void hide(std::uint32_t body) override { forest_.hide(body); }
    void place(std::uint32_t body, const Placement& placement) override
    {
        forest_.place(body, placement);
    }
    void deform(std::uint32_t body, const std::vector<glm::vec3>& positions) override
    {
        forest_.deform(body, positions);
    }
    Solution answer(std::span<const Receiver> receivers, const SolveSettings& settings,
                    const Progress& progress) const override
    {
        return {solve_masks(forest_.nodes(), forest_.roots(), receivers,
                            mask_options(choice(), settings), progress),
                0.0, std::nullopt};
    }

    MaskForest forest_;
};

}  // namespace

std::unique_ptr<MovingEngine> moving_masks(const Geometry& at_rest, std::vector<BodyMesh> bodies,
                                           const EngineChoice& choice)
{
    return std::make_unique<MovingMasks>(at_rest, std::move(bodies), choice);
}

}  // namespace surfelao
