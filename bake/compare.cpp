#include "bake/compare.h"

#include "bake/surface_error.h"
#include "engines/threads.h"
#include "files/scene_io.h"
#include "gpu/context.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <ranges>
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
    VertexTarget target;
    SurfaceTruth truth;
    Floor floor;
};

TruthSettings truth_settings_of(const CompareSettings& settings, const Definition& definition,
                                const Frame& frame)
{
    TruthSettings truth;
    truth.definition = definition;
    truth.offset = offset_of(settings.target, frame);
    truth.points = settings.sample > 0 ? settings.sample : kSurfacePoints;
    truth.rays = settings.reference_rays;
    truth.use_cache = settings.use_cache;
    return truth;
}

Floor floor_of(const Comparison& comparison, const VertexTarget& target, const SurfaceTruth& truth,
               const TruthSettings& settings, const Progress& progress)
{
    const Geometry& geometry = comparison.mesh->geometry;
    if (comparison.target.values == VertexValues::fit)
        return find_floor(target, geometry, truth, settings, progress);
    TargetSettings fitted = comparison.target;
    fitted.values = VertexValues::fit;
    return find_floor(VertexTarget(comparison.mesh, fitted), geometry, truth, settings, progress);
}

void tell(const Question& question, std::uint32_t reference_rays, Comparison& comparison)
{
    comparison.reference_rays = reference_rays;
    comparison.reference_noise = question.truth.noise;
    comparison.reference_from_cache = question.truth.from_cache;
    comparison.points = question.truth.points.size();
    comparison.ill_defined = question.truth.ill_defined;
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
    std::vector<std::uint32_t> order(std::min(kWorstCount, shown.size()));
    std::ranges::partial_sort_copy(
        std::views::iota(std::uint32_t{0}, static_cast<std::uint32_t>(shown.size())), order,
        [&](std::uint32_t a, std::uint32_t b) {
            return error_at(a) != error_at(b) ? error_at(a) > error_at(b) : a < b;
        });
    std::vector<WorstPoint> worst;
    for (const std::uint32_t i : order) {
        const SurfacePoint& point = truth.points[i];
        const std::size_t triangle = mesh.geometry.scene_triangle(point.triangle);
        const glm::uvec3 t = mesh.scene.triangles[triangle];
        const std::vector<glm::dvec3>& p = mesh.scene.positions;
        const glm::dvec2 at(point.at);
        worst.push_back({triangle, (1.0 - at.x - at.y) * p[t.x] + at.x * p[t.y] + at.y * p[t.z],
                         shown[i].occlusion, truth.reference[i].occlusion});
    }
    return worst;
}

/// The engine's own answers at the surface points: in one list with the receivers, so that they
/// are answered in groups as these are. Rays have no groups.
std::vector<Occlusion> answers_at_points(const Question& question, const Prepared& prepared,
                                         const CompareRow& row, const Progress& progress)
{
    if (is_opponent(row))
        return solve(prepared, question.truth.receivers, row.settings, progress).occlusion;
    const std::span<const Receiver> all = question.target.receivers();
    std::vector<Receiver> asked(all.begin(), all.end());
    asked.insert(asked.end(), question.truth.receivers.begin(), question.truth.receivers.end());
    std::vector<Occlusion> answers = solve(prepared, asked, row.settings, progress).occlusion;
    answers.erase(answers.begin(), answers.begin() + static_cast<std::ptrdiff_t>(all.size()));
    return answers;
}

/// Fills in everything about errors. They are the same in every round.
void judge(const Question& question, const Mesh& mesh, const Prepared& prepared,
           std::span<const Occlusion> values, CompareRow& row, const Progress& progress)
{
    const SurfaceTruth& truth = question.truth;
    const std::vector<Occlusion> shown = displayed_at(mesh.geometry, values, truth.points);
    row.seen = error_against(truth, shown);
    row.beyond = error_beyond(shown, question.floor);
    row.worst = worst_of(mesh, truth, shown);
    row.solve = error_against(truth, answers_at_points(question, prepared, row, progress));
    if (is_opponent(row))
        return;
    for (std::size_t v = 0; v < values.size(); ++v)
        row.errors.push_back(values[v].occlusion - question.floor.values[v].occlusion);
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

/// Seconds of one row, one of each round.
struct Times {
    std::vector<double> builds, solves, fits;
};

/// One round of one row; the first answer of all is judged.
void run_round(const Comparison& comparison, const Question& question, const EngineChoice& choice,
               CompareRow& row, Times& times, const Progress& progress)
{
    Times repeats;
    double spent = 0.0;
    bool judged = !times.solves.empty();
    do {
        const Prepared prepared = prepare(comparison.mesh->geometry, choice);
        const Solution solution =
            solve(prepared, question.target.receivers(), row.settings, progress);
        Stopwatch fitting;
        const std::vector<Occlusion> values = question.target.values(solution.occlusion);
        repeats.fits.push_back(fitting.lap());
        repeats.builds.push_back(prepared.seconds().surfels + prepared.seconds().tree);
        repeats.solves.push_back(solution.seconds);
        spent += repeats.builds.back() + repeats.solves.back() + repeats.fits.back();
        if (!judged)
            judge(question, *comparison.mesh, prepared, values, row, progress);
        judged = true;
    } while (spent < kLeastRound && repeats.solves.size() < kMostRepeats);
    times.builds.push_back(quantile(repeats.builds, 0.5));
    times.solves.push_back(quantile(repeats.solves, 0.5));
    times.fits.push_back(quantile(repeats.fits, 0.5));
}

void set_times(CompareRow& row, const Times& times, std::size_t receiver_count)
{
    row.rounds = static_cast<int>(times.solves.size());
    row.build_s = quantile(times.builds, 0.5);
    row.solve_s = quantile(times.solves, 0.5);
    row.fit_s = quantile(times.fits, 0.5);
    row.us_per_receiver =
        row.solve_s * 1e6 / static_cast<double>(std::max<std::size_t>(1, receiver_count));
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
    return row.solve_s + row.fit_s + (with_build ? row.build_s : 0.0);
}

double beyond_by_squares(const Comparison& comparison, const CompareRow& row)
{
    return without_noise(row.seen.rmse, comparison.floor.rmse);
}

Comparison compare(const CompareSettings& settings, const StageProgress& progress)
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
    comparison.threads = thread_count();
    comparison.rounds = settings.rounds;
    static_cast<void>(stage("read"));
    Stopwatch watch;
    comparison.mesh = std::make_shared<const Mesh>(
        make_mesh(read_scene(settings.input), settings.target.normals));
    VertexTarget target(comparison.mesh, settings.target);
    comparison.read_s = watch.lap();
    comparison.vertices = comparison.mesh->scene.positions.size();
    comparison.triangles = comparison.mesh->scene.triangles.size();
    comparison.dropped_triangles = comparison.mesh->geometry.dropped_triangles;
    comparison.receivers = target.receivers().size();
    const Frame& frame = comparison.mesh->geometry.frame;
    const Definition definition = definition_of(settings.max_distance, settings.kernel, frame);
    const TruthSettings truth_settings = truth_settings_of(settings, definition, frame);
    SurfaceTruth truth = trace_truth(*comparison.mesh, truth_settings, stage("reference"));
    Floor floor = floor_of(comparison, target, truth, truth_settings, stage("floor"));
    const Question question{std::move(target), std::move(truth), std::move(floor)};
    tell(question, settings.reference_rays, comparison);

    // rounds: one after the other, so that whatever slows the machine slows all alike
    std::vector<CompareRow>& rows = comparison.rows;
    rows = rows_of(settings, definition);
    std::vector<Times> times(rows.size());
    std::optional<GlContext> context;  // one for all, so that shaders are compiled once
    const auto run = [&](std::size_t i) {
        EngineChoice choice = rows[i].settings;
        if (choice.device == Device::gpu && choice.context == nullptr)
            choice.context = context ? &*context : &context.emplace(GlContext::create());
        run_round(comparison, question, choice, rows[i], times[i],
                  stage(name_of(rows[i].settings.engine) + " " + setting_of(rows[i].settings)));
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
