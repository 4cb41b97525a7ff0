#include "files/scene_io.h"
#include "gltf_maker.h"
#include "surfels/srgb.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

using test::GltfMaker;

std::vector<glm::vec3> factors_at_triangles(const BaseColors& colors)
{
    std::vector<glm::vec3> factors;
    for (const std::uint32_t material : colors.triangles)
        factors.push_back(colors.materials.at(material).factor);
    return factors;
}

// A quad is two triangles; names have blanks; what no file knows is white.
TEST(BaseColors, OfObjAreThoseOfItsMaterials)
{
    const TemporaryFolder folder;
    folder.file("a b.mtl",
                "newmtl red one\nKd 1 0 0\nmap_Kd -s 2 2 1 wood grain.png\n"
                "newmtl grey\nKd .5 .5 .5\n");
    folder.file("wood grain.png", "x");
    const Scene scene = read_scene(folder.file(
        "in.obj",
        "mtllib gone.mtl a b.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n"
        "usemtl red one\nf 1 2 3 4\nf 1 2\nusemtl grey\nf 1 2 3\nusemtl unknown\nf 1 2 4\n"));
    const BaseColors colors = scene.asset->base_colors();
    const float grey = srgb_decode(0.5f);
    EXPECT_EQ(
        factors_at_triangles(colors),
        (std::vector<glm::vec3>{{1, 1, 1}, {1, 0, 0}, {1, 0, 0}, glm::vec3(grey), {1, 1, 1}}));
    ASSERT_EQ(colors.pictures.size(), 1u);
    EXPECT_EQ(colors.pictures[0].file.filename(), "wood grain.png");
    EXPECT_EQ(colors.materials[colors.triangles[1]].picture, 0u);
    EXPECT_FALSE(colors.materials[colors.triangles[3]].picture.has_value());
}

/// A node with two squares of two triangles, the second without a material.
GltfMaker painted_squares()
{
    GltfMaker maker = test::square();
    auto& primitives = maker.document["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    primitives[0]["material"] = 0;
    maker.document["materials"] = {{{"pbrMetallicRoughness",
                                     {{"baseColorFactor", {0.25, 0.5, 1, 1}},
                                      {"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}}};
    maker.document["textures"] = {{{"source", 0}}};
    return maker;
}

TEST(BaseColors, OfGltfComeFromBufferViewsDataAndFiles)
{
    const TemporaryFolder folder;
    const struct {
        std::function<nlohmann::json(GltfMaker&)> image;
        const char* bytes;
        const char* file;
    } rows[] = {
        {[](GltfMaker& maker) {
             return nlohmann::json{{"bufferView", maker.add_view("PIC")}};
         },
         "PIC", ""},
        {[](GltfMaker&) {
             return nlohmann::json{{"uri", "data:image/png;base64,UElD"}};
         },
         "PIC", ""},
        {[](GltfMaker&) {
             return nlohmann::json{{"uri", "a%20b.png"}};
         },
         "", "a b.png"},
        {[](GltfMaker&) {
             return nlohmann::json{{"uri", "../secret.png"}};
         },
         "", ""},
        {[](GltfMaker&) {
             return nlohmann::json{{"bufferView", 99}};
         },
         "", ""},
    };
    for (const auto& row : rows) {
        GltfMaker maker = painted_squares();
        maker.document["images"] = nlohmann::json::array({row.image(maker)});
        const Scene scene = read_scene(folder.file("in.glb", maker.glb()));
        const BaseColors colors = scene.asset->base_colors();
        const glm::vec3 blue(0.25f, 0.5f, 1.0f), white(1.0f);
        EXPECT_EQ(factors_at_triangles(colors), (std::vector<glm::vec3>{blue, blue, white, white}));
        const BaseColor& painted = colors.materials[colors.triangles[0]];
        EXPECT_EQ(painted.uv_set, 1u);
        ASSERT_EQ(painted.picture, 0u);
        EXPECT_EQ(colors.pictures[0].bytes, row.bytes);
        EXPECT_EQ(colors.pictures[0].file.filename(), row.file);
    }
}

TEST(BaseColors, NamesTheCoordinatesOfAMapThatIsThere)
{
    const TemporaryFolder folder;
    const std::pair<nlohmann::json, std::optional<std::uint32_t>> rows[] = {
        {{{"index", 0}, {"texCoord", 1}}, 1}, {{{"index", 0}}, 0}, {5, {}}, {nullptr, {}}};
    for (const auto& [texture, set] : rows) {
        GltfMaker maker = painted_squares();
        maker.document["materials"][0]["occlusionTexture"] = texture;
        const Scene scene = read_scene(folder.file("in.glb", maker.glb()));
        EXPECT_EQ(scene.asset->occlusion_uvs(), set) << texture;
    }
}

// What is malformed is white, and nothing is thrown.
TEST(BaseColors, OfMalformedGltfAreWhite)
{
    const TemporaryFolder folder;
    for (const nlohmann::json& looks :
         {nlohmann::json{{"baseColorFactor", {"x", 1, nullptr, 1}}},
          nlohmann::json{{"baseColorFactor", 3}},
          nlohmann::json{{"baseColorTexture", {{"index", -1}}}},
          nlohmann::json{{"baseColorTexture", {{"index", 7}}}}, nlohmann::json(5)}) {
        GltfMaker maker = painted_squares();
        maker.document["materials"][0]["pbrMetallicRoughness"] = looks;
        const Scene scene = read_scene(folder.file("in.glb", maker.glb()));
        const BaseColors colors = scene.asset->base_colors();
        EXPECT_EQ(factors_at_triangles(colors), std::vector<glm::vec3>(4, glm::vec3(1.0f)))
            << looks;
        EXPECT_TRUE(colors.pictures.empty());
    }
}

}  // namespace
}  // namespace surfelao
