#include "bake/compare_target.h"

#include "surfels/stopwatch.h"

#include <cmath>
#include <span>
#include <utility>

namespace surfelao {
namespace {

/// The engine's own answers at the surface points: in one list with the receivers, so that they
/// are answered in groups as these are. Rays have no groups.
std::vector<Occlusion> answers_at_points(const Prepared& prepared,
                                         std::span<const Receiver> receivers,
                                         const SurfaceTruth& truth, const EngineSettings& engine,
                                         const Progress& progress)
{
    if (engine.engine == Engine::rays)
        return solve(prepared, truth.receivers, engine, progress).occlusion;
    std::vector<Receiver> asked(receivers.begin(), receivers.end());
    asked.insert(asked.end(), truth.receivers.begin(), truth.receivers.end());
    std::vector<Occlusion> answers = solve(prepared, asked, engine, progress).occlusion;
    answers.erase(answers.begin(), answers.begin() + static_cast<std::ptrdiff_t>(receivers.size()));
    return answers;
}

double build_seconds(const PrepareSeconds& seconds)
{
    return seconds.surfels + seconds.tree;
}

class ComparedVertices : public CompareTarget {
public:
    ComparedVertices(std::shared_ptr<const Mesh> mesh, const TargetSettings& settings)
        : mesh_(std::move(mesh)), settings_(settings), target_(mesh_, settings)
    {
    }

    std::uint64_t receivers() const override { return target_.receivers().size(); }

    bool shows(std::uint32_t) const override { return true; }

    Floor floor(const SurfaceTruth& truth, const TruthSettings& settings,
                const Progress& progress) const override
    {
        if (settings_.values == VertexValues::fit)
            return find_floor(target_, *mesh_, truth, settings, progress);
        TargetSettings fitted = settings_;
        fitted.values = VertexValues::fit;
        return find_floor(VertexTarget(mesh_, fitted), *mesh_, truth, settings, progress);
    }

    JobResult run(const EngineSettings& engine, const SurfaceTruth* truth,
                  const Progress& progress) const override
    {
        const Prepared prepared = prepare(mesh_->occluding(), engine);
        const Solution solution = solve(prepared, target_.receivers(), engine, progress);
        Stopwatch fitting;
        const std::vector<Occlusion> values = target_.values(solution.occlusion);
        JobResult result;
        result.seconds.fit = fitting.lap();
        result.seconds.build = build_seconds(prepared.seconds());
        result.seconds.solve = solution.seconds;
        if (truth == nullptr)
            return result;
        result.displayed = displayed_at(mesh_->geometry, values, truth->points);
        result.answers = answers_at_points(prepared, target_.receivers(), *truth, engine, progress);
        for (const Occlusion& value : values)
            result.occlusion.push_back(value.occlusion);
        return result;
    }

private:
    std::shared_ptr<const Mesh> mesh_;
    TargetSettings settings_;
    VertexTarget target_;
};

/// Of the floor's two halves. The opponent has none of them.
constexpr std::uint32_t kFloorSeeds[] = {0xA71A5001, 0xA71A5002};

class ComparedMap : public CompareTarget {
public:
    ComparedMap(std::shared_ptr<const Mesh> mesh, MapLayout layout, std::uint32_t padding,
                const TargetSettings& settings)
        : mesh_(std::move(mesh)),
          layout_(std::move(layout)),
          map_settings_{.padding = padding, .depth = MapDepth::whole, .check = 0},
          offset_(offset_of(settings, mesh_->geometry.frame))
    {
        for (const UvSet& page : layout_.pages) {
            std::vector<SurfacePoint> points;
            const MapRaster raster(mesh_->geometry, page, layout_.size);
            for (const Texel& texel : raster.texels(0, layout_.size.height))
                points.push_back(texel.point);
            const std::vector<Receiver> asked =
                receivers_at(mesh_->geometry, mesh_->surface, points, offset_);
            receivers_.insert(receivers_.end(), asked.begin(), asked.end());
        }
    }

    std::uint64_t receivers() const override { return receivers_.size(); }

    bool shows(std::uint32_t triangle) const override
    {
        return places_of(*mesh_, layout_, {triangle, {0.25f, 0.25f}}).count > 0;
    }

    Floor floor(const SurfaceTruth& truth, const TruthSettings& settings,
                const Progress& progress) const override
    {
        EngineSettings rays;
        rays.engine = Engine::rays;
        rays.definition = settings.definition;
        Floor floor;
        floor.rays = floor_rays(receivers_.size(), settings.rays);
        rays.rays = floor.rays / 2;
        std::vector<Occlusion> halves[2];
        for (int half = 0; half < 2; ++half) {
            rays.seed = kFloorSeeds[half];
            const auto part = [&, half](double done) { return progress(0.5 * (half + done)); };
            const MapBake bake = bake_with(rays, progress ? Progress(part) : Progress());
            halves[half] = displayed(bake, truth);
            const std::vector<float> held = occlusion_of(bake);
            floor.values.resize(held.size());
            for (std::size_t i = 0; i < held.size(); ++i)
                floor.values[i].occlusion += 0.5f * held[i];
        }
        double squares = 0.0;
        for (std::size_t i = 0; i < truth.points.size(); ++i) {
            const float first = halves[0][i].occlusion, second = halves[1][i].occlusion;
            floor.displayed.push_back({0.5f * (first + second), {}});
            squares += 0.25 * (first - second) * (first - second);
        }
        if (!truth.points.empty())
            floor.noise = std::sqrt(squares / static_cast<double>(truth.points.size()));
        floor.error = error_against(truth, floor.displayed);
        floor.error.rmse = without_noise(floor.error.rmse, floor.noise);
        return floor;
    }

    JobResult run(const EngineSettings& engine, const SurfaceTruth* truth,
                  const Progress& progress) const override
    {
        const MapBake bake = bake_with(engine, progress);
        JobResult result;
        result.seconds.raster = bake.seconds.raster;
        result.seconds.build = bake.seconds.surfels + bake.seconds.tree;
        result.seconds.solve = bake.seconds.solve;
        result.seconds.fill = bake.seconds.fill;
        if (truth == nullptr)
            return result;
        result.displayed = displayed(bake, *truth);
        result.answers = answers_at_points(prepare(mesh_->occluding(), engine), receivers_, *truth,
                                           engine, progress);
        result.occlusion = occlusion_of(bake);
        return result;
    }

private:
    MapBake bake_with(const EngineSettings& engine, const Progress& progress) const
    {
        const auto any_stage = [&](std::string_view, double done) { return progress(done); };
        return bake_map(*mesh_, layout_, map_settings_, engine, offset_,
                        progress ? StageProgress(any_stage) : StageProgress());
    }

    std::vector<Occlusion> displayed(const MapBake& bake, const SurfaceTruth& truth) const
    {
        std::vector<Occlusion> shown;
        shown.reserve(truth.points.size());
        for (const SurfacePoint& point : truth.points)
            shown.push_back(
                {1.0f - fetch_at(bake.visibility, places_of(*mesh_, layout_, point)), {}});
        return shown;
    }

    static std::vector<float> occlusion_of(const MapBake& bake)
    {
        std::vector<float> occlusion;
        for (const Map& page : bake.visibility)
            for (const float visibility : page.values)
                occlusion.push_back(1.0f - visibility);
        return occlusion;
    }

    std::shared_ptr<const Mesh> mesh_;
    MapLayout layout_;
    MapSettings map_settings_;
    Offset offset_;
    std::vector<Receiver> receivers_;  ///< at the texels of all pages
};

}  // namespace

std::unique_ptr<const CompareTarget> vertices_to_compare(std::shared_ptr<const Mesh> mesh,
                                                         const TargetSettings& settings)
{
    return std::make_unique<ComparedVertices>(std::move(mesh), settings);
}

std::unique_ptr<const CompareTarget> map_to_compare(std::shared_ptr<const Mesh> mesh,
                                                    MapLayout layout, std::uint32_t padding,
                                                    const TargetSettings& settings)
{
    return std::make_unique<ComparedMap>(std::move(mesh), std::move(layout), padding, settings);
}

}  // namespace surfelao
