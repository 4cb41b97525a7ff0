#include "files/scene_io.h"
#include "surfels/errors.h"

#include "malformed_case.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

#include <sys/stat.h>

namespace surfelao {
namespace {

using namespace malformed;

// ---- makers of contents
// --------------------------------------------------------------------------

/// Three vertices, a number of things wrong with what follows.
std::string obj(const std::string& rest)
{
    return "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + rest;
}

std::string off(const std::string& rest)
{
    return "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n" + rest;
}

constexpr const char* kPlyVertex =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
constexpr const char* kPlyFace = "element face 1\nproperty list uchar int vertex_indices\n";

std::string ply_header(const std::string& lines)
{
    return "ply\nformat ascii 1.0\n" + lines + "end_header\n";
}

std::string ply(const std::string& rows)
{
    return ply_header(std::string(kPlyVertex) + kPlyFace) + rows;
}

std::string binary_ply(const std::string& lines, const std::string& data)
{
    return "ply\nformat binary_little_endian 1.0\n" + lines + "end_header\n" + data;
}

const std::string kThreeVertices = bytes(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f);

std::string stl(const std::string& facets)
{
    return "solid s\n" + facets + "endsolid s\n";
}

constexpr const char* kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

std::string binary_stl(std::uint32_t count, const std::string& facets)
{
    return std::string(80, ' ') + bytes(count) + facets;
}

std::string binary_facet(float a = 0.f)
{
    return bytes(0.f, 0.f, 1.f, a, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, std::uint16_t{0});
}

const float kNan = std::numeric_limits<float>::quiet_NaN();
const float kInf = std::numeric_limits<float>::infinity();

// ---- the table
// -----------------------------------------------------------------------------------

// long: a table
std::vector<Case> cases()
{
    const std::string v = kPlyVertex;
    const std::string f = kPlyFace;
    const std::string rows = "0 0 0\n1 0 0\n0 1 0\n";
    return {
        // OBJ
        {"obj_Empty", "", {"empty"}},
        {"obj_OnlySpace", " \n\t\n", {"no faces"}},
        {"obj_OnlyComments", "# nothing\n# here\n", {"no faces"}},
        {"obj_OtherText", "Dear reader,\nthis is a letter.\n", {"no faces"}},
        {"obj_NulBytes", std::string(1000, '\0'), {"no faces"}},
        {"obj_Utf16", utf16(obj("f 1 2 3\n")), {"UTF-16"}},
        {"obj_Utf16BigEndian", "\xFE\xFF" + obj("f 1 2 3\n"), {"UTF-16"}},
        {"obj_Utf32", std::string("\0\0\xFE\xFF", 4) + obj("f 1 2 3\n"), {"UTF-32"}},
        {"obj_Nan", "v 0 0 nan\n" + obj("f 1 2 3\n"), {"vertex 0", "nan", "not finite", "face 0"}},
        {"obj_NegativeNan", "v 0 -nan 0\n" + obj("f 1 2 3\n"), {"vertex 0", "nan"}},
        {"obj_NanWithPayload", "v 0 nan(0x1) 0\n" + obj("f 1 2 3\n"), {"vertex 0", "nan"}},
        {"obj_NanOfWindows", "v 0 -1.#IND 0\n" + obj("f 1 2 3\n"), {"vertex 0", "nan"}},
        {"obj_Inf", "v inf 0 0\n" + obj("f 1 2 3\n"), {"vertex 0", "inf", "not finite", "face 0"}},
        {"obj_Infinity", "v 0 -INFINITY 0\n" + obj("f 1 2 3\n"), {"vertex 0", "-inf"}},
        {"obj_TooLarge", "v 1e999 0 0\n" + obj("f 1 2 3\n"), {"vertex 0", "inf"}},
        {"obj_TooLargeWithoutExponent",
         "v " + std::string(400, '9') + " 0 0\n" + obj("f 1 2 3\n"),
         {"vertex 0", "inf"}},
        {"obj_BeyondUse", "v 1e200 0 0\n" + obj("f 1 2 3\n"), {"vertex 0", "1e+200", "largest"}},
        {"obj_WordForNumber", "v 0 zero 0\n" + obj("f 1 2 3\n"), {"line 1", "\"zero\""}},
        {"obj_DecimalComma", "v 0,5 0 0\n" + obj("f 1 2 3\n"), {"line 1", "\"0,5\""}},
        {"obj_HexNumber", "v 0x10 0 0\n" + obj("f 1 2 3\n"), {"line 1", "\"0x10\""}},
        {"obj_TwoSigns", "v +-1 0 0\n" + obj("f 1 2 3\n"), {"line 1", "\"+-1\""}},
        {"obj_LoneSign", "v - 0 0\n" + obj("f 1 2 3\n"), {"line 1", "\"-\""}},
        {"obj_LonePoint", "v . 0 0\n" + obj("f 1 2 3\n"), {"line 1", "\".\""}},
        {"obj_LoneExponent", "v 1e 0 0\n" + obj("f 1 2 3\n"), {"line 1", "\"1e\""}},
        {"obj_TwoPoints", "v 1.2.3 0 0\n" + obj("f 1 2 3\n"), {"line 1", "\"1.2.3\""}},
        {"obj_UnprintableWord", "v \x01\x02\xFF 0 0\n" + obj("f 1 2 3\n"), {"line 1", "\"???\""}},
        {"obj_EndlessWord", "v " + std::string(1'000'000, 'x') + "\n", {"line 1", "xxx...\""}},
        {"obj_TwoCoordinates", "v 0 0\n" + obj("f 1 2 3\n"), {"line 1", "missing"}},
        {"obj_NoCoordinates", "v\n" + obj("f 1 2 3\n"), {"line 1", "missing"}},
        {"obj_FiveNumbers", "v 1 2 3 4 5\n" + obj("f 1 2 3\n"), {"line 1", "5 numbers"}},
        {"obj_EightNumbers", "v 1 2 3 4 5 6 7 8\n" + obj("f 1 2 3\n"), {"line 1", "8 numbers"}},
        {"obj_WordForColour", "v 0 0 0 1 1 red\n" + obj("f 1 2 3\n"), {"line 1", "\"red\""}},
        {"obj_IndexTooLarge", obj("f 1 2 4\n"), {"line 4", "vertex 4", "3 vertices"}},
        {"obj_IndexTooLargeLater", obj("f 1 2 3\nf 3 2 9\nf 1 2 7\n"), {"line 5", "vertex 9"}},
        {"obj_IndexZero", obj("f 0 1 2\n"), {"line 4", "vertex 0", "from 1"}},
        {"obj_IndexTooFarBack", obj("f -1 -2 -4\n"), {"line 4", "vertex -4", "3 vertices so far"}},
        {"obj_IndexBackBeforeVertices", "f -1 -2 -3\n" + obj(""), {"line 1", "0 vertices so far"}},
        {"obj_IndexBeyond32Bits", obj("f 1 2 4294967297\n"), {"line 4", "4294967297"}},
        {"obj_IndexBeyond64Bits", obj("f 1 2 99999999999999999999\n"), {"line 4", "too large"}},
        {"obj_IndexWithPoint", obj("f 1 2 3.0\n"), {"line 4", "\"3.0\""}},
        {"obj_IndexWord", obj("f 1 2 three\n"), {"line 4", "\"three\""}},
        {"obj_IndexEmpty", obj("f 1 2 /1\n"), {"line 4", "whole number"}},
        {"obj_FourSlashes", obj("f 1 2 3/1/1/1\n"), {"line 4", "\"1/1\""}},
        {"obj_TextureIndexWord", obj("f 1 2 3/x\n"), {"line 4", "\"x\""}},
        {"obj_NormalIndexWord", obj("f 1 2 3//x\n"), {"line 4", "\"x\""}},
        {"obj_FaceWithoutCorners", obj("f\n"), {"no faces of three"}},
        {"obj_CutInFace", obj("f 1 2 3\nf 1 2"), {"line 5", "ends", "2 corners"}},
        {"obj_CutInVertex", obj("f 1 2 3\nv 1 1"), {"line 5", "missing"}},
        {"obj_CommentSwallowsCorner", obj("f 1 2 # 3\n"), {"no faces of three"}},
        {"obj_LinesAreCounted", "\r\n\r\n\rv x\n", {"line 4", "\"x\""}},
        {"obj_ContinuedLinesAreCounted", "v 0 \\\n 0 \\\r\n x\n", {"line 3", "\"x\""}},

        // PLY: header
        {"ply_Empty", "", {"empty"}},
        {"ply_OtherMagic", "plx\nformat ascii 1.0\nend_header\n", {"\"ply\""}},
        {"ply_MagicOnly", "ply", {"header", "end_header"}},
        {"ply_MagicAndMore", "ply file\nformat ascii 1.0\nend_header\n", {"\"ply\""}},
        {"ply_Utf16", utf16(ply(rows + "3 0 1 2\n")), {"UTF-16"}},
        {"ply_NoEndHeader", "ply\nformat ascii 1.0\n" + v + f, {"end_header"}},
        {"ply_CutInHeader", "ply\nformat ascii 1.0\nelement vert", {"line 3", "missing"}},
        {"ply_NoFormat", "ply\n" + v + f + "end_header\n" + rows + "3 0 1 2\n", {"format"}},
        {"ply_UnknownFormat",
         "ply\nformat text 1.0\n" + v + f + "end_header\n",
         {"line 2", "\"text\""}},
        {"ply_UnknownVersion",
         "ply\nformat ascii 2.0\n" + v + f + "end_header\n",
         {"line 2", "\"2.0\""}},
        {"ply_WordBehindFormat",
         "ply\nformat ascii 1.0 yes\n" + v + "end_header\n",
         {"line 2", "\"yes\""}},
        {"ply_TwoFormats", ply_header("format ascii 1.0\n"), {"line 3", "second", "format"}},
        {"ply_UnknownKeyword", ply_header("elements vertex 3\n"), {"line 3", "\"elements\""}},
        {"ply_ElementWithoutName", ply_header("element\n"), {"line 3", "name"}},
        {"ply_ElementWithoutCount", ply_header("element vertex\n"), {"line 3", "count"}},
        {"ply_NegativeCount", ply_header("element vertex -3\n"), {"line 3", "negative", "-3"}},
        {"ply_WordForCount", ply_header("element vertex three\n"), {"line 3", "\"three\""}},
        {"ply_FractionForCount", ply_header("element vertex 3.5\n"), {"line 3", "\"3.5\""}},
        {"ply_CountBeyond64Bits",
         ply_header("element vertex 99999999999999999999\n"),
         {"line 3", "too large"}},
        {"ply_SecondVertexElement", ply_header(v + v + f), {"line 7", "second", "vertex"}},
        {"ply_PropertyBeforeElement", ply_header("property float x\n"), {"line 3", "property"}},
        {"ply_PropertyWithoutName",
         ply_header("element vertex 3\nproperty float\n"),
         {"line 4", "name"}},
        {"ply_PropertyOfUnknownType",
         ply_header("element vertex 3\nproperty real x\n"),
         {"line 4", "\"real\""}},
        {"ply_PropertyTwice",
         ply_header("element vertex 3\nproperty int x\nproperty int x\n"),
         {"line 5", "two properties"}},
        {"ply_ListWithoutTypes", ply_header("element face 1\nproperty list\n"), {"line 4", "type"}},
        {"ply_ListWithFloatLength",
         ply_header("element face 1\nproperty list float int vertex_indices\n"),
         {"line 4", "length"}},
        {"ply_NoVertexElement", ply_header(f) + "3 0 1 2\n", {"vertex"}},
        {"ply_NoZ",
         ply_header("element vertex 3\nproperty float x\nproperty float y\n" + f) +
             "0 0\n1 0\n0 1\n3 0 1 2\n",
         {"vertex", "\"z\""}},
        {"ply_ListForX",
         ply_header("element vertex 1\nproperty list uchar float x\nproperty float y\n"
                    "property float z\n" +
                    f) +
             "1 0 0 0\n3 0 0 0\n",
         {"vertex", "\"x\""}},
        {"ply_FaceWithoutIndices",
         ply_header(v + "element face 1\nproperty list uchar int corners\n") + rows + "3 0 1 2\n",
         {"face", "vertex_indices"}},
        {"ply_FloatIndices",
         ply_header(v + "element face 1\nproperty list uchar float vertex_indices\n") + rows +
             "3 0 1 2\n",
         {"face", "integers"}},
        {"ply_ScalarIndices",
         ply_header(v + "element face 1\nproperty int vertex_indices\n") + rows + "0\n",
         {"face", "integers"}},

        // PLY: ascii data
        {"ply_HugeVertexCount",
         ply_header("element vertex 4000000000\nproperty float x\nproperty float y\n"
                    "property float z\n" +
                    f) +
             rows,
         {"4000000000", "\"vertex\"", "short"}},
        {"ply_HugeFaceCount",
         ply_header(v + "element face 9000000000000000000\n"
                        "property list uchar int vertex_indices\n") +
             rows + "3 0 1 2\n",
         {"9000000000000000000", "\"face\"", "short"}},
        {"ply_HugeCountOfSomethingElse",
         ply_header(v + f + "element dust 5000000000\nproperty float x\n") + rows + "3 0 1 2\n",
         {"5000000000", "\"dust\"", "short"}},
        {"ply_CutInVertices", ply("0 0 0\n1 0 0\n           "), {"line 12", "vertex 2"}},
        {"ply_CutInRow", ply(rows + "3 0 1"), {"line 13", "face 0", "fewer"}},
        {"ply_CutBeforeFaces", ply(rows), {"line 13", "face 0 of 1", "missing"}},
        {"ply_ShortRow", ply("0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), {"line 11", "vertex 1", "fewer"}},
        {"ply_LongRow", ply("0 0 0\n1 0 0 7\n0 1 0\n3 0 1 2\n"), {"line 11", "vertex 1", "more"}},
        {"ply_Nan", ply("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), {"vertex 1", "nan", "face 0"}},
        {"ply_Inf", ply("0 0 0\n1 0 -inf\n0 1 0\n3 0 1 2\n"), {"vertex 1", "-inf", "face 0"}},
        {"ply_Word", ply("0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n"), {"line 11", "\"zero\""}},
        {"ply_IndexTooLarge",
         ply(rows + "3 0 1 3\n"),
         {"line 13", "face 0", "vertex 3", "3 vertices"}},
        {"ply_IndexNegative", ply(rows + "3 0 1 -1\n"), {"line 13", "face 0", "vertex -1"}},
        {"ply_IndexBeyond32Bits",
         ply(rows + "3 0 1 4294967296\n"),
         {"line 13", "face 0", "4294967296"}},
        {"ply_IndexFraction", ply(rows + "3 0 1 1.5\n"), {"line 13", "\"1.5\""}},
        {"ply_ListLengthNegative", ply(rows + "-3 0 1 2\n"), {"line 13", "face 0", "-3"}},
        {"ply_ListLengthHuge", ply(rows + "4294967295 0 1 2\n"), {"line 13", "face 0"}},
        {"ply_ListLengthFraction", ply(rows + "3.5 0 1 2\n"), {"line 13", "\"3.5\""}},
        {"ply_ListTooLong", ply(rows + "4 0 1 2\n"), {"line 13", "face 0", "fewer"}},
        {"ply_FaceWithTwoCorners", ply(rows + "2 0 1\n"), {"no faces of three"}},
        {"ply_SmallFaceIndexTooLarge", ply(rows + "2 0 3\n"), {"line 13", "face 0", "vertex 3"}},
        {"ply_StripIndexTooLarge",
         ply_header(v + "element tristrips 1\nproperty list int int vertex_indices\n") + rows +
             "4 0 1 2 5\n",
         {"line 13", "tristrips 0", "vertex 5"}},
        {"ply_StripIndexBelowMinusOne",
         ply_header(v + "element tristrips 1\nproperty list int int vertex_indices\n") + rows +
             "4 0 1 2 -2\n",
         {"line 13", "tristrips 0", "vertex -2"}},
        {"ply_StripsTooShort",
         ply_header(v + "element tristrips 1\nproperty list int int vertex_indices\n") + rows +
             "5 0 1 -1 1 2\n",
         {"no faces"}},

        {"ply_StrangeElement",
         ply_header(v + "element \x01\x02" + std::string(1000, 'e') +
                    " 1\nproperty int a\nproperty int b\n" + f) +
             rows + "5\n3 0 1 2\n",
         {"line 16", "??eee", "... 0 has fewer"}},

        // PLY: binary data
        {"ply_BinaryNan",
         binary_ply(v + f, bytes(0.f, 0.f, kNan) + kThreeVertices.substr(12) +
                               bytes(std::uint8_t{3}, 0, 1, 2)),
         {"vertex 0", "nan", "face 0"}},
        {"ply_BinaryInf",
         binary_ply(v + f, kThreeVertices.substr(0, 12) + bytes(-kInf, 0.f, 0.f) +
                               kThreeVertices.substr(24) + bytes(std::uint8_t{3}, 0, 1, 2)),
         {"vertex 1", "-inf", "face 0"}},
        {"ply_BinaryCutInVertices",
         binary_ply(v + f, kThreeVertices.substr(0, 30)),
         {"\"vertex\"", "short"}},
        {"ply_BinaryCutInFaces",
         binary_ply(v + f, kThreeVertices + bytes(std::uint8_t{3}, 0, 1)),
         {"face 0", "cut"}},
        {"ply_BinaryNoFaceData", binary_ply(v + f, kThreeVertices), {"face 0 of 1", "cut"}},
        {"ply_BinaryIndexTooLarge",
         binary_ply(v + f, kThreeVertices + bytes(std::uint8_t{3}, 0, 1, 3)),
         {"face 0", "vertex 3"}},
        {"ply_BinaryIndexNegative",
         binary_ply(v + f, kThreeVertices + bytes(std::uint8_t{3}, 0, 1, -2147483647)),
         {"face 0", "-2147483647"}},
        {"ply_BinaryUnsignedIndexTooLarge",
         binary_ply(v + "element face 1\nproperty list uint uint vertex_indices\n",
                    kThreeVertices + bytes(3u, 0u, 1u, 0xFFFFFFFFu)),
         {"face 0", "4294967295"}},
        {"ply_BinaryListLengthHuge",
         binary_ply(v + "element face 1\nproperty list uint uint vertex_indices\n",
                    kThreeVertices + bytes(0xFFFFFFFFu, 0u, 1u, 2u)),
         {"face 0", "4294967295"}},
        {"ply_BinaryListLengthNegative",
         binary_ply(v + "element face 1\nproperty list char int vertex_indices\n",
                    kThreeVertices + bytes(std::int8_t{-3}, 0, 1, 2)),
         {"face 0", "-3"}},
        {"ply_BinarySkippedListHuge",
         binary_ply("element vertex 1\nproperty list int double tags\nproperty float x\n"
                    "property float y\nproperty float z\n" +
                        f,
                    bytes(2000000000, 0., 0., 0., 0., 0., 0., 0.)),
         {"vertex 0", "2000000000"}},
        {"ply_BinaryHugeCount",
         binary_ply("element vertex 4294967295\nproperty double x\nproperty double y\n"
                    "property double z\n" +
                        f,
                    kThreeVertices),
         {"4294967295", "short"}},
        {"ply_BinaryBeyondUse",
         binary_ply(
             "element vertex 1\nproperty double x\nproperty double y\nproperty double z\n" + f,
             bytes(1e300, 0., 0., std::uint8_t{3}, 0, 0, 0)),
         {"vertex 0", "1e+300"}},

        // OFF
        {"off_Empty", "", {"empty"}},
        {"off_OnlyComments", "# nothing\n", {"empty"}},
        {"off_OtherMagic", "OFX\n3 1 0\n", {"line 1", "\"OFX\""}},
        {"off_UnknownVariant", "4OFF\n3 1 0\n", {"line 1", "\"4OFF\""}},
        {"off_NDimensional", "nOFF\n3\n3 1 0\n", {"line 1", "\"nOFF\""}},
        {"off_Binary", "OFF BINARY\n" + bytes(0, 0, 0), {"line 1", "binary"}},
        {"off_Utf16", utf16(off("3 0 1 2\n")), {"UTF-16"}},
        {"off_NoCounts", "OFF\n", {"number of vertices", "missing"}},
        {"off_NoFaceCount", "OFF\n3\n", {"number of faces", "missing"}},
        {"off_NegativeVertexCount", "OFF\n-3 1 0\n", {"line 2", "vertices", "-3"}},
        {"off_NegativeFaceCount", "OFF\n0 -1 0\n", {"line 2", "faces", "-1"}},
        {"off_HugeVertexCount", "OFF\n4000000000 1 0\n0 0 0\n", {"line 2", "4000000000"}},
        {"off_HugeFaceCount", "OFF\n1 4000000000 0\n0 0 0\n", {"line 2", "4000000000"}},
        {"off_CountBeyond64Bits", "OFF\n99999999999999999999 1 0\n", {"line 2", "too large"}},
        {"off_WordForCount", "OFF\nthree one none\n", {"line 2", "\"three\""}},
        {"off_WordForEdgeCount",
         "OFF\n3 1 none\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
         {"line 2", "\"none\""}},
        {"off_FourCounts", "OFF\n3 1 0 5\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", {"line 2", "\"5\""}},
        {"off_OnlyLines", off("2 0 1\n"), {"no faces"}},
        {"off_CutInVertices", "OFF\n3 1 0\n0 0 0\n1 0 0\n        ", {"line 5", "vertex 2"}},
        {"off_CutInFaces", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2", {"line 6", "face 1"}},
        {"off_CutInRow", off("3 0 1"), {"line 6", "face 0", "2 corners"}},
        {"off_ShortVertex", "OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n", {"line 3", "vertex 0"}},
        {"off_Nan", "OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", {"vertex 1", "nan", "face 0"}},
        {"off_Inf", "OFF\n3 1 0\n0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n", {"vertex 1", "inf", "face 0"}},
        {"off_Word", "OFF\n3 1 0\n0 0 0\n1 one 0\n0 1 0\n3 0 1 2\n", {"line 4", "\"one\""}},
        {"off_ThirteenNumbers",
         "OFF\n3 1 0\n" + repeated("0 ", 13) + "\n1 0 0\n0 1 0\n3 0 1 2\n",
         {"line 3", "vertex 0", "13 numbers"}},
        {"off_IndexTooLarge", off("3 0 1 3\n"), {"line 6", "face 0", "vertex 3", "3 vertices"}},
        {"off_IndexNegative", off("3 0 1 -1\n"), {"line 6", "face 0", "vertex -1"}},
        {"off_LineIndexTooLarge", off("2 0 7\n"), {"line 6", "face 0", "vertex 7"}},
        {"off_IndexFraction", off("3 0 1 2.0\n"), {"line 6", "\"2.0\""}},
        {"off_NegativeCorners", off("-3 0 1 2\n"), {"line 6", "face 0", "-3 corners"}},
        {"off_TooFewCorners", off("4 0 1 2\n"), {"line 6", "face 0", "says 4"}},
        {"off_HugeCorners", off("4000000000 0 1 2\n"), {"line 6", "face 0", "4000000000"}},

        // STL
        {"stl_Empty", "", {"empty"}},
        {"stl_FiveBytes", "solid", {"line 1", "endsolid"}},
        {"stl_OtherText", "liquid\n", {"text", "\"solid\"", "no STL"}},
        {"stl_Utf16", utf16(stl(kFacet)), {"UTF-16"}},
        {"stl_NoFacets", stl(""), {"no faces"}},
        {"stl_OnlySolids", stl("") + stl("") + stl(""), {"no faces"}},
        {"stl_CutInFacet",
         "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n",
         {"line 5", "\"vertex\"", "missing"}},
        {"stl_CutInVertex",
         "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0",
         {"line 4", "coordinate", "missing"}},
        {"stl_NoEndsolid", std::string("solid\n") + kFacet, {"line 9", "endsolid"}},
        {"stl_FacetOutsideSolid", stl(kFacet) + kFacet, {"line 10", "\"facet\"", "\"solid\""}},
        {"stl_Nan", stl("facet normal 0 0 1\nouter loop\nvertex nan 0 0\n"), {"line 4", "\"nan\""}},
        {"stl_Word",
         stl("facet normal 0 0 1\nouter loop\nvertex one 0 0\n"),
         {"line 4", "\"one\""}},
        {"stl_FourCoordinates",
         stl("facet normal 0 0 1\nouter loop\nvertex 0 0 0 0\n"),
         {"line 4", "more than 3"}},
        {"stl_TwoVertices",
         stl("facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
             "endloop\nendfacet\n"),
         {"no faces of three"}},
        {"stl_FourVertices",
         stl("facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
             "vertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\n"),
         {"line 7", "\"vertex\"", "\"endloop\""}},
        {"stl_OtherKeyword", stl("triangle 0 0 1\n"), {"line 2", "\"triangle\""}},
        {"stl_BinaryWithoutCount", std::string(80, '\0'), {"80 bytes", "no STL"}},
        {"stl_BinaryNoFacets", binary_stl(0, ""), {"no faces"}},
        {"stl_BinaryCut",
         binary_stl(2, binary_facet() + binary_facet().substr(0, 49)),
         {"says 2", "after 1"}},
        {"stl_BinaryHugeCount",
         binary_stl(0xFFFFFFFFu, binary_facet()),
         {"says 4294967295", "after 1"}},
        {"stl_BinaryMoreThanItSays",
         binary_stl(1, binary_facet() + binary_facet()),
         {"says 1", "size", "of 2"}},
        {"stl_BinaryNoCount", binary_stl(0, binary_facet()), {"says 0", "size", "of 1"}},
        {"stl_TextWithZeros",
         "solid" + std::string(75, '\0') + stl(kFacet),
         {"no text", "as a binary file"}},
        {"stl_BinaryNan", binary_stl(2, binary_facet() + binary_facet(kNan)), {"facet 1", "nan"}},
        {"stl_BinaryInf", binary_stl(1, binary_facet(kInf)), {"facet 0", "inf"}},
        {"stl_BinarySolidCut",
         "solid" + std::string(75, '\0') + bytes(3u) + binary_facet(),
         {"says 3", "after 1"}},
    };
}

class MalformedMesh : public testing::TestWithParam<Case> {};

TEST_P(MalformedMesh, IsRefusedInOneSentence)
{
    expect_refused(GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, MalformedMesh, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

// ---- what is no file at all
// ----------------------------------------------------------------------

std::string refusal(const std::filesystem::path& path)
{
    try {
        const Scene scene = read_scene(path);
        return "was read";
    } catch (const InputError& error) {
        return error.what();
    }
}

TEST(UnreadableFile, IsNamedWithItsReason)
{
    const TemporaryFolder folder;
    for (const std::string extension : {"obj", "ply", "off", "stl", "gltf", "glb"}) {
        const std::string missing = (folder / ("missing." + extension)).string();
        EXPECT_TRUE(refusal(missing).starts_with(missing + ": ")) << refusal(missing);
        EXPECT_NE(refusal(missing).find("No such file"), std::string::npos) << refusal(missing);

        const std::string directory = (folder / ("folder." + extension)).string();
        std::filesystem::create_directory(directory);
        EXPECT_NE(refusal(directory).find("is a folder"), std::string::npos) << refusal(directory);

        // opening a pipe for reading waits for a writer, unless one takes care
        const std::string pipe = (folder / ("pipe." + extension)).string();
        ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
        EXPECT_NE(refusal(pipe).find("regular file"), std::string::npos) << refusal(pipe);
    }
}

TEST(UnreadableFile, WithoutPermissionIsRefused)
{
    if (geteuid() == 0)
        GTEST_SKIP() << "root may read everything";
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.file("secret.obj", obj("f 1 2 3\n"));
    std::filesystem::permissions(path, std::filesystem::perms::none);
    EXPECT_NE(refusal(path).find("Permission denied"), std::string::npos) << refusal(path);
}

TEST(UnreadableFile, OfUnknownExtensionIsRefused)
{
    const TemporaryFolder folder;
    for (const std::string name : {"mesh.blend", "mesh", "mesh.obj.bak", ".obj"}) {
        const std::filesystem::path path = folder.file(name, obj("f 1 2 3\n"));
        EXPECT_NE(refusal(path).find("extension"), std::string::npos) << refusal(path);
    }
}

}  // namespace
}  // namespace surfelao
