#include "surfels/geometry.h"

#include "surfels/occlusion.h"
#include "surfels/receiver.h"
#include "surfels/surfel.h"

#include "scenes.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace surfelao {
namespace {

/// Two triangles in z = 0, vertices 0..3 counterclockwise from the origin.
Scene unit_square()
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    scene.triangles = {{0, 1, 2}, {0, 2, 3}};
    return scene;
}

Scene moved(Scene scene, double scale, glm::dvec3 offset)
{
    for (glm::dvec3& p : scene.positions)
        p = p * scale + offset;
    return scene;
}

TEST(Geometry, FrameIsCentredAndItsDiagonalIsOne)
{
    const Geometry geometry = make_geometry(moved(unit_square(), 10.0, {5, 5, 5}));
    EXPECT_NEAR(geometry.frame.diagonal, std::sqrt(200.0), 1e-12);
    EXPECT_EQ(geometry.frame.centre, glm::dvec3(10, 10, 5));
    EXPECT_NEAR(glm::length(geometry.positions[2] - geometry.positions[0]), 1.0f, 1e-6f);
}

TEST(Geometry, FarOffsetsAndExtremeScalesGiveTheSameUnitGeometry)
{
    const Geometry plain = make_geometry(unit_square());
    for (double scale : {1e-30, 1e-6, 1e6, 1e30}) {
        const Geometry other = make_geometry(moved(unit_square(), scale, glm::dvec3(0.0)));
        EXPECT_EQ(other.positions, plain.positions) << "scale " << scale;
        EXPECT_EQ(other.normals, plain.normals) << "scale " << scale;
    }
    const Geometry far = make_geometry(moved(unit_square(), 1.0, glm::dvec3(1e6)));
    EXPECT_EQ(far.positions, plain.positions);
}

TEST(Geometry, SurfelAreasSumToTheMeshArea)
{
    const Geometry geometry = make_geometry(unit_square());
    double sum = 0.0;
    for (const Surfel& surfel : surfels_at_vertices(geometry))
        sum += surfel.area;
    EXPECT_NEAR(sum, 0.5, 1e-6);  // area 1 in units of diagonal^2 = 2
}

double area_of(const std::vector<Surfel>& surfels)
{
    double sum = 0.0;
    for (const Surfel& surfel : surfels)
        sum += surfel.area;
    return sum;
}

TEST(SurfelCloud, LargeTrianglesBecomeManyDisksInTheirPlane)
{
    const Geometry geometry = make_geometry(unit_square());
    const SurfelCloud cloud = surfels_of(geometry);
    EXPECT_GE(cloud.surfels.size(), kFewestSurfels);
    EXPECT_LE(cloud.surfels.size(), 2 * kFewestSurfels);
    ASSERT_EQ(cloud.vertices.size(), cloud.surfels.size());
    EXPECT_NEAR(area_of(cloud.surfels), 0.5, 1e-6);
    glm::dvec3 mean(0.0);
    for (const Surfel& surfel : cloud.surfels) {
        EXPECT_EQ(surfel.normal, glm::vec3(0, 0, 1));
        EXPECT_LE(std::abs(surfel.position.x), 0.5f);
        EXPECT_EQ(surfel.position.z, 0.0f);
        EXPECT_LE(surfel.area, 0.5f / kFewestSurfels);
        const glm::vec3 a = surfel.corners[0], b = surfel.corners[1];
        EXPECT_NEAR(1.5f * glm::length(glm::cross(a, b)), surfel.area, 1e-9);
        EXPECT_FLOAT_EQ(surfel.reach,
                        std::max({glm::length(a), glm::length(b), glm::length(a + b)}));
        mean += glm::dvec3(surfel.position) / static_cast<double>(cloud.surfels.size());
    }
    EXPECT_NEAR(glm::length(mean), 0.0, 1e-6);  // the square's middle
}

// A needle of no area to speak of is not cut, however long.
TEST(SurfelCloud, ThereAreNoMorePiecesOfSliversThanTheirAreaIsWorth)
{
    Scene scene = unit_square();
    for (int i = 0; i < 8; ++i) {
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        const double x = 0.1 * i;
        for (const glm::dvec3 corner : {glm::dvec3(x, 0, 1), {x + 1e-7, 0, 1}, {x, 1, 1}})
            scene.positions.emplace_back(corner);
        scene.triangles.push_back({first, first + 1, first + 2});
    }
    const std::size_t square = surfels_of(make_geometry(unit_square())).surfels.size();
    EXPECT_EQ(surfels_of(make_geometry(scene)).surfels.size(), square + 8 * 3);
}

TEST(SurfelCloud, DoubledLargeTrianglesCountOnce)
{
    Scene scene = unit_square();
    scene.triangles.push_back({2, 0, 1});
    scene.triangles.push_back({0, 3, 2});
    const std::vector<Surfel> surfels = surfels_of(make_geometry(scene)).surfels;
    EXPECT_EQ(surfels.size(), surfels_of(make_geometry(unit_square())).surfels.size());
    EXPECT_NEAR(area_of(surfels), 0.5, 1e-6);
}

TEST(SurfelCloud, AFineSmoothMeshStaysAsItIs)
{
    const Geometry geometry = make_geometry(scenes::sphere({0, 0, 0}, 1.0, 64));
    const std::vector<Surfel> plain = surfels_at_vertices(geometry);
    const SurfelCloud cloud = surfels_of(geometry);
    ASSERT_EQ(cloud.surfels.size(), plain.size());
    for (std::size_t i = 0; i < plain.size(); ++i) {
        EXPECT_EQ(cloud.surfels[i].position, plain[i].position);
        EXPECT_EQ(cloud.surfels[i].area, plain[i].area);
        EXPECT_EQ(cloud.vertices[i], i);
    }
}

TEST(SurfelCloud, WithoutTrianglesIsEmpty)
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}};
    EXPECT_TRUE(surfels_of(make_geometry(scene)).surfels.empty());
}

// Vertices 0 and 4 stand at one place: a seam. Both get the mean normal of the fold.
TEST(Geometry, DoubledFacesHaveTheAreaOfSingleOnesWhicheverWayTheyFace)
{
    const Geometry once = make_geometry(unit_square());
    Scene scene = unit_square();
    scene.triangles.push_back({2, 0, 1});  // the same corners from another one on
    scene.triangles.push_back({0, 3, 2});  // its back
    scene.positions.push_back({1, 1, 0});  // another vertex at the same place
    scene.triangles.push_back({0, 1, 4});
    const std::vector<float> areas = make_geometry(scene).areas;
    for (std::size_t v = 0; v < 4; ++v)
        EXPECT_FLOAT_EQ(areas[v], once.areas[v]);
    EXPECT_EQ(areas[4], 0.0f);
    scene.triangles.push_back({1, 2, 3});  // another triangle over the same square does add
    EXPECT_GT(make_geometry(scene).areas[1], once.areas[1]);
}

TEST(Geometry, SeamsShareNormalAndArea)
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}, {0, 1, 0}};
    scene.triangles = {{0, 1, 2}, {4, 5, 3}};
    const Geometry geometry = make_geometry(scene);
    EXPECT_EQ(geometry.welded[4], 0u);
    EXPECT_EQ(geometry.normals[4], geometry.normals[0]);
    EXPECT_NEAR(geometry.normals[0].x, std::sqrt(0.5f), 1e-6f);
    EXPECT_NEAR(geometry.normals[0].z, std::sqrt(0.5f), 1e-6f);
    EXPECT_EQ(geometry.areas[4], 0.0f);
    EXPECT_EQ(surfels_at_vertices(geometry).size(), 4u);
}

// Front and back of one sheet with vertices of their own: each side keeps its own normal.
TEST(Geometry, BackToBackSheetsKeepTheirOwnNormals)
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.triangles = {{0, 1, 2}, {5, 4, 3}};
    const Geometry geometry = make_geometry(scene);
    EXPECT_EQ(geometry.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(geometry.normals[3], glm::vec3(0, 0, -1));
}

TEST(Geometry, TrianglesWithoutAreaAreDroppedCountedAndLeaveNoNaN)
{
    Scene scene = unit_square();
    scene.positions.push_back({2, 2, 0});  // 4: only a collinear triangle uses it
    scene.positions.push_back({9, 9, 9});  // 5: nobody uses it
    scene.triangles.push_back({0, 2, 4});
    scene.triangles.push_back({1, 1, 3});
    const Geometry geometry = make_geometry(scene);
    EXPECT_EQ(geometry.dropped_triangles, 2u);
    EXPECT_EQ(geometry.triangles.size(), 2u);
    EXPECT_EQ(geometry.normals[4], glm::vec3(0, 0, 1));
    EXPECT_EQ(geometry.normals[5], glm::vec3(0));
}

// A long chain of degenerate triangles, listed away from the one good triangle.
TEST(Geometry, ChainsOfDegenerateTrianglesEndAtARealNormal)
{
    Scene scene = unit_square();
    const std::uint32_t count = 100'000;
    for (std::uint32_t i = 0; i < count; ++i)
        scene.positions.push_back({2.0 + i, 0, 0});
    for (std::uint32_t i = count - 1; i > 0; --i)
        scene.triangles.push_back({3 + i, 4 + i, 4 + i});
    scene.triangles.push_back({1, 4, 4});
    const Geometry geometry = make_geometry(scene);
    EXPECT_EQ(geometry.normals.back(), glm::vec3(0, 0, 1));
}

TEST(Geometry, AllVerticesInOnePointGiveNoTrianglesAndNoNormals)
{
    Scene scene;
    scene.positions.assign(3, {7, 7, 7});
    scene.triangles = {{0, 1, 2}};
    const Geometry geometry = make_geometry(scene);
    EXPECT_TRUE(geometry.triangles.empty());
    EXPECT_EQ(geometry.frame.diagonal, 1.0);
    EXPECT_EQ(geometry.normals[1], glm::vec3(0));
}

TEST(BentNormal, NeverPointsBelowTheHorizon)
{
    const glm::vec3 up(0, 0, 1);
    EXPECT_NEAR(glm::distance(bent_normal_of({3, 0, 3}, up), {0.70710678f, 0, 0.70710678f}), 0.0f,
                1e-6f);
    EXPECT_EQ(bent_normal_of({0.3f, 0, -0.1f}, up), glm::vec3(1, 0, 0));
    EXPECT_EQ(bent_normal_of({0, 0, -0.1f}, up), up);
    EXPECT_EQ(bent_normal_of({1e-9f, 0, -0.1f}, up), up);  // a direction made of rounding
    EXPECT_EQ(bent_normal_of({0, 0, 0}, up), up);
    EXPECT_EQ(bent_normal_of({0, 0, 0}, {0, 0, 0}), glm::vec3(0.0f));
}

}  // namespace
}  // namespace surfelao
