#include "reference/closest_hit.h"

#include "scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace surfelao {
namespace {

/// A unit square that faces +z, in its own unit frame: the diagonal is 1.
TEST(ClosestHit, TellsWhereHowFarAndFromWhichSide)
{
    const Geometry geometry = make_geometry(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1));
    const RayScene scene(geometry, RayScene::Build::robust);
    const glm::vec3 place(0.1f, 0.2f, 0.0f), up(0, 0, 1);
    const Ray rays[] = {{place + 0.25f * up, -up, 1.0f},
                        {place - 0.5f * up, up, INFINITY},
                        {place + 0.25f * up, -up, 0.2f},
                        {place + 0.25f * up, up, INFINITY}};
    const std::vector<ClosestHit> hits = closest_hits(scene, rays);
    for (int i = 0; i < 2; ++i) {
        ASSERT_NE(hits[i].triangle, ClosestHit::kNone) << i;
        EXPECT_NEAR(hits[i].distance, i == 0 ? 0.25f : 0.5f, 1e-6f);
        EXPECT_EQ(hits[i].is_back, i == 1);
        const glm::uvec3 v = geometry.triangles[hits[i].triangle];
        const glm::vec3 met = (1.0f - hits[i].at.x - hits[i].at.y) * geometry.positions[v.x] +
                              hits[i].at.x * geometry.positions[v.y] +
                              hits[i].at.y * geometry.positions[v.z];
        EXPECT_NEAR(met.x, place.x, 1e-6f);
        EXPECT_NEAR(met.y, place.y, 1e-6f);
    }
    EXPECT_EQ(hits[2].triangle, ClosestHit::kNone);
    EXPECT_EQ(hits[3].triangle, ClosestHit::kNone);
}

}  // namespace
}  // namespace surfelao
