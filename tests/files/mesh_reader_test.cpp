// Legal files, the odd ones above all: what a reader makes of them.
#include "files/mesh_source.h"
#include "files/obj_io.h"
#include "files/off_io.h"
#include "files/ply_io.h"
#include "files/scene_io.h"
#include "files/stl_io.h"

#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace surfelao {
namespace {

using Positions = std::vector<glm::dvec3>;
using Triangles = std::vector<glm::uvec3>;

const Positions kCorner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const Triangles kOne{{0, 1, 2}};
constexpr const char* kCornerObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Scene obj(const std::string& text)
{
    return read_obj("test.obj", text);
}

// ---- OBJ
// -----------------------------------------------------------------------------------------

TEST(ReadObj, KeepsVerticesThatNobodyUsesAndThoseThatAreEqual)
{
    const Scene scene = obj("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0\nf 2 3 5\n");
    EXPECT_EQ(scene.positions.size(), 5u);
    EXPECT_EQ(scene.triangles, (Triangles{{1, 2, 4}}));
    ASSERT_EQ(scene.parts.size(), 1u);
    EXPECT_EQ(scene.parts[0].vertex_count, 5u);
    EXPECT_EQ(scene.parts[0].triangle_count, 1u);
}

TEST(ReadObj, TakesAllFormsOfCorners)
{
    for (const char* face : {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//2 3//3", "f 1/1/1 2/2/2 3/3/3",
                             "f 1/ 2/ 3/", "f -3 -2 -1", "f -3/-1/-1 2 3//2", "fo 1 2 3",
                             "f +1 +2 +3", "\tf\t1\t2\t3\t", "f 1 2 3 # done"}) {
        const Scene scene = obj(std::string(kCornerObj) + "vn 0 0 1\nvn 0 0 1\nvn 0 0 1\n" + face);
        EXPECT_EQ(scene.positions, kCorner) << face;
        EXPECT_EQ(scene.triangles, kOne) << face;
    }
}

TEST(ReadObj, NegativeIndicesCountFromTheLastVertexSoFar)
{
    const Scene scene = obj(std::string(kCornerObj) + "f -3 -2 -1\nv 5 5 5\nf -4 -3 -1\n");
    EXPECT_EQ(scene.triangles, (Triangles{{0, 1, 2}, {0, 1, 3}}));
}

TEST(ReadObj, FacesMayComeBeforeTheirVertices)
{
    EXPECT_EQ(obj(std::string("f 1 2 3\n") + kCornerObj).triangles, kOne);
}

TEST(ReadObj, TakesAnyEndOfLines)
{
    for (const char* end : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (const char* line : {"# comment", "v 0 0 0", "", "v 1 0 0", "v 0 1 0", "f 1 2 3"})
            text.append(line).append(end);
        EXPECT_EQ(obj(text).triangles, kOne);
        EXPECT_EQ(obj(text).positions, kCorner);
    }
}

TEST(ReadObj, TakesAByteOrderMarkAndNoLastNewline)
{
    EXPECT_EQ(obj(std::string("\xEF\xBB\xBF") + kCornerObj + "f 1 2 3").positions, kCorner);
}

TEST(ReadObj, JoinsContinuedLines)
{
    const Scene scene = obj("v 0 0 \\\n0\nv 1 \\\r\n 0 0\nv 0 1 0\nf 1 \\\n\\\n 2\\\n 3\n");
    EXPECT_EQ(scene.positions, kCorner);
    EXPECT_EQ(scene.triangles, kOne);
}

TEST(ReadObj, ABackslashEndsACommentLikeAnyOtherByte)
{
    EXPECT_EQ(obj("# C:\\models\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").positions, kCorner);
}

TEST(ReadObj, TakesAllKindsOfNumbers)
{
    const Scene scene = obj(
        "v +1 2. .5\nv -1e2 2.E+1 1e-2\nv 1e-400 -0 0000000000000000000000001.5\n"
        "v 0.1000000000000000055511151231257827 123456789012345678901234567890 1E00001\nf 1 2 3\n");
    EXPECT_EQ(scene.positions, (Positions{{1, 2, 0.5},
                                          {-100, 20, 0.01},
                                          {0, 0, 1.5},
                                          {0.1, 123456789012345678901234567890., 10}}));
}

TEST(ReadObj, WeightsAndColoursAreNoPartOfThePosition)
{
    const Scene scene = obj("v 0 0 0 2\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 255 0 0\nf 1 2 3\n");
    EXPECT_EQ(scene.positions, kCorner);
}

TEST(ReadObj, PassesOverEverythingThatIsNoSurface)
{
    const Scene scene =
        obj(std::string("mtllib missing.mtl\no thing\ng a b c\ns off\n") + kCornerObj +
            "vt 0 nan\nvp 0 0\nusemtl none\np 1 2\nl 1 2 3\nf 1 2 3\n"
            "curv 0 1 1 2 3\nunknown words here\n");
    EXPECT_EQ(scene.positions, kCorner);
    EXPECT_EQ(scene.triangles, kOne);
}

TEST(ReadObj, TakesVeryLongLines)
{
    std::string text = std::string("# ") + std::string(1'000'000, 'x') + "\n" + kCornerObj + "f";
    for (int i = 0; i < 1'000; ++i)
        text += std::string(1000, ' ') + "1 2 3";
    EXPECT_EQ(obj(text).triangles.size(), 2'998u);
}

TEST(ReadObj, FacesThatRepeatAVertexStayInTheCount)
{
    EXPECT_EQ(obj(std::string(kCornerObj) + "f 1 1 2\nf 1 2 3 3\n").triangles.size(), 3u);
}

// ---- PLY
// -----------------------------------------------------------------------------------------

TEST(ReadPly, TakesEveryScalarTypeForCoordinates)
{
    for (const char* type :
         {"char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8", "uint8",
          "int16", "uint16", "int32", "uint32", "float32", "float64"}) {
        std::string text = "ply\nformat ascii 1.0\nelement vertex 3\n";
        for (const char* axis : {"x", "y", "z"})
            text += std::string("property ") + type + " " + axis + "\n";
        text +=
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
        EXPECT_EQ(read_ply("test.ply", text).positions, kCorner) << type;
    }
}

/// Numbers as a binary file of either byte order has them.
class NumberBytes {
public:
    explicit NumberBytes(bool big) : big_(big) {}
    template <class Value>
    void add(std::initializer_list<Value> values)
    {
        for (const Value value : values) {
            char raw[sizeof(Value)];
            std::memcpy(raw, &value, sizeof(Value));
            if (big_)
                std::reverse(raw, raw + sizeof(Value));
            text.append(raw, sizeof(Value));
        }
    }
    std::string text;

private:
    bool big_;
};

template <class Coordinate, class Length, class Index>
void expect_binary(const std::string& coordinate, const std::string& length,
                   const std::string& index)
{
    for (const bool big : {false, true}) {
        std::string text = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                           "_endian 1.0\nelement vertex 4\nproperty uchar before\n";
        for (const char* axis : {"x", "y", "z"})
            text += "property " + coordinate + " " + axis + "\n";
        text += "property list uchar short after\nelement face 2\nproperty list " + length + " " +
                index + " vertex_indices\nproperty double quality\nend_header\n";
        NumberBytes data(big);
        for (int v = 0; v < 4; ++v) {
            data.add<std::uint8_t>({200});
            data.add<Coordinate>({Coordinate(v % 2 * 100), Coordinate(v / 2 * 100), Coordinate(7)});
            data.add<std::uint8_t>({2});
            data.add<std::int16_t>({-1, -2});
        }
        data.add<Length>({3});
        data.add<Index>({0, 1, 3});
        data.add<double>({0.5});
        data.add<Length>({4});
        data.add<Index>({0, 1, 3, 2});
        data.add<double>({0.5});
        const Scene scene = read_ply("test.ply", text + data.text);
        EXPECT_EQ(scene.positions, (Positions{{0, 0, 7}, {100, 0, 7}, {0, 100, 7}, {100, 100, 7}}))
            << coordinate << big;
        EXPECT_EQ(scene.triangles, (Triangles{{0, 1, 3}, {0, 1, 3}, {0, 3, 2}})) << length << index;
    }
}

TEST(ReadPly, TakesEveryTypeInBothByteOrders)
{
    expect_binary<float, std::uint8_t, std::int32_t>("float", "uchar", "int");
    expect_binary<double, std::uint32_t, std::uint32_t>("double", "uint", "uint");
    expect_binary<std::int8_t, std::int8_t, std::int8_t>("char", "char", "char");
    expect_binary<std::uint8_t, std::int16_t, std::uint8_t>("uint8", "int16", "uint8");
    expect_binary<std::int16_t, std::uint16_t, std::int16_t>("short", "ushort", "short");
    expect_binary<std::uint16_t, std::int32_t, std::uint16_t>("ushort", "int", "uint16");
    expect_binary<std::int32_t, std::uint8_t, std::uint32_t>("int", "uint8", "uint32");
    expect_binary<std::uint32_t, std::uint8_t, std::int32_t>("uint", "uint8", "int32");
}

TEST(ReadPly, PassesOverOtherElementsAndPropertiesInAnyOrder)
{
    const Scene scene =
        read_ply("test.ply",
                 "ply\nformat ascii 1.0\nCreated by Blender3D 247\ncomment made\nobj_info by hand\n"
                 "element camera 1\nproperty float fov\nproperty list uchar int ids\n"
                 "element face 1\nproperty uchar flags\n"
                 "property list uint uint vertex_index\nproperty list uchar float uv\n"
                 "comment between\nelement nothing 5\nelement vertex 3\n"
                 "property double z\nproperty list uchar int tags\nproperty int x\n"
                 "property float nx\nproperty float y\nend_header\n"
                 "45 3 1 2 3\n0 3 0 1 2 2 .5 .5\n"
                 "0 0 0 nan 0\n0 2 8 8 1 0 0\n0 1 8 0 0 1\n");
    EXPECT_EQ(scene.positions, kCorner);
    EXPECT_EQ(scene.triangles, kOne);
}

// 0 2 4     a strip: 012, 213 turned to 1 3 2, 234; after -1 a new one
// 1 3
TEST(ReadPly, TakesTriangleStrips)
{
    const Scene scene = read_ply(
        "test.ply",
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 1 0\n0 0 0\n1 1 0\n1 0 0\n2 1 0\n12 0 1 2 3 4 -1 4 3 3 2 -1 1\n");
    EXPECT_EQ(scene.triangles, (Triangles{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
}

TEST(ReadPly, ABinaryFileMayBeginWithALineFeedAfterCarriageReturns)
{
    std::string text =
        "ply\rformat binary_little_endian 1.0\relement vertex 3\rproperty char x\r"
        "property char y\rproperty char z\relement face 1\r"
        "property list uchar uchar vertex_indices\rend_header\r";
    text += std::string("\n\0\0\1\0\0\0\1\0\3\0\1\2", 13);
    EXPECT_EQ(read_ply("test.ply", text).positions, (Positions{{10, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(ReadPly, BytesBehindTheLastElementAreIgnored)
{
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n\n1 0 0\n0 1 0\n3 0 1 2\n";
    EXPECT_EQ(read_ply("test.ply", text + "\nend of file\n").triangles, kOne);
}

// ---- OFF
// -----------------------------------------------------------------------------------------

TEST(ReadOff, TakesAllVariantsOfTheHeader)
{
    for (const char* header :
         {"OFF\n3 1 3\n", "OFF 3 1 3\n", "3 1 3\n", "OFF\n3 1\n",
          "# c\nOFF # c\n\n# c\n3 1 3 # c\n", "COFF\n3 1 0\n", "NOFF\n3 1 0\n", "STOFF\n3 1 0\n",
          "STCNOFF\n3 1 0\n", "CNOFF 3 1 0\n", "OFF\n3\n1\n0\n", "\xEF\xBB\xBFOFF\r\n3 1 0\r\n"}) {
        const Scene scene =
            read_off("test.off", std::string(header) + "0 0 0\n1 0 0 # c\n\n0 1 0\n3 0 1 2\n");
        EXPECT_EQ(scene.positions, kCorner) << header;
        EXPECT_EQ(scene.triangles, kOne) << header;
    }
}

TEST(ReadOff, ColoursNormalsAndTextureCoordinatesArePassedOver)
{
    const Scene scene = read_off("test.off",
                                 "STCNOFF\n3 3 0\n0 0 0 0 0 1 255 0 0 255 .5 .5\n1 0 0 0 0 1\n"
                                 "0 1 0 9 9 9\n3 0 1 2 255 0 0\n2 0 1\n1 2 0.5 0.5 0.5 1\n");
    EXPECT_EQ(scene.positions, kCorner);
    EXPECT_EQ(scene.triangles, kOne);
}

// ---- STL
// -----------------------------------------------------------------------------------------

std::string facet(const std::string& a, const std::string& b, const std::string& c)
{
    return "facet normal nan 0 0\n outer loop\n  vertex " + a + "\n  vertex " + b + "\n  vertex " +
           c + "\n endloop\nendfacet\n";
}

TEST(ReadStl, EqualCornersAreOneVertex)
{
    const Scene scene =
        read_stl("test.stl", "solid a name\n" + facet("0 0 0", "1 0 0", "0 1 0") +
                                 facet("-0 0 0", "1.0 0 0", "0 0 1") + "endsolid a name\n");
    EXPECT_EQ(scene.positions, (Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(scene.triangles, (Triangles{{0, 1, 2}, {0, 1, 3}}));
}

TEST(ReadStl, TakesSeveralSolidsEmptyOnesAndAnyCase)
{
    const std::string one = facet("0 0 0", "1 0 0", "0 1 0");
    std::string upper = one;
    std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
    const Scene scene = read_stl("test.stl", "solid\nendsolid\n\nSOLID B\r\n" + upper +
                                                 "EndSolid B\n  solid c\n" + one + "endsolid");
    EXPECT_EQ(scene.positions, kCorner);
    EXPECT_EQ(scene.triangles, (Triangles{{0, 1, 2}, {0, 1, 2}}));
}

TEST(ReadStl, ABinaryFileMayBeginWithTheWordSolid)
{
    NumberBytes data(false);
    data.add<std::uint32_t>({1});
    data.add<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0});
    data.add<std::uint16_t>({7});
    const std::string text_header = "solid made by a program that does not know better";
    for (const char fill : {' ', '\0'}) {
        std::string header = text_header;
        header.resize(80, fill);
        EXPECT_EQ(read_stl("test.stl", header + data.text).positions, kCorner);
    }
    std::string header = text_header;
    header.resize(80, '\0');
    EXPECT_EQ(read_stl("test.stl", header + data.text + "more").positions, kCorner);
}

// ---- models of the package assimp-testmodels
// -----------------------------------------------------

struct Model {
    const char* path;
    std::size_t vertices;
    std::size_t triangles;
};

class AssimpModel : public testing::TestWithParam<Model> {};

TEST_P(AssimpModel, IsReadWithItsOwnVertices)
{
    const std::filesystem::path path =
        std::filesystem::path("/usr/share/assimp/models") / GetParam().path;
    if (!std::filesystem::exists(path))
        GTEST_SKIP() << "package assimp-testmodels is not installed";
    const Scene scene = read_scene(path);
    EXPECT_EQ(scene.positions.size(), GetParam().vertices);
    EXPECT_EQ(scene.triangles.size(), GetParam().triangles);
}

constexpr Model kModels[] = {
    {"OBJ/WusonOBJ.obj", 2117, 3732},
    {"OBJ/box_longline.obj", 8, 944},
    {"OBJ/concave_polygon.obj", 64, 64},
    {"OBJ/cube_with_vertexcolors.obj", 8, 12},
    {"OBJ/regr01.obj", 2108, 2710},
    {"OBJ/spider.obj", 762, 1368},
    {"PLY/cube_binary.ply", 8, 12},
    {"PLY/cube_uv.ply", 24, 12},
    {"PLY/float-color.ply", 3, 1},
    {"OFF/Wuson.off", 3205, 3732},
    {"STL/Spider_ascii.stl", 722, 1368},
    {"STL/Spider_binary.stl", 722, 1368},
    {"STL/triangle_with_empty_solid.stl", 3, 1},
    {"STL/triangle_with_two_solids.stl", 6, 2},
};
INSTANTIATE_TEST_SUITE_P(All, AssimpModel, testing::ValuesIn(kModels), [](const auto& test) {
    std::string name = test.param.path;
    std::ranges::replace_if(
        name, [](unsigned char c) { return !std::isalnum(c); }, '_');
    return name;
});

}  // namespace
}  // namespace surfelao
