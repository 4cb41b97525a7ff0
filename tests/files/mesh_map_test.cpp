// A map of occlusion in an OBJ or PLY result: over the file's own coordinates and over new ones.
#include "gltf_maker.h"
#include "temporary_folder.h"

#include "files/maker_mark.h"
#include "files/mesh_source.h"
#include "files/obj_io.h"
#include "files/ply_io.h"
#include "files/scene_io.h"
#include "files/sidecars.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using Notes = std::vector<std::string>;

/// Two squares, a triangle and a pentagon; normals, coordinates, two materials and none at first.
constexpr const char* kFacesObj =
    "# faces\nmtllib wood.mtl\nv 0 0 0 0.5 0.25 1\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0.5\n"
    "v 0 2 0\nv 1 2 0\nv 2 2 0\nv 1 3 0\nvn 0 0 1\nvn 0 1 0\nvt 0 0\nvt 1 0\n"
    "f 1//1 2//2 5//1 4//1 # plain\nusemtl wood\ng side\nf -8/1/1 -7/2/2 -4/1/1 -5/2/1\n"
    "usemtl grass\nf 4 5 7\nf 5/1 6 9 10 8\nl 1/1 2/2\n";

constexpr const char* kFacesPly =
    "ply\nformat ascii 1.0\ncomment hello\nelement face 4\nproperty uchar material\n"
    "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
    "property float weight\nelement vertex 10\nproperty float x\nproperty float y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "property uchar flags\nend_header\n"
    "7 4 0 1 4 3 0 .5\n8 4 1 2 5 4 0 .25\n9 2 4 5 0 1\n10 5 4 5 8 9 7 0 2\n"
    "0 0 0 0 0 1 1\n1 0 0 0 1 0 2\n2 0 0 1 0 0 3\n0 1 0 0 0 1 4\n1 1 0 0 0 1 5\n2 1 .5 0 0 1 6\n"
    "0 2 0 0 0 1 7\n1 2 0 0 0 1 8\n2 2 0 0 0 1 9\n1 3 0 0 0 1 10\n";

constexpr const char* kFacesOff = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

constexpr const char* kFacesStl =
    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\n"
    "endfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid\n";

/// The ascii file in binary.
std::string big_endian_ply()
{
    std::string text =
        "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 2\nproperty list uchar ushort vertex_indices\n"
        "property double area\nend_header\n";
    for (const float number : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f})
        append_bytes(text, number, std::endian::big);
    for (const std::uint16_t last : {std::uint16_t{3}, std::uint16_t{2}}) {
        const bool is_square = last == 3;
        text += is_square ? '\4' : '\3';
        for (const std::uint16_t v : {std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{2}})
            append_bytes(text, v, std::endian::big);
        if (is_square)
            append_bytes(text, last, std::endian::big);
        append_bytes(text, 0.5, std::endian::big);
    }
    return text;
}

OcclusionMap map_with(std::optional<UvSet> uvs)
{
    return {"a picture", 0, std::move(uvs)};
}

/// A place for each vertex.
UvSet whole(const Scene& scene)
{
    UvSet uvs;
    for (std::size_t v = 0; v < scene.positions.size(); ++v)
        uvs.values.emplace_back(static_cast<double>(v) / 64.0, 0.25);
    return uvs;
}

/// A place for each corner of a triangle.
UvSet apart(const Scene& scene)
{
    UvSet uvs;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        uvs.corners.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
        for (std::uint32_t k = 0; k < 3; ++k)
            uvs.values.emplace_back(t / 64.0, 0.125 * k);
    }
    return uvs;
}

const WriteOptions kBaked{.mark = make_mark("bake", "engine=masks at=texels")};

std::optional<glm::vec3> normal_of(const Scene& scene, std::size_t t, int k)
{
    if (scene.normals.empty())
        return {};
    const glm::uvec3 at =
        (scene.normals.corners.empty() ? scene.triangles : scene.normals.corners)[t];
    return at[k] == CornerNormals::kNone ? std::nullopt
                                         : std::optional(scene.normals.values[at[k]]);
}

std::optional<glm::dvec2> place_of(const Scene& scene, const UvSet& uvs, std::size_t t, int k)
{
    const std::uint32_t at = (uvs.corners.empty() ? scene.triangles : uvs.corners)[t][k];
    return at == UvSet::kNone ? std::nullopt : std::optional(uvs.values.at(at));
}

TEST(MeshMap, EveryCornerHasItsPlaceAndAllElseThatItHad)
{
    const TemporaryFolder folder;
    test::GltfMaker glb = test::square();
    const std::map<std::string, std::string> inputs = {
        {"in.obj", kFacesObj}, {"in.ply", kFacesPly}, {"big.ply", big_endian_ply()},
        {"in.off", kFacesOff}, {"in.stl", kFacesStl}, {"in.glb", glb.glb()}};
    for (const auto& [name, contents] : inputs) {
        const Scene scene = read_scene(folder.file(name, contents));
        const fs::path in = name;
        for (const char* out : {"obj.obj", "ply.ply"}) {
            for (const bool is_whole : {true, false}) {
                const UvSet asked = is_whole ? whole(scene) : apart(scene);
                write_scene_with_map(folder / out, scene, map_with(asked), kBaked);
                const Scene again = read_scene(folder / out);
                const std::string what = name + " to " + out;
                EXPECT_EQ(again.positions, scene.positions) << what;
                EXPECT_EQ(again.triangles, scene.triangles) << what;
                ASSERT_EQ(again.uvs.size(), 1u) << what;
                // polygons stay where they can
                const bool stay = is_whole && std::string(out) == "obj.obj";
                EXPECT_EQ(face_count(again), stay ? face_count(scene) : scene.triangles.size())
                    << what;
                const bool keeps_normals = in.extension() == fs::path(out).extension();
                for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
                    for (int k = 0; k < 3; ++k) {
                        const auto place = place_of(scene, asked, t, k);
                        EXPECT_EQ(place_of(again, again.uvs[0], t, k), place) << what << t;
                        EXPECT_EQ(normal_of(again, t, k),
                                  keeps_normals ? normal_of(scene, t, k) : std::nullopt)
                            << what << t;
                    }
                }
                EXPECT_EQ(contents_of(*map_file_of(folder / out)), "a picture");
            }
        }
    }
}

constexpr const char* kHead = "# surfelao: materials with a map of occlusion\n";

TEST(MeshMap, AnObjIsItsOwnTextWithNewCoordinatesAndMaterials)
{
    const TemporaryFolder folder;
    fs::create_directory(folder / "there");
    folder.file("bark.png", "");
    folder.file("wood.mtl",
                "newmtl wood\r\nKd 1 0 0\r\n map_Ka old.png\r\nmap_Kd -s 1 1 1 bark.png\r\n"
                "bump gone.png");
    const Scene scene = read_scene(folder.file("in.obj", kFacesObj));
    UvSet uvs = whole(scene);
    uvs.corners = scene.triangles;
    uvs.corners[4] = glm::uvec3(UvSet::kNone);
    EXPECT_EQ(write_scene_with_map(folder / "there/out.obj", scene, map_with(uvs)),
              (Notes{"new texture coordinates take the place of the file's",
                     "the map takes the place of the map_Ka of 1 material",
                     "named in the file and not found: \"gone.png\""}));
    std::string vt;
    for (const char* u : {"0", "0.015625", "0.03125", "0.046875", "0.0625", "0.078125", "0.09375",
                          "0.109375", "0.125", "0.140625"})
        vt += std::string("vt ") + u + " 0.75\n";
    EXPECT_EQ(contents_of(folder / "there/out.obj"),
              "mtllib out.ao.mtl\n# faces\nv 0 0 0 0.5 0.25 1\nv 1 0 0\nv 2 0 0\nv 0 1 0\n"
              "v 1 1 0\nv 2 1 0.5\nv 0 2 0\nv 1 2 0\nv 2 2 0\nv 1 3 0\nvn 0 0 1\nvn 0 1 0\n" +
                  vt +
                  "usemtl surfelao_plain\nf 1/1/1 2/2/2 5/5/1 4/4/1 # plain\nusemtl wood\n"
                  "g side\nf -8/3/1 -7/4/2 -4/7/1 -5/6/1\nusemtl grass\nf 4 5 7\n"
                  "f 5/5 6/6 9/9 10/10 8/8\nl 1 2\n");
    EXPECT_EQ(contents_of(folder / "there/out.ao.mtl"),
              std::string(kHead) +
                  "newmtl wood\r\nmap_Ka out.ao.png\r\nKd 1 0 0\r\nmap_Kd -s 1 1 1 ../bark.png\r\n"
                  "bump gone.png\nnewmtl surfelao_plain\nKa 1 1 1\nKd 1 1 1\nmap_Ka out.ao.png\n"
                  "newmtl grass\nKa 1 1 1\nKd 1 1 1\nmap_Ka out.ao.png\n");
    const std::vector<fs::path> beside = sidecars_of(folder / "there/out.obj");
    EXPECT_NE(std::ranges::find(beside, folder / "there/out.ao.png"), beside.end());
}

TEST(MeshMap, OverTheOwnCoordinatesTheFacesStay)
{
    const TemporaryFolder folder;
    const Scene obj = read_scene(folder.file("in.obj", kFacesObj));
    write_scene_with_map(folder / "out.obj", obj, map_with({}), kBaked);
    const std::string text = contents_of(folder / "out.obj");
    const std::string faces =
        "vt 0 0\nvt 1 0\nusemtl surfelao_plain\nf 1//1 2//2 5//1 4//1 # plain\nusemtl wood\n"
        "g side\nf -8/1/1 -7/2/2 -4/1/1 -5/2/1\nusemtl grass\nf 4 5 7\nf 5/1 6 9 10 8\nl 1/1 2/2\n";
    EXPECT_TRUE(text.ends_with(faces)) << text;

    std::string textured = kFacesPly;
    textured.replace(textured.find("4 3 0 .5"), 8, "4 3 8 0 0 1 0 1 1 0 1 .5");
    std::string wanted = textured;
    textured.replace(textured.find("hello"), 5, "TextureFile wood.png");
    folder.file("wood.png", "");
    const Scene ply = read_scene(folder.file("in.ply", textured));
    EXPECT_EQ(write_scene_with_map(folder / "ply.ply", ply, map_with({}), kBaked),
              Notes{"the map takes the place of 1 texture that the file names"});
    wanted.replace(wanted.find("comment hello"), 13,
                   "comment " + kBaked.mark + "\ncomment TextureFile ply.ao.png");
    EXPECT_EQ(contents_of(folder / "ply.ply"), wanted);

    // again and again it is the same
    for (const char* name : {"out.obj", "ply.ply"}) {
        const std::string once = contents_of(folder / name);
        EXPECT_EQ(
            write_scene_with_map(folder / name, read_scene(folder / name), map_with({}), kBaked),
            Notes{});
        EXPECT_EQ(contents_of(folder / name), once);
    }
}

TEST(MeshMap, APlyKeepsItsOtherProperties)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("in.ply", kFacesPly));
    UvSet uvs = whole(scene);
    uvs.corners = scene.triangles;
    uvs.values.emplace_back(0.5, 0.5);
    uvs.corners[1].x = 10;  // the first square comes apart
    uvs.corners[2] = uvs.corners[3] = glm::uvec3(UvSet::kNone);
    write_scene_with_map(folder / "out.ply", scene, map_with(uvs));
    const std::string text = contents_of(folder / "out.ply");
    EXPECT_TRUE(text.starts_with(
        "ply\nformat ascii 1.0\ncomment TextureFile out.ao.png\ncomment hello\nelement face 8\n"
        "property uchar material\nproperty list uchar int vertex_indices\nproperty float weight\n"
        "property list uchar float texcoord\nelement vertex 10\n"))
        << text;
    EXPECT_NE(text.find("end_header\n"
                        "7 3 0 1 4 .5 6 0 0.75 0.015625 0.75 0.0625 0.75\n"
                        "7 3 0 4 3 .5 6 0.5 0.5 0.0625 0.75 0.046875 0.75\n"
                        "8 3 1 2 5 .25 0\n"
                        "8 3 1 5 4 .25 0\n"
                        "9 2 4 5 1 0\n"),
              std::string::npos)
        << text;
    EXPECT_TRUE(text.ends_with("1 3 0 0 0 1 10\n"));
}

std::string refusal_of(const TemporaryFolder& folder, const char* name, const Scene& scene,
                       const OcclusionMap& map)
{
    try {
        static_cast<void>(write_scene_with_map(folder / name, scene, map, kBaked));
    } catch (const InputError& error) {
        return std::string(error.what()).substr(folder.path().string().size() + 1);
    }
    return "";
}

TEST(MeshMap, FilesOfTheUserAreNotReplaced)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("in.obj", kFacesObj));
    const OcclusionMap map = map_with(whole(scene));
    for (const char* name : {"ours.obj", "ours.ply"}) {
        EXPECT_EQ(refusal_of(folder, name, scene, map), "");
        fs::copy_file(folder / "ours.ao.png", folder / (std::string("kept.") + name));
        EXPECT_EQ(refusal_of(folder, name, scene, map), "");
        fs::remove(folder / "ours.ao.png");
    }
    for (const char* other : {"own.ao.png", "own.ao.mtl"}) {
        folder.file(other, "mine");
        EXPECT_EQ(refusal_of(folder, "own.obj", scene, map),
                  std::string(other) +
                      ": exists and is of no result at own.obj, which would "
                      "replace it");
        EXPECT_EQ(contents_of(folder / other), "mine");
        fs::remove(folder / other);
    }
    folder.file("own.ao.png", "mine");
    folder.file("own.ply",
                "ply\nformat ascii 1.0\ncomment TextureFile own.ao.png\nelement vertex 3\n");
    EXPECT_EQ(refusal_of(folder, "own.ply", scene, map),
              "own.ao.png: exists and is of no result at own.ply, which would replace it");
}

TEST(MeshMap, WhatCannotBeWrittenLeavesNothing)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("in.stl", kFacesStl));
    EXPECT_EQ(refusal_of(folder, "out.ply", scene, map_with({})),
              "out.ply: the mesh has no texture coordinates 0, which a map is to lie over");
    EXPECT_EQ(refusal_of(folder, "out.off", scene, map_with(whole(scene))),
              "out.off: a map goes into .glb, .gltf, .obj and .ply only, use .png, .tif or .exr "
              "for the map alone");
    UvSet few = whole(scene), odd = whole(scene), far = apart(scene);
    few.values.pop_back();
    odd.values[0].x = std::numeric_limits<double>::infinity();
    far.corners[0].x = 99;
    for (const char* name : {"out.obj", "out.ply"}) {
        for (const UvSet& uvs : {few, odd, far})
            EXPECT_THROW(write_scene_with_map(folder / name, scene, map_with(uvs)), SettingsError);
    }
    fs::create_directory(folder / "out.ply");  // the mesh cannot be there
    EXPECT_THROW(write_scene_with_map(folder / "out.ply", scene, map_with(whole(scene))),
                 InputError);
    EXPECT_EQ(folder.file_count(), 2);
    EXPECT_EQ(map_file_of("a/b.obj"), "a/b.ao.png");
    EXPECT_EQ(map_materials_of("a/b.obj"), "a/b.ao.mtl");
    EXPECT_EQ(map_materials_of("a/b.ply"), std::nullopt);
}

}  // namespace
}  // namespace surfelao
