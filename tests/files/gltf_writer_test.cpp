#include "gltf_maker.h"
#include "temporary_folder.h"

#include "files/gltf_io.h"
#include "files/gltf_uri.h"
#include "files/scene_io.h"
#include "surfels/errors.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <gtest/gtest.h>

#include <cstdlib>

namespace surfelao {
namespace {

using nlohmann::json;
using test::bytes_of;
using test::GltfMaker;
using test::kTriangleUri;
using test::one_triangle;
using test::square;

/// Written bytes taken apart: an independent way to look at them.
struct Written {
    json document;
    std::string bin;  ///< of a .glb, or of the last buffer's data URI

    std::vector<float> floats(const json& attribute) const
    {
        const json& accessor = document["accessors"][attribute.get<std::size_t>()];
        const json& view = document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        const std::size_t dimension = accessor["type"] == "SCALAR" ? 1
                                      : accessor["type"] == "VEC3" ? 3
                                                                   : 4;
        std::vector<float> values(accessor["count"].get<std::size_t>() * dimension);
        const std::size_t at =
            view["byteOffset"].get<std::size_t>() + accessor["byteOffset"].get<std::size_t>();
        EXPECT_LE(at + values.size() * sizeof(float), bin.size());
        std::memcpy(values.data(), bin.data() + at, values.size() * sizeof(float));
        return values;
    }

    const json& attributes(std::size_t mesh, std::size_t primitive = 0) const
    {
        return document["meshes"][mesh]["primitives"][primitive]["attributes"];
    }
};

std::uint32_t number_at(const std::string& bytes, std::size_t offset)
{
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

Written take_apart(const std::string& bytes)
{
    Written written;
    if (!bytes.starts_with("glTF")) {
        written.document = json::parse(bytes);
        const std::string& uri = written.document["buffers"].back()["uri"].get_ref<std::string&>();
        written.bin = decode_data_uri(uri).value_or("");
        return written;
    }
    EXPECT_EQ(number_at(bytes, 8), bytes.size());
    const std::size_t text_size = number_at(bytes, 12);
    EXPECT_EQ(text_size % 4, 0u);
    written.document = json::parse(bytes.substr(20, text_size));
    const std::size_t bin_size = number_at(bytes, 20 + text_size);
    EXPECT_EQ(bin_size % 4, 0u);
    written.bin = bytes.substr(28 + text_size, bin_size);
    return written;
}

/// A different value at each vertex: 0, 0.25, 0.5, 0.75, 0, ...; bent normals up.
std::vector<Occlusion> pattern(const Scene& scene)
{
    std::vector<Occlusion> occlusion(scene.positions.size());
    for (std::size_t i = 0; i < occlusion.size(); ++i)
        occlusion[i] = {static_cast<float>(i % 4) * 0.25f, {0, 0, 1}};
    return occlusion;
}

/// Read and written again as .glb, with the pattern.
Written round_trip(const GltfMaker& maker, const WriteOptions& options = {})
{
    const Scene scene = read_gltf("in.glb", maker.glb());
    return take_apart(gltf_contents("out.glb", scene, pattern(scene), options));
}

TEST(GltfWriter, AttributesComeBack)
{
    const Written written = round_trip(square());
    const json& attributes = written.attributes(0);
    EXPECT_EQ(written.floats(attributes["_OCCLUSION"]),
              (std::vector<float>{0, 0.25f, 0.5f, 0.75f}));
    EXPECT_EQ(written.floats(attributes["_BENT_NORMAL"]),
              (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
    EXPECT_FALSE(attributes.contains("COLOR_0"));
}

TEST(GltfWriter, TheRestIsUntouched)
{
    GltfMaker maker = square();
    maker.document["materials"] = {{{"name", "paint"}, {"extras", {{"a", 0.1}}}}};
    maker.document["extensionsUsed"] = {"ACME_paint"};
    maker.document["extensions"] = {{"ACME_paint", {{"hue", {1, 2.5, "x"}}}}};
    maker.document["animations"] = {{{"channels", json::array()}}};
    maker.document["asset"]["generator"] = "by hand";
    Written written = round_trip(maker);

    EXPECT_EQ(written.bin.substr(0, maker.bin.size()), maker.bin);
    json& document = written.document;
    EXPECT_EQ(document["buffers"][0]["byteLength"], written.bin.size());
    document["buffers"][0]["byteLength"] = maker.bin.size();
    for (const char* section : {"accessors", "bufferViews"})
        document[section].erase(document[section].begin() + 2, document[section].end());
    document["meshes"][0]["primitives"][0]["attributes"].erase("_OCCLUSION");
    document["meshes"][0]["primitives"][0]["attributes"].erase("_BENT_NORMAL");
    EXPECT_EQ(document, maker.document);
}

TEST(GltfWriter, UnknownChunksStay)
{
    const std::string chunk = bytes_of<std::uint32_t>({4}) + "ACME" + "1234";
    std::string glb = square().glb() + chunk;
    const auto size = static_cast<std::uint32_t>(glb.size());
    std::memcpy(glb.data() + 8, &size, sizeof size);
    const Scene scene = read_gltf("in.glb", glb);
    const std::string written = gltf_contents("out.glb", scene, pattern(scene));
    EXPECT_TRUE(written.ends_with(chunk));
    EXPECT_EQ(number_at(written, 8), written.size());
}

TEST(GltfWriter, EqualInputGivesEqualBytes)
{
    const Scene scene = read_gltf("in.glb", square().glb());
    for (const char* path : {"out.glb", "out.gltf"})
        EXPECT_EQ(gltf_contents(path, scene, pattern(scene)),
                  gltf_contents(path, scene, pattern(scene)));
}

TEST(GltfWriter, WhatIsWrittenIsTheSameSceneAgain)
{
    GltfMaker maker = square();
    maker.document["nodes"] = {
        {{"mesh", 0}, {"scale", {-1, 1, 1}}, {"children", {1}}},
        {{"mesh", 0}, {"rotation", {0, 0, 1, 1}}, {"translation", {1, 2, 3}}}};
    const Scene scene = read_gltf("in.glb", maker.glb());
    for (const char* path : {"out.glb", "elsewhere/out.gltf"}) {
        const Scene again = read_gltf(path, gltf_contents(path, scene, pattern(scene)));
        EXPECT_EQ(again.positions, scene.positions) << path;
        EXPECT_EQ(again.triangles, scene.triangles) << path;
    }
}

// ---- bent normals

// The normal matrix of the node must bring the attribute back to the world direction, whatever the
// node does to the mesh.
TEST(GltfWriter, BentNormalsAreNormalsOfMeshSpace)
{
    GltfMaker maker = square();
    maker.document["nodes"][0]["matrix"] = {0, -3, 0, 0, 0.5, 0, 0, 0, 1, 1, -2, 0, 4, 5, 6, 1};
    const glm::dmat3 to_world(0, -3, 0, 0.5, 0, 0, 1, 1, -2);
    const Scene scene = read_gltf("in.glb", maker.glb());
    const glm::vec3 world = glm::normalize(glm::vec3(1, 2, 3));
    const std::vector<Occlusion> occlusion(scene.positions.size(), {0.5f, world});
    const Written written = take_apart(gltf_contents("out.glb", scene, occlusion));
    const std::vector<float> values = written.floats(written.attributes(0)["_BENT_NORMAL"]);
    const glm::dvec3 attribute(values[0], values[1], values[2]);
    EXPECT_NEAR(glm::length(attribute), 1.0, 1e-6);
    const glm::dvec3 back = glm::normalize(glm::transpose(glm::inverse(to_world)) * attribute);
    EXPECT_NEAR(glm::length(back - glm::dvec3(world)), 0.0, 1e-6);
}

TEST(GltfWriter, TinyUnitsKeepTheirBentNormals)
{
    GltfMaker maker = square();
    maker.document["nodes"][0]["scale"] = {1e-200, 1e-200, 1e-200};
    const Written written = round_trip(maker);
    EXPECT_EQ(written.floats(written.attributes(0)["_BENT_NORMAL"])[2], 1.0f);
}

TEST(GltfWriter, WhereTheNodeLeavesNoDirectionTheBentNormalIsZero)
{
    GltfMaker maker = square();
    maker.document["nodes"][0]["scale"] = {1, 1, 0};
    const Written written = round_trip(maker);
    EXPECT_EQ(written.floats(written.attributes(0)["_BENT_NORMAL"]), std::vector<float>(12, 0.0f));
}

// ---- meshes that are used more than once

TEST(GltfWriter, EachUseOfAMeshHasItsOwnAttributes)
{
    GltfMaker maker = square();
    maker.document["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"mesh", 0}}};
    const Scene scene = read_gltf("in.glb", maker.glb());
    std::vector<Occlusion> occlusion(8, {0.25f, {0, 0, 1}});
    std::fill(occlusion.begin() + 4, occlusion.end(), Occlusion{0.75f, {0, 1, 0}});
    const Written written = take_apart(gltf_contents("out.glb", scene, occlusion));
    ASSERT_EQ(written.document["meshes"].size(), 2u);
    EXPECT_EQ(written.document["nodes"][0]["mesh"], 0);
    EXPECT_EQ(written.document["nodes"][1]["mesh"], 1);
    EXPECT_EQ(written.attributes(0)["POSITION"], written.attributes(1)["POSITION"]);
    EXPECT_EQ(written.floats(written.attributes(0)["_OCCLUSION"])[0], 0.25f);
    EXPECT_EQ(written.floats(written.attributes(1)["_OCCLUSION"])[0], 0.75f);
}

TEST(GltfWriter, NodesOutsideTheSceneKeepTheirMesh)
{
    GltfMaker maker = square();
    maker.add("nodes", {{"mesh", 0}});  // no scene lists it
    const Written written = round_trip(maker);
    ASSERT_EQ(written.document["meshes"].size(), 2u);
    EXPECT_EQ(written.document["nodes"][0]["mesh"], 1);
    EXPECT_EQ(written.document["nodes"][1]["mesh"], 0);
    EXPECT_FALSE(written.attributes(0).contains("_OCCLUSION"));
    EXPECT_TRUE(written.attributes(1).contains("_OCCLUSION"));
}

TEST(GltfWriter, PrimitivesThatShareVerticesShareAttributes)
{
    GltfMaker maker = square();
    json& primitives = maker.document["meshes"][0]["primitives"];
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 6}});
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});  // points
    const Written written = round_trip(maker);
    EXPECT_EQ(written.attributes(0, 0)["_OCCLUSION"], written.attributes(0, 1)["_OCCLUSION"]);
    EXPECT_FALSE(written.attributes(0, 2).contains("_OCCLUSION"));
}

// ---- colours

TEST(GltfWriter, ColorsAreTheVisibility)
{
    const Written written = round_trip(square(), {.colors = VertexColors::shaded});
    EXPECT_EQ(
        written.floats(written.attributes(0)["COLOR_0"]),
        (std::vector<float>{1, 1, 1, 0.75f, 0.75f, 0.75f, 0.5f, 0.5f, 0.5f, 0.25f, 0.25f, 0.25f}));
}

GltfMaker coloured_square()
{
    GltfMaker maker = square();
    const int colors = maker.add_accessor(
        maker.add_view(bytes_of<std::uint8_t>(
            {255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 102})),
        5121, "VEC4", 4);
    maker.document["accessors"][static_cast<std::size_t>(colors)]["normalized"] = true;
    maker.document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colors;
    return maker;
}

TEST(GltfWriter, ExistingColorsAreDarkenedAndKeepTheirAlpha)
{
    const Written written = round_trip(coloured_square(), {.colors = VertexColors::shaded});
    const std::vector<float> values = written.floats(written.attributes(0)["COLOR_0"]);
    ASSERT_EQ(values.size(), 16u);
    EXPECT_FLOAT_EQ(values[4], 0.75f);
    EXPECT_FLOAT_EQ(values[5], 0.0f);
    EXPECT_FLOAT_EQ(values[6], 0.2f * 0.75f);
    EXPECT_FLOAT_EQ(values[7], 1.0f);
    EXPECT_FLOAT_EQ(values[15], 0.4f);
}

TEST(GltfWriter, ExistingColorsStayWhenNoneAreAskedFor)
{
    const GltfMaker maker = coloured_square();
    EXPECT_EQ(round_trip(maker).attributes(0)["COLOR_0"], 2);
}

TEST(GltfWriter, PrimitivesWithColorsOfTheirOwnAreDarkenedApart)
{
    GltfMaker maker = coloured_square();
    maker.document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}});
    const Written written = round_trip(maker, {.colors = VertexColors::shaded});
    EXPECT_EQ(written.floats(written.attributes(0, 0)["COLOR_0"]).size(), 16u);
    EXPECT_EQ(written.floats(written.attributes(0, 1)["COLOR_0"]).size(), 12u);
}

// ---- from one container to another

/// A triangle and a square in two buffers, with a texture, as files in `folder`.
std::filesystem::path save_with_files(const TemporaryFolder& folder)
{
    GltfMaker maker = square();
    folder.file("square.bin", maker.bin);
    folder.file("triangle.bin", one_triangle().bin);
    folder.file("texture.png", "\x89PNG\r\n\x1A\n and so on");
    maker.document["buffers"] = {{{"byteLength", maker.bin.size()}, {"uri", "square.bin"}},
                                 {{"byteLength", 36}, {"uri", "triangle.bin"}}};
    const int view = maker.add("bufferViews", {{"buffer", 1}, {"byteLength", 36}});
    const int triangle = maker.add_accessor(view, 5126, "VEC3", 3);
    maker.document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", triangle}}}});
    maker.document["images"] = {{{"uri", "texture.png"}}, {{"uri", "absent.png"}}};
    return folder.file("in.gltf", maker.document.dump());
}

TEST(GltfWriter, ABinaryFileTakesBuffersAndImagesIn)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(save_with_files(folder));
    write_scene(folder / "out.glb", scene, pattern(scene));
    std::filesystem::remove(folder / "square.bin");
    std::filesystem::remove(folder / "triangle.bin");
    std::filesystem::remove(folder / "texture.png");
    const Written written = take_apart(contents_of(folder / "out.glb"));
    EXPECT_EQ(read_scene(folder / "out.glb").positions, scene.positions);
    ASSERT_EQ(written.document["buffers"].size(), 1u);
    EXPECT_FALSE(written.document["buffers"][0].contains("uri"));
    const json& image = written.document["images"][0];
    EXPECT_FALSE(image.contains("uri"));
    EXPECT_EQ(image["mimeType"], "image/png");
    const json& view = written.document["bufferViews"][image["bufferView"].get<std::size_t>()];
    EXPECT_EQ(written.bin.substr(view["byteOffset"], view["byteLength"]),
              "\x89PNG\r\n\x1A\n and so on");
    EXPECT_EQ(written.document["images"][1]["uri"], "absent.png");
}

TEST(GltfWriter, BesideTheOriginalFilesStayWhereTheyAre)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(save_with_files(folder));
    write_scene(folder / "out.gltf", scene, pattern(scene));
    const Written written = take_apart(contents_of(folder / "out.gltf"));
    EXPECT_EQ(written.document["buffers"][0]["uri"], "square.bin");
    EXPECT_EQ(written.document["buffers"][1]["uri"], "triangle.bin");
    EXPECT_EQ(written.document["images"][0]["uri"], "texture.png");
    EXPECT_EQ(written.floats(written.attributes(0)["_OCCLUSION"])[3], 0.75f);
    EXPECT_EQ(read_scene(folder / "out.gltf").positions, scene.positions);
}

TEST(GltfWriter, InAnotherFolderATextFileStandsAlone)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(save_with_files(folder));
    std::filesystem::create_directory(folder / "there");
    write_scene(folder / "there/out.gltf", scene, pattern(scene));
    const json document = json::parse(contents_of(folder / "there/out.gltf"));
    EXPECT_EQ(decode_data_uri(document["images"][0]["uri"].get<std::string>()),
              "\x89PNG\r\n\x1A\n and so on");
    EXPECT_EQ(document["images"][1]["uri"], "absent.png");
    EXPECT_EQ(read_scene(folder / "there/out.gltf").positions, scene.positions);
}

TEST(GltfWriter, ABinaryFileBecomesText)
{
    const Scene scene = read_gltf("in.glb", square().glb());
    const std::string text = gltf_contents("out.gltf", scene, pattern(scene));
    const Written written = take_apart(text);
    EXPECT_EQ(written.document["buffers"].size(), 2u);
    EXPECT_EQ(written.floats(written.attributes(0)["_OCCLUSION"])[1], 0.25f);
    EXPECT_EQ(read_gltf("out.gltf", text).positions, scene.positions);
}

TEST(GltfWriter, ImagesOutsideTheModelsFolderAreNotTakenIn)
{
    const TemporaryFolder folder;
    folder.file("secret.png", "\x89PNG secret");
    std::filesystem::create_directory(folder / "model");
    GltfMaker maker = square();
    maker.document["images"] = {{{"uri", "../secret.png"}}};
    const Scene scene = read_gltf(folder / "model/in.glb", maker.glb());
    const std::string written = gltf_contents(folder / "out.glb", scene, pattern(scene));
    EXPECT_EQ(written.find("secret\""), std::string::npos);
    EXPECT_EQ(take_apart(written).document["images"][0]["uri"], "../secret.png");
}

TEST(GltfWriter, FilesThatAreNoImagesAreNotTakenIn)
{
    const TemporaryFolder folder;
    folder.file("passwords", "root:x:0:0");
    GltfMaker maker = square();
    maker.document["images"] = {{{"uri", "passwords"}}};
    const Scene scene = read_gltf(folder / "in.glb", maker.glb());
    const std::string written = gltf_contents(folder / "out.glb", scene, pattern(scene));
    EXPECT_EQ(written.find("root:x"), std::string::npos);
}

TEST(GltfWriter, ASceneMadeInCodeIsRefused)
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.triangles = {{0, 1, 2}};
    EXPECT_THROW(static_cast<void>(gltf_contents("out.glb", scene, pattern(scene))), InputError);
}

// ---- another program's opinion

/// What `assimp info` says of a file, without the lines that tell times and sizes.
std::string assimp_info(const std::filesystem::path& path)
{
    const std::filesystem::path log = path.string() + ".txt";
    const std::string command = "assimp info \"" + path.string() + "\" > \"" + log.string() + '"';
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::istringstream lines(contents_of(log));
    std::string kept;
    for (std::string line; std::getline(lines, line);) {
        for (const char* wanted : {"Meshes:", "Nodes:", "Materials:", "Vertices:", "Faces:",
                                   "Animations:", "Primitive Types:"}) {
            if (line.starts_with(wanted))
                kept += line + '\n';
        }
    }
    return kept;
}

TEST(GltfWriter, AssimpFindsTheSameModel)
{
    const std::filesystem::path model =
        "/usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb";
    if (std::system("assimp version > /dev/null 2>&1") != 0 || !std::filesystem::exists(model))
        GTEST_SKIP() << "assimp-utils and assimp-testmodels are not installed";
    const TemporaryFolder folder;
    std::filesystem::copy_file(model, folder / "model.glb");
    const std::string expected = assimp_info(folder / "model.glb");
    EXPECT_NE(expected.find("Vertices:"), std::string::npos);
    const Scene scene = read_scene(model);
    for (const char* name : {"out.glb", "out.gltf"}) {
        write_scene(folder / name, scene, pattern(scene));
        EXPECT_EQ(assimp_info(folder / name), expected) << name;
    }
}

}  // namespace
}  // namespace surfelao
