#include "pixels/cube_placement.h"

#include "scenes.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

/// Two rooms side by side along x, of walls with two sides, and a door between them.
Scene rooms_with_a_door()
{
    const auto wall = [](glm::dvec3 low, glm::dvec3 high) { return scenes::box(low, high, 1); };
    constexpr double kThick = 0.05;
    return wall({-2, -1, -1 - kThick}, {2, 1, -1}) + wall({-2, -1, 1}, {2, 1, 1 + kThick}) +
           wall({-2, -1 - kThick, -1}, {2, -1, 1}) + wall({-2, 1, -1}, {2, 1 + kThick, 1}) +
           wall({-2 - kThick, -1, -1}, {-2, 1, 1}) + wall({2, -1, -1}, {2 + kThick, 1, 1}) +
           // the door, a third of the wall, from the floor on
           wall({-kThick, -1, -1}, {kThick, -0.3, 1}) + wall({-kThick, 0.3, -1}, {kThick, 1, 1}) +
           wall({-kThick, -0.3, 0.2}, {kThick, 0.3, 1});
}

// The first two that stand inside of the house: one in each room.
TEST(CubePlacement, PutsAMapIntoEachOfTwoRooms)
{
    const Mesh mesh = make_mesh(rooms_with_a_door());
    const CubePlacement placement = place_cube_maps(mesh);
    const double unit = 1.0 / mesh.geometry.frame.diagonal;
    std::vector<glm::dvec3> inside;
    for (const glm::vec3 centre : placement.centres) {
        const glm::dvec3 at = glm::dvec3(centre) / unit;
        if (std::abs(at.x) < 2.0 && std::abs(at.y) < 1.0 && std::abs(at.z) < 1.0)
            inside.push_back(at);
    }
    ASSERT_GE(inside.size(), 2u);
    EXPECT_LT(inside[0].x * inside[1].x, 0.0);
    EXPECT_GE(placement.covered, 0.98);
    EXPECT_EQ(place_cube_maps(mesh).centres, placement.centres);
}

// From inside of a closed body nobody looks: all maps are around it, and a few see it all.
TEST(CubePlacement, LeavesTheInsideOfABodyAlone)
{
    const Mesh mesh = make_mesh(scenes::sphere({0, 0, 0}, 1.0, 8));
    const float radius = glm::length(mesh.geometry.positions[0]);
    const CubePlacement placement = place_cube_maps(mesh);
    EXPECT_GE(placement.covered, 0.98);
    EXPECT_GE(placement.centres.size(), 4u);
    for (const glm::vec3 centre : placement.centres)
        EXPECT_GT(glm::length(centre), radius);
}

TEST(CubePlacement, KeepsToTheNumberAskedFor)
{
    const Mesh mesh = make_mesh(scenes::bumpy_sphere(8));
    EXPECT_EQ(place_cube_maps(mesh, 2).centres.size(), 2u);
    EXPECT_THROW((void)place_cube_maps(mesh, 0), SettingsError);
}

}  // namespace
}  // namespace surfelao
