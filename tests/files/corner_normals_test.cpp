// The normals that OBJ, PLY and OFF give: which corner gets which, and what is refused.
#include "files/obj_io.h"
#include "files/off_io.h"
#include "files/ply_io.h"
#include "files/scene_io.h"
#include "files/stl_io.h"
#include "surfels/errors.h"
#include "temporary_folder.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace surfelao {
namespace {

using Normals = std::vector<glm::vec3>;
using Triangles = std::vector<glm::uvec3>;

constexpr std::uint32_t kNone = CornerNormals::kNone;

Scene obj(const std::string& text)
{
    return read_obj("test.obj", text);
}

std::string refusal_of_obj(const std::string& text)
{
    try {
        obj(text);
        return "was read";
    } catch (const InputError& error) {
        return error.what();
    }
}

/// The normal at each corner of a triangle; nan where there is none.
glm::vec3 corner_normal(const Scene& scene, std::size_t triangle, int corner)
{
    const CornerNormals& normals = scene.normals;
    const std::uint32_t index = normals.corners.empty() ? scene.triangles[triangle][corner]
                                                        : normals.corners[triangle][corner];
    return index == kNone ? glm::vec3(std::numeric_limits<float>::quiet_NaN())
                          : normals.values[index];
}

void expect_same_normals(const Scene& scene, const Scene& expected)
{
    EXPECT_EQ(scene.normals.values, expected.normals.values);
    EXPECT_EQ(scene.normals.corners, expected.normals.corners);
}

std::vector<Occlusion> open_answers(const Scene& scene)
{
    return std::vector<Occlusion>(scene.positions.size());
}

// ---- OBJ
// -----------------------------------------------------------------------------------------

// 8 vertices, 6 normals, 6 quads; vertex 1 + x + 2 y + 4 z
constexpr const char* kCubeObj =
    "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
    "vn -1 0 0\nvn 1 0 0\nvn 0 -1 0\nvn 0 1 0\nvn 0 0 -1\nvn 0 0 1\n"
    "f 1//1 5//1 7//1 3//1\nf 2//2 4//2 8//2 6//2\nf 1//3 2//3 6//3 5//3\n"
    "f 3/1/4 7/1/4 8/1/4 4/1/4\nf -8//-2 -6//-2 -5//-2 -7//-2\nf -4/-9/-1 -3/1/-1 -1//-1 7//6\n";

TEST(CornerNormalsOfObj, EveryCornerOfACubeHasTheNormalOfItsFace)
{
    const Scene scene = obj(kCubeObj);
    EXPECT_EQ(scene.normals.values.size(), 6u);
    ASSERT_EQ(scene.triangles.size(), 12u);
    ASSERT_EQ(scene.normals.corners.size(), 12u);
    for (std::size_t t = 0; t < 12; ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            // the face lies where its normal points
            const glm::vec3 normal = corner_normal(scene, t, corner);
            const glm::vec3 place(scene.positions[scene.triangles[t][corner]]);
            EXPECT_EQ(glm::dot(normal, place), 1.0f) << "triangle " << t;
            EXPECT_EQ(normal, corner_normal(scene, t, 0)) << "triangle " << t;
        }
    }
}

//  3---------2    corner 4 is reflex; vn n belongs to vertex 6 - n, so that a corner that is cut
//   \       /     at the wrong place is seen
//    4     /
//   /     /
//  0-----1        and a corner at the place of the one before it
TEST(CornerNormalsOfObj, GoWithTheCornersOfACutConcavePolygon)
{
    std::string text = "v 0 0 0\nv 3 0 0\nv 4 2 0\nv 0 2 0\nv 1 1 0\nv 1 1 0\n";
    for (int n = 1; n <= 6; ++n)
        text += "vn " + std::to_string(7 - n) + " 0 0\n";
    const Scene scene = obj(text + "f 1//6 2//5 3//4 4//3 5//2 6//1\n");
    ASSERT_EQ(scene.triangles.size(), 4u);
    ASSERT_EQ(scene.normals.corners.size(), 4u);
    for (std::size_t t = 0; t < 4; ++t) {
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_EQ(corner_normal(scene, t, corner).x,
                      static_cast<float>(scene.triangles[t][corner] + 1));
    }
}

TEST(CornerNormalsOfObj, NegativeNumbersCountFromTheLastNormalSoFar)
{
    const Scene scene =
        obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nvn 2 0 0\nf 1//-1 2//-2 3//-1\n"
            "vn 3 0 0\nf 1//-1 2//-3 3//4\nvn 4 0 0\n");
    EXPECT_EQ(scene.normals.corners, (Triangles{{1, 0, 1}, {2, 0, 3}}));
}

TEST(CornerNormalsOfObj, ACornerMayHaveNone)
{
    const Scene scene =
        obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\n"
            "f 1 2 3\nf 1// 2/1 3/1/\nf 1 2//1 3 4//1\nf 1 2 3\n");
    EXPECT_EQ(scene.normals.corners, (Triangles{{kNone, kNone, kNone},
                                                {kNone, kNone, kNone},
                                                {kNone, 0, kNone},
                                                {kNone, kNone, 0},
                                                {kNone, kNone, kNone}}));
}

TEST(CornerNormalsOfObj, NumberedAsTheVerticesAreTheyBelongToThese)
{
    const std::string text =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 1 0 0\nvn 2 0 0\nvn 3 0 0\nvn 4 0 0\n"
        "f 1//1 2//2 3//3 4//4\n";
    const Scene scene = obj(text);
    EXPECT_EQ(scene.normals.values, (Normals{{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}));
    EXPECT_TRUE(scene.normals.corners.empty());
    // one more of them, a corner without, a corner with another
    EXPECT_EQ(obj(text + "vn 5 0 0\n").normals.corners, (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(obj(text + "f 1//1 2 3//3\n").normals.corners[2], glm::uvec3(0, kNone, 2));
    EXPECT_EQ(obj(text + "f 1//1 2//2 3//1\n").normals.corners[2], glm::uvec3(0, 1, 0));
}

TEST(CornerNormalsOfObj, AreNotKeptWhereNoFaceUsesThem)
{
    const Scene scene = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nvn 2 0 0\nvn 3 0 0\nf 1 2 3\n");
    EXPECT_TRUE(scene.normals.empty());
    EXPECT_TRUE(scene.normals.corners.empty());
}

TEST(CornerNormalsOfObj, MayBeAnyNumbers)
{
    const Scene scene =
        obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn nan -nan(ind) inf\nvn 1e400 -1e400 1e-400\nvn 0 0 0 w\n"
            "f 1//1 2//2 3//3\n");
    const float infinity = std::numeric_limits<float>::infinity();
    ASSERT_EQ(scene.normals.values.size(), 3u);
    EXPECT_TRUE(std::isnan(scene.normals.values[0].x));
    EXPECT_TRUE(std::isnan(scene.normals.values[0].y));
    EXPECT_EQ(scene.normals.values[0].z, infinity);
    EXPECT_EQ(scene.normals.values[1], glm::vec3(infinity, -infinity, 0));
    EXPECT_EQ(scene.normals.values[2], glm::vec3(0));
}

TEST(CornerNormalsOfObj, OutOfRangeAreNoneAndCounted)
{
    const std::string corner = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 1\n";
    // 2^32 + 1: the last 32 bits are in range
    for (const char* lost : {"3", "7", "0", "-3", "4294967297"}) {
        const Scene scene = obj(corner + "f 1//1 2//" + lost + " 3//2\n");
        EXPECT_EQ(scene.normals.corners, (std::vector<glm::uvec3>{{0, CornerNormals::kNone, 1}}));
        EXPECT_EQ(scene.notes, std::vector<std::string>{"1 corner of faces with a normal that the "
                                                        "file does not have: taken as without"});
    }
}

TEST(CornerNormalsOfObj, ThatAreNoNumbersAreRefused)
{
    EXPECT_EQ(refusal_of_obj("vn 0 up 1\nv 0 0 0\n"), "test.obj: line 1: \"up\" is not a number");
    EXPECT_EQ(refusal_of_obj("v 0 0 0\nvn 0 1\n"),
              "test.obj: line 2: a coordinate of the normal is missing");
}

TEST(CornerNormalsOfObj, SurviveTheWriting)
{
    const Scene scene = obj(kCubeObj);
    expect_same_normals(obj(obj_contents("x.obj", scene, open_answers(scene)).contents), scene);
}

// ---- PLY
// -----------------------------------------------------------------------------------------

/// A triangle with these property lines and rows behind its x y z.
std::string ascii_ply(const std::string& properties, const std::string (&more)[3])
{
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\n" +
           properties +
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 " + more[0] +
           "\n1 0 0 " + more[1] + "\n0 1 0 " + more[2] + "\n3 0 1 2\n";
}

TEST(CornerNormalsOfPly, AreThoseOfTheVertices)
{
    const Scene scene =
        read_ply("test.ply", ascii_ply("property float nx\nproperty uchar red\nproperty double nz\n"
                                       "property short ny\n",
                                       {"1 255 3 2", "nan 255 1e400 -5", "0 255 0 0"}));
    ASSERT_EQ(scene.normals.values.size(), 3u);
    EXPECT_TRUE(scene.normals.corners.empty());
    EXPECT_EQ(scene.normals.values[0], glm::vec3(1, 2, 3));
    EXPECT_TRUE(std::isnan(scene.normals.values[1].x));
    EXPECT_EQ(scene.normals.values[1].y, -5.0f);
    EXPECT_EQ(scene.normals.values[1].z, std::numeric_limits<float>::infinity());
    EXPECT_EQ(scene.normals.values[2], glm::vec3(0));
}

TEST(CornerNormalsOfPly, NeedAllThreeAsScalars)
{
    const auto normals = [](const std::string& properties, const std::string& row) {
        return read_ply("test.ply", ascii_ply(properties, {row, row, row})).normals.values;
    };
    EXPECT_TRUE(normals("property float nx\nproperty float nz\n", "up 1").empty());
    EXPECT_TRUE(
        normals("property float nx\nproperty list uchar float ny\nproperty float nz\n", "1 2 3 4 1")
            .empty());
    EXPECT_THROW(normals("property float nx\nproperty float ny\nproperty float nz\n", "1 up 1"),
                 InputError);
}

template <class Value>
void append(std::string& text, Value value, bool big)
{
    append_bytes(text, value, big ? std::endian::big : std::endian::little);
}

TEST(CornerNormalsOfPly, AreReadInBothByteOrdersAndSurviveTheWriting)
{
    for (const bool big : {false, true}) {
        std::string text = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                           "_endian 1.0\nelement vertex 3\nproperty float nx\nproperty float x\n"
                           "property double ny\nproperty float y\nproperty float z\n"
                           "property short nz\nelement face 1\n"
                           "property list uchar int vertex_indices\nend_header\n";
        for (int v = 0; v < 3; ++v) {
            append(text, static_cast<float>(v) + 0.5f, big);
            append(text, v == 1 ? 1.0f : 0.0f, big);
            append(text, -0.25, big);
            append(text, v == 2 ? 1.0f : 0.0f, big);
            append(text, 0.0f, big);
            append(text, static_cast<std::int16_t>(300 - v), big);
        }
        text += '\3';
        for (const std::int32_t corner : {0, 1, 2})
            append(text, corner, big);
        const Scene scene = read_ply("test.ply", text);
        EXPECT_EQ(scene.normals.values,
                  (Normals{{0.5, -0.25, 300}, {1.5, -0.25, 299}, {2.5, -0.25, 298}}));
        EXPECT_TRUE(scene.normals.corners.empty());
        expect_same_normals(
            read_ply("test.ply", ply_contents("x.ply", scene, open_answers(scene)).contents),
            scene);
    }
}

TEST(CornerNormals, OfVerticesGoIntoOtherFormats)
{
    const TemporaryFolder folder;
    const Scene scene =
        read_ply("test.ply", ascii_ply("property float nx\nproperty float ny\nproperty float nz\n",
                                       {"1 0.5 2", "0 0 -1", "0 3 0"}));
    Scene without = scene;
    without.normals = {};
    for (const char* name : {"a.obj", "a.off"}) {
        write_scene(folder / name, scene, open_answers(scene));
        EXPECT_EQ(read_scene(folder / name).normals.values, scene.normals.values) << name;
        write_scene(folder / name, without, open_answers(scene));
        EXPECT_TRUE(read_scene(folder / name).normals.empty()) << name;
    }
    const Scene off = read_scene(folder.file("b.off",
                                             "NOFF 3 1 0\n0 0 0 1 0.5 2\n1 0 0 0 0 -1\n"
                                             "0 1 0 0 3 0\n3 0 1 2\n"));
    write_scene(folder / "a.ply", off, open_answers(off));
    EXPECT_EQ(read_scene(folder / "a.ply").normals.values, scene.normals.values);
}

// ---- OFF and STL
// ---------------------------------------------------------------------------------

TEST(CornerNormalsOfOff, FollowTheCoordinatesUnderN)
{
    const auto normals = [](const std::string& header) {
        return read_off("test.off", header +
                                        "\n3 1 0\n0 0 0 1 2 3 9 9 9\n1 0 0 4 5\n"
                                        "0 1 0 6 7 8\n3 0 1 2\n")
            .normals;
    };
    for (const char* header : {"NOFF", "CNOFF", "STCNOFF"}) {
        EXPECT_EQ(normals(header).values, (Normals{{1, 2, 3}, {0, 0, 0}, {6, 7, 8}})) << header;
        EXPECT_TRUE(normals(header).corners.empty()) << header;
    }
    for (const char* header : {"OFF", "COFF", "STCOFF"})
        EXPECT_TRUE(normals(header).empty()) << header;
}

TEST(CornerNormalsOfOff, MayBeNanOrMissing)
{
    const Scene scene = read_off("test.off", "NOFF 3 1 0\n0 0 0 nan 0 1\n1 0 0\n0 1 0\n3 0 1 2\n");
    ASSERT_EQ(scene.normals.values.size(), 3u);
    EXPECT_TRUE(std::isnan(scene.normals.values[0].x));
    EXPECT_TRUE(read_off("test.off", "NOFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").normals.empty());
}

TEST(FreeVertices, AreThoseOfStlAlone)
{
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
        "endfacet\n";
    std::string binary(80, ' ');
    append(binary, std::uint32_t{1}, false);
    for (const float value : {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0})
        append(binary, value, false);
    EXPECT_TRUE(read_stl("test.stl", "solid\n" + facet + "endsolid\n").free_vertices);
    EXPECT_TRUE(read_stl("test.stl", binary + "ab").free_vertices);
    EXPECT_FALSE(obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").free_vertices);
}

}  // namespace
}  // namespace surfelao
