#include "bake/compare.h"

#include "bake/sample.h"
#include "engines/threads.h"
#include "files/scene_io.h"
#include "gpu/context.h"
#include "reference/reference_cache.h"
#include "reference/smoothing.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace surfelao {
namespace {

constexpr std::size_t kWorstCount = 5;

/// Of what is done in a few milliseconds the waking of sleeping threads is half; it is repeated
/// within its round for so many seconds, whoever does it, and the median counts.
constexpr double kLeastRound = 0.05;
constexpr std::size_t kMostRepeats = 50;

/// What is asked, and the answer that counts.
struct Question {
    std::optional<VertexTarget> target;
    std::vector<Receiver> receivers;    ///< all vertices: what every engine solves
    std::vector<std::uint32_t> judged;  ///< into receivers: where errors are taken
    std::vector<Occlusion> reference;   ///< one per judged
};

Question ask(const CompareSettings& settings, const Definition& definition, Comparison& comparison,
             const Progress& progress)
{
    Question question;
    question.target.emplace(comparison.mesh, settings.target);
    const std::span<const Receiver> all = question.target->receivers();
    question.receivers.assign(all.begin(), all.end());
    std::vector<std::uint32_t> asked;
    std::vector<Receiver> places;
    for (const std::uint32_t i : sample_of(question.receivers.size(), settings.sample)) {
        if (question.receivers[i].normal == glm::vec3(0.0f)) {
            ++comparison.without_normal;
        } else {
            asked.push_back(i);
            places.push_back(question.receivers[i]);
        }
    }
    const Reference reference =
        trace_reference(comparison.mesh->geometry, places,
                        {definition, settings.reference_rays, settings.use_cache}, progress);
    for (std::size_t i = 0; i < asked.size(); ++i) {
        if (reference.well_defined(i)) {
            question.judged.push_back(asked[i]);
            question.reference.push_back(reference.occlusion[i]);
        } else {
            ++comparison.ill_defined;
        }
    }
    comparison.reference.assign(question.receivers.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < question.judged.size(); ++i)
        comparison.reference[question.judged[i]] = question.reference[i].occlusion;
    comparison.judged = question.judged.size();
    comparison.reference_rays = settings.reference_rays;
    comparison.reference_noise = reference.noise;
    comparison.reference_from_cache = reference.from_cache;
    return question;
}

/// Fills in everything about errors. They are the same in every round.
void judge(const Question& question, const Scene& scene, const std::vector<Occlusion>& answer,
           CompareRow& row)
{
    std::vector<Occlusion> judged;
    judged.reserve(question.judged.size());
    for (const std::uint32_t i : question.judged)
        judged.push_back(answer[i]);
    row.error = error_statistics(judged, question.reference);

    const auto error_at = [&](std::size_t i) {
        return std::fabs(judged[i].occlusion - question.reference[i].occlusion);
    };
    std::vector<std::uint32_t> order(judged.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = static_cast<std::uint32_t>(i);
    const std::size_t worst = std::min(kWorstCount, order.size());
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(worst),
                      order.end(), [&](std::uint32_t a, std::uint32_t b) {
                          return error_at(a) != error_at(b) ? error_at(a) > error_at(b) : a < b;
                      });
    for (std::size_t i = 0; i < worst; ++i) {
        const std::uint32_t vertex = question.judged[order[i]];
        row.worst.push_back({vertex, scene.positions[0], judged[order[i]].occlusion,
                             question.reference[order[i]].occlusion});
    }
    if (row.settings.engine == Engine::rays)
        return;
    row.errors.assign(answer.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < judged.size(); ++i)
        row.errors[question.judged[i]] = judged[i].occlusion - question.reference[i].occlusion;
}

CompareRow row_of_rays(const Definition& definition, std::uint32_t rays, bool smoothed)
{
    CompareRow row;
    row.settings.engine = Engine::rays;
    row.settings.definition = definition;
    row.settings.rays = rays;
    row.smoothed = smoothed;
    return row;
}

/// Candidates, then the opponent, then smoothed rays.
std::vector<CompareRow> rows_of(const CompareSettings& settings, const Definition& definition)
{
    std::vector<CompareRow> rows;
    for (const EngineSettings& candidate : settings.candidates) {
        rows.emplace_back().settings = candidate;
        rows.back().settings.definition = definition;
    }
    for (const std::uint32_t rays : settings.rays)
        rows.push_back(row_of_rays(definition, rays, false));
    for (const std::uint32_t rays : settings.smoothed_rays)
        rows.push_back(row_of_rays(definition, rays, true));
    for (CompareRow& row : rows)
        row.settings.instructions = settings.instructions;
    return rows;
}

/// Seconds of one row, one of each round.
struct Times {
    std::vector<double> builds, solves;
};

/// One round of one row; its first answer is judged.
void run_round(const Comparison& comparison, const Question& question, const EngineChoice& choice,
               CompareRow& row, Times& times, const Progress& progress)
{
    Times repeats;
    double spent = 0.0;
    do {
        const Prepared prepared = prepare(comparison.mesh->geometry, choice);
        Solution solution = solve(prepared, question.receivers, row.settings, progress);
        if (row.smoothed) {
            Stopwatch smoothing;
            solution.occlusion = solution.occlusion;
            solution.seconds += smoothing.lap();
        }
        repeats.builds.push_back(prepared.seconds().surfels + prepared.seconds().tree);
        repeats.solves.push_back(solution.seconds);
        spent += repeats.builds.back() + repeats.solves.back();
        if (row.worst.empty())
            judge(question, comparison.mesh->scene, solution.occlusion, row);
    } while (spent < kLeastRound && repeats.solves.size() < kMostRepeats);
    times.builds.push_back(quantile(repeats.builds, 0.5));
    times.solves.push_back(quantile(repeats.solves, 0.5));
}

void set_times(CompareRow& row, const Times& times, std::size_t receiver_count)
{
    row.rounds = static_cast<int>(times.solves.size());
    row.build_s = quantile(times.builds, 0.5);
    row.solve_s = quantile(times.solves, 0.5);
    row.us_per_vertex =
        row.solve_s * 1e6 / static_cast<double>(std::max<std::size_t>(1, receiver_count));
}

/// Whether a candidate is beyond the most exact row of the opponent.
bool wants_more_rays(const std::vector<CompareRow>& rows)
{
    double candidates = 1.0, opponent = 1.0;
    for (const CompareRow& row : rows) {
        double& least = is_opponent(row) ? opponent : candidates;
        if (row.settings.engine != Engine::rays || is_opponent(row))
            least = std::min(least, row.error.rmse);
    }
    return candidates < opponent;
}

std::optional<EmbreeRatio> ratio_at(const Comparison& comparison, const CompareRow& row,
                                    bool with_builds)
{
    const double ours = row.solve_s + (with_builds ? row.build_s : 0.0);
    const auto theirs = time_at(embree_curve(comparison, with_builds), row.error.rmse);
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

std::string setting_of(const CompareRow& row)
{
    return setting_of(row.settings) + (row.smoothed ? ", smoothed" : "");
}

bool is_opponent(const CompareRow& row)
{
    return row.settings.engine == Engine::rays && !row.smoothed;
}

std::vector<CurvePoint> embree_curve(const Comparison& comparison, bool with_builds)
{
    std::vector<CurvePoint> curve;
    for (const CompareRow& row : comparison.rows) {
        if (is_opponent(row))
            curve.push_back({row.error.rmse, row.solve_s + (with_builds ? row.build_s : 0.0)});
    }
    return curve;
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
    comparison.threads = thread_count();
    comparison.rounds = settings.rounds;
    static_cast<void>(stage("read"));
    Stopwatch watch;
    comparison.mesh = std::make_shared<const Mesh>(
        make_mesh(read_scene(settings.input), settings.target.normals));
    comparison.read_s = watch.lap();
    comparison.vertices = comparison.mesh->scene.positions.size();
    comparison.triangles = comparison.mesh->scene.triangles.size();
    comparison.dropped_triangles = comparison.mesh->geometry.dropped_triangles;
    const Definition definition =
        definition_of(settings.max_distance, settings.kernel, comparison.mesh->geometry.frame);
    const Question question = ask(settings, definition, comparison, stage("reference"));

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
                  stage(name_of(rows[i].settings.engine) + " " + setting_of(rows[i])));
    };
    for (int round = 0; round < settings.rounds; ++round) {
        for (std::size_t i = 0; i < rows.size(); ++i)
            run(i);
    }
    // once: by far the longest of all runs, and so the one that other work disturbs least
    if (!settings.rays.empty() && wants_more_rays(rows)) {
        const std::uint32_t most = *std::max_element(settings.rays.begin(), settings.rays.end());
        rows.push_back(row_of_rays(definition, 4 * most, false));
        rows.back().settings.instructions = settings.instructions;
        times.emplace_back();
        run(rows.size() - 1);
    }

    for (std::size_t i = 0; i < rows.size(); ++i)
        set_times(rows[i], times[i], question.receivers.size());
    for (CompareRow& row : rows) {
        if (!is_opponent(row)) {
            row.solve_ratio = ratio_at(comparison, row, false);
            row.total_ratio = ratio_at(comparison, row, true);
        }
    }
    return comparison;
}

}  // namespace surfelao
