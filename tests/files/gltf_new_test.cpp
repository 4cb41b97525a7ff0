// Meshes of other formats as glTF.
#include "files/gltf_new.h"
#include "files/scene_io.h"
#include "surfels/errors.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace surfelao {
namespace {

/// Two squares that meet at a right angle, an object each.
constexpr const char* kCornerObj =
    "mtllib corner.mtl\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "o floor\nusemtl paint\nf 1/1 2/2 3/3 4/4\n"
    "o wall\ng left\nusemtl glass\nf 2/1 5/2 6/3 3/4\n";
constexpr const char* kCornerMtl =
    "newmtl paint\nKd 1 .5 0\nmap_Kd paint.png\nnewmtl glass\nd .25\nnewmtl tga\nmap_Kd a.tga\n";

Scene corner_as_gltf(const TemporaryFolder& folder)
{
    folder.file("corner.mtl", kCornerMtl);
    folder.file("paint.png", "\x89PNG");
    folder.file("a.tga", "");
    const auto path = folder.file("corner.obj", kCornerObj);
    return as_gltf(path, read_scene(path));
}

TEST(GltfNew, HasTheObjectsPlacesAndMaterialsOfTheMesh)
{
    const TemporaryFolder folder;
    const Scene scene = corner_as_gltf(folder);
    ASSERT_EQ(scene.parts.size(), 2u);
    EXPECT_EQ(scene.parts[0].name, "floor");
    EXPECT_EQ(scene.parts[1].name, "wall");
    ASSERT_EQ(scene.positions.size(), 8u);  // the hard edge's two vertices stand in both
    EXPECT_EQ(scene.positions[3], glm::dvec3(0, 1, 0));
    EXPECT_EQ(scene.positions[4], glm::dvec3(1, 0, 1));
    EXPECT_EQ(scene.uvs.at(0).values.at(2), glm::dvec2(1, 0));  // v down

    const BaseColors colors = scene.asset->base_colors();
    const auto material_at = [&](std::size_t triangle) {
        return colors.materials.at(colors.triangles.at(triangle));
    };
    EXPECT_EQ(material_at(0).name, "paint");
    EXPECT_FLOAT_EQ(material_at(0).factor.x, 1.0f);
    EXPECT_EQ(colors.pictures.at(material_at(0).picture.value()).file.filename(), "paint.png");
    EXPECT_EQ(material_at(2).name, "glass");
    EXPECT_EQ(material_at(2).opacity, Opacity::clear);
    EXPECT_FLOAT_EQ(material_at(2).alpha, 0.25f);
    const auto wall = std::ranges::find(scene.labels, "left", &Label::name);
    ASSERT_NE(wall, scene.labels.end());
    EXPECT_EQ(wall->ranges, (std::vector<Label::Range>{{2, 2}}));
    ASSERT_FALSE(scene.notes.empty());
    EXPECT_EQ(scene.notes.front(),
              "textures that are neither PNG nor JPEG are left out of the glTF: 1");
}

TEST(GltfNew, NormalsAreThoseOfTheSurfaceAndPartVerticesAtHardEdges)
{
    const TemporaryFolder folder;
    const auto path = folder.file("fold.off",
                                  "OFF\n6 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 0 1\n1 1 1\n"
                                  "4 0 1 2 3\n4 1 4 5 2\n");
    const Scene hard = as_gltf(path, read_scene(path));
    ASSERT_EQ(hard.positions.size(), 8u);
    for (int vertex = 0; vertex < 6; ++vertex)  // the file's own come first
        EXPECT_EQ(hard.positions[vertex], read_scene(path).positions[vertex]);
    EXPECT_FLOAT_EQ(hard.normals.values.at(0).z, 1.0f);
    EXPECT_FLOAT_EQ(std::abs(hard.normals.values.at(4).x), 1.0f);
    const Scene smooth = as_gltf(path, read_scene(path), {.crease = 180.0f});
    EXPECT_EQ(smooth.positions.size(), 6u);
}

TEST(GltfNew, CoordinatesFarOutKeepTheirLastBits)
{
    const TemporaryFolder folder;
    const auto path = folder.file("far.obj",
                                  "v 500000.001 0 4000000\nv 500001 0 4000000\n"
                                  "v 500000.001 1 4000000\nf 1 2 3\n");
    const Scene scene = as_gltf(path, read_scene(path));
    EXPECT_NEAR(scene.positions.at(0).x, 500000.001, 1e-6);
}

TEST(GltfNew, ColorsOfVerticesAndResultsAreWritten)
{
    const TemporaryFolder folder;
    const auto path =
        folder.file("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n");
    const Scene scene = as_gltf(path, read_scene(path));
    write_scene(folder / "a.gltf", scene, std::vector<Occlusion>(3, {.occlusion = 0.5f}),
                {.colors = VertexColors::keep});
    const std::string text = contents_of(folder / "a.gltf");
    EXPECT_NE(text.find("\"COLOR_0\""), std::string::npos);
    EXPECT_NE(text.find("\"_OCCLUSION\""), std::string::npos);
    EXPECT_EQ(read_scene(folder / "a.gltf").positions, scene.positions);
    // one from glTF stays what it is
    EXPECT_EQ(as_gltf(path, scene).asset, scene.asset);
}

TEST(GltfNew, PointsAreRefused)
{
    const TemporaryFolder folder;
    const auto path = folder.file("a.obj", "v 0 0 0\nv 1 0 0\n");
    EXPECT_THROW(static_cast<void>(as_gltf(path, read_scene(path))), InputError);
}

}  // namespace
}  // namespace surfelao
