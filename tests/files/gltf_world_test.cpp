// Where a viewer shows things: normals, skins, morph targets, hidden nodes, instances, extensions.
#include "gltf_maker.h"

#include "files/gltf_io.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace surfelao {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::GltfMaker;
using test::one_triangle;
using test::primitive;
using test::square;

using Points = std::vector<glm::dvec3>;
using Normals = std::vector<glm::vec3>;

const Points kPlainSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

Scene read_made(const GltfMaker& maker)
{
    return read_gltf("made.glb", maker.glb());
}

json& node(GltfMaker& maker, std::size_t index = 0)
{
    return maker.document["nodes"][index];
}

// ---- normals

/// The square with (3, 4, 0) at each vertex: of length 5, to be seen at length 1.
GltfMaker square_with_normals()
{
    GltfMaker maker = square();
    primitive(maker)["attributes"]["NORMAL"] =
        maker.add_vectors<float>({3, 4, 0, 3, 4, 0, 3, 4, 0, 3, 4, 0});
    return maker;
}

TEST(GltfNormals, OnePerVertexAtUnitLength)
{
    const Scene scene = read_made(square_with_normals());
    EXPECT_EQ(scene.normals.values, Normals(4, {0.6f, 0.8f, 0.0f}));
    EXPECT_TRUE(scene.normals.corners.empty());
    EXPECT_TRUE(read_made(square()).normals.empty());
}

TEST(GltfNormals, StayUprightUnderUnevenScales)
{
    GltfMaker maker = square_with_normals();
    node(maker)["scale"] = {3, 4, 1};  // (3, 4, 0) -> (1, 1, 0)
    const glm::vec3 normal = read_made(maker).normals.values[0];
    EXPECT_FLOAT_EQ(normal.x, std::sqrt(0.5f));
    EXPECT_FLOAT_EQ(normal.y, std::sqrt(0.5f));
}

TEST(GltfNormals, StayOnTheOutsideUnderMirrors)
{
    GltfMaker maker = square_with_normals();
    node(maker)["scale"] = {-2, 2, 2};
    EXPECT_EQ(read_made(maker).normals.values[0], glm::vec3(-0.6f, 0.8f, 0.0f));
}

TEST(GltfNormals, AreFoundInTinyUnitsAndUnderFlatteningNodes)
{
    GltfMaker maker = square_with_normals();
    node(maker)["scale"] = {1e-200, 1e-200, 1e-200};
    EXPECT_EQ(read_made(maker).normals.values[0], glm::vec3(0.6f, 0.8f, 0.0f));
    node(maker)["scale"] = {1, 0, 1};
    EXPECT_EQ(read_made(maker).normals.values[0], glm::vec3(0, 1, 0));
}

TEST(GltfNormals, PartsWithoutHaveZeros)
{
    GltfMaker maker = square_with_normals();
    const int other = maker.add_vectors<float>({5, 5, 5, 6, 5, 5, 5, 6, 5});
    maker.document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", other}}}});
    const Scene scene = read_made(maker);
    ASSERT_EQ(scene.normals.values.size(), 7u);
    EXPECT_EQ(scene.normals.values[3], glm::vec3(0.6f, 0.8f, 0.0f));
    EXPECT_EQ(scene.normals.values[4], glm::vec3(0.0f));
}

TEST(GltfNormals, NormalisedBytes)
{
    GltfMaker maker = square();
    const int normals = maker.add_accessor(
        maker.add_view(
            bytes_of<std::int8_t>({0, 0, 127, 0, 0, 0, -127, 0, 127, 0, 0, 0, 0, 0, 0, 0}), 4),
        5120, "VEC3", 4);
    maker.document["accessors"].back()["normalized"] = true;
    primitive(maker)["attributes"]["NORMAL"] = normals;
    EXPECT_EQ(read_made(maker).normals.values,
              (Normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, 0, 0}}));
}

TEST(GltfNormals, WhatIsNoNumberIsNoNormal)
{
    GltfMaker maker = square_with_normals();
    const float bad = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(maker.bin.data() + maker.bin.size() - 4, &bad, sizeof bad);
    const Normals normals = read_made(maker).normals.values;
    EXPECT_EQ(normals[3], glm::vec3(0.0f));
    EXPECT_EQ(normals[2], glm::vec3(0.6f, 0.8f, 0.0f));
}

TEST(GltfNormals, OtherNormalsAtTheSamePositionsMakeAnotherPart)
{
    GltfMaker maker = square_with_normals();
    const int up = maker.add_vectors<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    json second = primitive(maker);
    second["attributes"]["NORMAL"] = up;
    maker.document["meshes"][0]["primitives"].push_back(second);
    maker.document["meshes"][0]["primitives"].push_back(primitive(maker));
    const Scene scene = read_made(maker);
    ASSERT_EQ(scene.parts.size(), 2u);
    EXPECT_EQ(scene.parts[0].triangle_count, 4u);
    EXPECT_EQ(scene.parts[1].primitive, 1);
    EXPECT_EQ(scene.normals.values[4], glm::vec3(0, 0, 1));
}

// ---- tangents

/// (1, 0, 1) and a sign of -1, -1, 1, 0 at the vertices.
GltfMaker square_with_tangents()
{
    GltfMaker maker = square_with_normals();
    primitive(maker)["attributes"]["TANGENT"] = maker.add_accessor(
        maker.add_view(bytes_of<float>({1, 0, 1, -1, 1, 0, 1, -1, 1, 0, 1, 1, 0, 0, 0, 1})), 5126,
        "VEC4", 4);
    return maker;
}

using Tangents = std::vector<glm::vec4>;
const float kHalf = std::sqrt(0.5f);

TEST(GltfTangents, MoveWithTheSurface)
{
    GltfMaker maker = square_with_tangents();
    EXPECT_EQ(
        read_made(maker).tangents,
        (Tangents{
            {kHalf, 0, kHalf, -1}, {kHalf, 0, kHalf, -1}, {kHalf, 0, kHalf, 1}, {0, 0, 0, 0}}));
    EXPECT_TRUE(read_made(square_with_normals()).tangents.empty());
    node(maker)["scale"] = {3, 1, -4};  // along the matrix, and a mirror
    EXPECT_EQ(read_made(maker).tangents[0], glm::vec4(0.6f, 0.0f, -0.8f, 1.0f));
}

TEST(GltfTangents, PartsWithoutHaveZeros)
{
    GltfMaker maker = square_with_tangents();
    json without = primitive(maker);
    without["attributes"].erase("TANGENT");
    maker.document["meshes"][0]["primitives"].push_back(without);
    const Scene scene = read_made(maker);
    EXPECT_EQ(scene.parts.size(), 2u);
    ASSERT_EQ(scene.tangents.size(), 8u);
    EXPECT_EQ(scene.tangents[2], glm::vec4(kHalf, 0, kHalf, 1));
    EXPECT_EQ(scene.tangents[4], glm::vec4(0.0f));
}

TEST(GltfTangents, AreMorphedAndSkinned)
{
    GltfMaker maker = square_with_tangents();
    primitive(maker)["targets"] = {
        {{"TANGENT", maker.add_vectors<float>({-2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0})}}};
    maker.document["meshes"][0]["weights"] = {0.5};
    EXPECT_EQ(read_made(maker).tangents[0], glm::vec4(0, 0, 1, -1));

    json& attributes = primitive(maker)["attributes"];
    attributes["JOINTS_0"] =
        maker.add_accessor(maker.add_view(std::string(16, '\0')), 5121, "VEC4", 4);
    attributes["WEIGHTS_0"] = maker.add_accessor(
        maker.add_view(bytes_of<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})), 5126,
        "VEC4", 4);
    maker.document["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"scale", {-3, 4, 4}}}};
    maker.document["scenes"][0]["nodes"] = {0, 1};
    maker.document["skins"] = {{{"joints", {1}}}};
    EXPECT_EQ(read_made(maker).tangents[1], glm::vec4(-0.6f, 0, 0.8f, 1));
}

// ---- skins

/// The square on two joints, nodes 1 and 2, under a node that must not count: vertices 0 and 3
/// follow the first, 1 the second, 2 both by half. The first joint moves by (0, 0, 10), the second
/// turns x to y.
GltfMaker skinned_square()
{
    GltfMaker maker = square_with_normals();
    maker.document["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {0, 0, 50}}},
                               {{"translation", {0, 0, 10}}},
                               {{"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}};
    maker.document["scenes"][0]["nodes"] = {0, 1, 2};
    maker.document["skins"] = {{{"joints", {1, 2}}}};
    json& attributes = primitive(maker)["attributes"];
    attributes["JOINTS_0"] = maker.add_accessor(
        maker.add_view(bytes_of<std::uint8_t>({0, 9, 9, 9, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0})),
        5121, "VEC4", 4);
    attributes["WEIGHTS_0"] = maker.add_accessor(
        maker.add_view(bytes_of<float>({1, 0, 0, 0, 3, 0, 0, 0, .5, .5, 0, 0, 0, 0, 0, 0})), 5126,
        "VEC4", 4);
    return maker;
}

TEST(GltfSkins, VerticesFollowTheirJointsAlone)
{
    const Scene scene = read_made(skinned_square());
    // vertex 1 has a weight of 3, vertex 3 none at all
    EXPECT_EQ(scene.positions, (Points{{0, 0, 10}, {0, 1, 0}, {0, 1, 5}, {0, 1, 10}}));
    EXPECT_EQ(scene.normals.values[0], glm::vec3(0.6f, 0.8f, 0.0f));
    EXPECT_EQ(scene.normals.values[1], glm::vec3(-0.8f, 0.6f, 0.0f));
}

TEST(GltfSkins, InverseBindMatricesComeFirst)
{
    GltfMaker maker = skinned_square();
    // before joint 0: moves by (1, 0, 0); before joint 1: halves, then moves by (1, 0, 0)
    maker.document["skins"][0]["inverseBindMatrices"] = maker.add_accessor(
        maker.add_view(bytes_of<float>({1,   0, 0, 0, 0, 1,   0, 0, 0, 0, 1,   0, 1, 0, 0, 1,
                                        0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 1, 0, 0, 1})),
        5126, "MAT4", 2);
    EXPECT_EQ(read_made(maker).positions,
              (Points{{1, 0, 10}, {0, 1.5, 0}, {0.75, 1.25, 5}, {1, 1, 10}}));
}

TEST(GltfSkins, JointsAndWeightsOfAllTypesAndSeveralSets)
{
    GltfMaker maker = skinned_square();
    json& attributes = primitive(maker)["attributes"];
    attributes["JOINTS_0"] = maker.add_accessor(
        maker.add_view(bytes_of<std::uint16_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0})),
        5123, "VEC4", 4);
    attributes["JOINTS_1"] = maker.add_accessor(
        maker.add_view(bytes_of<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0})),
        5121, "VEC4", 4);
    for (const char* name : {"WEIGHTS_0", "WEIGHTS_1"}) {
        attributes[name] = maker.add_accessor(
            maker.add_view(
                bytes_of<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 51, 0, 0, 0, 255, 0, 0, 0})),
            5121, "VEC4", 4);
        maker.document["accessors"].back()["normalized"] = true;
    }
    EXPECT_EQ(read_made(maker).positions, (Points{{0, 0, 10}, {0, 1, 0}, {0, 1, 5}, {0, 1, 10}}));
}

TEST(GltfSkins, JointsMayStandOutsideTheSceneAndBeHidden)
{
    GltfMaker maker = skinned_square();
    maker.document["scenes"][0]["nodes"] = {0, 2};
    node(maker, 2)["extensions"]["KHR_node_visibility"] = {{"visible", false}};
    maker.add("nodes", {{"children", {1}}, {"translation", {0, 0, 1}}});
    EXPECT_EQ(read_made(maker).positions, (Points{{0, 0, 11}, {0, 1, 0}, {0, 1, 5.5}, {0, 1, 11}}));
}

TEST(GltfSkins, MirroringJointsTurnTheWinding)
{
    GltfMaker maker = skinned_square();
    node(maker, 0)["scale"] = {-1, 1, 1};  // does not count
    EXPECT_EQ(read_made(maker).triangles[0], glm::uvec3(0, 1, 2));
    node(maker, 1)["scale"] = {-1, 1, 1};
    node(maker, 2) = {{"scale", {-1, 1, 1}}};
    const Scene scene = read_made(maker);
    EXPECT_EQ(scene.triangles[0], glm::uvec3(0, 2, 1));
    EXPECT_EQ(scene.normals.values[0], glm::vec3(-0.6f, 0.8f, 0.0f));
}

TEST(GltfSkins, WithoutJointsTheNodeCounts)
{
    GltfMaker maker = skinned_square();
    primitive(maker)["attributes"].erase("JOINTS_0");
    EXPECT_EQ(read_made(maker).positions[0], glm::dvec3(0, 0, 50));
}

// ---- morph targets

/// Target 0 lifts all by 2 and tips normals; target 1, sparse, pulls vertex 1 by 4 along x.
GltfMaker morphed_square()
{
    GltfMaker maker = square_with_normals();
    const int lift = maker.add_vectors<float>({0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2});
    const int tip = maker.add_vectors<float>({-3, -4, 1, -3, -4, 1, -3, -4, 1, -3, -4, 1});
    const int indices = maker.add_view(bytes_of<std::uint8_t>({1}));
    const int values = maker.add_view(bytes_of<float>({4, 0, 0}));
    const int pull =
        maker.add("accessors", {{"componentType", 5126},
                                {"type", "VEC3"},
                                {"count", 4},
                                {"sparse",
                                 {{"count", 1},
                                  {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                  {"values", {{"bufferView", values}}}}}});
    primitive(maker)["targets"] = {{{"POSITION", lift}, {"NORMAL", tip}}, {{"POSITION", pull}}};
    maker.document["meshes"][0]["weights"] = {1, 0.5};
    return maker;
}

TEST(GltfMorphs, TheMeshesWeightsAreTheDefault)
{
    const Scene scene = read_made(morphed_square());
    EXPECT_EQ(scene.positions, (Points{{0, 0, 2}, {3, 0, 2}, {1, 1, 2}, {0, 1, 2}}));
    EXPECT_EQ(scene.normals.values, Normals(4, {0, 0, 1}));
}

TEST(GltfMorphs, TheNodesWeightsComeFirst)
{
    GltfMaker maker = morphed_square();
    node(maker)["weights"] = {0, 1};
    EXPECT_EQ(read_made(maker).positions, (Points{{0, 0, 0}, {5, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(read_made(maker).normals.values[0], glm::vec3(0.6f, 0.8f, 0.0f));
}

TEST(GltfMorphs, WithoutWeightsNothingMoves)
{
    GltfMaker maker = morphed_square();
    maker.document["meshes"][0].erase("weights");
    EXPECT_EQ(read_made(maker).positions, kPlainSquare);
}

TEST(GltfMorphs, JointsMoveWhatIsMorphed)
{
    GltfMaker maker = skinned_square();
    primitive(maker)["targets"] = {
        {{"POSITION", maker.add_vectors<float>({0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2})}}};
    maker.document["meshes"][0]["weights"] = {1};
    EXPECT_EQ(read_made(maker).positions, (Points{{0, 0, 12}, {0, 1, 2}, {0, 1, 7}, {0, 1, 12}}));
}

// ---- hidden nodes

TEST(GltfVisibility, HiddenNodesAndAllBelowAreLeftOut)
{
    GltfMaker maker = square();
    maker.document["nodes"] = {{{"mesh", 0}, {"children", {1}}},
                               {{"mesh", 0}, {"children", {2}}, {"extensions", json::object()}},
                               {{"mesh", 0}}};
    EXPECT_EQ(read_made(maker).parts.size(), 3u);
    node(maker, 1)["extensions"]["KHR_node_visibility"] = {{"visible", false}};
    node(maker, 2)["extensions"]["KHR_node_visibility"] = {{"visible", true}};
    const Scene scene = read_made(maker);
    EXPECT_EQ(scene.positions, kPlainSquare);
    EXPECT_EQ(scene.notes, std::vector<std::string>{"2 nodes are hidden and left out"});
}

// ---- instances

/// Two instances of the square, under a node that moves by (100, 0, 0).
GltfMaker instanced_square()
{
    GltfMaker maker = square();
    const int rotations = maker.add_accessor(
        maker.add_view(bytes_of<std::int16_t>({0, 0, 0, 32767, 0, 0, 32767, 0})), 5122, "VEC4", 2);
    maker.document["accessors"].back()["normalized"] = true;
    node(maker) = {{"mesh", 0},
                   {"name", "plates"},
                   {"translation", {100, 0, 0}},
                   {"extensions",
                    {{"EXT_mesh_gpu_instancing",
                      {{"attributes",
                        {{"TRANSLATION", maker.add_vectors<float>({0, 0, 1, 0, 0, 2})},
                         {"ROTATION", rotations},
                         {"SCALE", maker.add_vectors<float>({1, 1, 1, 2, 3, -1})}}}}}}}};
    maker.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    maker.document["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    return maker;
}

TEST(GltfInstances, EachIsAUseOfTheMesh)
{
    const Scene scene = read_made(instanced_square());
    ASSERT_EQ(scene.parts.size(), 2u);
    EXPECT_EQ(scene.parts[1].name, "plates");
    // the second is scaled by (2, 3, -1), then turned by half a turn about z, then lifted
    EXPECT_EQ(scene.positions, (Points{{100, 0, 1},
                                       {101, 0, 1},
                                       {101, 1, 1},
                                       {100, 1, 1},
                                       {100, 0, 2},
                                       {98, 0, 2},
                                       {98, -3, 2},
                                       {100, -3, 2}}));
    EXPECT_EQ(scene.triangles[0], glm::uvec3(0, 1, 2));
    EXPECT_EQ(scene.triangles[2], glm::uvec3(4, 6, 5));
}

TEST(GltfInstances, AttributesThatMoveNothingCountThem)
{
    GltfMaker maker = square();
    node(maker)["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["_ID"] =
        maker.add_indices<std::uint8_t>({7, 8, 9});
    EXPECT_EQ(read_made(maker).parts.size(), 3u);
}

// ---- extensions and notes

TEST(GltfExtensions, ThatLeaveTheTrianglesOrMoveAllAlikeMayBeRequired)
{
    for (const char* name :
         {"CESIUM_RTC", "CESIUM_primitive_outline", "EXT_instance_features", "EXT_mesh_features",
          "EXT_mesh_gpu_instancing", "EXT_structural_metadata", "FB_ngon_encoding",
          "KHR_interactivity", "KHR_materials_variants", "KHR_node_visibility", "MSFT_lod",
          "OMI_physics_body", "VRM", "VRMC_vrm"}) {
        GltfMaker maker = square();
        maker.document["extensionsRequired"] = {name};
        maker.document["extensions"] = {{"CESIUM_RTC", {{"center", {1, 2, 3}}}}};
        EXPECT_EQ(read_made(maker).positions, kPlainSquare) << name;
    }
}

TEST(GltfExtensions, ThatMakeOtherGeometryAreRefused)
{
    for (const std::string name :
         {"EXT_mesh_primitive_restart", "EXT_meshopt_compression", "EXT_primitive_voxels",
          "KHR_draco_mesh_compression", "KHR_gaussian_splatting", "KHR_meshopt_compression",
          "MPEG_buffer_circular", "VRMX_unknown"}) {
        GltfMaker maker = square();
        maker.document["extensionsRequired"] = {name};
        EXPECT_EQ(test::refusal(maker.glb()),
                  "requires the extension " + name + ", which is not supported");
    }
}

TEST(GltfNotes, ASentenceForEachKind)
{
    EXPECT_TRUE(read_made(square()).notes.empty());
    GltfMaker maker = square();
    json& primitives = maker.document["meshes"][0]["primitives"];
    primitives[0]["material"] = 1;
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"material", 2}});
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"material", 2}});
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"material", 99}});
    maker.document["materials"] = {{{"alphaMode", "OPAQUE"}},
                                   {{"alphaMode", "BLEND"}},
                                   {{"alphaMode", "MASK"}},
                                   {{"alphaMode", "MASK"}}};
    maker.document["animations"] = {{{"channels", json::array()}}};
    EXPECT_EQ(read_made(maker).notes,
              (std::vector<std::string>{"1 primitive of points or lines is left out",
                                        "3 corners behind the last whole triangles are left out",
                                        "1 animation is not played: the default pose is baked"}));
}

// ---- written again

std::string written(const Scene& scene)
{
    const std::vector<Occlusion> occlusion(scene.positions.size(), {0.5f, {0, 0, 1}});
    return gltf_contents("out.gltf", scene, occlusion).contents;
}

TEST(GltfWorld, WhatIsWrittenStandsWhereItStood)
{
    for (const GltfMaker& maker : {skinned_square(), morphed_square(), instanced_square()}) {
        const Scene scene = read_made(maker);
        const Scene again = read_gltf("out.gltf", written(scene));
        EXPECT_EQ(again.positions, scene.positions);
        EXPECT_EQ(again.triangles, scene.triangles);
        EXPECT_EQ(again.normals.values, scene.normals.values);
    }
}

TEST(GltfWorld, HiddenNodesAreWrittenUntouched)
{
    GltfMaker maker = square();
    maker.add("nodes",
              {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
    maker.document["scenes"][0]["nodes"] = {0, 1};
    const json before = maker.document;
    const json after = json::parse(written(read_made(maker)));
    EXPECT_EQ(after["nodes"][1], before["nodes"][1]);
    EXPECT_EQ(after["meshes"][0], before["meshes"][0]);
    EXPECT_EQ(after["nodes"][0]["mesh"], 1);
}

TEST(GltfWorld, InstancesAreWrittenAsChildrenWithMeshesOfTheirOwn)
{
    GltfMaker maker = instanced_square();
    node(maker)["children"] = {1};
    node(maker)["weights"] = {0.5};
    maker.add("nodes", {{"name", "child"}});
    maker.document["animations"] = {
        {{"channels",
          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}},
           {{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
    const json after = json::parse(written(read_made(maker)));
    EXPECT_EQ(after["nodes"][0],
              (json{{"name", "plates"}, {"translation", {100, 0, 0}}, {"children", {2, 3, 1}}}));
    EXPECT_EQ(after["nodes"][2], (json{{"name", "plates"},
                                       {"mesh", 0},
                                       {"weights", {0.5}},
                                       {"translation", {0.0, 0.0, 1.0}}}));
    EXPECT_EQ(after["nodes"][3], (json{{"name", "plates"},
                                       {"mesh", 1},
                                       {"weights", {0.5}},
                                       {"translation", {0.0, 0.0, 2.0}},
                                       {"rotation", {0.0, 0.0, 1.0, 0.0}},
                                       {"scale", {2.0, 3.0, -1.0}}}));
    EXPECT_FALSE(after.contains("extensionsUsed"));
    EXPECT_FALSE(after.contains("extensionsRequired"));
    const json& channels = after["animations"][0]["channels"];
    EXPECT_EQ(channels[0]["target"], (json{{"path", "weights"}}));
    EXPECT_EQ(channels[1]["target"], (json{{"node", 0}, {"path", "scale"}}));
}

// A bent normal in the file, taken along each vertex's own matrix as NORMAL is, must be the
// world's.
TEST(GltfWorld, BentNormalsOfSkinnedVerticesAreTakenBackEachByItself)
{
    GltfMaker maker = skinned_square();
    node(maker, 2) = {{"scale", {1, 2, 5}}};
    const Scene scene = read_made(maker);
    const glm::vec3 world = glm::normalize(glm::vec3(1, 2, 3));
    const std::vector<Occlusion> occlusion(scene.positions.size(), {0.5f, world});
    // the attribute as NORMAL: reading it brings it to the world
    json document = json::parse(gltf_contents("out.gltf", scene, occlusion).contents);
    json& attributes = document["meshes"][0]["primitives"][0]["attributes"];
    attributes["NORMAL"] = attributes["_BENT_NORMAL"];
    const Scene again = read_gltf("out.gltf", document.dump());
    for (const glm::vec3& normal : again.normals.values)
        EXPECT_NEAR(glm::length(normal - world), 0.0f, 1e-6f);
}

}  // namespace
}  // namespace surfelao
