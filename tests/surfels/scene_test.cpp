#include "surfels/scene.h"

#include "surfels/errors.h"
#include "surfels/geometry.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace surfelao {
namespace {

std::string refusal(const std::vector<glm::dvec3>& positions,
                    const std::vector<glm::uvec3>& triangles)
{
    try {
        static_cast<void>(make_scene(positions, triangles));
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing was thrown";
}

const std::vector<glm::dvec3> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST(MakeScene, ArraysBecomeASceneOfOnePart)
{
    const Scene scene = make_scene(kCorners, std::vector<glm::uvec3>{{0, 1, 2}, {2, 1, 0}});
    EXPECT_EQ(scene.positions, kCorners);
    ASSERT_EQ(scene.parts.size(), 1u);
    EXPECT_EQ(scene.parts[0].vertex_count, 3u);
    EXPECT_EQ(scene.parts[0].triangle_count, 2u);
    EXPECT_EQ(make_geometry(scene).triangles.size(), 2u);
}

TEST(MakeScene, RefusesWithTheElementWhatIsNoScene)
{
    EXPECT_EQ(refusal(kCorners, {{0, 1, 2}, {0, 3, 1}}),
              "triangle 1 uses vertex 3, but there are 3 vertices");
    EXPECT_EQ(refusal(kCorners, {}), "there is no triangle");
    for (const double wrong : {std::numeric_limits<double>::quiet_NaN(),
                               -std::numeric_limits<double>::infinity(), 1e301}) {
        std::vector<glm::dvec3> positions = kCorners;
        positions[2].y = wrong;
        EXPECT_EQ(refusal(positions, {{0, 1, 2}}),
                  "vertex 2 has a coordinate that is no number or beyond 1e300");
    }
}

// A scene that was filled by hand goes through no other door.
TEST(MakeScene, GeometryRefusesTheSame)
{
    Scene scene;
    scene.name = "mine";
    scene.positions = kCorners;
    scene.triangles = {{0, 1, 7}};
    EXPECT_THROW(static_cast<void>(make_geometry(scene)), InputError);
    scene.triangles = {{0, 1, 2}};
    EXPECT_NO_THROW(static_cast<void>(make_geometry(scene)));
}

TEST(MakeScene, TextureCoordinatesMustBeThereOrNone)
{
    Scene scene = make_scene(kCorners, std::vector<glm::uvec3>{{0, 1, 2}});
    const auto fault = [&](const UvSet& uvs) {
        scene.uvs = {{}, uvs};
        try {
            check_scene(scene);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::vector<glm::dvec2> two(2, glm::dvec2(0.5));
    EXPECT_EQ(fault({two, {{1, UvSet::kNone, 0}}}), "");
    EXPECT_EQ(fault({two, {}}), "there are 2 texture coordinates for 3 vertices");
    EXPECT_EQ(fault({two, {{1, 0, 0}, {0, 0, 0}}}),
              "there are texture coordinates of 2 triangles for 1");
    EXPECT_EQ(fault({two, {{1, 0, 2}}}),
              "triangle 0 uses a texture coordinate that there is not: there are 2");
}

}  // namespace
}  // namespace surfelao
