// Files of points that must be refused, each in one sentence that names line or point and fault.
#include "cloud_cases.h"
#include "malformed_case.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

using namespace malformed;
using test::compressed;
using test::kXyzFields;
using test::lzf;
using test::pcd_header;
using test::ply_cloud;

std::string pcd(const std::string& fields, const std::string& rest)
{
    return "VERSION .7\n" + fields + rest;
}

// long: a table
std::vector<Case> cloud_cases()
{
    const std::string f = kXyzFields;
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const std::string points = bytes(1.f, 2.f, 3.f, 4.f, 5.f, 6.f);
    const auto packed = [&](const std::string& data) {
        return pcd_header(f, 2, "binary_compressed") + data;
    };
    return {
        // PLY, OBJ, OFF
        {"ply_NoPoints", ply_cloud("element vertex 0\n" + xyz, ""), {"no faces"}},
        {"ply_AllNan", ply_cloud("element vertex 1\n" + xyz, "nan 0 0\n"), {"no point", "finite"}},
        {"ply_CloudCut",
         ply_cloud("element vertex 3\n" + xyz, "0 0 0\n1 1 1\n       "),
         {"line 10", "vertex 2", "missing"}},
        {"ply_CloudCount",
         ply_cloud("element vertex 999999999999\n" + xyz, "0 0 0\n"),
         {"999999999999", "short"}},
        {"ply_CloudWithoutZ",
         ply_cloud("element vertex 1\nproperty float x\nproperty float y\n", "0 0\n"),
         {"\"vertex\"", "\"z\""}},
        {"obj_AllNan", "v nan 0 0\nv 0 inf 0\n", {"no point", "finite"}},
        {"off_CountTooLarge", "OFF\n3 0 0\n0 0 0\n1 1 1\n", {"vertex 2", "missing"}},

        // text
        {"xyz_Empty", "", {"empty"}},
        {"xyz_OnlyComments", "# x y z\n// nothing\n\n", {"no points"}},
        {"xyz_OnlyHeader", "x y z\n", {"no points"}},
        {"xyz_TwoColumns", "1 2\n3 4\n", {"line 1", "2 columns", "x y z"}},
        {"xyz_Ragged", "1 2 3\n\n4 5 6 7\n", {"line 3", "4 columns", "first has 3"}},
        {"xyz_RaggedShort", "1 2 3 4\n4 5 6\n", {"line 2", "3 columns", "first has 4"}},
        {"xyz_EmptyField", "1,2,3,4\n4,5,,6\n", {"line 2", "3 columns"}},
        {"xyz_Nan", "1 2 3\n# c\n4 nan 6\n", {"line 3", "point 1", "nan", "finite"}},
        {"xyz_Inf", "1 2 -inf\n", {"line 1", "point 0", "-inf"}},
        {"xyz_TooFar", "1 2 1e200\n", {"line 1", "1e+200", "1e+100"}},
        {"xyz_TooFarForANumber", "1 2 1e999\n", {"line 1", "point 0", "inf"}},
        {"xyz_Word", "1 2 3\n4 five 6\n", {"line 2", "\"five\""}},
        {"xyz_Letter", "Dear reader,\nthis is a letter.\n", {"line 1", "\"Dear\"", "x y z"}},
        {"xyz_Molecule", "2\nwater\nO 0 0 0\nH 0 0 1\n", {"line 2", "\"water\""}},
        {"xyz_DecimalCommas", "1,5;2,5;3,5\n", {"line 1", "\"1,5\""}},
        {"xyz_Header", "x y z r g\n1 2 3 4 5 6\n", {"line 2", "6 columns", "named are 5"}},
        {"xyz_HeaderWithoutZ", "x y r g\n1 2 3 4\n", {"line 1", "\"x\"", "x y z"}},
        {"xyz_SecondHeader", "x y z\nx y z\n1 2 3 4\n", {"line 3", "4 columns", "named are 3"}},
        {"xyz_Utf16", utf16("1 2 3\n"), {"UTF-16"}},
        {"xyz_NulBytes", std::string(1000, '\0'), {"line 1", "not a number"}},
        {"xyz_ManyColumns",
         [] {
             std::string line;
             for (int i = 0; i < 1001; ++i)
                 line += "1 ";
             return line + "\n";
         }(),
         {"line 1", "1000 columns"}},
        {"pts_CountTooLarge", "3\n1 2 3\n4 5 6\n", {"line 1", "3 points", "2 follow"}},
        {"pts_CountTooSmall", "1\n1 2 3\n4 5 6\n", {"line 1", "1 point,", "2 follow"}},
        {"pts_HugeCount", "9000000000000000000\n1 2 3\n", {"line 1", "9000000000000000000"}},
        {"pts_HugerCount", "90000000000000000000\n1 2 3\n", {"line 1", "too large"}},
        {"pts_NegativeCount", "-1\n1 2 3\n", {"line 1", "-1"}},
        {"pts_Fraction", "1.5\n1 2 3\n", {"line 1", "\"1.5\""}},
        {"pts_OnlyCount", "1\n", {"1 column"}},
        {"pts_SecondScan", "1\n1 2 3\n1\n4 5 6\n", {"line 3", "1 column"}},

        // PCD: header
        {"pcd_Empty", "", {"empty"}},
        {"pcd_OtherText", "Dear reader\n", {"line 1", "\"Dear\""}},
        {"pcd_NoData", pcd(f, "POINTS 2\n"), {"within the header"}},
        {"pcd_NoFields", pcd("", "POINTS 2\nDATA ascii\n1 2 3\n"), {"FIELDS"}},
        {"pcd_SecondFields", pcd(f + f, "POINTS 2\nDATA ascii\n"), {"line 6", "second"}},
        {"pcd_NoZ", pcd("FIELDS x y\n", "POINTS 1\nDATA ascii\n1 2\n"), {"FIELDS", "z"}},
        {"pcd_TwoX",
         pcd("FIELDS x x y z\n", "POINTS 1\nDATA ascii\n1 1 2 3\n"),
         {"\"x\"", "another"}},
        {"pcd_ArrayOfX",
         pcd("FIELDS x y z\nCOUNT 2 1 1\n", "POINTS 1\nDATA ascii\n1 1 2 3\n"),
         {"FIELDS", "x"}},
        {"pcd_LongInteger",
         pcd("FIELDS x y z\nSIZE 8 4 4\nTYPE I F F\n", "POINTS 1\nDATA ascii\n1 2 3\n"),
         {"FIELDS", "x"}},
        {"pcd_Size",
         pcd("FIELDS x y z\nSIZE 3 4 4\n", "POINTS 1\nDATA ascii\n"),
         {"\"x\"", "3 bytes"}},
        {"pcd_SizeHuge",
         pcd("FIELDS x y z\nSIZE 4 4 9223372036854775807\n", "POINTS 1\nDATA ascii\n"),
         {"\"z\"", "9223372036854775807"}},
        {"pcd_Type",
         pcd("FIELDS x y z\nTYPE F Q F\n", "POINTS 1\nDATA ascii\n"),
         {"\"y\"", "\"Q\""}},
        {"pcd_FewTypes",
         pcd("FIELDS x y z\nTYPE F F\n", "POINTS 1\nDATA ascii\n"),
         {"line 3", "fewer types"}},
        {"pcd_ManyTypes",
         pcd("FIELDS x y z\nTYPE F F F F\n", "POINTS 1\nDATA ascii\n"),
         {"line 3", "\"F\""}},
        {"pcd_Count0",
         pcd("FIELDS x y z a\nCOUNT 1 1 1 0\n", "POINTS 1\nDATA ascii\n1 2 3\n"),
         {"\"a\"", "count 0"}},
        {"pcd_CountHuge",
         pcd("FIELDS x y z a\nCOUNT 1 1 1 4611686018427387904\n", "POINTS 1\nDATA ascii\n1 2 3\n"),
         {"\"a\"", "4611686018427387904"}},
        {"pcd_CountsHuge",
         pcd("FIELDS x y z a b\nCOUNT 1 1 1 50 50\n", "POINTS 1\nDATA ascii\n1\n"),
         {"\"b\"", "more numbers"}},
        {"pcd_NoCount", pcd(f, "DATA ascii\n1 2 3\n"), {"WIDTH", "POINTS"}},
        {"pcd_NoPoints", pcd(f, "WIDTH 0\nHEIGHT 4\nDATA ascii\n"), {"no points"}},
        {"pcd_Product",
         pcd(f, "WIDTH 2\nHEIGHT 2\nPOINTS 2\nDATA ascii\n1 2 3\n4 5 6\n"),
         {"2 x 2", "POINTS 2"}},
        {"pcd_ProductOverflows",
         pcd(f, "WIDTH 4294967296\nHEIGHT 4294967297\nPOINTS 1\nDATA ascii\n1 2 3\n"),
         {"4294967296 x 4294967297"}},
        {"pcd_ProductIsZero64",
         pcd(f, "WIDTH 4294967296\nHEIGHT 4294967296\nDATA ascii\n1 2 3\n"),
         {"4294967296 x 4294967296"}},
        {"pcd_NegativeWidth", pcd(f, "WIDTH -1\n"), {"line 6", "-1"}},
        {"pcd_Viewpoint", pcd(f, "VIEWPOINT 1 2\n"), {"line 6", "viewpoint"}},
        {"pcd_Kind", pcd(f, "POINTS 1\nDATA text\n"), {"line 7", "\"text\""}},
        {"pcd_KindWithMore", pcd(f, "POINTS 1\nDATA ascii 7\n"), {"line 7", "\"7\""}},

        // PCD: data
        {"pcd_AsciiHuge",
         pcd(f, "POINTS 4000000000\nDATA ascii\n1 2 3\n"),
         {"4000000000", "short"}},
        {"pcd_AsciiCut",
         pcd_header(f, 3, "ascii") + "1 2 3\n4 5 6\n      ",
         {"point 2", "missing"}},
        {"pcd_AsciiShortRow",
         pcd_header(f, 2, "ascii") + "1 2 3\n4 5\n   ",
         {"line 13", "point 1", "fewer"}},
        {"pcd_AsciiLongRow",
         pcd_header(f, 2, "ascii") + "1 2 3 4\n4 5 6\n",
         {"line 12", "point 0", "more"}},
        {"pcd_AsciiMore",
         pcd_header(f, 1, "ascii") + "1 2 3\n4 5 6\n",
         {"line 13", "\"4\"", "1 point"}},
        {"pcd_AsciiWord", pcd_header(f, 2, "ascii") + "1 2 3\n4 b 6\n", {"line 13", "\"b\""}},
        {"pcd_AsciiAllNan", pcd_header(f, 1, "ascii") + "1 nan 3\n", {"no point", "finite"}},
        {"pcd_BinaryCut",
         pcd_header(f, 2, "binary") + points.substr(1),
         {"2 points", "12 bytes", "23"}},
        {"pcd_BinaryHuge",
         pcd(f, "POINTS 4000000000\nDATA binary\n" + points),
         {"4000000000 points", "24"}},
        {"pcd_BinaryEmpty", pcd(f, "POINTS 1\nDATA binary\n"), {"1 point", "have 0"}},
        {"pcd_PackedWithoutSizes", packed("1234567"), {"cut"}},
        {"pcd_PackedCut", packed(bytes(100u, 24u) + "12"), {"100", "after 2"}},
        {"pcd_PackedSize", packed(bytes(2u, 25u) + "12"), {"2 points", "12 bytes", "25"}},
        {"pcd_PackedSizeHuge",
         pcd(f, "POINTS 4000000000\nDATA binary_compressed\n" + bytes(1u, 0xffffffffu) + "1"),
         {"4000000000", "4294967295"}},
        {"pcd_PackedBomb",
         pcd(f, "POINTS 300000000\nDATA binary_compressed\n" + bytes(1u, 3600000000u) + "1"),
         {"unpack", "3600000000"}},
        {"pcd_PackedBackTooFar",
         packed(bytes(4u, 24u) + std::string("\0a\x20\x01", 4)),
         {"unpack"}},
        {"pcd_PackedBackFromNothing",
         packed(bytes(2u, 24u) + std::string("\x20\0", 2)),
         {"unpack"}},
        {"pcd_PackedCutInCopy", packed(bytes(3u, 24u) + std::string("\0a\xE0", 3)), {"unpack"}},
        {"pcd_PackedCutInRun",
         packed(bytes(3u, 24u) + "\x1f"
                                 "ab"),
         {"unpack"}},
        {"pcd_PackedTooShort", packed(bytes(2u, 24u) + std::string("\0a", 2)), {"unpack"}},
        {"pcd_PackedRunTooLong",
         packed(bytes(33u, 24u) + "\x1f" + std::string(32, 'a')),
         {"unpack"}},
        {"pcd_PackedCopyTooLong",
         packed(bytes(5u, 24u) + std::string("\0a\xE0\xff\0", 5)),
         {"unpack"}},
    };
}

class MalformedCloud : public testing::TestWithParam<Case> {};

TEST_P(MalformedCloud, IsRefusedInOneSentence)
{
    expect_refused(GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, MalformedCloud, testing::ValuesIn(cloud_cases()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace surfelao
