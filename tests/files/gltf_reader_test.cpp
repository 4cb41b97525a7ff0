#include "gltf_maker.h"
#include "temporary_folder.h"

#include "files/gltf_io.h"
#include "files/scene_io.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace surfelao {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::GltfMaker;
using test::kTriangleUri;
using test::one_triangle;
using test::primitive;
using test::square;

using Positions = std::vector<glm::dvec3>;
using Triangles = std::vector<glm::uvec3>;

Scene read(const GltfMaker& maker)
{
    return read_gltf("made.glb", maker.glb());
}

const Positions kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const Triangles kSquareTriangles = {{0, 1, 2}, {0, 2, 3}};
const Positions kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST(GltfReader, ReadsABinaryFile)
{
    const Scene scene = read(square());
    EXPECT_EQ(scene.name, "made.glb");
    EXPECT_EQ(scene.positions, kSquare);
    EXPECT_EQ(scene.triangles, kSquareTriangles);
    ASSERT_EQ(scene.parts.size(), 1u);
    EXPECT_EQ(scene.parts[0].vertex_count, 4u);
    EXPECT_EQ(scene.parts[0].triangle_count, 2u);
    EXPECT_EQ(scene.parts[0].node, 0);
    EXPECT_EQ(scene.parts[0].mesh, 0);
    EXPECT_EQ(scene.parts[0].primitive, 0);
    EXPECT_NE(scene.asset, nullptr);
}

// ---- where the bytes are

TEST(GltfReader, ExternalBuffersLieBesideTheFile)
{
    const TemporaryFolder folder;
    folder.file("the buffer.bin", square().bin);
    const auto path = folder.file("made.gltf", square().gltf("the%20buffer.bin"));
    EXPECT_EQ(read_scene(path).positions, kSquare);
}

TEST(GltfReader, ExternalBuffersMayBeLongerThanDeclaredAndLieDeeper)
{
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "data");
    folder.file("data/square.bin", square().bin + "more");
    const auto path = folder.file("made.gltf", square().gltf("./data/square.bin"));
    EXPECT_EQ(read_scene(path).positions, kSquare);
}

TEST(GltfReader, DataUrisOfAnyMediaType)
{
    const std::string data = std::string(kTriangleUri).substr(std::string(kTriangleUri).find(','));
    for (const char* head :
         {"data:application/octet-stream;base64", "data:application/gltf-buffer;base64",
          "data:;base64", "data:text/plain;charset=x;base64"})
        EXPECT_EQ(read_gltf("a.gltf", one_triangle().gltf(head + data)).positions, kTriangle)
            << head;
}

TEST(GltfReader, ContentDecidesNotTheExtension)
{
    EXPECT_EQ(read_gltf("made.gltf", square().glb()).positions, kSquare);
    EXPECT_EQ(read_gltf("made.glb", one_triangle().gltf(kTriangleUri)).positions, kTriangle);
}

TEST(GltfReader, AByteOrderMarkAndSpaceAroundAreFine)
{
    const std::string text = "\xEF\xBB\xBF \r\n" + one_triangle().gltf(kTriangleUri) + "\n\n";
    EXPECT_EQ(read_gltf("made.gltf", text).positions, kTriangle);
}

TEST(GltfReader, UnknownChunksAndBytesBehindTheEndAreFine)
{
    std::string glb = square().glb() + bytes_of<std::uint32_t>({4}) + "ACME" + "????";
    const auto size = static_cast<std::uint32_t>(glb.size());
    std::memcpy(glb.data() + 8, &size, sizeof size);
    EXPECT_EQ(read_gltf("made.glb", glb + "behind the end").positions, kSquare);
}

TEST(GltfReader, ImagesAreNotLookedAt)
{
    GltfMaker maker = square();
    maker.document["images"] = {{{"uri", "absent.png"}}, {{"uri", "data:image/png;base64,AAAA"}}};
    maker.document["textures"] = {{{"source", 0}}, {{"source", 99}}};
    EXPECT_EQ(read(maker).positions, kSquare);
}

TEST(GltfReader, WhatIsNotGeometryIsNotJudged)
{
    GltfMaker maker = square();
    maker.document["animations"] = "dance";
    maker.document["materials"] = {1, nullptr, {{"pbrMetallicRoughness", "shiny"}}};
    maker.document["extras"] = {{"deep", {1, {2, {3}}}}};
    maker.document["extensionsUsed"] = 5;
    maker.document["nodes"][0]["camera"] = "yes";
    EXPECT_EQ(read(maker).positions, kSquare);
}

TEST(GltfReader, ExtensionsThatLeaveGeometryAloneMayBeRequired)
{
    GltfMaker maker = square();
    maker.document["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_materials_unlit",
                                            "KHR_texture_transform", "EXT_texture_webp"};
    EXPECT_EQ(read(maker).positions, kSquare);
}

TEST(GltfReader, WholeNumbersMayBeWrittenAsReals)
{
    GltfMaker maker = square();
    maker.document["scene"] = 0.0;
    maker.document["nodes"][0]["mesh"] = 0.0;
    maker.document["accessors"][0]["count"] = 4.0;
    maker.document["buffers"][0]["byteLength"] = 60.0;
    maker.document["accessors"][0]["componentType"] = 5126.0;
    EXPECT_EQ(read(maker).positions, kSquare);
}

// ---- topologies and indices

TEST(GltfReader, StripsTurnEverySecondTriangle)
{
    GltfMaker maker = square();
    primitive(maker)["mode"] = 5;
    primitive(maker)["indices"] = maker.add_indices<std::uint16_t>({0, 1, 3, 2});
    EXPECT_EQ(read(maker).triangles, (Triangles{{0, 1, 3}, {1, 2, 3}}));
}

TEST(GltfReader, StripsJumpOverRepeatedVertices)
{
    GltfMaker maker = square();
    primitive(maker)["mode"] = 5;
    primitive(maker)["indices"] = maker.add_indices<std::uint16_t>({0, 1, 3, 3, 1, 1, 1, 2, 3});
    EXPECT_EQ(read(maker).triangles, (Triangles{{0, 1, 3}, {1, 2, 3}}));
}

TEST(GltfReader, FansShareTheirFirstVertex)
{
    GltfMaker maker = square();
    primitive(maker)["mode"] = 6;
    primitive(maker)["indices"] = maker.add_indices<std::uint16_t>({0, 1, 2, 3});
    EXPECT_EQ(read(maker).triangles, (Triangles{{1, 2, 0}, {2, 3, 0}}));
}

TEST(GltfReader, WithoutIndicesTheVerticesAreTakenInOrder)
{
    for (const auto& [mode, expected] :
         {std::pair{4, Triangles{{0, 1, 2}}}, std::pair{5, Triangles{{0, 1, 2}, {1, 3, 2}}},
          std::pair{6, Triangles{{1, 2, 0}, {2, 3, 0}}}}) {
        GltfMaker maker = square();
        primitive(maker).erase("indices");
        primitive(maker)["mode"] = mode;
        EXPECT_EQ(read(maker).triangles, expected) << "mode " << mode;
    }
}

TEST(GltfReader, IndicesOfAllTypes)
{
    GltfMaker bytes = square();
    primitive(bytes)["indices"] = bytes.add_indices<std::uint8_t>({0, 1, 2, 0, 2, 3});
    EXPECT_EQ(read(bytes).triangles, kSquareTriangles);
    GltfMaker words = square();
    primitive(words)["indices"] = words.add_indices<std::uint32_t>({0, 1, 2, 0, 2, 3});
    EXPECT_EQ(read(words).triangles, kSquareTriangles);
}

TEST(GltfReader, AnIncompleteLastTriangleIsLeftOut)
{
    GltfMaker maker = square();
    maker.document["accessors"][1]["count"] = 5;
    EXPECT_EQ(read(maker).triangles, (Triangles{{0, 1, 2}}));
}

TEST(GltfReader, PointsLinesAndPrimitivesWithoutPositionsAreLeftOut)
{
    GltfMaker maker = square();
    json& primitives = maker.document["meshes"][0]["primitives"];
    for (int mode = 0; mode < 4; ++mode)
        primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", mode}});
    primitives.push_back({{"attributes", json::object()}});
    const Scene scene = read(maker);
    EXPECT_EQ(scene.parts.size(), 1u);
    EXPECT_EQ(scene.triangles, kSquareTriangles);
}

TEST(GltfReader, PrimitivesWithVerticesOfTheirOwnAreParts)
{
    GltfMaker maker = square();
    const int other = maker.add_vectors<float>({5, 5, 5, 6, 5, 5, 5, 6, 5});
    maker.document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", other}}}});
    const Scene scene = read(maker);
    ASSERT_EQ(scene.parts.size(), 2u);
    EXPECT_EQ(scene.parts[1].primitive, 1);
    EXPECT_EQ(scene.parts[1].first_vertex, 4u);
    EXPECT_EQ(scene.parts[1].first_triangle, 2u);
    EXPECT_EQ(scene.triangles[2], glm::uvec3(4, 5, 6));
}

TEST(GltfReader, PrimitivesThatShareVerticesAreOnePart)
{
    GltfMaker maker = square();
    primitive(maker)["indices"] = maker.add_indices<std::uint16_t>({0, 1, 2});
    maker.document["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", 0}}},
         {"indices", maker.add_indices<std::uint16_t>({0, 2, 3})}});
    const Scene scene = read(maker);
    ASSERT_EQ(scene.parts.size(), 1u);
    EXPECT_EQ(scene.positions, kSquare);
    EXPECT_EQ(scene.triangles, kSquareTriangles);
}

// ---- accessors

TEST(GltfReader, InterleavedVerticesWithAnOffset)
{
    GltfMaker maker;
    const int view = maker.add_view(bytes_of<float>({9, 0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0}), 16);
    maker.document["accessors"] = {{{"bufferView", view},
                                    {"byteOffset", 4},
                                    {"componentType", 5126},
                                    {"type", "VEC3"},
                                    {"count", 3}}};
    maker.document["meshes"] = one_triangle().document["meshes"];
    maker.document["nodes"] = one_triangle().document["nodes"];
    EXPECT_EQ(read(maker).positions, kTriangle);
}

TEST(GltfReader, BytesNeedNoAlignment)
{
    GltfMaker maker = one_triangle();
    maker.bin = "?" + maker.bin;
    maker.document["buffers"][0]["byteLength"] = 37;
    maker.document["bufferViews"][0]["byteOffset"] = 1;
    EXPECT_EQ(read(maker).positions, kTriangle);
}

template <typename T>
Positions quantised(bool normalized, std::initializer_list<T> values)
{
    GltfMaker maker = one_triangle();
    primitive(maker)["attributes"]["POSITION"] = maker.add_vectors<T>(values);
    maker.document["accessors"].back()["normalized"] = normalized;
    return read(maker).positions;
}

// The formulas of section 3.6.2.2: c / 127, c / 255 and so on, and nothing below -1.
TEST(GltfReader, NormalisedAndPlainIntegers)
{
    EXPECT_EQ(quantised<std::int8_t>(true, {127, -127, -128, 0, 1, 2, 3, 4, 5})[0],
              glm::dvec3(1, -1, -1));
    EXPECT_EQ(quantised<std::uint8_t>(true, {255, 0, 51, 0, 1, 2, 3, 4, 5})[0],
              glm::dvec3(1, 0, 0.2));
    EXPECT_EQ(quantised<std::int16_t>(true, {32767, -32768, 0, 0, 1, 2, 3, 4, 5})[0],
              glm::dvec3(1, -1, 0));
    EXPECT_EQ(quantised<std::uint16_t>(true, {65535, 13107, 0, 0, 1, 2, 3, 4, 5})[0],
              glm::dvec3(1, 0.2, 0));
    EXPECT_EQ(quantised<std::int16_t>(false, {-300, 7, 0, 0, 1, 2, 3, 4, 5})[0],
              glm::dvec3(-300, 7, 0));
    EXPECT_EQ(quantised<std::uint8_t>(false, {200, 7, 0, 0, 1, 2, 3, 4, 5})[0],
              glm::dvec3(200, 7, 0));
}

json sparse(GltfMaker& maker, int indices_component, const std::string& indices,
            const std::string& values, int count)
{
    const int indices_view = maker.add_view(indices);
    const int values_view = maker.add_view(values);
    return {{"count", count},
            {"indices", {{"bufferView", indices_view}, {"componentType", indices_component}}},
            {"values", {{"bufferView", values_view}}}};
}

TEST(GltfReader, SparsePositionsReplaceSome)
{
    GltfMaker maker = square();
    maker.document["accessors"][0]["sparse"] = sparse(maker, 5123, bytes_of<std::uint16_t>({1, 3}),
                                                      bytes_of<float>({7, 8, 9, 4, 5, 6}), 2);
    EXPECT_EQ(read(maker).positions, (Positions{{0, 0, 0}, {7, 8, 9}, {1, 1, 0}, {4, 5, 6}}));
}

TEST(GltfReader, SparsePositionsWithoutAViewReplaceZeros)
{
    GltfMaker maker = square();
    maker.document["accessors"][0].erase("bufferView");
    maker.document["accessors"][0]["sparse"] =
        sparse(maker, 5125, bytes_of<std::uint32_t>({2}), bytes_of<float>({7, 8, 9}), 1);
    EXPECT_EQ(read(maker).positions, (Positions{{0, 0, 0}, {0, 0, 0}, {7, 8, 9}, {0, 0, 0}}));
}

TEST(GltfReader, SparseIndicesReplaceSome)
{
    GltfMaker maker = square();
    maker.document["accessors"][1]["sparse"] =
        sparse(maker, 5121, bytes_of<std::uint8_t>({5}), bytes_of<std::uint16_t>({1}), 1);
    EXPECT_EQ(read(maker).triangles, (Triangles{{0, 1, 2}, {0, 2, 1}}));
}

// ---- nodes and scenes

TEST(GltfReader, InstancesAreMovedByTheirNodes)
{
    GltfMaker maker = square();
    maker.document["nodes"] = {{{"name", "left"}, {"mesh", 0}},
                               {{"children", {2}}, {"scale", {2, 2, 2}}},
                               {{"name", "right"}, {"mesh", 0}, {"translation", {5, 0, 0}}}};
    maker.document["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = read(maker);
    ASSERT_EQ(scene.parts.size(), 2u);
    EXPECT_EQ(scene.parts[0].name, "left");
    EXPECT_EQ(scene.parts[1].name, "right");
    EXPECT_EQ(scene.parts[1].node, 2);
    EXPECT_EQ(scene.parts[1].first_vertex, 4u);
    EXPECT_EQ(scene.parts[1].first_triangle, 2u);
    EXPECT_EQ(scene.positions[4], glm::dvec3(10, 0, 0));
    EXPECT_EQ(scene.positions[6], glm::dvec3(12, 2, 0));
    EXPECT_EQ(scene.triangles[2], glm::uvec3(4, 5, 6));
}

TEST(GltfReader, ANamelessNodeTakesItsMeshesName)
{
    GltfMaker maker = square();
    maker.document["meshes"][0]["name"] = "plate";
    EXPECT_EQ(read(maker).parts[0].name, "plate");
}

// Scale 2 along x, then a quarter turn about z, then a shift: (1, 1, 0) -> (2, 1, 0) -> (-1, 2, 0).
TEST(GltfReader, ScaleThenRotationThenTranslation)
{
    GltfMaker maker = square();
    maker.document["nodes"][0]["scale"] = {2, 1, 1};
    maker.document["nodes"][0]["rotation"] = {0, 0, 3, 3};  // of any length
    maker.document["nodes"][0]["translation"] = {10, 20, 30};
    const glm::dvec3 moved = read(maker).positions[2];
    EXPECT_NEAR(moved.x, 9, 1e-12);
    EXPECT_NEAR(moved.y, 22, 1e-12);
    EXPECT_NEAR(moved.z, 30, 1e-12);
}

TEST(GltfReader, AMatrixIsStoredColumnByColumn)
{
    GltfMaker maker = square();
    maker.document["nodes"][0]["matrix"] = {0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1};
    EXPECT_EQ(read(maker).positions[2], glm::dvec3(9, 22, 30));
}

TEST(GltfReader, PositionsAreMovedInDoublePrecision)
{
    GltfMaker maker = square();
    maker.document["nodes"][0]["translation"] = {1e9, 0, 0};
    maker.document["nodes"][0]["scale"] = {1e-3, 1, 1};
    EXPECT_EQ(read(maker).positions[1].x, 1e9 + 1e-3);
}

TEST(GltfReader, MirroringTurnsTheWinding)
{
    GltfMaker maker = one_triangle();
    maker.document["nodes"][0]["scale"] = {-1, 1, 1};
    const Scene scene = read(maker);
    EXPECT_EQ(scene.positions[1], glm::dvec3(-1, 0, 0));
    EXPECT_EQ(scene.triangles, (Triangles{{0, 2, 1}}));
}

TEST(GltfReader, MirroringTwiceTurnsNothing)
{
    GltfMaker maker = one_triangle();
    maker.document["nodes"] = {{{"scale", {-1, 1, 1}}, {"children", {1}}},
                               {{"scale", {1, -2, 1}}, {"mesh", 0}}};
    EXPECT_EQ(read(maker).triangles, (Triangles{{0, 1, 2}}));
}

TEST(GltfReader, AFlatteningNodeIsFine)
{
    GltfMaker maker = one_triangle();
    maker.document["nodes"][0]["scale"] = {1, 0, 1};
    EXPECT_EQ(read(maker).positions[2], glm::dvec3(0, 0, 0));
}

GltfMaker two_scenes()
{
    GltfMaker maker = square();
    maker.document["nodes"] = {{{"mesh", 0}, {"name", "first"}}, {{"mesh", 0}, {"name", "second"}}};
    maker.document["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    return maker;
}

TEST(GltfReader, TheDefaultSceneIsRead)
{
    GltfMaker maker = two_scenes();
    maker.document["scene"] = 1;
    const Scene scene = read(maker);
    ASSERT_EQ(scene.parts.size(), 1u);
    EXPECT_EQ(scene.parts[0].name, "second");
}

TEST(GltfReader, WithoutADefaultTheFirstSceneIsRead)
{
    GltfMaker maker = two_scenes();
    maker.document.erase("scene");
    const Scene scene = read(maker);
    ASSERT_EQ(scene.parts.size(), 1u);
    EXPECT_EQ(scene.parts[0].name, "first");
}

TEST(GltfReader, WithoutScenesAllRootNodesAreRead)
{
    GltfMaker maker = two_scenes();
    maker.document.erase("scene");
    maker.document.erase("scenes");
    EXPECT_EQ(read(maker).parts.size(), 2u);
}

TEST(GltfReader, DeepNodeTreesNeedNoStack)
{
    GltfMaker maker = square();
    maker.document["nodes"] = json::array();
    constexpr int kDepth = 20'000;
    for (int i = 0; i < kDepth; ++i)
        maker.document["nodes"].push_back({{"children", {i + 1}}, {"translation", {1, 0, 0}}});
    maker.document["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(read(maker).positions[0], glm::dvec3(kDepth, 0, 0));
}

TEST(GltfReader, AnEmptyPrimitiveIsFineBesideAnother)
{
    GltfMaker maker = square();
    maker.document["accessors"].push_back(maker.document["accessors"][0]);
    maker.document["accessors"][2]["count"] = 0;
    maker.document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 2}}}});
    EXPECT_EQ(read(maker).positions, kSquare);
}

}  // namespace
}  // namespace surfelao
