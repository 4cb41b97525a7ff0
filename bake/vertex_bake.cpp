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

/// Says which stage begins; the moment at which a job between two stages can be stopped.
void enter_stage(const StageProgress& progress, std::string_view stage)
{
    if (progress && !progress(stage, 0.0))
        throw Cancelled();
}

Progress progress_in(const StageProgress& progress, std::string_view stage)
{
    return [&progress, stage](double done) { return !progress || progress(stage, done); };
}

/// One mesh, prepared engines, and the points by which all answers are judged.
class Baker {
public:
    /// error: what shall be told of other bakes than the first, which may be a coarse one.
    Baker(const Mesh& mesh, const VertexTarget& target, const Offset& offset, std::uint32_t check,
          const StageProgress& progress, std::optional<double> error = {})
        : mesh_(mesh),
          target_(target),
          offset_(offset),
          count_(check),
          progress_(progress),
          asked_(error)
    {
    }

    /// The seconds are those of all calls so far.
    VertexBake bake(const EngineSettings& engine)
    {
        const Prepared& prepared = prepared_for(engine);
        VertexBake bake;
        bake.engine = engine;
        bake.surfels = prepared.surfel_count();
        enter_stage(progress_, "solve");
        Solution solution =
            solve(prepared, target_.receivers(), engine, progress_in(progress_, "solve"));
        seconds_.solve += solution.seconds;
        bake.residual = solution.residual;

        enter_stage(progress_, "fit");
        Stopwatch watch;
        bake.values = target_.values(solution.occlusion);
        seconds_.fit += watch.lap();
        bake.answers = std::move(solution.occlusion);
        if (count_ > 0)
            bake.error = error_of(bake);
        seconds_.check += watch.lap();
        bake.seconds = seconds_;
        return bake;
    }

    /// Measures what has been baked last at four times as many points; false where they are enough.
    bool refine(VertexBake& bake)
    {
        if (count_ >= kMostSearchPoints)
            return false;
        count_ = std::min(4 * count_, kMostSearchPoints);
        check_.reset();
        Stopwatch watch;
        bake.error = error_of(bake);
        bake.seconds.check = seconds_.check += watch.lap();
        return true;
    }

    [[nodiscard]] const ErrorCheck& check() const { return *check_; }

private:
    const Prepared& prepared_for(const EngineSettings& engine)
    {
        const auto found = prepared_.find(engine.engine);
        if (found != prepared_.end())
            return found->second;
        enter_stage(progress_, "build");
        const Prepared& prepared =
            prepared_.emplace(engine.engine, prepare(mesh_.geometry, engine)).first->second;
        seconds_.surfels += prepared.seconds().surfels;
        seconds_.tree += prepared.seconds().tree;
        return prepared;
    }

    StatedError error_of(const VertexBake& bake)
    {
        enter_stage(progress_, "check");
        const Geometry& geometry = mesh_.geometry;
        const Shown shown = [&](const SurfacePoint& point) {
            return displayed(geometry, bake.values, point);
        };
        if (!check_) {
            const std::vector<double> density =
                density_for(geometry, target_, bake.answers, bake.values);
            check_.emplace(mesh_, density, offset_, count_);
            check_->add_floor(target_, density);
            check_->trace(bake.engine.definition, shown, progress_in(progress_, "check"), asked_);
        }
        return check_->error_of(shown, bake.answers);
    }

    const Mesh& mesh_;
    const VertexTarget& target_;
    const Offset& offset_;
    std::uint32_t count_;
    const StageProgress& progress_;
    std::optional<double> asked_;
    std::map<Engine, Prepared> prepared_;
    std::optional<ErrorCheck> check_;
    VertexBakeSeconds seconds_;
};

}  // namespace

VertexBake bake_vertices(const Mesh& mesh, const VertexTarget& target, const EngineSettings& engine,
                         const Offset& offset, std::uint32_t check, const StageProgress& progress)
{
    return Baker(mesh, target, offset, check, progress).bake(engine);
}

VertexBake bake_to_error(const Mesh& mesh, const VertexTarget& target, const EngineSettings& engine,
                         const Offset& offset, double error, std::uint32_t check,
                         const StageProgress& progress)
{
    Baker baker(mesh, target, offset, check, progress, error / 2.0);
    // what the fit leaves of independent noise
    const double kept = std::min(1.0, std::sqrt(static_cast<double>(mesh.scene.positions.size()) /
                                                static_cast<double>(target.receivers().size())));
    return search_error(baker, engine, error, kept);
}

}  // namespace surfelao
