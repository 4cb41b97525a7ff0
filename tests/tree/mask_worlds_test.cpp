#include "tree/masks/masks.h"

#include "differences.h"
#include "family.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "tests/vertex_receivers.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

// What masks alone promise; the worlds with known answers are tests/engines/.
namespace surfelao {
namespace {

using scenes::operator+;

struct Setting {
    const char* name;
    MaskOptions options;
};

std::vector<Setting> settings()
{
    return {{"coarsest", {.quality = MaskOptions::kCoarsest}},
            {"draft", {.quality = MaskOptions::kDraft}},
            {"good", {.quality = MaskOptions::kGood}},
            {"best", {.quality = MaskOptions::kBest}},
            {"exact", {.exact = true}}};
}

std::vector<Occlusion> solve(const Geometry& geometry, std::span<const Receiver> receivers,
                             const MaskOptions& options)
{
    return solve_masks(*build_mask_tree(geometry), receivers, options);
}

/// A receiver at a world position, off the surface by the default offset.
Receiver receiver_at(const Geometry& geometry, glm::dvec3 position, glm::dvec3 normal)
{
    const glm::vec3 n(glm::normalize(normal));
    return {
        glm::vec3((position - geometry.frame.centre) / geometry.frame.diagonal) + kVertexOffset * n,
        n};
}

// Who asks may drop the receivers when told so; a ground looks at them to the end.
TEST(MaskWorlds, ForgottenReceiversAreAnsweredAllTheSame)
{
    const Geometry geometry = make_geometry(scenes::bumpy_sphere(16));
    const auto tree = build_mask_tree(geometry);
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    MaskOptions options;
    for (const bool is_forgotten : {true, false}) {
        std::vector<Receiver> asked = receivers;
        std::size_t forgotten = 0;
        const auto found =
            solve_masks(*tree, asked, options, {}, [&](std::size_t first, std::size_t end) {
                EXPECT_EQ(first, forgotten);
                forgotten = end;
                std::fill(asked.begin() + static_cast<std::ptrdiff_t>(first),
                          asked.begin() + static_cast<std::ptrdiff_t>(end),
                          Receiver{glm::vec3(9.0f), glm::vec3(NAN)});
            });
        EXPECT_EQ(forgotten, is_forgotten ? receivers.size() : 0u);
        EXPECT_EQ(found, solve_masks(*tree, receivers, options));
        options.definition.ground = Ground{{0, 0, 1}, -0.3f};
    }
}

// A body of 1/100,000 of its scene: its triangles are 1e-7 diagonals wide, and their second moments
// 1e-29 diagonals^4. Nothing may underflow on the way.
TEST(MaskWorlds, ATinyPartOfAHugeSceneIsAsGoodAsAlone)
{
    const Scene body = scenes::bumpy_sphere(16);
    // specks far away on both sides: the body stays in the middle, where floats are fine
    Scene specks;
    for (const double far : {-1e5, 1e5}) {
        const std::uint32_t first = static_cast<std::uint32_t>(specks.positions.size());
        for (const glm::dvec3 corner : {glm::dvec3(far, 0, 0), {far, 1, 0}, {far, 0, 1}})
            specks.positions.push_back(corner);
        specks.triangles.push_back({first, first + 1, first + 2});
    }
    const Geometry alone = make_geometry(body);
    const Geometry together = make_geometry(body + specks);
    const float share = static_cast<float>(alone.frame.diagonal / together.frame.diagonal);
    const std::vector<Occlusion> expected = solve(alone, vertex_receivers(alone), {});
    const std::vector<Occlusion> answer =
        solve(together, vertex_receivers(together, kVertexOffset * share), {});
    // another frame rounds otherwise: single bits at edges, and splits where extents are equal
    EXPECT_LT(rms_difference(expected, answer), 0.01);
}

// By its area nearly all of the scene is the far ball: the rest is little to see, but not for who
// is inside of it.
TEST(MaskWorlds, ASmallBodyIsClosedFromInsideHoweverLargeItsNeighbour)
{
    for (const double far : {6.0, 10.0, 20.0, 40.0}) {
        const glm::dvec3 small(far, 0.3 * far, 0.1 * far);
        const Geometry geometry =
            make_geometry(scenes::sphere({0, 0, 0}, 1.0, 12) + scenes::sphere(small, 0.01, 4));
        std::vector<Receiver> receivers;
        for (const glm::dvec3 normal : {glm::dvec3(1, 0, 0), {0, 1, 0}, {-1, 0, 0}, {-1, -1, 1}})
            receivers.push_back(receiver_at(geometry, small, normal));
        for (const Setting& setting : settings()) {
            for (const Occlusion& found : solve(geometry, receivers, setting.options)) {
                // .86: so coarse a ball has cracks
                EXPECT_GT(found.occlusion, 0.8) << setting.name << " at " << far;
            }
        }
    }
}

TEST(MaskWorlds, RotationScaleAndOrderDoNotMatter)
{
    const Scene scene = scenes::bumpy_sphere(12) + scenes::box({0.9, 0.9, 0.9}, {1.6, 1.5, 1.4}, 6);
    const auto answers_of = [](const Scene& s) {
        const Geometry geometry = make_geometry(s);
        return solve(geometry, vertex_receivers(geometry), {});
    };
    const std::vector<Occlusion> expected = answers_of(scene);
    const auto change = [&](const Scene& other) {
        return rms_difference(expected, answers_of(other));
    };
    // scale and a far offset cost digits of the input only
    EXPECT_LT(change(scenes::moved(scene, [](glm::dvec3 p) { return 1e-6 * p; })), 1e-3);
    EXPECT_LT(change(scenes::moved(scene, [](glm::dvec3 p) { return 1e6 * p; })), 1e-3);
    EXPECT_LT(change(scenes::moved(scene, [](glm::dvec3 p) { return p + 1e6; })), 1e-3);
    // other clusters and other directions: as large as the error of `good` itself
    EXPECT_LT(change(scenes::moved(scene,
                                   [](glm::dvec3 p) {
                                       return glm::dvec3(0.6 * p.x - 0.8 * p.y,
                                                         0.8 * p.x + 0.6 * p.y, p.z);
                                   })),
              0.012);
    Scene reversed = scene;
    std::reverse(reversed.triangles.begin(), reversed.triangles.end());
    EXPECT_LT(change(reversed), 1e-3);
}

TEST(MaskWorlds, WhatAGroupSharesChangesWithThePlace)
{
    // sixteen receivers on the ground, together before a wall that is drawn from among them only
    const Geometry geometry = make_geometry(scenes::sheet({6, -2, 0}, {0, 4, 0}, {0, 0, 4}, 4));
    std::vector<Receiver> receivers;
    for (int i = 0; i < 16; ++i)
        receivers.push_back(receiver_at(geometry, {0.4 * (i % 4), 0.4 * (i / 4), 0}, {0, 0, 1}));
    const std::vector<Occlusion> exact = solve(geometry, receivers, {.exact = true});
    const std::vector<Occlusion> draft =
        solve(geometry, receivers, {.quality = MaskOptions::kDraft});
    EXPECT_GT(exact[3].occlusion - exact[0].occlusion, 0.015f);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        // 0.003; without the change 0.0105, all of them 0.038
        EXPECT_NEAR(draft[i].occlusion, exact[i].occlusion, 0.005) << i;
    }
}

TEST(MaskWorlds, TheSameAnswerFromEveryKernel)
{
    const Geometry geometry =
        make_geometry(scenes::bumpy_sphere(8) + scenes::box({0.9, 0.9, 0.9}, {1.6, 1.5, 1.4}, 6));
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    std::vector<Setting> all = settings();
    const Ground ground{glm::normalize(glm::vec3(0.2f, 0.5f, 0.8f)), -0.2f};
    all.push_back({"coarsest within",
                   {.definition = {.max_distance = 0.4f}, .quality = MaskOptions::kCoarsest}});
    all.push_back({"ground", {.definition = {.ground = ground}}});
    all.push_back({"ground within", {.definition = {.max_distance = 0.4f, .ground = ground}}});
    for (Setting setting : all) {
        setting.options.kernel = MaskKernelSet::portable;
        const std::vector<Occlusion> expected = solve(geometry, receivers, setting.options);
        for (const MaskKernelSet kernel : available_mask_kernels()) {
            setting.options.kernel = kernel;
            const std::vector<Occlusion> found = solve(geometry, receivers, setting.options);
            // products are fused or not: a bit here and there changes, each worth 1/1000
            EXPECT_LT(rms_difference(expected, found), 3e-4)
                << setting.name << ", " << name_of(kernel);
        }
    }
}

TEST(MaskWorlds, ErrorAgainstTheOracleFallsWithQuality)
{
    const Geometry geometry = make_geometry(scenes::bumpy_sphere(16));
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    const std::vector<Occlusion> truth = solve(geometry, receivers, {.exact = true});
    double last = 0.03;
    for (const float quality : {MaskOptions::kDraft, MaskOptions::kGood, MaskOptions::kBest}) {
        const std::vector<Occlusion> found = solve(geometry, receivers, {.quality = quality});
        const double error = rms_difference(truth, found);
        EXPECT_LT(error, last) << quality;
        last = error;
    }
}

// A drum between two plates: some of its walls are drawn for a group, others for each receiver.
// What is exact from the group's centre is not so beside them.
TEST(MaskWorlds, NoLightFallsBetweenWallsThatAreSharedAndOthers)
{
    const Scene walls = scenes::grid(12, 1, [](double s, double t) {
        const double angle = 2.0 * std::numbers::pi * s;
        return glm::dvec3(std::cos(angle), std::sin(angle), t);
    });
    const Geometry geometry =
        make_geometry(walls + scenes::sheet({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1) +
                      scenes::sheet({-2, -2, 1}, {4, 0, 0}, {0, 4, 0}, 1));
    std::vector<Receiver> receivers;
    for (int x = -20; x <= 20; ++x) {
        for (int y = -20; y <= 20; ++y)
            receivers.push_back(receiver_at(geometry, {0.03 * x, 0.03 * y, 0}, {0, 0, 1}));
    }
    double open = 0.0;
    for (const Occlusion& one : solve(geometry, receivers, {}))
        open += 1.0 - one.occlusion;
    // 0.00005; where only clusters have cracks beside them 0.0005
    EXPECT_LT(open / static_cast<double>(receivers.size()), 2e-4);
}

/// How much darker good answers are than exact ones in the mean, at each step-th vertex.
double mean_darkness(const Geometry& geometry, std::size_t step)
{
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    const std::vector<Occlusion> good = solve(geometry, receivers, {});
    std::vector<Receiver> some;
    for (std::size_t i = 0; i < receivers.size(); i += step)
        some.push_back(receivers[i]);
    const std::vector<Occlusion> exact = solve(geometry, some, {.exact = true});
    double darker = 0.0;
    for (std::size_t i = 0; i < some.size(); ++i)
        darker += good[i * step].occlusion - exact[i].occlusion;
    return darker / static_cast<double>(some.size());
}

// Springs, blocks and balls: what stands open between the turns of a wire is no crack, and its
// strips are no wider than they are.
TEST(MaskWorlds, WiresAreAsOpenAsTheyAre)
{
    constexpr std::uint32_t kSprings = 141;
    // .0024, and .0025 as Clang compiles it: closed pinholes are a little of each, and worth more
    // on hills (below)
    EXPECT_NEAR(mean_darkness(make_geometry(scenes::family_scene(kSprings)), 8), 0.0, 0.0028);
}

// Hills cover little of each other's sky, by clusters: what is open between these is no sky.
TEST(MaskWorlds, HillsAreAsClosedAsTheyAre)
{
    constexpr std::uint32_t kHills = 111;
    // where pinholes are open -.0038
    EXPECT_GT(mean_darkness(make_geometry(scenes::family_scene(kHills)), 16), -0.0034);
}

// From inside of a smooth body nothing is open, however narrow its clusters are drawn.
TEST(MaskWorlds, BodiesAreClosedFromInside)
{
    constexpr std::uint32_t kKnot = 16;
    constexpr std::size_t kStep = 16;
    const Geometry geometry = make_geometry(scenes::family_scene(kKnot));
    const std::vector<Receiver> outside = vertex_receivers(geometry);
    std::vector<Receiver> inside;
    for (std::size_t i = 0; i < outside.size(); i += kStep) {
        const Receiver& there = outside[i];
        inside.push_back({there.position - 2.0f * kVertexOffset * there.normal, -there.normal});
    }
    const std::vector<Occlusion> exact = solve(geometry, inside, {.exact = true});
    for (const float quality : {MaskOptions::kGood, MaskOptions::kBest, MaskOptions::kFinest})
        EXPECT_LT(rms_difference(exact, solve(geometry, inside, {.quality = quality})), 0.003)
            << quality;
}

// Under a ball near a wide floor all is covered but the horizon, and that is open.
TEST(MaskWorlds, TheHorizonAloneIsOpenUnderWhatStandsOverAFloor)
{
    const double height = 1.0, reach = 5.0;
    const Geometry geometry =
        make_geometry(scenes::sphere({0, 0, 1 + height}, 1, 16) +
                      scenes::sheet({-reach, -reach, 0}, {2 * reach, 0, 0}, {0, 2 * reach, 0}, 1));
    const std::vector<Receiver> under{receiver_at(geometry, {0, 0, height}, {0, 0, -1})};
    // the form factor of a rectangle's corner, four times
    const double x = reach / height, root = std::sqrt(1 + x * x);
    const double covered = 4.0 / std::numbers::pi * x / root * std::atan(x / root);
    for (const float quality : {MaskOptions::kDraft, MaskOptions::kGood, MaskOptions::kBest})
        EXPECT_NEAR(solve(geometry, under, {.quality = quality})[0].occlusion, covered, 0.002)
            << quality;
}

TEST(MaskWorlds, RefusesWhatItDoesNotMeasure)
{
    const Geometry geometry = make_geometry(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1));
    EXPECT_THROW(static_cast<void>(solve(geometry, {}, {.quality = 5.0f})), SettingsError);
    MaskOptions bunnell;
    bunnell.definition.kernel = Kernel::bunnell;
    EXPECT_THROW(static_cast<void>(solve(geometry, {}, bunnell)), SettingsError);
}

}  // namespace
}  // namespace surfelao
