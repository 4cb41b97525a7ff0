#include "reference/closest_hit.h"

#include "random.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

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

/// Of a ball about the origin the nearest place lies on the line to it, up to the facets.
TEST(NearestPlaces, LieOnTheSurfaceAndAreNearest)
{
    const Geometry geometry = make_geometry(scenes::sphere({0, 0, 0}, 1.0, 12));
    const RayScene scene(geometry, RayScene::Build::quick);
    const float radius = 0.5f / std::sqrt(3.0f);  // of the box's diagonal
    Random random(5);
    std::vector<glm::vec3> places;
    for (int i = 0; i < 200; ++i)
        places.push_back(glm::vec3(random.in_cube() - 0.5));
    const std::vector<NearestPlace> found = nearest_places(scene, geometry, places);
    for (std::size_t i = 0; i < places.size(); ++i) {
        ASSERT_NE(found[i].triangle, ClosestHit::kNone);
        EXPECT_NEAR(glm::distance(found[i].position, places[i]), found[i].distance, 1e-6f);
        EXPECT_NEAR(glm::length(found[i].position), radius, 0.01f * radius);
        EXPECT_NEAR(found[i].distance, std::abs(glm::length(places[i]) - radius), 0.01f * radius);
        for (const glm::vec3 vertex : geometry.positions)
            EXPECT_LE(found[i].distance, glm::distance(vertex, places[i]) + 1e-6f);
    }
}

TEST(NearestPlaces, OfSeveralAsNearTheLowestTriangleCounts)
{
    const Geometry geometry = make_geometry(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1));
    const RayScene scene(geometry, RayScene::Build::quick);
    const glm::vec3 above_the_diagonal(0.0f, 0.0f, 0.25f);
    EXPECT_EQ(nearest_places(scene, geometry, {&above_the_diagonal, 1})[0].triangle, 0u);
}

}  // namespace
}  // namespace surfelao
