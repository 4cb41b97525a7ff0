#include "viewer/model.h"

#include "scenes.h"
#include "surfels/surfel.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace surfelao {
namespace {

Scene triangle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c)
{
    Scene scene;
    scene.positions = {a, b, c};
    scene.triangles = {{0, 1, 2}};
    return scene;
}

// Engleson's report finds 0.03 for 129 x 129 vertices where spacing is 0.0406: the same rule.
TEST(CoveringRadii, ASquareGridNeedsItsSpacingOverTheRootOfTwo)
{
    const Geometry geometry = make_geometry(scenes::sheet({0, 0, 0}, {8, 0, 0}, {0, 8, 0}, 8));
    const float spacing = static_cast<float>(1.0 / geometry.frame.diagonal);
    for (float radius : covering_radii(geometry))
        EXPECT_NEAR(radius, spacing / std::sqrt(2.0f), 1e-6f);
}

TEST(CoveringRadii, MatchesTheClosedForms)
{
    // equilateral with side 1: circumradius 1 / sqrt(3)
    Geometry geometry = make_geometry(triangle({0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}));
    float unit = static_cast<float>(geometry.frame.diagonal);
    EXPECT_NEAR(covering_radii(geometry)[0] * unit, 1.0f / std::sqrt(3.0f), 1e-5f);
    // obtuse, symmetric, 120 degrees between sides of 1: 1 / (2 cos 30) on the long side
    geometry =
        make_geometry(triangle({0, 0, 0}, {std::sqrt(3.0), 0, 0}, {std::sqrt(0.75), 0.5, 0}));
    unit = static_cast<float>(geometry.frame.diagonal);
    EXPECT_NEAR(covering_radii(geometry)[2] * unit, 1.0f / std::sqrt(3.0f), 1e-5f);
}

// Random triangles, sharp ones too: every point is within the radius of a corner, and 0.99 of the
// radius is too little for some point of the worst one found by sampling.
TEST(CoveringRadii, CoverEveryPointAndNoMore)
{
    std::mt19937 random(7);
    const auto coordinate = [&] { return static_cast<double>(random() % 1000) / 1000.0; };
    for (int trial = 0; trial < 200; ++trial) {
        const glm::dvec3 a(coordinate(), coordinate(), 0), b(coordinate(), coordinate(), 0),
            c(coordinate(), 0.1 * coordinate(), 0);
        const Geometry geometry = make_geometry(triangle(a, b, c));
        const double radius = covering_radii(geometry)[0] * geometry.frame.diagonal;
        double farthest = 0.0;
        constexpr int kSteps = 200;
        for (int i = 0; i <= kSteps; ++i) {
            for (int k = 0; k <= kSteps - i; ++k) {
                const double s = i / double(kSteps), t = k / double(kSteps);
                const glm::dvec3 p = a + s * (b - a) + t * (c - a);
                farthest = std::max(farthest, std::min({glm::distance(p, a), glm::distance(p, b),
                                                        glm::distance(p, c)}));
            }
        }
        if (geometry.triangles.empty())
            continue;  // three points in line
        EXPECT_LE(farthest, radius * 1.0001) << trial;
        EXPECT_GE(farthest, radius * 0.95) << trial;
    }
}

TEST(Model, HasASplatPerSurfelWhereTrianglesAreSmall)
{
    for (const float largest : {0.2f, std::numeric_limits<float>::infinity()}) {
        const Model model =
            make_model(make_mesh(scenes::sphere({0, 0, 0}, 1.0, 8)), UpAxis::y, {}, largest);
        ASSERT_EQ(model.splats.size(), surfels_at_vertices(model.geometry()).size());
        ASSERT_EQ(model.splat_radii.size(), model.splats.size());
        for (std::size_t i = 0; i < model.splats.size(); ++i)
            EXPECT_EQ(model.splats[i].vertices, glm::uvec3(model.surfels[i]));
    }
}

// Every point of a large triangle, a sliver and a right angle, is in a disk; none is larger than it
// may be, and there are not many more than the area asks for.
TEST(Model, LargeTrianglesAreCoveredFromInside)
{
    const glm::dvec3 a(0, 0, 0), b(1, 0, 0);
    for (const glm::dvec3 c : {glm::dvec3(0, 1, 0), glm::dvec3(0.3, 0.01, 0)}) {
        const Model model = make_model(make_mesh(triangle(a, b, c)), UpAxis::y);
        ASSERT_EQ(model.splat_radii.size(), model.splats.size());
        EXPECT_LT(model.splats.size(), 20'000u);
        const std::vector<glm::vec3>& p = model.geometry().positions;
        const auto point = [&](glm::vec2 at) {
            return p[0] + at.x * (p[1] - p[0]) + at.y * (p[2] - p[0]);
        };
        std::mt19937 random(3);
        for (int trial = 0; trial < 300; ++trial) {
            glm::vec2 place(static_cast<float>(random() % 1000) / 999.0f,
                            static_cast<float>(random() % 1000) / 999.0f);
            if (place.x + place.y > 1.0f)
                place = 1.0f - place;
            float beyond = 1.0f;
            for (std::size_t i = 0; i < model.splats.size(); ++i) {
                const std::uint32_t packed = model.splats[i].place;
                const glm::vec3 middle =
                    point(glm::vec2(packed & 0xFFFFu, packed >> 16) / 65535.0f);
                beyond =
                    std::min(beyond, glm::distance(middle, point(place)) - model.splat_radii[i]);
            }
            EXPECT_LE(beyond, 0.0f);
        }
        for (std::size_t i = 0; i < model.splats.size(); ++i) {
            EXPECT_EQ(model.splats[i].vertices, glm::uvec3(0, 1, 2));
            EXPECT_LE(model.splat_radii[i], 1.06f * kLargestSplat);
        }
    }
}

// 20,000 triangles across the whole box would need two hundred million disks of that size.
TEST(Model, SplatsInsideOfTrianglesEndAtANumber)
{
    Scene scene;
    std::mt19937 random(5);
    for (std::uint32_t i = 0; i < 20'000; ++i) {
        for (int corner = 0; corner < 3; ++corner)
            scene.positions.emplace_back(random() % 1000, random() % 1000, random() % 1000);
        scene.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const Model model = make_model(make_mesh(scene), UpAxis::y);
    EXPECT_LE(model.splats.size(), 400'000u + 60'000u);
    EXPECT_GE(model.splats.size(), 20'000u);
}

TEST(Model, KnowsTheLevelOfEachSurfelsLeaf)
{
    const Model model = make_model(make_mesh(scenes::sphere({0, 0, 0}, 1.0, 8)), UpAxis::y);
    ASSERT_EQ(model.levels.size(), model.surfels.size());
    const glm::vec2 range = level_range(model);
    EXPECT_GE(range.x, 1.0f);   // more surfels than fit into a root that is a leaf
    EXPECT_LE(range.y, 21.0f);  // octree.h
    EXPECT_LT(range.x, range.y);
}

TEST(Model, GroundLiesUnderTheScene)
{
    for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
        const Model model = make_model(make_mesh(scenes::box({1, 2, 3}, {2, 4, 6}, 2)), up);
        const glm::vec3 above = up_direction(up);
        float lowest = 1e9f;
        for (const glm::vec3& p : model.geometry().positions)
            lowest = std::min(lowest, glm::dot(p, above));
        ASSERT_EQ(model.ground_receivers.size(), std::size_t{kGroundReceivers});
        EXPECT_EQ(model.answer_count(), model.geometry().positions.size() + kGroundReceivers);
        for (const Receiver& receiver : model.ground_receivers) {
            EXPECT_LT(glm::dot(receiver.position, above), lowest);
            EXPECT_GT(glm::dot(receiver.position, above), lowest - 0.01f);
            EXPECT_EQ(receiver.normal, above);
        }
        const ShadowSquare& ground = model.ground;
        EXPECT_GT(glm::dot(glm::cross(ground.axis_x, ground.axis_y), above), 0.0f);
        EXPECT_NEAR(glm::distance(model.ground_receivers.back().position,
                                  ground.corner + ground.axis_x + ground.axis_y),
                    1e-4f, 1e-5f);
    }
}

TEST(Model, TheShadowLiesInTheGroundThatOccludes)
{
    for (const std::optional<double> height : {std::optional<double>(), {2.5}, {-1.0}}) {
        const Model model = make_model(make_mesh(scenes::box({1, 2, 3}, {2, 4, 6}, 2)), UpAxis::y,
                                       {}, kLargestSplat, GroundPlane{{0, 1, 0}, height});
        EXPECT_NEAR(model.ground.corner.y, model.occluding_ground->height, 1e-6f);
        EXPECT_GT(model.ground_receivers[7].position.y, model.occluding_ground->height);
    }
}

TEST(Model, AlsoOfOneTriangleAndOfNoneWithArea)
{
    const Model one =
        make_model(make_mesh(triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})), UpAxis::y, {}, 1.0f);
    EXPECT_EQ(one.splats.size(), 3u);
    const Model none = make_model(make_mesh(triangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0})), UpAxis::y);
    EXPECT_EQ(none.splats.size(), 0u);
    EXPECT_FALSE(none.seen.empty());
    EXPECT_EQ(level_range(none), glm::vec2(0.0f, 1.0f));
}

}  // namespace
}  // namespace surfelao
