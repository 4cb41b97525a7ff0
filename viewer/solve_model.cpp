#include "viewer/solve_model.h"

#include "reference/reference_cache.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <span>
#include <utility>

namespace surfelao {
namespace {

constexpr std::uint32_t kDraftShare = 16;  // of the rays

/// A stage of a longer work, which takes it from one share of the whole to another.
Progress stage(const Progress& whole, double from, double to)
{
    if (!whole)
        return {};
    return [&whole, from, to](double done) { return whole(from + (to - from) * done); };
}

void append(std::vector<Occlusion>& values, std::span<const Occlusion> more)
{
    values.insert(values.end(), more.begin(), more.end());
}

std::vector<Receiver> receivers_of(const Model& model)
{
    if (model.cloud)
        return receivers_at(model.cloud->cloud, model.cloud->cloud.order, model.cloud->offset);
    const std::span<const Receiver> receivers = model.target->receivers();
    return {receivers.begin(), receivers.end()};
}

/// answers: at receivers_of().
std::vector<Occlusion> values_of(const Model& model, std::span<const Occlusion> answers)
{
    if (!model.cloud)
        return model.target->values(answers);
    std::vector<Occlusion> values(answers.size());
    const std::vector<std::uint32_t>& order = model.cloud->cloud.order;
    for (std::size_t i = 0; i < order.size(); ++i)
        values[order[i]] = answers[i];
    return values;
}

bool is_same(const SurfacePoint& a, const SurfacePoint& b)
{
    return a.triangle == b.triangle && a.at == b.at;
}

}  // namespace

EngineSettings draft_of(EngineSettings settings)
{
    if (settings.engine == Engine::rays)
        settings.rays = std::max(1u, settings.rays / kDraftShare);
    else
        settings.quality = std::min(settings.quality, kDraft);
    return settings;
}

Prepared prepare(const Model& model, const EngineChoice& choice)
{
    return model.cloud ? prepare(model.cloud->cloud, model.cloud->squares, choice)
                       : prepare(model.occluding(), choice);
}

ModelAnswer solve_model(const Prepared& prepared, const Model& model, const SolveSettings& settings,
                        const SolveWith& with, const Progress& progress)
{
    std::vector<std::span<const Receiver>> lists(1);
    std::vector<Receiver> asked;
    if (with.vertices)
        lists[0] = asked = receivers_of(model);
    if (with.ground)
        lists.push_back(model.ground_receivers);
    if (with.points)
        lists.push_back(model.point_receivers);
    std::vector<Solution> found = solve_lists(prepared, lists, settings, progress);

    Stopwatch watch;
    ModelAnswer answer;
    if (with.points) {
        answer.at_points = std::move(found.back().occlusion);
        found.pop_back();
    }
    if (with.vertices)
        answer.values = values_of(model, found.front().occlusion);
    else
        answer.values.resize(model.geometry().positions.size());
    if (with.ground) {
        append(answer.values, found.back().occlusion);
    } else {
        for (const Receiver& receiver : model.ground_receivers)
            answer.values.push_back({0.0f, receiver.normal});
    }
    answer.seconds = found.front().seconds + watch.lap();
    return answer;
}

ModelReference reference_of(const Model& model, const Definition& definition, std::uint32_t rays,
                            const Progress& progress)
{
    std::vector<Receiver> receivers = receivers_of(model);
    const std::size_t asked = receivers.size();
    receivers.insert(receivers.end(), model.ground_receivers.begin(), model.ground_receivers.end());
    const Reference traced = trace_reference(
        model.occluding(), receivers,
        {.definition = definition, .rays = rays, .find_ill_defined = false}, progress);
    const std::span<const Occlusion> answers = traced.occlusion;
    ModelReference reference{values_of(model, answers.first(asked)), traced.from_cache};
    append(reference.values, answers.subspan(asked));
    return reference;
}

ModelTruth truth_of(const Model& model, const Definition& definition, std::uint32_t rays,
                    const Progress& progress)
{
    if (model.cloud)
        return {reference_of(model, definition, rays, progress), {}, {}};
    const Geometry& geometry = model.geometry();
    const TruthSettings settings = {.definition = definition,
                                    .offset = offset_of(model.settings, geometry.frame),
                                    .points = kModelPoints,
                                    .rays = rays};
    ModelTruth found;
    found.truth = trace_truth(*model.mesh, settings, stage(progress, 0.0, 0.2));
    const auto find = [&](const VertexTarget& fitted) {
        found.floor =
            find_floor(fitted, *model.mesh, found.truth, settings, stage(progress, 0.2, 0.6));
    };
    if (model.settings.values == VertexValues::fit) {
        find(*model.target);
        const Reference ground =
            trace_reference(model.occluding(), model.ground_receivers,
                            {.definition = definition, .rays = rays, .find_ill_defined = false},
                            stage(progress, 0.6, 1.0));
        found.reference = {found.floor.values, found.floor.from_cache && ground.from_cache};
        append(found.reference.values, ground.occlusion);
    } else {
        TargetSettings fit = model.settings;
        fit.values = VertexValues::fit;
        find(VertexTarget(model.mesh, fit));
        found.reference = reference_of(model, definition, rays, stage(progress, 0.6, 1.0));
        found.reference.from_cache &= found.floor.from_cache;
    }
    found.reference.from_cache &= found.truth.from_cache;
    return found;
}

ModelError error_of(const Model& model, const ModelTruth& truth, std::span<const Occlusion> values,
                    std::span<const Occlusion> at_points)
{
    // those of the well-defined points: in the same order, some left out
    std::vector<Occlusion> judged;
    for (std::size_t i = 0; i < model.points.size() && judged.size() < truth.truth.points.size();
         ++i) {
        if (is_same(model.points[i], truth.truth.points[judged.size()]))
            judged.push_back(at_points[i]);
    }
    SURFELAO_CHECK(judged.size() == truth.truth.points.size());
    const std::span<const Occlusion> of_vertices = values.first(model.geometry().positions.size());
    return {.seen = seen_error(model.geometry(), of_vertices, truth.truth),
            .floor = truth.floor.error.rmse,
            .solve = error_against(truth.truth, judged).rmse,
            .left_out = truth.truth.ill_defined};
}

}  // namespace surfelao
