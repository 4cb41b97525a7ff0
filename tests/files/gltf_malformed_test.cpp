// Broken glTF files: each is refused in one sentence that names the element and the fault.
#include "gltf_maker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace surfelao {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::GltfMaker;
using test::Malformed;
using test::primitive;
using test::refusal;
using test::square;

json& accessor(GltfMaker& maker, std::size_t index)
{
    return maker.document["accessors"][index];
}

void make_sparse(GltfMaker& maker, std::initializer_list<std::uint8_t> targets)
{
    const int indices = maker.add_view(bytes_of(targets));
    const int values = maker.add_view(std::string(targets.size() * 12, '\0'));
    accessor(maker, 0)["sparse"] = {{"count", targets.size()},
                                    {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                    {"values", {{"bufferView", values}}}};
}

void set_float(GltfMaker& maker, std::size_t index, float value)
{
    std::memcpy(maker.bin.data() + index * sizeof value, &value, sizeof value);
}

const json kHuge = 18446744073709551615u;

const Malformed kMalformed[] = {
    // the document as a whole
    {"NoAsset", "asset is missing: this is not glTF",
     [](GltfMaker& m) { m.document.erase("asset"); }},
    {"AssetIsNumber", "asset is missing: this is not glTF",
     [](GltfMaker& m) { m.document["asset"] = 2; }},
    {"NoVersion", "asset has no version",
     [](GltfMaker& m) { m.document["asset"].erase("version"); }},
    {"VersionOne", "asset is glTF version 1.0, only 2.x is read",
     [](GltfMaker& m) { m.document["asset"]["version"] = "1.0"; }},
    {"VersionThree", "asset is glTF version 3.0, only 2.x is read",
     [](GltfMaker& m) { m.document["asset"]["version"] = "3.0"; }},
    {"NewerMinimum", "asset demands a reader of version \"2.1\", this one knows 2.0",
     [](GltfMaker& m) { m.document["asset"]["minVersion"] = "2.1"; }},
    {"NeedsDraco", "requires the extension KHR_draco_mesh_compression, which is not supported",
     [](GltfMaker& m) { m.document["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }},
    {"NeedsMeshopt", "requires the extension EXT_meshopt_compression, which is not supported",
     [](GltfMaker& m) { m.document["extensionsRequired"] = {"EXT_meshopt_compression"}; }},
    {"NeedsUnknown", "requires the extension ACME_secret, which is not supported",
     [](GltfMaker& m) { m.document["extensionsRequired"] = {"ACME_secret"}; }},
    {"RequiredIsObject", "extensionsRequired is not an array",
     [](GltfMaker& m) { m.document["extensionsRequired"] = json::object(); }},
    {"RequiredHoldsNumber", "extensionsRequired holds something that is not a string",
     [](GltfMaker& m) { m.document["extensionsRequired"] = {1}; }},
    {"NothingInIt", "has no node with a mesh in its scene",
     [](GltfMaker& m) {
         m.document = {{"asset", {{"version", "2.0"}}}};
     }},
    {"NoTriangles", "has meshes of points and lines only, no triangles",
     [](GltfMaker& m) { primitive(m)["mode"] = 0; }},
    {"SectionIsObject", "accessors is not an array",
     [](GltfMaker& m) { m.document["accessors"] = json::object(); }},
    {"SectionIsNull", "nodes is not an array", [](GltfMaker& m) { m.document["nodes"] = nullptr; }},
    {"EntryIsString", "node 0 is not an object",
     [](GltfMaker& m) { m.document["nodes"][0] = "node"; }},

    // scenes and nodes
    {"SceneOutOfRange", "scene 1 is out of range, there are 1 scenes",
     [](GltfMaker& m) { m.document["scene"] = 1; }},
    {"SceneNegative", "scene is not a whole number from 0",
     [](GltfMaker& m) { m.document["scene"] = -1; }},
    {"SceneFraction", "scene is not a whole number from 0",
     [](GltfMaker& m) { m.document["scene"] = 0.5; }},
    {"SceneIsString", "scene is not a whole number from 0",
     [](GltfMaker& m) { m.document["scene"] = "0"; }},
    {"SceneHuge", "scene 18446744073709551615 is too large",
     [](GltfMaker& m) { m.document["scene"] = kHuge; }},
    {"SceneListsUnknownNode", "scene 0: nodes 7 is out of range, there are 1 nodes",
     [](GltfMaker& m) { m.document["scenes"][0]["nodes"] = {7}; }},
    {"SceneListsNodeTwice", "scene 0 lists node 0 twice",
     [](GltfMaker& m) {
         m.document["scenes"][0]["nodes"] = {0, 0};
     }},
    {"SceneListsChild", "scene 0 lists node 0, which is a child of node 1",
     [](GltfMaker& m) {
         m.add("nodes", {{"children", {0}}});
         m.document["scenes"][0]["nodes"] = {1, 0};
     }},
    {"SceneNodesNotArray", "scene 0: nodes is not an array",
     [](GltfMaker& m) { m.document["scenes"][0]["nodes"] = 0; }},
    {"NodeIsItsOwnChild", "node 0 is on or below a cycle of nodes",
     [](GltfMaker& m) { m.document["nodes"][0]["children"] = {0}; }},
    {"NodeCycle", "node 0 is on or below a cycle of nodes",
     [](GltfMaker& m) {
         m.document["nodes"][0]["children"] = {1};
         m.add("nodes", {{"children", {0}}});
     }},
    {"CycleOutsideTheScene", "node 1 is on or below a cycle of nodes",
     [](GltfMaker& m) {
         m.add("nodes", {{"children", {2}}});
         m.add("nodes", {{"children", {1}}});
     }},
    {"NodeWithTwoParents", "node 2 is a child of node 0 and again of node 1",
     [](GltfMaker& m) {
         m.document["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
         m.document["scenes"][0]["nodes"] = {0, 1};
     }},
    {"ChildTwice", "node 0 is a child of node 1 and again of node 1",
     [](GltfMaker& m) {
         m.add("nodes", {{"children", {0, 0}}});
         m.document["scenes"][0]["nodes"] = {1};
     }},
    {"ChildOutOfRange", "node 0: children 5 is out of range, there are 1 nodes",
     [](GltfMaker& m) { m.document["nodes"][0]["children"] = {5}; }},
    {"ChildIsFloat", "node 0: children is not a whole number from 0",
     [](GltfMaker& m) { m.document["nodes"][0]["children"] = {0.5}; }},
    {"NodeMeshOutOfRange", "node 0: mesh 3 is out of range, there are 1 meshes",
     [](GltfMaker& m) { m.document["nodes"][0]["mesh"] = 3; }},
    {"NodeMeshNegative", "node 0: mesh is not a whole number from 0",
     [](GltfMaker& m) { m.document["nodes"][0]["mesh"] = -1; }},
    {"MatrixTooShort", "node 0: matrix has 3 numbers instead of 16",
     [](GltfMaker& m) {
         m.document["nodes"][0]["matrix"] = {1, 0, 0};
     }},
    {"MatrixHoldsString", "node 0: matrix holds something that is not a number",
     [](GltfMaker& m) {
         m.document["nodes"][0]["matrix"] = json::array();
         for (int i = 0; i < 16; ++i)
             m.document["nodes"][0]["matrix"].push_back("1");
     }},
    {"MatrixIsProjective",
     "node 0: matrix does not end in the row 0 0 0 1: it is no affine transform",
     [](GltfMaker& m) {
         m.document["nodes"][0]["matrix"] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
     }},
    {"TranslationTooLong", "node 0: translation has 4 numbers instead of 3",
     [](GltfMaker& m) {
         m.document["nodes"][0]["translation"] = {1, 2, 3, 4};
     }},
    {"ScaleIsNumber", "node 0: scale is not an array",
     [](GltfMaker& m) { m.document["nodes"][0]["scale"] = 2; }},
    {"RotationZero", "node 0: rotation has a length of zero or infinity",
     [](GltfMaker& m) {
         m.document["nodes"][0]["rotation"] = {0, 0, 0, 0};
     }},
    {"RotationOverflows", "node 0: rotation has a length of zero or infinity",
     [](GltfMaker& m) {
         m.document["nodes"][0]["rotation"] = {1e300, 1e300, 0, 0};
     }},
    {"TransformsOverflow", "node 1 has a transform that is not finite",
     [](GltfMaker& m) {
         m.document["nodes"] = {{{"children", {1}}, {"scale", {1e200, 1, 1}}},
                                {{"mesh", 0}, {"scale", {1e200, 1, 1}}}};
     }},
    {"VertexMovedToInfinity", "node 0 moves vertex 1 of mesh 0 to infinity",
     [](GltfMaker& m) {
         m.document["nodes"][0]["scale"] = {1e308, 1, 1};
         set_float(m, 3, 1e30f);
     }},
    {"NameIsNumber", "node 0: name is not a string",
     [](GltfMaker& m) { m.document["nodes"][0]["name"] = 7; }},

    // meshes
    {"MeshWithoutPrimitives", "mesh 0 has no primitives",
     [](GltfMaker& m) { m.document["meshes"][0] = json::object(); }},
    {"PrimitivesNotArray", "mesh 0: primitives is not an array",
     [](GltfMaker& m) { m.document["meshes"][0]["primitives"] = 1; }},
    {"PrimitiveIsNull", "mesh 0 primitive 0 is not an object",
     [](GltfMaker& m) { primitive(m) = nullptr; }},
    {"AttributesNotObject", "mesh 0 primitive 0: attributes is not an object",
     [](GltfMaker& m) { primitive(m)["attributes"] = {0}; }},
    {"PositionOutOfRange", "mesh 0 primitive 0: POSITION 2 is out of range, there are 2 accessors",
     [](GltfMaker& m) { primitive(m)["attributes"]["POSITION"] = 2; }},
    {"PositionNegative", "mesh 0 primitive 0: POSITION is not a whole number from 0",
     [](GltfMaker& m) { primitive(m)["attributes"]["POSITION"] = -1; }},
    {"PositionIsScalar", "mesh 0 primitive 0 POSITION accessor 1 is not of type VEC3",
     [](GltfMaker& m) { primitive(m)["attributes"]["POSITION"] = 1; }},
    {"IndicesOutOfRange", "mesh 0 primitive 0: indices 2 is out of range, there are 2 accessors",
     [](GltfMaker& m) { primitive(m)["indices"] = 2; }},
    {"IndicesAreVectors", "mesh 0 primitive 0 indices accessor 0 is not of type SCALAR",
     [](GltfMaker& m) { primitive(m)["indices"] = 0; }},
    {"ModeUnknown", "mesh 0 primitive 0 has the unknown mode 7",
     [](GltfMaker& m) { primitive(m)["mode"] = 7; }},
    {"ModeIsString", "mesh 0 primitive 0: mode is not a whole number from 0",
     [](GltfMaker& m) { primitive(m)["mode"] = "TRIANGLES"; }},
    {"ModeHuge", "mesh 0 primitive 0: mode 4294967300 is too large",
     [](GltfMaker& m) { primitive(m)["mode"] = 4294967300u; }},
    {"DracoPrimitive",
     "mesh 0 primitive 0 is compressed by KHR_draco_mesh_compression, which is not supported",
     [](GltfMaker& m) {
         primitive(m)["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
     }},
    {"BufferLengthFraction", "buffer 0 has no byteLength that is a whole number",
     [](GltfMaker& m) { m.document["buffers"][0]["byteLength"] = 59.5; }},
    {"ColorsTooFew", "mesh 0 primitive 0 COLOR_0 accessor 2 has 1 elements for 4 vertices",
     [](GltfMaker& m) {
         primitive(m)["attributes"]["COLOR_0"] = m.add_vectors<float>({1, 1, 1});
     }},
    {"ColorsAreScalar", "mesh 0 primitive 0 COLOR_0 accessor 1 is neither of type VEC3 nor VEC4",
     [](GltfMaker& m) { primitive(m)["attributes"]["COLOR_0"] = 1; }},

    // accessors
    {"AccessorWithoutType", "accessor 0 has no type",
     [](GltfMaker& m) { accessor(m, 0).erase("type"); }},
    {"AccessorWithoutCount", "accessor 0 has no count",
     [](GltfMaker& m) { accessor(m, 0).erase("count"); }},
    {"AccessorWithoutComponentType", "accessor 0 has no componentType",
     [](GltfMaker& m) { accessor(m, 0).erase("componentType"); }},
    {"AccessorTypeUnknown", "accessor 0 has the unknown type \"VEC5\"",
     [](GltfMaker& m) { accessor(m, 0)["type"] = "VEC5"; }},
    {"PositionIsVec2", "mesh 0 primitive 0 POSITION accessor 0 is not of type VEC3",
     [](GltfMaker& m) { accessor(m, 0)["type"] = "VEC2"; }},
    {"ComponentTypeUnknown", "accessor 0 has the unknown componentType 5127",
     [](GltfMaker& m) { accessor(m, 0)["componentType"] = 5127; }},
    {"ComponentTypeDouble", "accessor 0 has the unknown componentType 5130",
     [](GltfMaker& m) { accessor(m, 0)["componentType"] = 5130; }},
    {"ComponentTypeSignedInt", "accessor 1 has the unknown componentType 5124",
     [](GltfMaker& m) { accessor(m, 1)["componentType"] = 5124; }},
    {"PositionIsUint32",
     "mesh 0 primitive 0 POSITION accessor 0 has componentType 5125 (unsigned int), which no "
     "position may have",
     [](GltfMaker& m) { accessor(m, 0)["componentType"] = 5125; }},
    {"NormalizedIsNumber", "accessor 0: normalized is not true or false",
     [](GltfMaker& m) { accessor(m, 0)["normalized"] = 1; }},
    {"IndicesFloat", "mesh 0 primitive 0 indices accessor 2 is not of an unsigned integer type",
     [](GltfMaker& m) {
         primitive(m)["indices"] = m.add_indices<float>({0, 1, 2});
     }},
    {"IndicesSigned", "mesh 0 primitive 0 indices accessor 2 is not of an unsigned integer type",
     [](GltfMaker& m) {
         primitive(m)["indices"] = m.add_indices<std::int16_t>({0, 1, 2});
     }},
    {"CountTooLarge",
     "mesh 0 primitive 0 POSITION accessor 0: 5 elements from byte 0 on do not fit into bufferView "
     "0 of 48 bytes",
     [](GltfMaker& m) { accessor(m, 0)["count"] = 5; }},
    {"CountHuge", "accessor 0: count 18446744073709551615 is too large",
     [](GltfMaker& m) { accessor(m, 0)["count"] = kHuge; }},
    {"CountOverflows", "accessor 0: count 1537228672809129302 is too large",
     [](GltfMaker& m) { accessor(m, 0)["count"] = 1537228672809129302u; }},
    {"CountNegative", "accessor 0: count is not a whole number from 0",
     [](GltfMaker& m) { accessor(m, 0)["count"] = -1; }},
    {"CountFraction", "accessor 0: count is not a whole number from 0",
     [](GltfMaker& m) { accessor(m, 0)["count"] = 3.5; }},
    {"OffsetPastTheEnd",
     "mesh 0 primitive 0 POSITION accessor 0: 4 elements from byte 4 on do not fit into bufferView "
     "0 of 48 bytes",
     [](GltfMaker& m) { accessor(m, 0)["byteOffset"] = 4; }},
    {"OffsetFarPastTheEnd",
     "mesh 0 primitive 0 POSITION accessor 0: 4 elements from byte 9007199254740992 on do not fit "
     "into bufferView 0 of 48 bytes",
     [](GltfMaker& m) { accessor(m, 0)["byteOffset"] = 9007199254740992u; }},
    {"OffsetHuge", "accessor 0: byteOffset 18446744073709551615 is too large",
     [](GltfMaker& m) { accessor(m, 0)["byteOffset"] = kHuge; }},
    {"OffsetNegative", "accessor 0: byteOffset is not a whole number from 0",
     [](GltfMaker& m) { accessor(m, 0)["byteOffset"] = -4; }},
    {"AccessorViewOutOfRange", "accessor 0: bufferView 9 is out of range, there are 2 bufferViews",
     [](GltfMaker& m) { accessor(m, 0)["bufferView"] = 9; }},
    {"AccessorWithoutView",
     "mesh 0 primitive 0 POSITION accessor 0 has neither a bufferView nor sparse values",
     [](GltfMaker& m) { accessor(m, 0).erase("bufferView"); }},
    {"IndicesWithoutView", "mesh 0 primitive 0 indices accessor 1 has no bufferView",
     [](GltfMaker& m) { accessor(m, 1).erase("bufferView"); }},
    {"PositionNaN", "mesh 0 primitive 0 POSITION accessor 0: element 1 is not finite",
     [](GltfMaker& m) { set_float(m, 4, std::numeric_limits<float>::quiet_NaN()); }},
    {"PositionInfinite", "mesh 0 primitive 0 POSITION accessor 0: element 3 is not finite",
     [](GltfMaker& m) { set_float(m, 11, -std::numeric_limits<float>::infinity()); }},
    {"IndexOutOfRange",
     "mesh 0 primitive 0 indices accessor 1: index 1 is 4, but there are 4 vertices",
     [](GltfMaker& m) { m.bin[50] = 4; }},
    {"IndexFarOutOfRange",
     "mesh 0 primitive 0 indices accessor 1: index 0 is 32512, but there are 4 vertices",
     [](GltfMaker& m) { m.bin[49] = '\x7F'; }},
    {"RestartValue",
     "mesh 0 primitive 0 indices accessor 3: index 2 is 255, the primitive restart value, which "
     "glTF does not allow",
     [](GltfMaker& m) {
         const std::string points(256 * 12, '\0');
         primitive(m)["attributes"]["POSITION"] =
             m.add_accessor(m.add_view(points), 5126, "VEC3", 256);
         primitive(m)["indices"] = m.add_indices<std::uint8_t>({0, 1, 255});
     }},
    {"IndexBeyondUnindexedVertices",
     "mesh 0 primitive 0 indices accessor 1: index 2 is 2, but there are 2 vertices",
     [](GltfMaker& m) { accessor(m, 0)["count"] = 2; }},

    // sparse accessors
    {"SparseIsNumber", "accessor 0: sparse is not an object",
     [](GltfMaker& m) { accessor(m, 0)["sparse"] = 1; }},
    {"SparseWithoutCount", "accessor 0 sparse has no count",
     [](GltfMaker& m) { make_sparse(m, {1}), accessor(m, 0)["sparse"].erase("count"); }},
    {"SparseWithoutIndices", "accessor 0 sparse has no indices",
     [](GltfMaker& m) { make_sparse(m, {1}), accessor(m, 0)["sparse"].erase("indices"); }},
    {"SparseWithoutValues", "accessor 0 sparse has no values",
     [](GltfMaker& m) { make_sparse(m, {1}), accessor(m, 0)["sparse"].erase("values"); }},
    {"SparseIndexOutOfRange",
     "mesh 0 primitive 0 POSITION accessor 0: sparse index 1 is 4, but the accessor has 4 elements",
     [](GltfMaker& m) {
         make_sparse(m, {1, 4});
     }},
    {"SparseIndicesNotIncreasing",
     "mesh 0 primitive 0 POSITION accessor 0: sparse indices do not increase at 1",
     [](GltfMaker& m) {
         make_sparse(m, {2, 1});
     }},
    {"SparseIndexTwice",
     "mesh 0 primitive 0 POSITION accessor 0: sparse indices do not increase at 1",
     [](GltfMaker& m) {
         make_sparse(m, {2, 2});
     }},
    {"SparseCountTooLarge",
     "mesh 0 primitive 0 POSITION accessor 0 sparse indices: 1000 elements from byte 0 on do not "
     "fit into bufferView 2 of 1 bytes",
     [](GltfMaker& m) { make_sparse(m, {1}), accessor(m, 0)["sparse"]["count"] = 1000; }},
    {"SparseCountHuge", "accessor 0 sparse: count 18446744073709551615 is too large",
     [](GltfMaker& m) { make_sparse(m, {1}), accessor(m, 0)["sparse"]["count"] = kHuge; }},
    {"SparseIndicesFloat",
     "mesh 0 primitive 0 POSITION accessor 0 sparse indices are not of an unsigned integer type",
     [](GltfMaker& m) {
         make_sparse(m, {1});
         accessor(m, 0)["sparse"]["indices"]["componentType"] = 5126;
     }},
    {"SparseViewOutOfRange",
     "accessor 0 sparse values: bufferView 77 is out of range, there are 4 bufferViews",
     [](GltfMaker& m) {
         make_sparse(m, {1});
         accessor(m, 0)["sparse"]["values"]["bufferView"] = 77;
     }},
    {"SparseOffsetPastTheEnd",
     "mesh 0 primitive 0 POSITION accessor 0 sparse values: 1 elements from byte 2147483647 on do "
     "not fit into bufferView 3 of 12 bytes",
     [](GltfMaker& m) {
         make_sparse(m, {1});
         accessor(m, 0)["sparse"]["values"]["byteOffset"] = 2147483647;
     }},
    {"ZeroAccessorHuge",
     "node 0 brings the scene to more than 8400000 vertices, far more than a file of this size may "
     "stand for",
     [](GltfMaker& m) {
         make_sparse(m, {1});
         accessor(m, 0).erase("bufferView");
         accessor(m, 0)["count"] = 4'000'000'000u;
     }},

    // buffer views and buffers
    {"ViewWithoutBuffer", "bufferView 0 has no buffer",
     [](GltfMaker& m) { m.document["bufferViews"][0].erase("buffer"); }},
    {"ViewWithoutLength", "bufferView 0 has no byteLength",
     [](GltfMaker& m) { m.document["bufferViews"][0].erase("byteLength"); }},
    {"ViewBufferOutOfRange", "bufferView 0: buffer 1 is out of range, there are 1 buffers",
     [](GltfMaker& m) { m.document["bufferViews"][0]["buffer"] = 1; }},
    {"ViewPastTheEnd",
     "mesh 0 primitive 0 POSITION accessor 0: bufferView 0 ends at byte 64, but buffer 0 has 60",
     [](GltfMaker& m) { m.document["bufferViews"][0]["byteLength"] = 64; }},
    {"ViewOffsetPastTheEnd",
     "mesh 0 primitive 0 POSITION accessor 0: bufferView 0 ends at byte 148, but buffer 0 has 60",
     [](GltfMaker& m) { m.document["bufferViews"][0]["byteOffset"] = 100; }},
    {"ViewOffsetHuge",
     "mesh 0 primitive 0 POSITION accessor 0: bufferView 0 ends at byte 9007199254741039, but "
     "buffer 0 has 60",
     [](GltfMaker& m) { m.document["bufferViews"][0]["byteOffset"] = 9007199254740991u; }},
    {"ViewLengthHuge",
     "mesh 0 primitive 0 POSITION accessor 0: bufferView 0 ends at byte 9007199254740991, but "
     "buffer 0 has 60",
     [](GltfMaker& m) { m.document["bufferViews"][0]["byteLength"] = 9007199254740991u; }},
    {"ViewTooShort",
     "mesh 0 primitive 0 POSITION accessor 0: 4 elements from byte 0 on do not fit into bufferView "
     "0 of 11 bytes",
     [](GltfMaker& m) { m.document["bufferViews"][0]["byteLength"] = 11; }},
    {"StrideOdd",
     "mesh 0 primitive 0 POSITION accessor 0 has elements of 12 bytes, but bufferView 0 has a "
     "byteStride of 13",
     [](GltfMaker& m) { m.document["bufferViews"][0]["byteStride"] = 13; }},
    {"StrideBelowElement",
     "mesh 0 primitive 0 POSITION accessor 0 has elements of 12 bytes, but bufferView 0 has a "
     "byteStride of 8",
     [](GltfMaker& m) { m.document["bufferViews"][0]["byteStride"] = 8; }},
    {"StridePastTheEnd",
     "mesh 0 primitive 0 POSITION accessor 0: 4 elements from byte 0 on do not fit into bufferView "
     "0 of 48 bytes",
     [](GltfMaker& m) { m.document["bufferViews"][0]["byteStride"] = 16; }},
    {"BuffersNotArray", "buffers is not an array",
     [](GltfMaker& m) { m.document["buffers"] = "all"; }},
    {"BufferIsNumber", "buffer 0 is not an object",
     [](GltfMaker& m) { m.document["buffers"][0] = 60; }},
    {"BufferWithoutLength", "buffer 0 has no byteLength that is a whole number",
     [](GltfMaker& m) { m.document["buffers"][0].erase("byteLength"); }},
    {"BufferLengthNegative", "buffer 0 has no byteLength that is a whole number",
     [](GltfMaker& m) { m.document["buffers"][0]["byteLength"] = -1; }},
    {"BufferLongerThanItsBytes", "buffer 0 declares 1000000000000 bytes, but has 60",
     [](GltfMaker& m) { m.document["buffers"][0]["byteLength"] = 1000000000000u; }},
    {"BufferWithoutBytes",
     "mesh 0 primitive 0 POSITION accessor 0: bufferView 0 ends at byte 48, but buffer 0 has 0",
     [](GltfMaker& m) { m.bin.clear(); }},
    {"BufferShortensItsBytes",
     "mesh 0 primitive 0 POSITION accessor 0: bufferView 0 ends at byte 48, but buffer 0 has 40",
     [](GltfMaker& m) { m.document["buffers"][0]["byteLength"] = 40; }},
    {"UriIsNumber", "buffer 0 has a uri that is not a string",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = 1; }},
    {"UriIsEmpty",
     "buffer 0 uri \"\" is not the relative path of a file in the model's own folder, or of a .bin",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = ""; }},
    {"UriClimbs",
     "buffer 0 uri \"../secret\" is not the relative path of a file in the model's own folder, or "
     "of a .bin",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "../secret"; }},
    {"UriClimbsInside",
     "buffer 0 uri \"a/../../b\" is not the relative path of a file in the model's own folder, or "
     "of a .bin",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "a/../../b"; }},
    {"UriClimbsEncoded",
     "buffer 0 uri \"%2e%2E/secret\" is not the relative path of a file in the model's own folder, "
     "or of a .bin",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "%2e%2E/secret"; }},
    {"UriAbsolute",
     "buffer 0 uri \"/etc/passwd\" is not the relative path of a file in the model's own folder, "
     "or of a .bin",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "/etc/passwd"; }},
    {"UriWithScheme",
     "buffer 0 uri \"file:///etc/passwd\" is not the relative path of a file in the model's own "
     "folder, or of a .bin",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "file:///etc/passwd"; }},
    {"UriWithHost",
     "buffer 0 uri \"http://host/a\" is not the relative path of a file in the model's own folder, "
     "or of a .bin",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "http://host/a"; }},
    {"UriWithBackslash",
     "buffer 0 uri \"..\\a\" is not the relative path of a file in the model's own folder, or of a "
     ".bin",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "..\\a"; }},
    {"UriWithNull",
     "buffer 0 uri \"a%00.bin\" is not the relative path of a file in the model's own folder, or "
     "of a .bin",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "a%00.bin"; }},
    {"UriOfAFolder", "buffer 0 uri \".\": is a folder, not a file",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "."; }},
    {"UriOfNoFile", "buffer 0 uri \"absent.bin\": cannot be opened: No such file or directory",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "absent.bin"; }},
    {"DataUriBroken", "buffer 0 has a data URI that is broken",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "data:;base64,AA*A"; }},
    {"DataUriCut", "buffer 0 has a data URI that is broken",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "data:;base64,AAAAA"; }},
    {"DataUriShort", "buffer 0 declares 60 bytes, but has 3",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "data:;base64,AAAA"; }},
    {"DataUriWithoutComma", "buffer 0 has a data URI that is broken",
     [](GltfMaker& m) { m.document["buffers"][0]["uri"] = "data:;base64"; }},

    // small files that stand for very much
    {"InstancesWithoutEnd",
     "node 404 brings the scene to more than 16196800 vertices, far more than a file of this size "
     "may stand for",
     [](GltfMaker& m) {
         m.document["scenes"][0]["nodes"] = json::array();
         m.document["nodes"] = json::array();
         const std::string points(40000 * 12, '\0');
         primitive(m)["attributes"]["POSITION"] =
             m.add_accessor(m.add_view(points), 5126, "VEC3", 40000);
         for (int i = 0; i < 500; ++i)
             m.document["scenes"][0]["nodes"].push_back(m.add("nodes", {{"mesh", 0}}));
     }},
    {"JsonWithoutEnd",
     "node 22 repeats mesh 0 of 2000070 bytes of JSON: there are more repetitions than a file of "
     "this size may stand for",
     [](GltfMaker& m) {
         m.document["meshes"][0]["extras"] = std::string(2000000, 'x');
         m.document["scenes"][0]["nodes"] = json::array();
         m.document["nodes"] = json::array();
         for (int i = 0; i < 10000; ++i)
             m.document["scenes"][0]["nodes"].push_back(m.add("nodes", {{"mesh", 0}}));
     }},
    {"TrianglesWithoutEnd",
     "node 0 brings the scene to more than 11547648 triangles, far more than a file of this size "
     "may stand for",
     [](GltfMaker& m) {
         const json again = primitive(m);
         const std::string list(2 * 90000, '\0');
         const int indices = m.add_accessor(m.add_view(list), 5123, "SCALAR", 90000);
         for (int i = 0; i < 400; ++i) {
             json copy = again;
             copy["indices"] = indices;
             m.document["meshes"][0]["primitives"].push_back(copy);
         }
     }},
};

class GltfMalformed : public testing::TestWithParam<Malformed> {};

TEST_P(GltfMalformed, IsRefusedInOneSentence)
{
    GltfMaker maker = square();
    GetParam().damage(maker);
    EXPECT_EQ(refusal(maker.glb()), GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(Each, GltfMalformed, testing::ValuesIn(kMalformed),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(GltfMalformed, ControlCharactersStayOutOfTheSentence)
{
    GltfMaker maker = square();
    maker.document["extensionsRequired"] = {"evil\n\x1B[2J"};
    EXPECT_EQ(refusal(maker.glb()), "requires the extension evil??[2J, which is not supported");
}

}  // namespace
}  // namespace surfelao
