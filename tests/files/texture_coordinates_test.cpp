// Where corners lie in a map, as the readers of all formats fill Scene::uvs.
#include "files/obj_io.h"
#include "files/off_io.h"
#include "files/ply_io.h"
#include "gltf_maker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace surfelao {
namespace {

using test::GltfMaker;
using test::primitive;
using Uvs = std::vector<glm::dvec2>;
using Triangles = std::vector<glm::uvec3>;

constexpr std::uint32_t kNone = UvSet::kNone;

/// v down.
const Uvs kSquareUvs{{0.25, 0}, {1, 0}, {1, 0.75}, {0.25, 0.5}};

Scene obj(const std::string& text)
{
    return read_obj("test.obj", text);
}

Scene gltf(const GltfMaker& maker)
{
    return read_gltf("made.glb", maker.glb());
}

/// The square with these properties of the vertices and of the face, in rows that begin so.
Scene ply(const std::string& vertex_properties, const std::vector<std::string>& vertices,
          const std::string& face_properties, const std::string& face)
{
    const std::string places[] = {" 0 0 0\n", " 1 0 0\n", " 1 1 0\n", " 0 1 0\n"};
    std::string text = "ply\nformat ascii 1.0\nelement vertex 4\n" + vertex_properties +
                       "property float x\nproperty float y\nproperty float z\nelement face 1\n" +
                       face_properties + "property list uchar int vertex_indices\nend_header\n";
    for (std::size_t v = 0; v < 4; ++v)
        text += vertices[v] + places[v];
    return read_ply("test.ply", text + face + " 4 0 1 2 3\n");
}

Scene ply_with(const std::string& u, const std::string& v)
{
    return ply("property double " + u + "\nproperty float " + v + '\n',
               {"0.25 1", "1 1", "1 0.25", "0.25 0.5"}, "", "");
}

template <class Component>
GltfMaker square_with(std::initializer_list<Component> numbers, const char* type = "VEC2")
{
    GltfMaker maker = test::square();
    const std::size_t dimension = type[3] - '0';
    const int uvs =
        maker.add_accessor(maker.add_view(test::bytes_of(numbers)),
                           test::component_type<Component>(), type, numbers.size() / dimension);
    maker.document["accessors"].back()["normalized"] = !std::is_same_v<Component, float>;
    primitive(maker)["attributes"]["TEXCOORD_0"] = uvs;
    return maker;
}

GltfMaker float_square()
{
    return square_with<float>({0.25, 0, 1, 0, 1, 0.75, 0.25, 0.5});
}

/// Of the corners in turn; nan where one has none.
Uvs at_corners(const Scene& scene, std::size_t set = 0)
{
    const UvSet& uvs = scene.uvs.at(set);
    Uvs places;
    for (const glm::uvec3 corners : uvs.corners.empty() ? scene.triangles : uvs.corners) {
        for (int k = 0; k < 3; ++k)
            places.push_back(corners[k] == kNone ? glm::dvec2(NAN) : uvs.values.at(corners[k]));
    }
    return places;
}

TEST(TextureCoordinates, OfASquareAreTheSameFromEveryFormat)
{
    const std::string face = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1 2/2 3/3 4/4\n";
    const struct {
        const char* name;
        std::function<Scene()> read;
    } rows[] = {
        {"OBJ", [&] { return obj(face + "vt .25 1\nvt 1 1 0\nvt 1 .25\nvt .25 .5 9 x\n"); }},
        {"PLY s t", [] { return ply_with("s", "t"); }},
        {"PLY u v", [] { return ply_with("u", "v"); }},
        {"PLY texture_u texture_v", [] { return ply_with("texture_u", "texture_v"); }},
        {"PLY texture_s texture_t", [] { return ply_with("texture_s", "texture_t"); }},
        {"PLY texcoord",
         [] {
             return ply("property float s\nproperty float t\n", {"9 9", "9 9", "9 9", "9 9"},
                        "property list uchar float texcoord\n", "8 .25 1 1 1 1 .25 .25 .5");
         }},
        {"STOFF",
         [] {
             return read_off("test.off",
                             "STNOFF 4 1 0\n0 0 0 0 0 1 .25 1\n1 0 0 0 0 1 9 9 9 1 1\n"
                             "1 1 0 0 0 1 1 .25\n0 1 0 0 0 1 9 9 9 9 .25 .5\n4 0 1 2 3\n");
         }},
        {"glTF", [] { return gltf(float_square()); }},
    };
    for (const auto& row : rows) {
        const Scene scene = row.read();
        ASSERT_EQ(scene.uvs.size(), 1u) << row.name;
        EXPECT_EQ(scene.uvs[0].values, kSquareUvs) << row.name;
        EXPECT_TRUE(scene.uvs[0].corners.empty()) << row.name;
        EXPECT_TRUE(scene.notes.empty()) << row.name;
        EXPECT_NO_THROW(check_scene(scene)) << row.name;
    }
}

TEST(TextureCoordinates, AreNoneWhereNoFaceUsesThemOrTheyAreNoPair)
{
    EXPECT_TRUE(obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1 2// 3\n").uvs.empty());
    EXPECT_TRUE(obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n").uvs.empty());
    EXPECT_TRUE(ply_with("s", "v").uvs.empty());
    EXPECT_TRUE(ply("", {"", "", "", ""}, "property list uchar float texcoord\n", "0").uvs.empty());
    EXPECT_TRUE(ply("", {"", "", "", ""}, "property float texcoord\n", "1").uvs.empty());
    EXPECT_TRUE(gltf(test::square()).uvs.empty());
}

TEST(TextureCoordinates, OfObjAreNumberedAsNormalsAre)
{
    const Scene scene =
        obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0.5 1\nvt 1\n"
            "f 1/-1 2/-2/1 3/3/1\nf 1 2//1 3/1\nf 1/2 2/2\nf 1 2 3\nvt nan inf\n"
            "f 1/4 2/0 3/-4\n");
    EXPECT_EQ(
        scene.uvs[0].corners,
        (Triangles{{1, 0, 2}, {kNone, kNone, 0}, {kNone, kNone, kNone}, {kNone, kNone, kNone}}));
    EXPECT_EQ(scene.normals.corners[0], glm::uvec3(kNone, 0, 0));
    EXPECT_EQ(scene.uvs[0].values[1], glm::dvec2(1, 1));
    EXPECT_TRUE(std::isnan(scene.uvs[0].values[2].x));
    EXPECT_EQ(scene.uvs[0].values[2].y, -HUGE_VAL);
    EXPECT_EQ(scene.notes.back(),
              "3 corners of faces with a texture coordinate that the file does not have: taken as "
              "without");
}

//  3---------2    corner 4 is reflex
//   \       /
//    4     /
//   /     /
//  0-----1
TEST(TextureCoordinates, GoWithTheCornersOfACutPolygon)
{
    const glm::dvec2 corners[] = {{0, 0}, {3, 0}, {4, 2}, {0, 2}, {1, 1}};
    std::string obj_text, obj_face = "f", ply_rows, ply_uvs = "10", ply_face = "5";
    for (int k = 4; k >= 0; --k) {  // vt in another order than v
        const auto text = [](double x) { return ' ' + std::to_string(x); };
        const glm::dvec2 v = corners[4 - k];
        obj_text += 'v' + text(v.x) + text(v.y) + " 0\n" + "vt" + text(corners[k].x) +
                    text(1 - corners[k].y) + '\n';
        obj_face += ' ' + std::to_string(5 - k) + '/' + std::to_string(k + 1);
        ply_rows += text(v.x) + text(v.y) + " 0\n";
        ply_uvs += text(v.x) + text(1 - v.y);
        ply_face += ' ' + std::to_string(4 - k);
    }
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement face 3\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nend_header\n";
    for (const Scene& scene :
         {obj(obj_text + obj_face + '\n'),
          read_ply("test.ply", header + ply_rows + "2 0 1 4 0 0 0 0\n" + ply_face + ' ' + ply_uvs +
                                   "\n3 0 1 2 0\n")}) {
        ASSERT_GE(scene.triangles.size(), 3u);
        const Uvs places = at_corners(scene);
        for (std::size_t i = 0; i < 9; ++i) {
            const glm::dvec3 position =
                scene.positions[scene.triangles[i / 3][static_cast<int>(i % 3)]];
            EXPECT_EQ(places[i], glm::dvec2(position));
        }
        for (std::size_t i = 9; i < places.size(); ++i)  // the face without
            EXPECT_TRUE(std::isnan(places[i].x));
    }
}

TEST(TextureCoordinates, OfGltfMayBeNormalisedAndNotFinite)
{
    const Uvs expected{{0, 1}, {1, 0}, {0.2, 0}, {0, 0}};
    for (const GltfMaker& maker :
         {square_with<std::uint8_t>({0, 255, 255, 0, 51, 0, 0, 0}),
          square_with<std::uint16_t>({0, 65535, 65535, 0, 13107, 0, 0, 0})})
        EXPECT_EQ(gltf(maker).uvs[0].values, expected);
    const Scene odd = gltf(square_with<float>({NAN, 0, HUGE_VALF, 0, 1, 1, 0, 0}));
    EXPECT_TRUE(std::isnan(odd.uvs[0].values[0].x));
    EXPECT_EQ(odd.uvs[0].values[1].x, HUGE_VAL);
}

TEST(TextureCoordinates, OfGltfBelongToThePrimitiveAlsoWhereVerticesAreShared)
{
    GltfMaker maker = float_square();
    const int other = maker.add_accessor(
        maker.add_view(test::bytes_of<float>({7, 0, 7, 1, 7, 2, 7, 3})), 5126, "VEC2", 4);
    nlohmann::json& primitives = maker.document["meshes"][0]["primitives"];
    for (int copy = 0; copy < 3; ++copy)
        primitives.push_back(primitive(maker));
    primitives[1]["attributes"]["TEXCOORD_0"] = other;
    primitives[2]["attributes"].erase("TEXCOORD_0");
    primitives[2]["attributes"]["TEXCOORD_2"] = other;
    primitives[2]["attributes"]["TEXCOORD_8"] = other;  // beyond those that are read
    // a second use, mirrored: its triangles are wound the other way
    maker.add("nodes", {{"mesh", 0}, {"scale", {-1, 1, 1}}});
    maker.document["scenes"][0]["nodes"] = {0, 1};

    const Scene scene = gltf(maker);
    ASSERT_EQ(scene.parts.size(), 2u);
    ASSERT_EQ(scene.uvs.size(), 3u);
    EXPECT_TRUE(scene.uvs[1].empty());
    EXPECT_TRUE(scene.uvs[1].corners.empty());
    EXPECT_EQ(scene.uvs[0].values.size(), 16u);
    EXPECT_NO_THROW(check_scene(scene));
    const Uvs first = at_corners(scene), third = at_corners(scene, 2);
    for (std::size_t i = 0; i < first.size(); ++i) {
        const std::uint32_t vertex =
            scene.triangles[i / 3][static_cast<int>(i % 3)] % 4;  // of the mesh
        const std::size_t p = i / 6 % 4;
        const glm::dvec2 in_other(7, vertex);
        const bool has_first = p != 2;
        EXPECT_EQ(std::isnan(first[i].x), !has_first) << i;
        EXPECT_EQ(std::isnan(third[i].x), has_first) << i;
        EXPECT_EQ(has_first ? first[i] : third[i], p == 0 || p == 3 ? kSquareUvs[vertex] : in_other)
            << i;
    }
    maker.document["meshes"][0]["primitives"] = nlohmann::json::array({primitive(float_square())});
    EXPECT_TRUE(gltf(maker).uvs[0].corners.empty()) << "two uses, a value for each vertex";
}

TEST(TextureCoordinates, ThatAnEarlierBakeHasAddedAreNone)
{
    GltfMaker maker = test::square();
    primitive(maker)["attributes"]["COLOR_0"] =
        maker.add_vectors<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0});
    const Scene scene = gltf(maker);
    const std::string baked = gltf_contents("x.glb", scene, std::vector<Occlusion>(4)).contents;
    ASSERT_NE(baked.find("TEXCOORD_0"), std::string::npos);
    EXPECT_TRUE(read_gltf("x.glb", baked).uvs.empty());
}

TEST(TextureCoordinates, OfGltfThatDoNotFitAreRefused)
{
    EXPECT_EQ(test::refusal(square_with<float>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3").glb()),
              "mesh 0 primitive 0 TEXCOORD_0 accessor 2 is not of type VEC2");
    EXPECT_EQ(test::refusal(square_with<float>({0, 0, 0, 0, 0, 0}).glb()),
              "mesh 0 primitive 0 TEXCOORD_0 accessor 2 has 3 elements for 4 vertices");
    // primitives with the same vertices and other coordinates each: the product of both
    GltfMaker maker = test::one_triangle();
    constexpr std::size_t kVertices = 1 << 16;
    const std::string zeros(12 * kVertices, '\0');
    const int view = maker.add_view(zeros);
    const int positions = maker.add_accessor(view, 5126, "VEC3", kVertices);
    const int indices = maker.add_indices<std::uint32_t>({0, 1, 2});
    nlohmann::json primitives;
    for (int copy = 0; copy < 600; ++copy)
        primitives.push_back(
            {{"indices", indices},
             {"attributes",
              {{"POSITION", positions},
               {"TEXCOORD_0", maker.add_accessor(view, 5126, "VEC2", kVertices)}}}});
    maker.document["meshes"][0]["primitives"] = primitives;
    EXPECT_NE(test::refusal(maker.glb()).find("texture coordinates, far more than"),
              std::string::npos);
}

}  // namespace
}  // namespace surfelao
