#include "tree/masks/winding.h"

#include "scenes.h"

#include <gtest/gtest.h>

#include <utility>

namespace surfelao {
namespace {

/// Every other triangle the other way round.
Scene mixed(Scene scene)
{
    for (std::size_t t = 1; t < scene.triangles.size(); t += 2)
        std::swap(scene.triangles[t].y, scene.triangles[t].z);
    return scene;
}

TEST(MaskWinding, OnlyTrianglesWoundAtRandomAreMixed)
{
    const Scene ball = scenes::bumpy_sphere(16);
    EXPECT_FALSE(is_winding_mixed(make_geometry(ball)));
    EXPECT_FALSE(is_winding_mixed(make_geometry(scenes::flipped(ball))));
    EXPECT_TRUE(is_winding_mixed(make_geometry(mixed(ball))));

    // one part inside out is no mixture: its triangles agree with each other
    using scenes::operator+=;
    Scene parts = ball;
    parts += scenes::flipped(scenes::room({3, 0, 0}, {4, 1, 1}, 4));
    EXPECT_FALSE(is_winding_mixed(make_geometry(parts)));
    EXPECT_FALSE(is_winding_mixed(make_geometry(Scene())));
}

TEST(MaskWinding, AMixtureIsWoundAsItWas)
{
    const Scene ball = scenes::bumpy_sphere(16);
    Geometry geometry = make_geometry(mixed(ball));
    wind_alike(geometry);
    EXPECT_EQ(geometry.triangles, make_geometry(ball).triangles);
}

TEST(MaskWinding, SeamsAreCrossed)
{
    // two triangles with vertices of their own
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    scene.triangles = {{0, 1, 2}, {3, 5, 4}};
    Geometry geometry = make_geometry(scene);
    wind_alike(geometry);
    EXPECT_EQ(geometry.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}}));
}

TEST(MaskWinding, EdgesOfMoreThanTwoTrianglesAskNothing)
{
    // three wings at one edge
    Scene scene;
    scene.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
    scene.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    Geometry geometry = make_geometry(scene);
    const std::vector<glm::uvec3> before = geometry.triangles;
    wind_alike(geometry);
    EXPECT_EQ(geometry.triangles, before);
}

}  // namespace
}  // namespace surfelao
