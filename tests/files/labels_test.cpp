// Names in files, and the triangles that have them.
#include "surfels/labels.h"
#include "files/scene_io.h"
#include "gltf_maker.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

/// "node a 0+2 4+1"
std::vector<std::string> labels_in(const std::string& file_name, const std::string& contents)
{
    const TemporaryFolder folder;
    std::vector<std::string> texts;
    for (const Label& label : read_scene(folder.file(file_name, contents)).labels) {
        std::string& text = texts.emplace_back(name_of(label.kind));
        text += " " + label.name;
        for (const Label::Range& range : label.ranges)
            text += " " + std::to_string(range.first) + "+" + std::to_string(range.count);
    }
    return texts;
}

using Texts = std::vector<std::string>;

// Faces before any name have none; a quad is two triangles; a face of two corners is none.
TEST(FileLabels, OfObjAreObjectsGroupsAndMaterials)
{
    EXPECT_EQ(labels_in("a.obj",
                        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\no big one\ng left all\n"
                        "usemtl red\nf 1 2 3 4\nf 1 2\ng all\nf 1 2 3\nusemtl red\nf 2 3 4\no\n"
                        "f 1 2 4\ng left\n"),
              (Texts{"group left 1+2", "group all 1+5", "material red 1+5", "object big one 1+4"}));
}

TEST(FileLabels, OfGltfAreNodesWithAllBelowMeshesAndMaterials)
{
    test::GltfMaker maker = test::square();  // two triangles
    nlohmann::json& document = maker.document;
    document["materials"] = {{{"name", "red"}}};
    document["meshes"][0]["name"] = "square";
    document["meshes"].push_back(document["meshes"][0]);
    document["meshes"][1]["name"] = "other";
    document["meshes"][1]["primitives"][0]["material"] = 0;
    document["nodes"] = {{{"name", "root"}, {"children", {1, 4}}},
                         {{"name", "group"}, {"children", {2, 3}}},
                         {{"name", "a"}, {"mesh", 0}},
                         {{"name", "group"}, {"mesh", 1}},
                         {{"name", "a"}, {"mesh", 1}, {"children", {5}}},
                         {{"name", "empty"}}};
    EXPECT_EQ(labels_in("a.glb", maker.glb()),
              (Texts{"node root 0+6", "node group 0+4", "node a 0+2 4+2", "mesh square 0+2",
                     "mesh other 2+4", "material red 2+4"}));
}

TEST(FileLabels, OfStlAreSolidsAndPlyHasNone)
{
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
        "endfacet\n";
    EXPECT_EQ(
        labels_in("a.stl", "solid left side\n" + facet + facet + "endsolid left side\nsolid\n" +
                               facet + "endsolid\nsolid top\n" + facet + "endsolid\n"),
        (Texts{"object left side 0+2", "object top 3+1"}));
    EXPECT_EQ(labels_in("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), Texts{});
}

}  // namespace
}  // namespace surfelao
