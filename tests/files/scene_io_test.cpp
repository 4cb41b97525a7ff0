#include "files/scene_io.h"

#include "files/mesh_source.h"
#include "surfels/errors.h"
#include "surfels/srgb.h"

#include "temporary_folder.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

// 0..3 a square, 4 unused; one face of four corners; texture and normal indices beside
constexpr const char* kSquareObj =
    "# square\nmtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\n"
    "vt 0 0\nvn 0 0 1\ng side\nf 1/1/1 2//1 3/1 4\n";

/// Plain numbers in the texts below; vertex_colors_test.cpp is about the others.
const WriteOptions kLinear{.encoding = Encoding::linear};

/// A different value for every vertex.
std::vector<Occlusion> ramp(std::size_t count)
{
    std::vector<Occlusion> occlusion(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(count);
        occlusion[i] = {t, glm::normalize(glm::vec3(t, 0.5f, -1.0f))};
    }
    return occlusion;
}

// ---- a second, simple reader of what was written
// -------------------------------------------------

/// The numbers of each vertex property of a PLY file, by name; scalar properties only.
std::map<std::string, std::vector<double>> vertex_properties(const fs::path& path)
{
    struct Element {
        std::string name;
        std::size_t count = 0;
        std::vector<std::pair<std::string, std::string>> columns;  // type, name
    };
    std::istringstream stream(contents_of(path));
    std::vector<Element> elements;
    std::string line, format;
    while (std::getline(stream, line) && line != "end_header") {
        std::istringstream words(line);
        std::string keyword, first, second;
        words >> keyword >> first >> second;
        if (keyword == "format")
            format = first;
        if (keyword == "element")
            elements.push_back({first, std::stoul(second), {}});
        if (keyword == "property")
            elements.back().columns.emplace_back(first, second);
    }
    const auto binary = [&](auto value) {
        char raw[sizeof(value)];
        stream.read(raw, sizeof(value));
        if (format == "binary_big_endian")
            std::reverse(raw, raw + sizeof(value));
        std::memcpy(&value, raw, sizeof(value));
        return static_cast<double>(value);
    };
    const auto number = [&](const std::string& type) {
        if (format == "ascii") {
            double value = 0.0;
            stream >> value;
            return value;
        }
        return type == "float"    ? binary(float{})
               : type == "double" ? binary(double{})
               : type == "uchar"  ? binary(std::uint8_t{})
                                  : binary(std::int32_t{});
    };
    std::map<std::string, std::vector<double>> values;
    for (const Element& element : elements) {
        for (std::size_t row = 0; row < element.count; ++row) {
            for (const auto& [type, name] : element.columns)
                values[name].push_back(number(type));
        }
        if (element.name == "vertex")
            break;
    }
    return values;
}

void expect_attributes(const fs::path& path, const std::vector<Occlusion>& occlusion)
{
    const auto values = vertex_properties(path);
    for (const char* name :
         {"occlusion", "bent_nx", "bent_ny", "bent_nz", "red", "green", "blue"}) {
        ASSERT_TRUE(values.contains(name)) << name << " in " << path;
        ASSERT_EQ(values.at(name).size(), occlusion.size()) << name << " in " << path;
    }
    for (std::size_t v = 0; v < occlusion.size(); ++v) {
        EXPECT_EQ(static_cast<float>(values.at("occlusion")[v]), occlusion[v].occlusion);
        EXPECT_EQ(static_cast<float>(values.at("bent_nx")[v]), occlusion[v].bent_normal.x);
        EXPECT_EQ(static_cast<float>(values.at("bent_ny")[v]), occlusion[v].bent_normal.y);
        EXPECT_EQ(static_cast<float>(values.at("bent_nz")[v]), occlusion[v].bent_normal.z);
        const double grey = std::round(255.0f * srgb_encode(1.0f - occlusion[v].occlusion));
        for (const char* channel : {"red", "green", "blue"})
            EXPECT_EQ(values.at(channel)[v], grey) << channel << " of vertex " << v;
    }
}

// ---- round trips
// ---------------------------------------------------------------------------------

TEST(SceneIo, ObjKeepsItsOwnTextExceptForVertexColours)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("square.obj", kSquareObj));
    EXPECT_EQ(scene.name, "square.obj");
    EXPECT_EQ(scene.positions.size(), 5u);
    EXPECT_EQ(scene.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    write_scene(folder / "out.obj", scene, ramp(5), kLinear);
    EXPECT_EQ(contents_of(folder / "out.obj"),
              "# square\nmtllib none.mtl\nv 0 0 0 1.000000 1.000000 1.000000\n"
              "v 1 0 0 0.800000 0.800000 0.800000\nv 1 1 0 0.600000 0.600000 0.600000\n"
              "v 0 1 0 0.400000 0.400000 0.400000\nv 5 5 5 0.200000 0.200000 0.200000\n"
              "vt 0 0\nvn 0 0 1\ng side\nf 1/1/1 2//1 3/1 4\n");
}

// Weights go; comments, continued lines and line ends stay.
TEST(SceneIo, ObjVertexLinesAreReplacedWhateverTheyLookLike)
{
    const TemporaryFolder folder;
    const Scene scene =
        read_scene(folder.file("odd.obj",
                               "\xEF\xBB\xBFv 0 0 0 # origin\r\n"
                               "v 1 \\\r\n0 0 2\\\r\n\r\n  v\t0 1.50 0\r\nf 1 2 3"));
    write_scene(folder / "out.obj", scene, ramp(3), kLinear);
    EXPECT_EQ(contents_of(folder / "out.obj"),
              "\xEF\xBB\xBFv 0 0 0 1.000000 1.000000 1.000000 # origin\r\n"
              "v 1 \\\r\n0 0 0.666667 0.666667 0.666667\r\n  v\t0 1.50 0 0.333333 0.333333 "
              "0.333333\r\nf 1 2 3");
    EXPECT_EQ(read_scene(folder / "out.obj").positions, scene.positions);
}

TEST(SceneIo, PolygonsSurviveInEveryFormat)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("square.obj", kSquareObj));
    for (const char* name : {"out.ply", "out.off", "out.obj"}) {
        write_scene(folder / name, scene, ramp(5));
        const Scene again = read_scene(folder / name);
        EXPECT_EQ(again.positions, scene.positions) << name;
        EXPECT_EQ(again.triangles, scene.triangles) << name;
        EXPECT_EQ(face_count(again), 1u) << name;
    }
    expect_attributes(folder / "out.ply", ramp(5));
}

TEST(SceneIo, OffHasGreyVertices)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("square.obj", kSquareObj));
    write_scene(folder / "out.off", scene, ramp(5), kLinear);
    EXPECT_EQ(contents_of(folder / "out.off"),
              "COFF\n5 1 0\n0 0 0 255 255 255 255\n1 0 0 204 204 204 255\n1 1 0 153 153 153 255\n"
              "0 1 0 102 102 102 255\n5 5 5 51 51 51 255\n4 0 1 2 3\n");
}

TEST(SceneIo, StlIsWrittenAsPly)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(
        folder.file("one.stl",
                    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0.1 0 0\nvertex 1 0 0\n"
                    "vertex 0 1 0\nendloop\nendfacet\nendsolid\n"));
    write_scene(folder / "out.ply", scene, ramp(3));
    EXPECT_EQ(read_scene(folder / "out.ply").triangles, scene.triangles);
    expect_attributes(folder / "out.ply", ramp(3));
}

/// Of a PLY file with other things in it, of which only the vertex rows may change.
std::string rich_header(const std::string& format)
{
    return "ply\nformat " + format +
           " 1.0\ncomment kept\nelement camera 1\nproperty int id\n"
           "element vertex 3\nproperty double x\nproperty double y\nproperty float occlusion\n"
           "comment between\nproperty double z\nproperty uchar red\nproperty int tag\n"
           "element face 1\nproperty list uchar int vertex_indices\nproperty float quality\n"
           "end_header\n";
}

TEST(SceneIo, AsciiPlyKeepsEverythingElse)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(
        folder.file("in.ply", rich_header("ascii") +
                                  "77\n0.1 0 0.25 0 9 -5\n1 0 0.25 0  9 -6\n\n0 1 0.25 0 9 -7\n"
                                  "3 0 1 2 0.5\nbehind the end\n"));
    const std::vector<Occlusion> occlusion(3, {0.25f, {0, 1, 0}});
    write_scene(folder / "out.ply", scene, occlusion);
    EXPECT_EQ(contents_of(folder / "out.ply"),
              "ply\nformat ascii 1.0\ncomment kept\nelement camera 1\nproperty int id\n"
              "element vertex 3\nproperty double x\nproperty double y\n"
              "comment between\nproperty double z\nproperty int tag\n"
              "property float occlusion\nproperty float bent_nx\nproperty float bent_ny\n"
              "property float bent_nz\nproperty uchar red\nproperty uchar green\n"
              "property uchar blue\n"
              "element face 1\nproperty list uchar int vertex_indices\nproperty float quality\n"
              "end_header\n77\n0.1 0 0 -5 0.25 0 1 0 225 225 225\n1 0 0 -6 0.25 0 1 0 225 225 225\n"
              "\n0 1 0 -7 0.25 0 1 0 225 225 225\n3 0 1 2 0.5\nbehind the end\n");
    expect_attributes(folder / "out.ply", occlusion);
}

TEST(SceneIo, BinaryPlyKeepsEverythingElseInItsByteOrder)
{
    const TemporaryFolder folder;
    for (const bool big : {false, true}) {
        const auto number = [big](auto value) {
            char raw[sizeof(value)];
            std::memcpy(raw, &value, sizeof(value));
            if (big)
                std::reverse(raw, raw + sizeof(value));
            return std::string(raw, sizeof(value));
        };
        const std::string header = rich_header(big ? "binary_big_endian" : "binary_little_endian");
        std::string rows = number(std::int32_t{77});
        for (int v = 0; v < 3; ++v)
            rows += number(v == 1 ? 1.1 : 0.0) + number(v == 2 ? 1.1 : 0.0) + number(0.25f) +
                    number(0.0) + "\x09" + number(std::int32_t{-5});
        const std::string rest = "\x03" + number(std::int32_t{0}) + number(std::int32_t{1}) +
                                 number(std::int32_t{2}) + number(0.5f) + "behind the end";
        const Scene scene = read_scene(folder.file("in.ply", header + rows + rest));
        write_scene(folder / "out.ply", scene, ramp(3));

        expect_attributes(folder / "out.ply", ramp(3));
        const auto values = vertex_properties(folder / "out.ply");
        EXPECT_EQ(values.at("tag"), (std::vector<double>{-5, -5, -5}));
        EXPECT_EQ(values.at("y"), (std::vector<double>{0, 0, 1.1}));
        EXPECT_TRUE(contents_of(folder / "out.ply").ends_with(rest));
        const Scene again = read_scene(folder / "out.ply");
        EXPECT_EQ(again.positions, scene.positions);
        EXPECT_EQ(again.triangles, scene.triangles);

        // once more: the properties are replaced, not added
        write_scene(folder / "twice.ply", again, ramp(3));
        EXPECT_EQ(contents_of(folder / "twice.ply"), contents_of(folder / "out.ply"));
    }
}

TEST(SceneIo, PlyCoordinatesAreDoubleWhereFloatWouldMoveThem)
{
    const TemporaryFolder folder;
    const auto types = [&](const std::string& offset) {
        const Scene scene =
            read_scene(folder.file("in.obj", "v " + offset + ".1 0 0\nv " + offset + ".9 0 0\nv " +
                                                 offset + ".1 1 0\nf 1 2 3\n"));
        write_scene(folder / "out.ply", scene, ramp(3));
        const Scene again = read_scene(folder / "out.ply");
        for (std::size_t v = 0; v < 3; ++v)
            EXPECT_LE(glm::distance(again.positions[v], scene.positions[v]), 2e-7) << offset;
        return contents_of(folder / "out.ply").find("property double x") != std::string::npos;
    };
    EXPECT_FALSE(types("0"));
    EXPECT_TRUE(types("1000000"));
}

TEST(SceneIo, PolygonsWithManyCornersGetALongerCount)
{
    const TemporaryFolder folder;
    std::ostringstream text;
    for (int i = 0; i < 300; ++i)
        text << "v " << std::cos(i * 0.02) << ' ' << std::sin(i * 0.02) << " 0\n";
    text << 'f';
    for (int i = 1; i <= 300; ++i)
        text << ' ' << i;
    const Scene scene = read_scene(folder.file("disc.obj", text.str()));
    write_scene(folder / "disc.ply", scene, ramp(300));
    EXPECT_EQ(read_scene(folder / "disc.ply").triangles.size(), 298u);
    EXPECT_EQ(face_count(read_scene(folder / "disc.ply")), 1u);
}

// ---- refusals
// ------------------------------------------------------------------------------------

TEST(SceneIo, ExtensionsAreKnownInAnyCase)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("SQUARE.OBJ", kSquareObj));
    write_scene(folder / "OUT.Ply", scene, ramp(5));
    EXPECT_EQ(read_scene(folder / "OUT.Ply").positions.size(), 5u);
}

TEST(SceneIo, OutputsThatCannotBeAreRefusedBeforehand)
{
    const TemporaryFolder folder;
    const auto sentence = [&](const std::string& input, const std::string& output) {
        try {
            check_output(folder / input, folder / output);
        } catch (const InputError& error) {
            return std::string(error.what()).substr((folder / output).string().size());
        }
        return std::string("allowed");
    };
    EXPECT_EQ(sentence("a.obj", "b.stl"), ": STL has no place for occlusion, use .ply");
    EXPECT_EQ(sentence("a.obj", "b.fbx"),
              ": such files are read, not written, use .ply, .obj or .glb");
    EXPECT_EQ(sentence("a.obj", "b.usd"),
              ": the extension .usd is not known, only .ply .obj .off .gltf .glb .pcd .xyz .pts "
              ".txt .asc");
    EXPECT_EQ(sentence("a.obj", "b"),
              ": a file without extension is not known, only .ply .obj .off .gltf .glb .pcd .xyz "
              ".pts .txt .asc");
    EXPECT_EQ(sentence("a.xyz", "b.glb"), ": points alone are not written as glTF, use .ply");
    EXPECT_NE(sentence("a.obj", "missing/b.ply").find("does not exist"), std::string::npos);
    EXPECT_EQ(sentence("a.obj", "b.ply"), "allowed");
    EXPECT_EQ(sentence("a.gltf", "b.GLB"), "allowed");
    EXPECT_EQ(sentence("a.glb", "b.off"), "allowed");
    EXPECT_EQ(sentence("a.stl", "b.glb"), "allowed");
}

TEST(SceneIo, AFailedWriteLeavesNothing)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("square.obj", kSquareObj));
    fs::create_directories(folder / "folder.ply");
    EXPECT_THROW(write_scene(folder / "folder.ply", scene, ramp(5)), InputError);
    EXPECT_THROW(write_scene(folder / "out.stl", scene, ramp(5)), InputError);
    EXPECT_THROW(write_scene(folder / "missing/out.ply", scene, ramp(5)), InputError);
    EXPECT_EQ(folder.file_count(), 2);
}

TEST(SceneIo, AnotherNumberOfAnswersThanVerticesIsRefused)
{
    const TemporaryFolder folder;
    Scene scene = read_scene(folder.file("square.obj", kSquareObj));
    EXPECT_THROW(write_scene(folder / "out.ply", scene, ramp(4)), SettingsError);
    scene.positions.pop_back();  // no longer as it was read
    EXPECT_THROW(write_scene(folder / "out.ply", scene, ramp(4)), InputError);
    EXPECT_FALSE(fs::exists(folder / "out.ply"));
}

}  // namespace
}  // namespace surfelao
