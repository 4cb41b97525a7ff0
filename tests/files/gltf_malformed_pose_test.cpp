// Broken normals, skins, morph targets and instances: each is refused in one sentence.
#include "gltf_maker.h"

#include <gtest/gtest.h>

#include <limits>

namespace surfelao {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::GltfMaker;
using test::Malformed;
using test::primitive;
using test::refusal;

/// A square with all of it: NORMAL is accessor 2, joints 3, weights 4, inverse bind matrices 5, the
/// displacement 6; node 0 shows it on a skin, node 1 is the joint, node 2 shows two instances of
/// mesh 1, with translations 7.
GltfMaker posed_square()
{
    GltfMaker maker = test::square();
    maker.add_vectors<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    maker.add_accessor(maker.add_view(std::string(16, '\0')), 5121, "VEC4", 4);
    maker.add_accessor(
        maker.add_view(bytes_of<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})), 5126,
        "VEC4", 4);
    maker.add_accessor(
        maker.add_view(bytes_of<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1})), 5126,
        "MAT4", 1);
    maker.add_vectors<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    maker.add_vectors<float>({0, 0, 0, 5, 5, 5});
    maker.add("meshes", maker.document["meshes"][0]);
    json& skinned = primitive(maker);
    skinned["attributes"].update({{"NORMAL", 2}, {"JOINTS_0", 3}, {"WEIGHTS_0", 4}});
    skinned["targets"] = {{{"POSITION", 6}, {"NORMAL", 2}}};
    maker.document["meshes"][0]["weights"] = {1};
    maker.document["skins"] = {{{"joints", {1}}, {"inverseBindMatrices", 5}}};
    maker.document["nodes"] = {
        {{"mesh", 0}, {"skin", 0}},
        json::object(),
        {{"mesh", 1},
         {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", 7}}}}}}}}};
    maker.document["scenes"][0]["nodes"] = {0, 1, 2};
    return maker;
}

json& accessor_of(GltfMaker& maker, std::size_t index)
{
    return maker.document["accessors"][index];
}

json& instances(GltfMaker& maker)
{
    return maker.document["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"];
}

/// Floats into the bytes of an accessor's view.
void overwrite(GltfMaker& maker, std::size_t view, std::initializer_list<float> values)
{
    maker.bin.replace(maker.document["bufferViews"][view]["byteOffset"].get<std::size_t>(),
                      values.size() * sizeof(float), bytes_of(values));
}

const Malformed kMalformedPoses[] = {
    // normals
    {"NormalOutOfRange", "mesh 0 primitive 0: NORMAL 8 is out of range, there are 8 accessors",
     [](GltfMaker& m) { primitive(m)["attributes"]["NORMAL"] = 8; }},
    {"TangentIsVec3", "mesh 0 primitive 0 TANGENT accessor 1 is not of type VEC4",
     [](GltfMaker& m) { primitive(m)["attributes"]["TANGENT"] = 1; }},
    {"NormalIsVec4", "mesh 0 primitive 0 NORMAL accessor 4 is not of type VEC3",
     [](GltfMaker& m) { primitive(m)["attributes"]["NORMAL"] = 4; }},
    {"NormalsTooFew", "mesh 0 primitive 0 NORMAL accessor 7 has 2 elements for 4 vertices",
     [](GltfMaker& m) { primitive(m)["attributes"]["NORMAL"] = 7; }},
    {"NormalUnsigned",
     "mesh 0 primitive 0 NORMAL accessor 8 is of an unsigned type, which no direction may be",
     [](GltfMaker& m) {
         primitive(m)["attributes"]["NORMAL"] =
             m.add_vectors<std::uint8_t>({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
     }},
    {"NormalsDoNotFit",
     "mesh 0 primitive 0 NORMAL accessor 2: 4 elements from byte 4 on do not fit into bufferView 2 "
     "of 48 bytes",
     [](GltfMaker& m) { accessor_of(m, 2)["byteOffset"] = 4; }},

    // skins
    {"SkinIsNumber", "skin 0 is not an object", [](GltfMaker& m) { m.document["skins"][0] = 1; }},
    {"SkinOutOfRange", "node 0: skin 1 is out of range, there are 1 skins",
     [](GltfMaker& m) { m.document["nodes"][0]["skin"] = 1; }},
    {"NoJoints", "skin 0 has no joints",
     [](GltfMaker& m) { m.document["skins"][0].erase("joints"); }},
    {"JointIsNoNode", "skin 0: joints 3 is out of range, there are 3 nodes",
     [](GltfMaker& m) { m.document["skins"][0]["joints"] = {3}; }},
    {"JointOutsideTheSkin",
     "mesh 0 primitive 0 JOINTS_0 accessor 3: vertex 0 uses joint 255, but the skin has 1",
     [](GltfMaker& m) {
         m.bin[m.document["bufferViews"][3]["byteOffset"].get<std::size_t>()] = '\xFF';
     }},
    {"FirstJointOutsideTheSkin",
     "mesh 0 primitive 0 JOINTS_0 accessor 3: vertex 0 uses joint 0, but the skin has 0",
     [](GltfMaker& m) {
         m.document["skins"][0]["joints"] = json::array();
         overwrite(m, 4, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
     }},
    {"JointsAreFloat", "mesh 0 primitive 0 JOINTS_0 accessor 4 does not hold whole numbers from 0",
     [](GltfMaker& m) { primitive(m)["attributes"]["JOINTS_0"] = 4; }},
    {"JointsAreVec3", "mesh 0 primitive 0 JOINTS_0 accessor 2 is not of type VEC4",
     [](GltfMaker& m) { primitive(m)["attributes"]["JOINTS_0"] = 2; }},
    {"JointsTooFew", "mesh 0 primitive 0 JOINTS_0 accessor 3 has 3 elements for 4 vertices",
     [](GltfMaker& m) { accessor_of(m, 3)["count"] = 3; }},
    {"JointsWithoutWeights", "mesh 0 primitive 0 has JOINTS_0 but no WEIGHTS_0",
     [](GltfMaker& m) { primitive(m)["attributes"].erase("WEIGHTS_0"); }},
    {"WeightsAreSigned",
     "mesh 0 primitive 0 WEIGHTS_0 accessor 3 is neither float nor a byte or short from 0",
     [](GltfMaker& m) {
         primitive(m)["attributes"]["WEIGHTS_0"] = 3;
         primitive(m)["attributes"]["JOINTS_0"] =
             m.add_accessor(m.add_view(std::string(16, '\0')), 5121, "VEC4", 4);
         accessor_of(m, 3)["componentType"] = 5120;
     }},
    {"WeightIsInfinite", "mesh 0 primitive 0 WEIGHTS_0 accessor 4: element 0 is not finite",
     [](GltfMaker& m) { overwrite(m, 4, {std::numeric_limits<float>::infinity()}); }},
    {"BindMatricesTooFew", "skin 0 inverseBindMatrices accessor 5 has 1 elements for 2 joints",
     [](GltfMaker& m) {
         m.document["skins"][0]["joints"] = {1, 1};
     }},
    {"BindMatricesAreVectors", "skin 0 inverseBindMatrices accessor 4 is not of type MAT4",
     [](GltfMaker& m) { m.document["skins"][0]["inverseBindMatrices"] = 4; }},
    {"BindMatricesAreShorts", "skin 0 inverseBindMatrices accessor 5 is not float",
     [](GltfMaker& m) { accessor_of(m, 5)["componentType"] = 5122; }},
    {"BindMatrixIsNaN", "skin 0 inverseBindMatrices accessor 5: element 0 is not finite",
     [](GltfMaker& m) { overwrite(m, 5, {std::numeric_limits<float>::quiet_NaN()}); }},
    {"JointMovesToInfinity", "node 0 moves vertex 0 of mesh 0 to infinity",
     [](GltfMaker& m) {
         m.document["nodes"][1]["scale"] = {1e300, 1, 1};
         overwrite(m, 5, {1e30f});
     }},

    // morph targets
    {"TargetsAreAnObject", "mesh 0 primitive 0: targets is not an array",
     [](GltfMaker& m) { primitive(m)["targets"] = json::object(); }},
    {"TargetIsNumber", "mesh 0 primitive 0 target 0 is not an object",
     [](GltfMaker& m) { primitive(m)["targets"][0] = 6; }},
    {"TargetOutOfRange",
     "mesh 0 primitive 0 target 0: POSITION 8 is out of range, there are 8 accessors",
     [](GltfMaker& m) { primitive(m)["targets"][0]["POSITION"] = 8; }},
    {"TargetTooShort",
     "mesh 0 primitive 0 target 0 POSITION accessor 7 has 2 elements for 4 vertices",
     [](GltfMaker& m) { primitive(m)["targets"][0]["POSITION"] = 7; }},
    {"TargetNormalTooShort",
     "mesh 0 primitive 0 target 0 NORMAL accessor 7 has 2 elements for 4 vertices",
     [](GltfMaker& m) { primitive(m)["targets"][0]["NORMAL"] = 7; }},
    {"TargetIsNaN", "mesh 0 primitive 0 target 0 POSITION accessor 6: element 0 is not finite",
     [](GltfMaker& m) { overwrite(m, 6, {std::numeric_limits<float>::quiet_NaN()}); }},
    {"WeightsHoldAString", "mesh 0: weights holds something that is not a number",
     [](GltfMaker& m) { m.document["meshes"][0]["weights"] = {"1"}; }},
    {"NodeWeightsAreANumber", "node 0: weights is not an array",
     [](GltfMaker& m) { m.document["nodes"][0]["weights"] = 1; }},
    {"WeightMovesToInfinity", "node 0 moves vertex 0 of mesh 0 to infinity",
     [](GltfMaker& m) {
         m.document["meshes"][0]["weights"] = {1e308};
         overwrite(m, 6, {0, 0, 1e30f});
     }},

    // visibility
    {"VisibleIsNumber", "node 0 KHR_node_visibility: visible is not true or false",
     [](GltfMaker& m) {
         m.document["nodes"][0]["extensions"]["KHR_node_visibility"] = {{"visible", 0}};
     }},
    {"VisibilityIsFlag", "node 0 KHR_node_visibility is not an object",
     [](GltfMaker& m) { m.document["nodes"][0]["extensions"]["KHR_node_visibility"] = false; }},
    {"AllIsHidden", "hides all that its scene holds",
     [](GltfMaker& m) {
         for (json& node : m.document["nodes"])
             node["extensions"]["KHR_node_visibility"] = {{"visible", false}};
     }},

    // instances
    {"InstancesAreAList", "node 2: EXT_mesh_gpu_instancing is not an object",
     [](GltfMaker& m) { instances(m) = json::array(); }},
    {"InstancesWithoutAttributes", "node 2 EXT_mesh_gpu_instancing has no attributes",
     [](GltfMaker& m) { instances(m) = json::object(); }},
    {"InstancesWithNoAttribute", "node 2 EXT_mesh_gpu_instancing has no attributes",
     [](GltfMaker& m) { instances(m)["attributes"] = json::object(); }},
    {"InstanceOutOfRange",
     "node 2 EXT_mesh_gpu_instancing: _ID 8 is out of range, there are 8 accessors",
     [](GltfMaker& m) { instances(m)["attributes"]["_ID"] = 8; }},
    {"InstancesDiffer", "node 2 EXT_mesh_gpu_instancing has 4 values of SCALE and 2 of TRANSLATION",
     [](GltfMaker& m) { instances(m)["attributes"]["SCALE"] = 6; }},
    {"InstanceIsVec4", "node 2 EXT_mesh_gpu_instancing SCALE accessor 4 is not of type VEC3",
     [](GltfMaker& m) {
         instances(m)["attributes"] = {{"SCALE", 4}};
     }},
    {"InstanceIsVec3", "node 2 EXT_mesh_gpu_instancing ROTATION accessor 6 is not of type VEC4",
     [](GltfMaker& m) {
         instances(m)["attributes"] = {{"ROTATION", 6}};
     }},
    {"InstanceIsUint32",
     "node 2 EXT_mesh_gpu_instancing SCALE accessor 7 has componentType 5125 (unsigned int), which "
     "no instance may have",
     [](GltfMaker& m) {
         instances(m)["attributes"] = {{"SCALE", 7}};
         accessor_of(m, 7)["componentType"] = 5125;
     }},
    {"InstanceIsNaN",
     "node 2 EXT_mesh_gpu_instancing TRANSLATION accessor 7: element 0 is not finite",
     [](GltfMaker& m) { overwrite(m, 7, {std::numeric_limits<float>::quiet_NaN()}); }},
    {"InstanceTurnedByNothing",
     "node 2 EXT_mesh_gpu_instancing ROTATION 1 has a length of zero or infinity",
     [](GltfMaker& m) {
         instances(m)["attributes"] = {{"ROTATION", 4}};
         overwrite(m, 4, {0, 0, 0, 1, 0, 0, 0, 0});
     }},
    {"InstancesOfASkin",
     "node 0 EXT_mesh_gpu_instancing stands beside a skin, which is not supported",
     [](GltfMaker& m) {
         m.document["nodes"][0]["extensions"] = m.document["nodes"][2]["extensions"];
     }},

    // small files that stand for very much
    {"ManyInstances",
     "node 2 brings the scene to more than 8418752 instances, far more than a file of this size "
     "may stand for",
     [](GltfMaker& m) {
         m.add("accessors", accessor_of(m, 7));
         json& many = accessor_of(m, 8);
         many.erase("bufferView");
         many["count"] = 9000000000000;
         many["sparse"] = {{"count", 0},
                           {"indices", {{"bufferView", 0}, {"componentType", 5121}}},
                           {"values", {{"bufferView", 0}}}};
         instances(m)["attributes"]["TRANSLATION"] = 8;
     }},
    {"ManyCopiesOfAName",
     "node 2 repeats mesh 1 of 100060 bytes of JSON: there are more repetitions than a file of "
     "this "
     "size may stand for",
     [](GltfMaker& m) {
         m.add("accessors", accessor_of(m, 7));
         json& many = accessor_of(m, 8);
         many.erase("bufferView");
         many["count"] = 10000;
         many["sparse"] = {{"count", 0},
                           {"indices", {{"bufferView", 0}, {"componentType", 5121}}},
                           {"values", {{"bufferView", 0}}}};
         instances(m)["attributes"]["TRANSLATION"] = 8;
         m.document["nodes"][2]["name"] = std::string(100000, 'x');
     }},
    {"ManyTargets",
     "node 0 brings the scene to more than 16768896 displacements of morph targets and skins, far "
     "more than a file of this size may stand for",
     [](GltfMaker& m) {
         const int points =
             m.add_accessor(m.add_view(std::string(40000 * 12, '\0')), 5126, "VEC3", 40000);
         primitive(m) = {{"attributes", {{"POSITION", points}}}};
         m.document["meshes"][0]["weights"] = json::array();
         for (int i = 0; i < 2000; ++i) {
             primitive(m)["targets"].push_back({{"POSITION", points}});
             m.document["meshes"][0]["weights"].push_back(0.001);
         }
     }},
};

class GltfMalformedPose : public testing::TestWithParam<Malformed> {};

TEST_P(GltfMalformedPose, IsRefusedInOneSentence)
{
    GltfMaker maker = posed_square();
    GetParam().damage(maker);
    EXPECT_EQ(refusal(maker.glb()), GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(Each, GltfMalformedPose, testing::ValuesIn(kMalformedPoses),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(GltfMalformedPoses, TheUnbrokenOneIsRead)
{
    EXPECT_EQ(refusal(posed_square().glb()), "was read");
}

}  // namespace
}  // namespace surfelao
