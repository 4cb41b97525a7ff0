#include "bake/vertex_bake.h"

#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace surfelao {
namespace {

class Baker : public JudgedBaker {
public:
    Baker(const Mesh& mesh, const VertexTarget& target, const Offset& offset, std::uint32_t check,
          const StageProgress& progress, Occluders* occluders, std::optional<double> error = {})
        : JudgedBaker(mesh.occluding(), occluders, check, progress, error),
          mesh_(mesh),
          target_(target),
          offset_(offset)
    {
    }

    /// The seconds are those of all calls so far.
    VertexBake bake(const EngineSettings& engine)
    {
        VertexBake bake = solved(engine);
        finish(bake);
        return bake;
    }

    /// Answers without values.
    VertexBake solved(const EngineSettings& engine, const ForgetReceivers& forget = {})
    {
        const Prepared& prepared = prepared_for(engine, seconds_.surfels, seconds_.tree);
        VertexBake bake;
        bake.engine = engine;
        bake.surfels = prepared.surfel_count();
        enter("solve");
        Solution solution =
            solve(prepared, target_.receivers(), engine, progress_in("solve"), forget);
        seconds_.solve += solution.seconds;
        bake.residual = solution.residual;
        bake.answers = std::move(solution.occlusion);
        bake.seconds = seconds_;
        return bake;
    }

    /// Values of the answers, and their error.
    void finish(VertexBake& bake)
    {
        seconds_ = bake.seconds;
        enter("fit");
        Stopwatch watch;
        bake.values = target_.values(bake.answers);
        seconds_.fit += watch.lap();
        bake.seconds = seconds_;
        judge(bake);
    }

    /// Measures what has been baked last, if at all.
    void judge(VertexBake& bake)
    {
        Stopwatch watch;
        if (count_ > 0)
            bake.error = error_of(bake);
        bake.seconds.check = seconds_.check += watch.lap();
    }

private:
    StatedError error_of(const VertexBake& bake)
    {
        enter("check");
        const Geometry& geometry = mesh_.geometry;
        const Shown shown = [&](const SurfacePoint& point) {
            return displayed(geometry, bake.values, point);
        };
        if (!check_) {
            const auto receivers_of = [&](std::span<const SurfacePoint> points) {
                return receivers_at(geometry, mesh_.surface, points, offset_);
            };
            const std::vector<double> density =
                density_for(geometry, target_, bake.answers, bake.values);
            check_.emplace(geometry, density, receivers_of, occluding(), count_);
            check_->add_floor(target_, density, receivers_of);
            check_->trace(bake.engine.definition, shown, progress_in("check"), asked_);
        }
        return check_->error_of(shown, bake.answers);
    }

    const Mesh& mesh_;
    const VertexTarget& target_;
    const Offset& offset_;
    VertexBakeSeconds seconds_;
};

}  // namespace

VertexBake bake_vertices(const Mesh& mesh, const VertexTarget& target, const EngineSettings& engine,
                         const Offset& offset, std::uint32_t check, const StageProgress& progress)
{
    return bake_answers(mesh, target, solve_vertices(mesh, target, engine, progress), offset, check,
                        progress);
}

VertexBake solve_vertices(const Mesh& mesh, const VertexTarget& target,
                          const EngineSettings& engine, const StageProgress& progress,
                          Occluders* occluders, const ForgetReceivers& forget)
{
    return Baker(mesh, target, {}, 0, progress, occluders).solved(engine, forget);
}

VertexBake bake_answers(const Mesh& mesh, const VertexTarget& target, VertexBake solved,
                        const Offset& offset, std::uint32_t check, const StageProgress& progress)
{
    Baker(mesh, target, offset, check, progress, nullptr).finish(solved);
    return solved;
}

VertexBake bake_to_error(const Mesh& mesh, const VertexTarget& target, const EngineSettings& engine,
                         const Offset& offset, double error, std::uint32_t check,
                         const StageProgress& progress, Occluders* occluders)
{
    Baker baker(mesh, target, offset, check, progress, occluders, error / 2.0);
    // what the fit leaves of independent noise
    const double kept =
        std::min(1.0, std::sqrt(static_cast<double>(mesh.geometry.positions.size()) /
                                static_cast<double>(target.receivers().size())));
    return search_error(baker, engine, error, kept);
}

}  // namespace surfelao
