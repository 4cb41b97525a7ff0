#include "reference/moving_rays.h"
#include "engines/engine_options.h"
#include "engines/moving_engine.h"
#include "surfels/stopwatch.h"

#include <vector>

namespace surfelao {
namespace {

/// Answers depend on the frame alone, so nothing is remembered.
class MovingRays : public MovingEngine {
public:
    MovingRays(const MovingParts& parts, const EngineChoice& choice)
        : choice_(choice),
          scene_(parts.at_rest, parts.body_of_triangle, isa_of(choice.instructions)),
          versions_(parts.bodies, 0)
    {
    }

    void move(std::span<const MovingBody> bodies, FrameReport& report) override
    {
        Stopwatch watch;
        for (std::uint32_t b = 0; b < bodies.size(); ++b) {
            const MovingBody& body = bodies[b];
            if (body.version == versions_[b])
                continue;
            if (!body.placement)
                scene_.hide(b);
            else if (body.form)
                scene_.deform(b, *body.form);
            else
                scene_.place(b, matrix_of(*body.placement));
            versions_[b] = body.version;
        }
        report.place += watch.lap();
        now_ = &scene_.now();
        report.tree += watch.lap();
    }

    Solution solve(std::span<const Receiver> receivers, const SolveSettings& settings,
                   const Progress& progress) const override
    {
        check_settings(choice_, settings);
        check_receivers(receivers);
        Stopwatch watch;
        Solution solution;
        solution.occlusion = trace_occlusion(*now_, receivers, ray_options(settings), progress);
        solution.seconds = watch.lap();
        return solution;
    }

private:
    EngineChoice choice_;
    MovingRayScene scene_;
    const RayScene* now_ = &scene_.now();
    std::vector<std::uint64_t> versions_;  ///< of the bodies, as the scene has them
};

}  // namespace

std::unique_ptr<MovingEngine> moving_rays(const MovingParts& parts, const EngineChoice& choice)
{
    return std::make_unique<MovingRays>(parts, choice);
}

}  // namespace surfelao
