#include "tests/stability/judge.h"

#include "reference/rays.h"
#include "reference/well_defined.h"
#include "tests/differences.h"

#include <tbb/task_arena.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <exception>

namespace surfelao::stability {
namespace {

/// Bent normals are sums of thousands of float directions.
constexpr float kUnitLength = 1e-4f;

std::vector<Occlusion> solve(const World& world, std::span<const Receiver> receivers,
                             const Engine& engine, Built& built, int threads)
{
    std::vector<Occlusion> result;
    tbb::task_arena arena(threads);
    arena.execute([&] {
        SolveSettings settings = engine.settings;
        settings.definition = world.definition;
        result = built.of(engine, world, threads)(receivers, settings);
    });
    return result;
}

/// Empty where every number is what it may be.
std::string fault_in_numbers(std::span<const Receiver> receivers,
                             const std::vector<Occlusion>& answers)
{
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const Occlusion a = answers[i];
        const glm::vec3 n = receivers[i].normal;
        if (!std::isfinite(a.occlusion) || !std::isfinite(glm::dot(a.bent_normal, a.bent_normal)))
            return "not a number";
        if (a.occlusion < 0.0f || a.occlusion > 1.0f)
            return "outside [0, 1]";
        if (n == glm::vec3(0.0f)) {
            if (a.occlusion != 0.0f || a.bent_normal != glm::vec3(0.0f))
                return "no normal, yet an answer";
            continue;
        }
        if (std::abs(glm::length(a.bent_normal) - 1.0f) > kUnitLength)
            return "bent normal not of unit length";
        if (glm::dot(a.bent_normal, n) < -kUnitLength)
            return "bent normal below the horizon";
    }
    return {};
}

/// Over the receivers that have an answer and a hemisphere.
Bound error_of(const Trial& trial, const std::vector<Occlusion>& answers,
               const std::vector<Occlusion>& like)
{
    Bound error;
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        if (!trial.has_answer[i])
            continue;
        const double right = trial.world.like ? double(like[trial.world.like_receiver[i]].occlusion)
                                              : trial.truth[i];
        const double off = std::abs(double(answers[i].occlusion) - right);
        error.worst = std::max(error.worst, off);
        sum += off * off;
        ++count;
    }
    if (count > 0)
        error.rms = std::sqrt(sum / static_cast<double>(count));
    return error;
}

Finding examine(const Trial& trial, const Engine& engine, const std::string& excuse, Built& built)
{
    Finding finding;
    finding.verdict = Verdict::fail;
    finding.bound = engine.bound;

    const Answers answers = solve_twice(trial.world, engine, built);
    finding.fault = answers.fault;
    if (answers.occlusion.size() != trial.world.receivers.size())
        return finding;
    std::vector<Occlusion> like;
    if (trial.world.like) {
        like = solve(*trial.world.like, trial.world.like->receivers, engine, built,
                     tbb::task_arena::automatic);
        finding.bound = {2.0 * engine.bound.rms, 2.0 * engine.bound.worst};
    }
    finding.error = error_of(trial, answers.occlusion, like);
    if (!finding.fault.empty())
        return finding;

    if (trial.undefined == trial.has_answer.size()) {
        finding.verdict = Verdict::undefined;
    } else if (finding.error.rms <= finding.bound.rms &&
               finding.error.worst <= finding.bound.worst) {
        finding.verdict = Verdict::pass;
    } else if (engine.may_be_excused && !excuse.empty()) {
        finding.verdict = Verdict::excused;
    } else {
        finding.fault = "error above its bound";
    }
    return finding;
}

}  // namespace

const Solver& Built::of(const Engine& engine, const World& world, int threads)
{
    Solver& solver = solvers_[{engine.built, &world, threads}];
    if (!solver)
        solver = engine.prepare(world.geometry);
    return solver;
}

Trial prepare(World world)
{
    Trial trial;
    trial.world = std::move(world);
    const RayScene rays(trial.world.geometry, RayScene::Build::robust);
    const auto changes_of = [](const RayScene& scene, const World& of) {
        return placement_change(scene, of.receivers, of.definition);
    };
    const std::vector<float> change = changes_of(rays, trial.world);
    trial.has_answer.resize(change.size());
    std::transform(change.begin(), change.end(), trial.has_answer.begin(),
                   [](float c) { return c <= kIllDefined; });
    if (trial.world.like) {
        const World& like = *trial.world.like;
        const std::vector<float> there =
            changes_of(RayScene(like.geometry, RayScene::Build::robust), like);
        for (std::size_t i = 0; i < change.size(); ++i) {
            if (there[trial.world.like_receiver[i]] > kIllDefined)
                trial.has_answer[i] = false;
        }
    } else if (trial.world.answer) {
        for (const Receiver& receiver : trial.world.receivers)
            trial.truth.push_back(
                receiver.normal == glm::vec3(0.0f) ? 0.0 : trial.world.answer(receiver));
    } else {
        RayOptions options;
        options.definition = trial.world.definition;
        options.rays = 4096;
        for (const Occlusion& answer : trace_occlusion(rays, trial.world.receivers, options))
            trial.truth.push_back(answer.occlusion);
    }
    trial.undefined = static_cast<std::size_t>(
        std::count(trial.has_answer.begin(), trial.has_answer.end(), false));
    return trial;
}

Trial thinned(const Trial& trial, std::size_t most)
{
    const std::size_t all = trial.world.receivers.size();
    const std::size_t stride = std::max<std::size_t>(1, (all + most - 1) / most);
    Trial few = trial;
    few.world.receivers.clear();
    few.world.like_receiver.clear();
    few.truth.clear();
    few.has_answer.clear();
    std::vector<Receiver> like;
    for (std::size_t i = 0; i < all; i += stride) {
        few.world.receivers.push_back(trial.world.receivers[i]);
        few.has_answer.push_back(trial.has_answer[i]);
        if (trial.world.like) {
            few.world.like_receiver.push_back(static_cast<std::uint32_t>(like.size()));
            like.push_back(trial.world.like->receivers[trial.world.like_receiver[i]]);
        } else {
            few.truth.push_back(trial.truth[i]);
        }
    }
    if (trial.world.like) {
        auto other = std::make_shared<World>(*trial.world.like);
        other->receivers = std::move(like);
        few.world.like = std::move(other);
    }
    few.undefined =
        static_cast<std::size_t>(std::count(few.has_answer.begin(), few.has_answer.end(), false));
    return few;
}

Answers solve_twice(const World& world, const Engine& engine, Built& built)
{
    Answers answers;
    answers.occlusion = solve(world, world.receivers, engine, built, 1);
    if (answers.occlusion.size() != world.receivers.size())
        answers.fault = "not one answer per receiver";
    else
        answers.fault = fault_in_numbers(world.receivers, answers.occlusion);
    if (answers.fault.empty()) {
        const std::size_t count = engine.repeats == 0
                                      ? world.receivers.size()
                                      : std::min(engine.repeats, world.receivers.size());
        const std::vector<Occlusion> again = solve(world, std::span(world.receivers).first(count),
                                                   engine, built, tbb::task_arena::automatic);
        if (!same_bytes({answers.occlusion.begin(),
                         answers.occlusion.begin() + static_cast<std::ptrdiff_t>(count)},
                        again))
            answers.fault = "two runs differ";
    }
    return answers;
}

Finding judge(const Trial& trial, const Engine& engine, const std::string& excuse, Built& built)
{
    try {
        return examine(trial, engine, excuse, built);
    } catch (const std::exception& error) {
        return {Verdict::fail, {}, engine.bound, error.what()};
    }
}

}  // namespace surfelao::stability
