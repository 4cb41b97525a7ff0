#include "tests/stability/judge.h"

#include "tests/scenes.h"
#include "tests/stability/engines.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace surfelao::stability {
namespace {

const Receiver kFacingUp{{0, 0, 0}, {0, 0, 1}};

Polygon square(double half, double height)
{
    return {
        {-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}};
}

// Table value of a facing square: 4 times the corner rectangle, a / h = half / height.
double facing_square(double half, double height)
{
    const double x = half / height, root = std::sqrt(1 + x * x);
    return 4.0 / (2.0 * std::numbers::pi) * 2.0 * x / root * std::atan(x / root);
}

TEST(FormFactor, FacingSquareMatchesTheTables)
{
    for (const double height : {1e-6, 0.1, 1.0, 30.0})
        EXPECT_NEAR(form_factor(kFacingUp, square(1.0, height)), facing_square(1.0, height), 1e-12);
}

TEST(FormFactor, WindingDoesNotMatter)
{
    Polygon turned = square(1.0, 0.5);
    std::reverse(turned.begin(), turned.end());
    EXPECT_NEAR(form_factor(kFacingUp, turned), facing_square(1.0, 0.5), 1e-12);
}

TEST(FormFactor, WhatIsBelowTheHorizonIsCutOff)
{
    EXPECT_EQ(form_factor(kFacingUp, square(1.0, -0.5)), 0.0);
    // a wall of 200 x 200 through the horizon, 1 away: the foot of an endless wall is half closed
    const Polygon wall{{1e-4, -100, -100}, {1e-4, 100, -100}, {1e-4, 100, 100}, {1e-4, -100, 100}};
    EXPECT_NEAR(form_factor(kFacingUp, wall), 0.5, 1e-5);
}

TEST(FormFactor, SphereOnTheAxis)
{
    EXPECT_NEAR(sphere_form_factor(kFacingUp, {0, 0, 2}, 0.5), 1.0 / 16.0, 1e-12);
    EXPECT_NEAR(sphere_form_factor(kFacingUp, {2, 0, 2}, 0.5), 0.25 / 8.0 * std::sqrt(0.5), 1e-12);
}

/// A floor under a ceiling that closes a bit less than half of it; every receiver has an answer.
Trial floor_and_ceiling()
{
    using namespace scenes;
    Scene scene = sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
    scene += sheet({0, 0, 0.5}, {0, 1, 0}, {1, 0, 0}, 4);
    return prepare(at_vertices(scene));
}

/// The right answer, spoilt.
Engine spoilt(const Trial& trial, const std::function<void(std::vector<Occlusion>&)>& spoil)
{
    Engine engine;
    engine.name = "spoilt";
    engine.bound = {0.001, 0.01};
    engine.prepare = [=](const Geometry&) -> Solver {
        return [=](std::span<const Receiver> receivers, const SolveSettings&) {
            std::vector<Occlusion> answers(receivers.size());
            for (std::size_t i = 0; i < answers.size(); ++i)
                answers[i] = {static_cast<float>(trial.truth[i]), receivers[i].normal};
            spoil(answers);
            return answers;
        };
    };
    return engine;
}

Finding judge_alone(const Trial& trial, const Engine& engine, const std::string& excuse = {})
{
    Built built;
    return judge(trial, engine, excuse, built);
}

Finding judged(const std::function<void(std::vector<Occlusion>&)>& spoil, bool excusable = false,
               const std::string& excuse = {})
{
    const Trial trial = floor_and_ceiling();
    Engine engine = spoilt(trial, spoil);
    engine.may_be_excused = excusable;
    return judge_alone(trial, engine, excuse);
}

TEST(Judge, PassesTheRightAnswer)
{
    const Finding finding = judged([](auto&) {});
    EXPECT_EQ(finding.verdict, Verdict::pass) << finding.fault;
    EXPECT_LT(finding.error.worst, 1e-6);
}

TEST(Judge, FailsOnEveryKindOfFault)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(judged([=](auto& a) { a[3].occlusion = nan; }).fault, "not a number");
    EXPECT_EQ(judged([=](auto& a) { a[3].bent_normal.y = nan; }).fault, "not a number");
    EXPECT_EQ(judged([](auto& a) { a[3].occlusion = -1e-6f; }).fault, "outside [0, 1]");
    EXPECT_EQ(judged([](auto& a) { a[3].occlusion = 1.000001f; }).fault, "outside [0, 1]");
    EXPECT_EQ(judged([](auto& a) { a[3].bent_normal *= 0.99f; }).fault,
              "bent normal not of unit length");
    EXPECT_EQ(judged([](auto& a) { a[3].bent_normal *= -1.0f; }).fault,
              "bent normal below the horizon");
    EXPECT_EQ(judged([](auto& a) { a.pop_back(); }).fault, "not one answer per receiver");
    EXPECT_EQ(judged([](auto& a) { a[3].occlusion += 0.02f; }).fault, "error above its bound");
    EXPECT_EQ(judged([](auto& a) {
                  for (Occlusion& each : a)
                      each.occlusion += 0.002f;
              }).fault,
              "error above its bound");
    EXPECT_EQ(judged([](auto&) { throw std::runtime_error("no memory"); }).fault, "no memory");
    std::atomic<int> calls{0};
    EXPECT_EQ(judged([&](auto& a) { a[3].occlusion += 1e-6f * static_cast<float>(calls++); }).fault,
              "two runs differ");
}

TEST(Judge, ExcusesErrorsOfTheDiskEngineButNoFaults)
{
    const auto worse = [](auto& a) { a[3].occlusion += 0.2f; };
    EXPECT_EQ(judged(worse, true, "layers").verdict, Verdict::excused);
    EXPECT_NEAR(judged(worse, true, "layers").error.worst, 0.2, 1e-6);
    EXPECT_EQ(judged(worse, true, "").verdict, Verdict::fail);
    EXPECT_EQ(judged(worse, false, "layers").verdict, Verdict::fail);
    EXPECT_EQ(judged([](auto& a) { a[3].occlusion = 2.0f; }, true, "layers").verdict,
              Verdict::fail);
}

TEST(Judge, LeavesReceiversWithoutAnAnswerOutAndSaysSo)
{
    using namespace scenes;
    const double offset = 1e-4 * std::sqrt(2.0);
    Scene scene = sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4);
    scene += sheet({0, 0, offset}, {0, 1, 0}, {1, 0, 0}, 4);
    const Trial trial = prepare(at_vertices(scene));
    EXPECT_EQ(trial.undefined, 50u);
    const Finding finding =
        judge_alone(trial, spoilt(trial, [](auto& a) { a[3].occlusion = 0.5f; }));
    EXPECT_EQ(finding.verdict, Verdict::undefined);
}

TEST(Judge, HoldsAnEngineAgainstItselfOnAnEqualScene)
{
    const Scene scene = scenes::bumpy_sphere(4);
    const Trial same = prepare(with_like(at_vertices(scene), at_vertices(scene)));
    const Trial other = prepare(with_like(at_vertices(scene), at_vertices(scenes::flipped(scene))));
    const Engine rays = all_engines().front();
    EXPECT_EQ(judge_alone(same, rays).error.worst, 0.0);
    EXPECT_EQ(judge_alone(same, rays).verdict, Verdict::pass);
    EXPECT_EQ(judge_alone(other, rays).verdict, Verdict::fail);  // seen from inside
}

TEST(Judge, ThinnedTrialsKeepTheAnswersOfTheReceiversThatStay)
{
    const Scene scene = scenes::bumpy_sphere(4);
    const std::uint32_t last = static_cast<std::uint32_t>(scene.positions.size() - 1);
    World turned = at_vertices(scene);
    std::reverse(turned.receivers.begin(), turned.receivers.end());
    const Trial rays = prepare(at_vertices(scene));
    const Trial like = prepare(with_like(std::move(turned), at_vertices(scene),
                                         [=](std::uint32_t receiver) { return last - receiver; }));
    const Trial few_rays = thinned(rays, 10), few_like = thinned(like, 10);
    ASSERT_LE(few_rays.world.receivers.size(), 10u);
    ASSERT_GE(few_rays.world.receivers.size(), 5u);
    for (std::size_t i = 0, k = 0; k < few_rays.truth.size(); ++k) {
        while (rays.world.receivers[i].position != few_rays.world.receivers[k].position)
            ++i;
        EXPECT_EQ(few_rays.truth[k], rays.truth[i]);
    }
    Built built;
    EXPECT_EQ(judge(few_like, all_engines().front(), "", built).verdict, Verdict::pass);
    for (std::size_t k = 0; k < few_like.world.receivers.size(); ++k) {
        const World& other = *few_like.world.like;
        EXPECT_EQ(other.receivers[few_like.world.like_receiver[k]].position,
                  few_like.world.receivers[k].position);
    }
}

TEST(Judge, TheSecondRunMayAskTheFirstReceiversOnly)
{
    const Trial trial = floor_and_ceiling();
    std::vector<std::size_t> asked;
    Engine engine = spoilt(trial, [&](auto& answers) { asked.push_back(answers.size()); });
    engine.repeats = 7;
    Built built;
    EXPECT_EQ(judge(trial, engine, "", built).verdict, Verdict::pass);
    EXPECT_EQ(asked, (std::vector<std::size_t>{50, 7}));
}

TEST(Cases, AreManyAndHaveNamesOfTheirOwn)
{
    std::vector<std::string> names;
    for (const Case& item : all_cases())
        names.push_back(item.group + item.name);
    EXPECT_GE(names.size(), 40u);
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace surfelao::stability
