#include "engines/moving_engine.h"

#include "engines/options.h"
#include "surfels/stopwatch.h"

namespace surfelao {

void MovingEngine::move(std::span<const MovingBody> bodies, FrameReport& report)
{
    Stopwatch watch;
    for (std::uint32_t k = 0; k < bodies.size(); ++k) {
        const MovingBody& body = bodies[k];
        if (body.version == versions_[k])
            continue;
        if (!body.placement)
            hide(k);
        else if (!body.form)
            place(k, *body.placement);
        else
            deform(k, *body.form);
        (body.form ? report.tree : report.place) += watch.lap();
        versions_[k] = body.version;
    }
    settle();
    report.tree += watch.lap();
}

Solution MovingEngine::solve(std::span<const Receiver> receivers, const SolveSettings& settings,
                             const Progress& progress) const
{
    check_settings(choice_, settings);
    check_receivers(receivers);
    Stopwatch watch;
    Solution solution = answer(receivers, settings, progress);
    solution.seconds = watch.lap();
    return solution;
}

}  // namespace surfelao
