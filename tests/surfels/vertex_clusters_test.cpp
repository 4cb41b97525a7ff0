#include "surfels/vertex_clusters.h"

#include "scenes.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+=;

/// About the axis z, open at both ends.
Scene tube(double radius, int cells)
{
    return scenes::grid(8 * cells, cells, [&](double s, double t) {
        const double angle = 2.0 * std::numbers::pi * s;
        return glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), t);
    });
}

double area_of(const Geometry& geometry)
{
    const std::vector<double> areas = triangle_areas(geometry);
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}

// Cubes are five triangles wide: a column has a dozen vertices.
TEST(VertexClusters, AFineBallHasFewerVerticesWhereItWas)
{
    const Geometry fine = make_geometry(scenes::sphere({1, 2, 3}, 1.0, 64));
    constexpr float kCube = 0.03f;
    const Geometry found = cluster_vertices(fine, kCube);
    EXPECT_LT(found.triangles.size(), fine.triangles.size() / 6);
    EXPECT_EQ(found.frame.centre, fine.frame.centre);
    EXPECT_EQ(found.frame.diagonal, fine.frame.diagonal);
    const double radius = 1.0 / fine.frame.diagonal;
    for (const glm::vec3 position : found.positions)
        EXPECT_NEAR(glm::length(position), radius, 0.1 * double{kCube});
    EXPECT_NEAR(area_of(found), area_of(fine), 0.01 * area_of(fine));
}

TEST(VertexClusters, ATubeThinnerThanACubeKeepsItsWidth)
{
    constexpr double kRadius = 0.02;
    const Geometry fine = make_geometry(tube(kRadius, 12));
    const Geometry found = cluster_vertices(fine, 0.1f);
    const double radius = kRadius / fine.frame.diagonal;
    for (const glm::vec3 position : found.positions)
        EXPECT_NEAR(std::hypot(position.x, position.y), radius, 0.1 * radius);
    EXPECT_NEAR(area_of(found), area_of(fine), 0.05 * area_of(fine));
}

TEST(VertexClusters, LeavesAndOpenEdgesStayAsTheyAre)
{
    Scene leaves;
    for (int i = 0; i < 400; ++i) {
        const double at = 0.01 * i;
        leaves += scenes::triangle({0, at, 0}, {0, at + 0.01, 0}, {0, at, 0.01});
    }
    const Geometry before = make_geometry(leaves);
    const Geometry after = cluster_vertices(before, 0.05f);
    ASSERT_EQ(after.triangles.size(), before.triangles.size());
    EXPECT_NEAR(area_of(after), area_of(before), 1e-6 * area_of(before));

    // of a sheet all but the edges is clustered, and what it covers stays
    const Geometry sheet = make_geometry(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 50));
    const Geometry fewer = cluster_vertices(sheet, 0.04f);
    EXPECT_LT(fewer.triangles.size(), sheet.triangles.size() / 2);
    EXPECT_NEAR(area_of(fewer), area_of(sheet), 1e-4 * area_of(sheet));
}

// Two sheets closer to each other than a cube is wide, back to back: none takes the other's place.
TEST(VertexClusters, SidesOfAPlateStayApart)
{
    const Geometry plate = make_geometry(scenes::box({0, 0, 0}, {1, 1, 0.01}, 40));
    const Geometry found = cluster_vertices(plate, 0.05f);
    EXPECT_LT(found.triangles.size(), plate.triangles.size() / 2);
    const float low = std::ranges::min_element(plate.positions, {}, &glm::vec3::z)->z;
    const float high = std::ranges::max_element(plate.positions, {}, &glm::vec3::z)->z;
    for (const glm::vec3 position : found.positions)
        EXPECT_LT(std::min(position.z - low, high - position.z), 0.3f * (high - low));
    EXPECT_NEAR(area_of(found), area_of(plate), 0.02 * area_of(plate));
}

TEST(VertexClusters, TheSameBytesFromAnyNumberOfThreads)
{
    const Geometry fine = make_geometry(scenes::bumpy_sphere(64));
    const Geometry expected = [&] {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        return cluster_vertices(fine, 0.02f);
    }();
    const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
    const Geometry found = cluster_vertices(fine, 0.02f);
    EXPECT_EQ(found.positions, expected.positions);
    EXPECT_EQ(found.triangles, expected.triangles);
}

}  // namespace
}  // namespace surfelao
