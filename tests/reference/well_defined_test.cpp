#include "reference/well_defined.h"
#include "tests/vertex_receivers.h"

#include <gtest/gtest.h>

#include <cmath>

namespace surfelao {
namespace {

/// Adds the parallelogram corner, corner + u, corner + u + v, corner + v; its front is u x v.
void add_sheet(Scene& scene, glm::dvec3 corner, glm::dvec3 u, glm::dvec3 v)
{
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), {corner, corner + u, corner + u + v, corner + v});
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.triangles.push_back({first, first + 2, first + 3});
}

/// A floor [-1, 1]^2 at z = 0, facing up.
Scene floor_scene()
{
    Scene scene;
    add_sheet(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    return scene;
}

/// placement_change of a receiver on the floor at (x, y, 0).
float change_at(const Scene& scene, double x, double y, float offset = kVertexOffset)
{
    const Geometry geometry = make_geometry(scene);
    const glm::dvec3 unit = (glm::dvec3(x, y, 0) - geometry.frame.centre) / geometry.frame.diagonal;
    const glm::vec3 up(0, 0, 1);
    const Receiver receiver{glm::vec3(unit) + offset * up, up, offset};
    return placement_change(RayScene(geometry, RayScene::Build::robust), {&receiver, 1}, {})[0];
}

TEST(PlacementChange, IsNothingOnALoneSheetAndUnderAFarOne)
{
    Scene scene = floor_scene();
    EXPECT_EQ(change_at(scene, 0.3, 0.2), 0.0f);
    add_sheet(scene, {-1, -1, 0.5}, {2, 0, 0}, {0, 2, 0});
    EXPECT_LT(change_at(scene, 0.3, 0.2), 0.01f);
}

TEST(PlacementChange, FindsASheetAsNearAsTheOffset)
{
    Scene scene = floor_scene();
    const double diagonal = std::sqrt(8.0);
    add_sheet(scene, {-1, -1, 1e-4 * diagonal}, {2, 0, 0}, {0, 2, 0});
    EXPECT_GT(change_at(scene, 0.3, 0.2), 0.9f);
    // the sheet is ten offsets away: the question has an answer
    EXPECT_LT(change_at(scene, 0.3, 0.2, 1e-5f), 0.01f);
}

TEST(PlacementChange, FindsTheFootOfAWallInWhosePlaneTheReceiverStands)
{
    for (const bool along_x : {true, false}) {
        Scene scene = floor_scene();
        add_sheet(scene, along_x ? glm::dvec3(0, -1, 0) : glm::dvec3(-1, 0, 0),
                  along_x ? glm::dvec3(0, 2, 0) : glm::dvec3(2, 0, 0), {0, 0, 2});
        EXPECT_GT(along_x ? change_at(scene, 0, 0.2) : change_at(scene, 0.2, 0), 0.3f);
        EXPECT_LT(change_at(scene, 1e-3, 1e-3), 0.05f);  // beside it
    }
}

TEST(PlacementChange, FindsAWallThroughTheReceiverWhereEverySideIsClosed)
{
    Scene scene = floor_scene();
    add_sheet(scene, {-1, -1, 0.01}, {2, 0, 0}, {0, 2, 0});  // a lid: closed on either side
    EXPECT_LT(change_at(scene, 0, 0.2), 0.01f);
    add_sheet(scene, {0, -1, 0}, {0, 2, 0}, {0, 0, 0.01});
    EXPECT_GT(change_at(scene, 0, 0.2), 0.3f);
    EXPECT_LT(change_at(scene, 1e-3, 0.2), 0.01f);  // beside it
}

TEST(PlacementChange, IsNothingInACreaseOfTwoDegreesWhichLooksTheSameAtEveryScale)
{
    Scene scene;  // a V along y, 2 degrees wide; both flanks face inwards
    const double x = std::sin(0.0174533), z = std::cos(0.0174533);
    add_sheet(scene, {0, -1, 0}, {0, 2, 0}, {-x, 0, z});
    add_sheet(scene, {x, -1, z}, {0, 2, 0}, {-x, 0, -z});
    EXPECT_LT(change_at(scene, 0, 0.1), kIllDefined);
}

TEST(PlacementChange, ReceiversWithoutANormalHaveNone)
{
    const Receiver receiver{{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    const Geometry geometry = make_geometry(floor_scene());
    EXPECT_EQ(placement_change(RayScene(geometry, RayScene::Build::robust), {&receiver, 1}, {})[0],
              0.0f);
}

TEST(PlacementChange, CanBeCancelled)
{
    const Geometry geometry = make_geometry(floor_scene());
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    EXPECT_THROW((void)placement_change(RayScene(geometry, RayScene::Build::robust), receivers, {},
                                        [](double) { return false; }),
                 Cancelled);
}

}  // namespace
}  // namespace surfelao
