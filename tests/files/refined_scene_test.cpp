// Files whose triangles are cut: what is new in them, and that nothing else is.
#include "files/refined_scene.h"

#include "gltf_maker.h"
#include "temporary_folder.h"

#include "files/refined_faces.h"
#include "files/scene_io.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <array>

namespace surfelao {
namespace {

using test::bytes_of;
using test::GltfMaker;

/// The diagonal of the square of the first two triangles is cut; other triangles stay.
Refinement across(const Scene& scene)
{
    Refinement refinement;
    const auto middle = static_cast<std::uint32_t>(scene.positions.size());
    refinement.old_vertices = middle;
    const glm::uvec3 a = scene.triangles[0], b = scene.triangles[1];
    refinement.parents = {{a.x, a.z}};  // which are b.x and b.y
    refinement.pieces = {
        {a.x, a.y, middle}, {a.y, a.z, middle}, {b.x, middle, b.z}, {middle, b.y, b.z}};
    refinement.first = {0, 2, 4};
    for (std::size_t t = 2; t < scene.triangles.size(); ++t) {
        refinement.pieces.push_back(scene.triangles[t]);
        refinement.first.push_back(static_cast<std::uint32_t>(refinement.pieces.size()));
    }
    return refinement;
}

/// Vertices behind the first face, numbers that count backwards, corners without coordinates.
constexpr const char* kWholeObj =
    "# c\no a\nv 0 0 0 1 0 0\nv 2 0 0 0 0 0\nv 2 2 0 1 0 0\nv 0 2 0 0 0 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\ng one\nusemtl red\nf -4/1/1 -3/2/1 -2/3/1 -1//1 # quad\n"
    "o b\nv 5 0 0\ns 1\nf 1 2 -1\n";
constexpr const char* kCutObj =
    "# c\no a\nv 0 0 0 1 0 0\nv 2 0 0 0 0 0\nv 2 2 0 1 0 0\nv 0 2 0 0 0 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\ng one\nusemtl red\n"
    "v 5 0 0\nv 1 1 0 1 0 0\nvt 0.5 0.5\n"
    "f 1/1/1 2/2/1 6/4/1\nf 2/2/1 3/3/1 6/4/1\nf 1/1/1 6/4/1 4//1\nf 6/4/1 3/3/1 4//1 # quad\n"
    "o b\ns 1\nf 1 2 5\n";

constexpr const char* kWholeOff =
    "# c\nCOFF # d\n5 2 9\n0 0 0 255 0 0 255\n2 0 0 0 0 0 255\n2 2 0 1 0 0 255\n0 2 0 0 0 0 255\n"
    "5 0 0 0 0 0 255\n4 0 1 2 3 7 8 9 # quad\n3 0 1 4\n";
constexpr const char* kCutOff =
    "# c\nCOFF # d\n6 5 0\n0 0 0 255 0 0 255\n2 0 0 0 0 0 255\n2 2 0 1 0 0 255\n"
    "0 2 0 0 0 0 255\n5 0 0 0 0 0 255\n1 1 0 128 0 0 255\n"
    "3 0 1 5 7 8 9\n3 1 2 5 7 8 9\n3 0 5 3 7 8 9\n3 5 2 3 7 8 9 # quad\n3 0 1 4\n";

constexpr const char* kWholePly =
    "ply\nformat ascii 1.0\ncomment c\nelement vertex 5\nproperty float x\nproperty float y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "property uchar red\nproperty list uchar int ids\nelement face 2\n"
    "property list uchar char vertex_indices\nproperty short part\n"
    "property list uchar float texcoord\nelement tail 1\nproperty int n\nend_header\n"
    "0 0 0 1 0 0 10 1 3\n2 0 0 0 0 1 0 0\n2 2 0 0 1 0 20 0\n0 2 0 0 0 1 0 0\n5 0 0 0 0 1 0 0\n"
    "4 0 1 2 3 7 8 0 0 1 0 1 1 0 1\n3 0 1 4 9 0\n42\n";
constexpr const char* kCutPly =
    "ply\nformat ascii 1.0\ncomment c\nelement vertex 6\nproperty float x\nproperty float y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "property uchar red\nproperty list uchar int ids\nelement face 5\n"
    "property list uchar char vertex_indices\nproperty short part\n"
    "property list uchar float texcoord\nelement tail 1\nproperty int n\nend_header\n"
    "0 0 0 1 0 0 10 1 3\n2 0 0 0 0 1 0 0\n2 2 0 0 1 0 20 0\n0 2 0 0 0 1 0 0\n5 0 0 0 0 1 0 0\n"
    "1 1 0 0.70710677 0.70710677 0 15 1 3\n"
    "3 0 1 5 7 6 0 0 1 0 0.5 0.5\n3 1 2 5 7 6 1 0 1 1 0.5 0.5\n"
    "3 0 5 3 7 6 0 0 0.5 0.5 0 1\n3 5 2 3 7 6 0.5 0.5 1 1 0 1\n3 0 1 4 9 0\n42\n";

struct TextCase {
    const char *name, *text, *refined;
    std::string (*refine)(const Scene&, const Refinement&, std::span<const glm::vec3>);
};

TEST(RefinedScene, KeepsTheRestOfTextFiles)
{
    const TemporaryFolder folder;
    for (const TextCase& c : {TextCase{"a.obj", kWholeObj, kCutObj, refined_obj},
                              TextCase{"a.off", kWholeOff, kCutOff, refined_off},
                              TextCase{"a.ply", kWholePly, kCutPly, refined_ply}}) {
        const Scene scene = read_scene(folder.file(c.name, c.text));
        EXPECT_EQ(c.refine(scene, across(scene), {}), c.refined);
    }
}

/// The third triangle has copies of the first two vertices; nothing is cut.
Refinement with_copies(const Scene& scene)
{
    Refinement refinement;
    refinement.old_vertices = static_cast<std::uint32_t>(scene.positions.size());
    refinement.parents = {glm::uvec2(0), glm::uvec2(1)};
    refinement.pieces = scene.triangles;
    for (int k = 0; k < 3; ++k) {
        if (refinement.pieces[2][k] < 2)
            refinement.pieces[2][k] += refinement.old_vertices;
    }
    refinement.first = {0, 1, 2, 3};
    return refinement;
}

constexpr const char* kCopiedObj =
    "# c\no a\nv 0 0 0 1 0 0\nv 2 0 0 0 0 0\nv 2 2 0 1 0 0\nv 0 2 0 0 0 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\ng one\nusemtl red\n"
    "v 5 0 0\nv 0 0 0 1 0 0\nv 2 0 0 0 0 0\nvn 0 0.5 5\nvn 0 0.5 6\nvn 0 0.5 4\n"
    "f 1/1/1 2/2/1 3/3/1 4//1 # quad\no b\ns 1\nf 6//2 7//3 5//4\n";
constexpr const char* kCopiedOff =
    "# c\nCNOFF # d\n7 2 0\n0 0 0 0 0.5 0 255 0 0 255\n2 0 0 0 0.5 1 0 0 0 255\n"
    "2 2 0 0 0.5 2 1 0 0 255\n0 2 0 0 0.5 3 0 0 0 255\n5 0 0 0 0.5 4 0 0 0 255\n"
    "0 0 0 0 0.5 5 255 0 0 255\n2 0 0 0 0.5 6 0 0 0 255\n4 0 1 2 3 7 8 9 # quad\n3 5 6 4\n";
constexpr const char* kBarePly =
    "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
    "property float z\nproperty uchar red\nelement face 2\n"
    "property list uchar char vertex_indices\nproperty short part\nend_header\n"
    "0 0 0 10\n2 0 0 0\n2 2 0 20\n0 2 0 0\n5 0 0 0\n4 0 1 2 3 7\n3 0 1 4 9\n";
constexpr const char* kCopiedPly =
    "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\n"
    "property float z\nproperty uchar red\nproperty float nx\nproperty float ny\n"
    "property float nz\nelement face 2\n"
    "property list uchar char vertex_indices\nproperty short part\nend_header\n"
    "0 0 0 10 0 0.5 0\n2 0 0 0 0 0.5 1\n2 2 0 20 0 0.5 2\n0 2 0 0 0 0.5 3\n5 0 0 0 0 0.5 4\n"
    "0 0 0 10 0 0.5 5\n2 0 0 0 0 0.5 6\n4 0 1 2 3 7\n3 5 6 4 9\n";

TEST(RefinedScene, CopiesVerticesAndAddsNormals)
{
    const TemporaryFolder folder;
    std::vector<glm::vec3> normals;
    for (int v = 0; v < 7; ++v)
        normals.emplace_back(0.0f, 0.5f, static_cast<float>(v));
    for (const TextCase& c : {TextCase{"a.obj", kWholeObj, kCopiedObj, refined_obj},
                              TextCase{"a.off", kWholeOff, kCopiedOff, refined_off},
                              TextCase{"a.ply", kBarePly, kCopiedPly, refined_ply}}) {
        const Scene scene = read_scene(folder.file(c.name, c.text));
        EXPECT_EQ(c.refine(scene, with_copies(scene), normals), c.refined);
    }
}

/// The pieces of `refined` are those of the refinement, each corner where it belongs.
void expect_places(const Scene& scene, const Refinement& refinement, const Scene& refined)
{
    std::vector<glm::dvec3> places = scene.positions;
    for (const glm::uvec2& of : refinement.parents)
        places.push_back(0.5 * places[of.x] + 0.5 * places[of.y]);
    ASSERT_EQ(refined.triangles.size(), refinement.pieces.size());
    for (std::size_t t = 0; t < refined.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k)
            EXPECT_LT(glm::distance(refined.positions[refined.triangles[t][k]],
                                    places[refinement.pieces[t][k]]),
                      1e-6)
                << t;
    }
}

// Also of files that a bake has coloured, and in formats that others are turned into.
TEST(RefinedScene, IsReadAsItsPieces)
{
    const TemporaryFolder folder;
    const Scene obj = read_scene(folder.file("a.obj", kWholeObj));
    const std::vector<Occlusion> occlusion(obj.positions.size(), Occlusion{0.25f, {0, 0, 1}});
    for (const char* name : {"b.obj", "b.off", "b.ply"}) {
        WriteOptions options;
        options.colors = VertexColors::grey;
        options.mark = "surfelao 0 bake: at=vertices";
        write_scene(folder / name, obj, occlusion, options);
        const Scene scene = read_scene(folder / name);
        const Refinement refinement = across(scene);
        const Scene refined = refined_scene(scene, refinement);
        expect_places(scene, refinement, refined);
        ASSERT_NE(refined.asset, nullptr) << name;
        const std::vector<glm::vec4> colors = refined.asset->own_colors();
        ASSERT_EQ(colors.size(), 6u) << name;
        EXPECT_EQ(colors[5], colors[0]) << name;  // red at both ends
    }
}

/// A square of small numbers in two places, one of them mirrored, with a morph target.
GltfMaker small_square()
{
    GltfMaker maker;
    const int positions = maker.add_accessor(
        maker.add_view(bytes_of<std::uint16_t>({0, 0, 0, 0, 7, 0, 0, 0, 7, 7, 0, 0, 0, 7, 0, 0}),
                       8),
        5123, "VEC3", 4);
    const int normals = maker.add_accessor(
        maker.add_view(
            bytes_of<std::int8_t>({127, 0, 0, 0, 0, 0, 127, 0, 0, 127, 0, 0, 0, 0, 127, 0}), 4),
        5120, "VEC3", 4);
    maker.document["accessors"][normals]["normalized"] = true;
    const int target = maker.add_vectors<float>({0, 0, 1, 0, 0, 0, 0, 0, 3, 0, 0, 0});
    const int indices = maker.add_indices<std::uint8_t>({0, 1, 2, 0, 2, 3});
    maker.add("meshes", {{"primitives",
                          {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                            {"targets", {{{"POSITION", target}}}},
                            {"indices", indices}}}},
                         {"weights", {0.5}}});
    maker.add("nodes", {{"mesh", 0}});
    maker.add("nodes", {{"mesh", 0}, {"translation", {9, 0, 0}}, {"scale", {-1, 1, 1}}});
    maker.document["scenes"][0]["nodes"] = {0, 1};
    maker.document["extensionsUsed"] = {"KHR_mesh_quantization"};
    return maker;
}

TEST(RefinedScene, CutsEachUseOfAMeshInGltf)
{
    const TemporaryFolder folder;
    const GltfMaker maker = small_square();
    const Scene scene = read_scene(folder.file("a.glb", maker.glb()));
    const Refinement refinement = across(scene);
    const Scene refined = refined_scene(scene, refinement);
    expect_places(scene, refinement, refined);
    ASSERT_EQ(refined.parts.size(), 2u);
    EXPECT_EQ(refined.parts[0].vertex_count, 5u);
    EXPECT_EQ(refined.parts[1].vertex_count, 4u);
    // 3.5 is no whole number, and the target adds half of 2
    EXPECT_EQ(refined.positions[4], glm::dvec3(3.5, 3.5, 1.0));
    const glm::vec3 normal = refined.normals.values[4];
    EXPECT_NEAR(normal.x, std::sqrt(0.5f), 0.01f);
    EXPECT_NEAR(normal.y, std::sqrt(0.5f), 0.01f);
    write_scene(folder / "b.glb", refined, std::vector<Occlusion>(refined.positions.size()));
    EXPECT_EQ(read_scene(folder / "b.glb").positions, refined.positions);
}

// One use is turned, stretched and mirrored.
TEST(RefinedScene, GivesGltfNormalsOfTheWorld)
{
    GltfMaker maker = small_square();
    maker.document["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
    maker.document["nodes"][1]["scale"] = {-1, 2, 3};
    maker.document["nodes"][1]["rotation"] = {0.6, 0, 0, 0.8};
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("a.glb", maker.glb()));
    ASSERT_TRUE(scene.normals.empty());
    std::vector<glm::vec3> normals;
    for (int v = 0; v < 9; ++v)  // the last is new, of the first part
        normals.push_back(glm::normalize(glm::vec3(1, v, 2)));
    const Scene refined = refined_scene(scene, across(scene), normals);
    ASSERT_TRUE(refined.normals.of_vertices());
    ASSERT_EQ(refined.normals.values.size(), 9u);
    const std::array<std::size_t, 9> number_of{0, 1, 2, 3, 5, 6, 7, 8, 4};
    for (std::size_t v = 0; v < 9; ++v)
        EXPECT_GT(glm::dot(glm::normalize(refined.normals.values[number_of[v]]), normals[v]),
                  0.999999f)
            << v;
}

TEST(RefinedScene, RefusesSkins)
{
    GltfMaker maker = test::one_triangle();
    const int joints = maker.add_accessor(
        maker.add_view(bytes_of<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0})), 5121, "VEC4",
        3);
    const int weights = maker.add_accessor(
        maker.add_view(bytes_of<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})), 5126, "VEC4", 3);
    test::primitive(maker)["attributes"]["JOINTS_0"] = joints;
    test::primitive(maker)["attributes"]["WEIGHTS_0"] = weights;
    maker.document["nodes"][0]["skin"] = 0;
    maker.add("nodes", {{"name", "joint"}});
    maker.document["scenes"][0]["nodes"] = {0, 1};
    maker.add("skins", {{"joints", {1}}});
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("a.glb", maker.glb()));
    EXPECT_THROW(check_refinable(scene), InputError);
}

}  // namespace
}  // namespace surfelao
