#include "surfels/bodies.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

// A strip of three triangles 0-1-2, 2-1-3, 2-3-4: the middle one is another body's.
TEST(Bodies, HaveTheirOwnVerticesInTheOrderOfTheirTriangles)
{
    Geometry strip;
    strip.positions.resize(5);
    strip.triangles = {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}};
    const std::vector<BodyMesh> bodies = split_bodies(strip, std::vector<std::uint32_t>{2, 0, 2});
    ASSERT_EQ(bodies.size(), 3u);
    EXPECT_EQ(bodies[0].vertices, (std::vector<std::uint32_t>{2, 1, 3}));
    EXPECT_EQ(bodies[0].triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));
    EXPECT_TRUE(bodies[1].triangles.empty());
    EXPECT_EQ(bodies[2].vertices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
    EXPECT_EQ(bodies[2].triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {2, 3, 4}}));
    EXPECT_EQ(split_bodies(Geometry(), {}).size(), 1u);
}

}  // namespace
}  // namespace surfelao
