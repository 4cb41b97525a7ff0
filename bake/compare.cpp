#include "bake/compare.h"

#include "bake/compare_target.h"
#include "engines/threads.h"
#include "gpu/context.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

namespace surfelao {
namespace {

constexpr std::size_t kWorstCount = 5;

/// Of what is done in a few milliseconds the waking of sleeping threads is half; it is repeated
/// within its round for so many seconds, whoever does it, and the median counts.
constexpr double kLeastRound = 0.05;
constexpr std::size_t kMostRepeats = 50;

/// What is asked, and what is right.
struct Question {
    std::unique_ptr<const CompareTarget> target;
    SurfaceTruth truth;
    Floor floor;
};

TruthSettings truth_settings_of(const CompareSettings& settings, const Definition& definition,
                                const Mesh& mesh, const CompareTarget& target)
{
    TruthSettings truth;
    truth.definition = definition;
    truth.offset = offset_of(settings.target, mesh.geometry.frame);
    truth.points = settings.sample > 0 ? settings.sample : kSurfacePoints;
    truth.rays = settings.reference_rays;
    truth.use_cache = settings.use_cache;
    truth.leave_out_hidden = settings.texels.has_value();
    truth.measure = triangle_areas(mesh.geometry);
    for (std::uint32_t t = 0; t < truth.measure.size(); ++t)
        truth.measure[t] *= target.shows(t) ? 1.0 : 0.0;
    return truth;
}

void tell(const Question& question, std::uint32_t reference_rays, Comparison& comparison)
{
    comparison.reference_rays = reference_rays;
    comparison.reference_noise = question.truth.noise;
    comparison.reference_from_cache = question.truth.from_cache;
    comparison.points = question.truth.points.size();
    comparison.ill_defined = question.truth.ill_defined;
    comparison.hidden = question.truth.hidden;
    comparison.floor = question.floor.error;
    comparison.floor_rays = question.floor.rays;
    comparison.floor_noise = question.floor.noise;
    for (const Occlusion& value : question.floor.values)
        comparison.reference.push_back(value.occlusion);
}

std::vector<WorstPoint> worst_of(const Mesh& mesh, const SurfaceTruth& truth,
                                 std::span<const Occlusion> shown)
{
    const auto error_at = [&](std::size_t i) {
        return std::fabs(shown[i].occlusion - truth.reference[i].occlusion);
    };
    std::vector<std::uint32_t> all(shown.size());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<std::uint32_t> order(std::min(kWorstCount, shown.size()));
    std::ranges::partial_sort_copy(all, order, [&](std::uint32_t a, std::uint32_t b) {
        return error_at(a) != error_at(b) ? error_at(a) > error_at(b) : a < b;
    });
    std::vector<WorstPoint> worst;
    for (const std::uint32_t i : order) {
        const SurfacePoint& point = truth.points[i];
        if (mesh.scene.triangles.empty()) {
            worst.push_back({point.triangle, mesh.scene.positions[point.triangle],
                             shown[i].occlusion, truth.reference[i].occlusion});
            continue;
        }
        const std::size_t triangle = mesh.geometry.scene_triangle(point.triangle);
        const glm::uvec3 t = mesh.scene.triangles[triangle];
        const std::vector<glm::dvec3>& p = mesh.scene.positions;
        const glm::dvec2 at(point.at);
        worst.push_back({triangle, (1.0 - at.x - at.y) * p[t.x] + at.x * p[t.y] + at.y * p[t.z],
                         shown[i].occlusion, truth.reference[i].occlusion});
    }
    return worst;
}

/// Fills in everything about errors. They are the same in every round.
void judge(const Question& question, const Mesh& mesh, const JobResult& result, CompareRow& row)
{
    const SurfaceTruth& truth = question.truth;
    row.seen = error_against(truth, result.displayed);
    row.beyond = error_beyond(result.displayed, question.floor);
    row.worst = worst_of(mesh, truth, result.displayed);
    row.solve = error_against(truth, result.answers);
    if (is_opponent(row))
        return;
    for (std::size_t i = 0; i < result.occlusion.size(); ++i)
        row.errors.push_back(result.occlusion[i] - question.floor.values[i].occlusion);
}

CompareRow row_of_rays(const CompareSettings& settings, const Definition& definition,
                       std::uint32_t rays)
{
    CompareRow row;
    row.settings.engine = Engine::rays;
    row.settings.definition = definition;
    row.settings.rays = rays;
    row.settings.instructions = settings.instructions;
    return row;
}

/// Candidates, then the opponent.
std::vector<CompareRow> rows_of(const CompareSettings& settings, const Definition& definition)
{
    std::vector<CompareRow> rows;
    for (const EngineSettings& candidate : settings.candidates) {
        EngineSettings& own = rows.emplace_back().settings = candidate;
        own.definition = definition;
        own.instructions = settings.instructions;
    }
    for (const std::uint32_t rays : settings.rays)
        rows.push_back(row_of_rays(settings, definition, rays));
    return rows;
}

/// The members of JobSeconds, and where a row keeps them.
constexpr std::pair<double JobSeconds::*, double CompareRow::*> kSeconds[] = {
    {&JobSeconds::raster, &CompareRow::raster_s}, {&JobSeconds::build, &CompareRow::build_s},
    {&JobSeconds::solve, &CompareRow::solve_s},   {&JobSeconds::fit, &CompareRow::fit_s},
    {&JobSeconds::fill, &CompareRow::fill_s},
};

JobSeconds median_of(const std::vector<JobSeconds>& list)
{
    JobSeconds median;
    for (const auto& [member, kept] : kSeconds) {
        std::vector<double> seconds;
        for (const JobSeconds& one : list)
            seconds.push_back(one.*member);
        median.*member = quantile(std::move(seconds), 0.5);
    }
    return median;
}

/// One round of one row; the first answer of all is judged.
JobSeconds run_round(const Comparison& comparison, const Question& question,
                     const EngineSettings& engine, bool is_judged, CompareRow& row,
                     const Progress& progress)
{
    std::vector<JobSeconds> repeats;
    double spent = 0.0;
    do {
        const bool judges = is_judged && repeats.empty();
        const JobResult result =
            question.target->run(engine, judges ? &question.truth : nullptr, progress);
        repeats.push_back(result.seconds);
        for (const auto& [member, kept] : kSeconds)
            spent += result.seconds.*member;
        if (judges)
            judge(question, *comparison.mesh, result, row);
    } while (spent < kLeastRound && repeats.size() < kMostRepeats);
    return median_of(repeats);
}

void set_times(CompareRow& row, const std::vector<JobSeconds>& rounds, std::size_t receiver_count)
{
    row.rounds = static_cast<int>(rounds.size());
    const JobSeconds median = median_of(rounds);
    for (const auto& [member, kept] : kSeconds)
        row.*kept = median.*member;
    row.us_per_receiver =
        row.solve_s * 1e6 / static_cast<double>(std::max<std::size_t>(1, receiver_count));
}

/// The mesh, or the cloud.
void take_scene(Scene scene, const CompareSettings& settings, Comparison& comparison,
                const StageProgress& progress)
{
    check_target(scene, settings.target, settings.parts);
    if (!scene.triangles.empty()) {
        comparison.mesh = std::make_shared<const Mesh>(
            mesh_of(std::move(scene), read_others(settings.parts, settings.reading),
                    settings.target.normals, settings.parts));
        return;
    }
    require(!settings.texels, scene.name + ": has points only, no faces: --at points");
    comparison.cloud =
        std::make_shared<const PointTarget>(make_point_target(scene, settings.target, progress));
    comparison.points_report = report_of(*comparison.cloud);
    comparison.mesh = std::make_shared<const Mesh>(point_mesh(std::move(scene), comparison.cloud));
}

/// Makes the mesh the one at whose vertices all engines answer.
void subdivide_mesh(Comparison& comparison, const CompareSettings& settings,
                    const StageProgress& progress)
{
    const Mesh& read = *comparison.mesh;
    require(!comparison.cloud, read.scene.name + ": has points only, which --subdivide cannot cut");
    EngineSettings engine;
    const Frame& frame = read.geometry.frame;
    engine.definition = definition_of(settings.max_distance, settings.kernel, frame);
    engine.definition.ground = ground_of(settings.ground, {read.geometry, read.occluding()},
                                         largest_offset_of(settings.target, frame));
    if (!knows_kernel(engine.engine, settings.kernel))
        engine.engine = Engine::rays;
    Occluders occluders(read.occluding());
    SubdivisionReport told;
    comparison.mesh = std::make_shared<const Mesh>(
        subdivided(read, *settings.subdivide, settings.target, engine, occluders, progress, told));
}

/// The layout is told in the comparison.
std::unique_ptr<const CompareTarget> target_of(const CompareSettings& settings,
                                               Comparison& comparison)
{
    if (comparison.cloud)
        return points_to_compare(*comparison.cloud);
    if (!settings.texels)
        return vertices_to_compare(comparison.mesh, settings.target);
    TexelLayout found = layout_for(*comparison.mesh, *settings.texels);
    comparison.page = found.layout.size;
    comparison.pages = found.layout.pages.size();
    comparison.uv_set = found.uv_set;
    return map_to_compare(comparison.mesh, std::move(found.layout), settings.texels->padding,
                          settings.target);
}

/// Whether a candidate is beyond the most exact row of the opponent.
bool wants_more_rays(const std::vector<CompareRow>& rows)
{
    double candidates = 1.0, opponent = 1.0;
    for (const CompareRow& row : rows) {
        double& least = is_opponent(row) ? opponent : candidates;
        least = std::min(least, row.beyond);
    }
    return candidates < opponent;
}

std::optional<EmbreeRatio> ratio_of(const Comparison& comparison, const CompareRow& row,
                                    bool with_builds)
{
    std::vector<CurvePoint> family;
    for (const CompareRow& other : comparison.rows) {
        if (is_opponent(other))
            family.push_back({other.beyond, job_seconds(other, with_builds)});
    }
    const double ours = job_seconds(row, with_builds);
    const auto theirs = time_at(family, row.beyond);
    if (!theirs || !(ours > 0.0))
        return std::nullopt;
    return EmbreeRatio{theirs->seconds / ours, theirs->extrapolated};
}

}  // namespace

const CompareRow& shown_row(const Comparison& comparison)
{
    for (const CompareRow& row : comparison.rows) {
        if (!row.errors.empty() && row.settings.quality == kGood)
            return row;
    }
    return comparison.rows.front();
}

bool is_opponent(const CompareRow& row)
{
    return row.settings.engine == Engine::rays;
}

double job_seconds(const CompareRow& row, bool with_build)
{
    return row.solve_s + row.fit_s + row.fill_s + (with_build ? row.build_s : 0.0);
}

double beyond_by_squares(const Comparison& comparison, const CompareRow& row)
{
    return without_noise(row.seen.rmse, comparison.floor.rmse);
}

Comparison compare(const CompareSettings& settings, const StageProgress& progress)
{
    if (progress && !progress("read", 0.0))
        throw Cancelled();
    Stopwatch watch;
    Scene scene = read_scene(settings.input, settings.reading);
    const double read_s = watch.lap();
    Comparison comparison = compare(std::move(scene), settings, progress);
    comparison.read_s += read_s;
    return comparison;
}

Comparison compare(Scene scene, const CompareSettings& settings, const StageProgress& progress)
{
    require(settings.rounds >= 1, "rounds must be at least 1");
    const auto stage = [&](std::string name) -> Progress {
        if (!progress)
            return {};
        if (!progress(name, 0.0))
            throw Cancelled();
        return [&progress, name = std::move(name)](double done) { return progress(name, done); };
    };

    // the scene and the question
    Comparison comparison;
    comparison.input = settings.input;
    comparison.target = settings.target;
    comparison.texels = settings.texels;
    comparison.subdivide = settings.subdivide;
    comparison.threads = thread_count();
    comparison.rounds = settings.rounds;
    static_cast<void>(stage("read"));
    Stopwatch watch;
    take_scene(std::move(scene), settings, comparison, progress);
    if (settings.subdivide)
        subdivide_mesh(comparison, settings, progress);
    std::unique_ptr<const CompareTarget> target = target_of(settings, comparison);
    comparison.read_s = watch.lap();
    comparison.vertices = comparison.mesh->scene.positions.size();
    comparison.triangles = comparison.mesh->scene.triangles.size();
    comparison.dropped_triangles = comparison.mesh->geometry.dropped_triangles;
    comparison.receivers = target->receivers();
    const Geometry& geometry = comparison.mesh->geometry;
    Definition definition = definition_of(settings.max_distance, settings.kernel, geometry.frame);
    definition.ground = comparison.cloud
                            ? ground_below(*comparison.cloud, settings.ground)
                            : ground_of(settings.ground, {geometry, comparison.mesh->occluding()},
                                        largest_offset_of(settings.target, geometry.frame));
    if (definition.ground)
        comparison.ground = text_of(*definition.ground, geometry.frame);
    const TruthSettings truth_settings =
        truth_settings_of(settings, definition, *comparison.mesh, *target);
    SurfaceTruth truth = target->truth(truth_settings, stage("reference"));
    Floor floor = target->floor(truth, truth_settings, stage("floor"));
    const Question question{std::move(target), std::move(truth), std::move(floor)};
    tell(question, settings.reference_rays, comparison);

    // rounds: one after the other, so that whatever slows the machine slows all alike
    std::vector<CompareRow>& rows = comparison.rows;
    rows = rows_of(settings, definition);
    std::vector<std::vector<JobSeconds>> times(rows.size());
    std::optional<GlContext> context;  // one for all, so that shaders are compiled once
    const auto run = [&](std::size_t i) {
        EngineSettings engine = rows[i].settings;
        if (engine.device == Device::gpu && engine.context == nullptr)
            engine.context = context ? &*context : &context.emplace(GlContext::create());
        times[i].push_back(run_round(comparison, question, engine, times[i].empty(), rows[i],
                                     stage(name_of(engine.engine) + " " + setting_of(engine))));
    };
    for (int round = 0; round < settings.rounds; ++round) {
        for (std::size_t i = 0; i < rows.size(); ++i)
            run(i);
    }
    // once: by far the longest of all runs, and so the one that other work disturbs least
    if (!settings.rays.empty() && wants_more_rays(rows)) {
        const std::uint32_t most = *std::max_element(settings.rays.begin(), settings.rays.end());
        rows.push_back(row_of_rays(settings, definition, 4 * most));
        times.emplace_back();
        run(rows.size() - 1);
    }

    for (std::size_t i = 0; i < rows.size(); ++i)
        set_times(rows[i], times[i], comparison.receivers);
    for (CompareRow& row : rows) {
        if (!is_opponent(row)) {
            row.ratio = ratio_of(comparison, row, false);
            row.ratio_with_builds = ratio_of(comparison, row, true);
        }
    }
    return comparison;
}

}  // namespace surfelao
