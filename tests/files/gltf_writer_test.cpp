#include "gltf_maker.h"
#include "temporary_folder.h"
#include "written_gltf.h"

#include "files/gltf_io.h"
#include "files/gltf_uri.h"
#include "files/maker_mark.h"
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
using test::number_at;
using test::one_triangle;
using test::pattern;
using test::round_trip;
using test::square;
using test::take_apart;
using test::Written;

TEST(GltfWriter, AttributesComeBack)
{
    const Written written = round_trip(square());
    const json& attributes = written.attributes(0);
    EXPECT_EQ(written.floats(attributes["_OCCLUSION"]),
              (std::vector<float>{0, 0.25f, 0.5f, 0.75f}));
    EXPECT_EQ(written.floats(attributes["_BENT_NORMAL"]),
              (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
}

TEST(GltfWriter, TheRestIsUntouched)
{
    GltfMaker maker = square();
    maker.document["materials"] = {{{"name", "paint"}, {"extras", {{"a", 0.1}}}}};
    maker.document["extensionsUsed"] = {"ACME_paint"};
    maker.document["extensions"] = {{"ACME_paint", {{"hue", {1, 2.5, "x"}}}}};
    maker.document["animations"] = {{{"channels", json::array()}}};
    maker.document["asset"]["generator"] = "by hand";
    Written written = round_trip(maker, {.colors = VertexColors::keep});

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
    const std::string written = gltf_contents("out.glb", scene, pattern(scene)).contents;
    EXPECT_TRUE(written.ends_with(chunk));
    EXPECT_EQ(number_at(written, 8), written.size());
}

TEST(GltfWriter, EqualInputGivesEqualBytes)
{
    const Scene scene = read_gltf("in.glb", square().glb());
    for (const char* path : {"out.glb", "out.gltf"})
        EXPECT_EQ(gltf_contents(path, scene, pattern(scene)).contents,
                  gltf_contents(path, scene, pattern(scene)).contents);
}

TEST(GltfWriter, WhatIsWrittenIsTheSameSceneAgain)
{
    GltfMaker maker = square();
    maker.document["nodes"] = {
        {{"mesh", 0}, {"scale", {-1, 1, 1}}, {"children", {1}}},
        {{"mesh", 0}, {"rotation", {0, 0, 1, 1}}, {"translation", {1, 2, 3}}}};
    const Scene scene = read_gltf("in.glb", maker.glb());
    for (const char* path : {"out.glb", "elsewhere/out.gltf"}) {
        const Scene again = read_gltf(path, gltf_contents(path, scene, pattern(scene)).contents);
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
    const Written written = take_apart(gltf_contents("out.glb", scene, occlusion).contents);
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
    const Written written = take_apart(gltf_contents("out.glb", scene, occlusion).contents);
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

/// The URIs of all buffers and images that are no data.
std::vector<std::string> uris_of(const std::filesystem::path& path)
{
    const json document = json::parse(contents_of(path));
    std::vector<std::string> uris;
    for (const char* list : {"buffers", "images"}) {
        for (const json& entry : document[list]) {
            if (!is_data_uri(entry["uri"].get<std::string>()))
                uris.push_back(entry["uri"].get<std::string>());
        }
    }
    return uris;
}

// A bake of a result in a third folder still names the original's files.
TEST(GltfWriter, InAnotherFolderATextFileFindsTheFiles)
{
    const TemporaryFolder folder;
    for (const char* name : {"my model", "my model/maps", "there", "there/deep"})
        std::filesystem::create_directory(folder / name);
    GltfMaker maker = square();
    folder.file("my model/square.bin", maker.bin);
    folder.file("my model/other.buffer", maker.bin);
    folder.file("my model/maps/50%.png", "");
    folder.file("beside.png", "");
    maker.document["buffers"] = {{{"byteLength", maker.bin.size()}, {"uri", "square.bin"}},
                                 {{"byteLength", maker.bin.size()}, {"uri", "other.buffer"}}};
    for (const char* uri :
         {"maps\\50%25.png", "../beside.png", "absent\\1.png", "http://host/a.png"})
        maker.add("images", {{"uri", uri}});
    const auto in = folder.file("my model/in.gltf", maker.document.dump());
    const auto bake = [](const std::filesystem::path& from, const std::filesystem::path& to) {
        const Scene scene = read_scene(from);
        return write_scene(to, scene, pattern(scene), {.mark = make_mark("bake", "x")});
    };

    const std::vector<std::string> notes = {"named in the file and not found: \"absent\\1.png\""};
    EXPECT_EQ(bake(in, folder / "my model/out.gltf"), notes);
    EXPECT_EQ(bake(in, folder / "there/out.gltf"), notes);
    EXPECT_EQ(bake(folder / "there/out.gltf", folder / "there/deep/out.gltf"), notes);
    EXPECT_EQ(uris_of(folder / "my model/out.gltf"),
              (std::vector<std::string>{"square.bin", "other.buffer", "maps/50%25.png",
                                        "../beside.png", "absent\\1.png", "http://host/a.png"}));
    EXPECT_EQ(uris_of(folder / "there/out.gltf"),  // only a .bin is read from elsewhere
              (std::vector<std::string>{"../my%20model/square.bin", "../my%20model/maps/50%25.png",
                                        "../beside.png", "absent\\1.png", "http://host/a.png"}));
    EXPECT_EQ(
        uris_of(folder / "there/deep/out.gltf"),
        (std::vector<std::string>{"../../my%20model/square.bin", "../../my%20model/maps/50%25.png",
                                  "../../beside.png", "absent\\1.png", "http://host/a.png"}));
}

TEST(GltfWriter, ABinaryFileBecomesText)
{
    const Scene scene = read_gltf("in.glb", square().glb());
    const std::string text = gltf_contents("out.gltf", scene, pattern(scene)).contents;
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
    const std::string written = gltf_contents(folder / "out.glb", scene, pattern(scene)).contents;
    EXPECT_EQ(written.find("PNG secret"), std::string::npos);
    EXPECT_EQ(take_apart(written).document["images"][0]["uri"], "secret.png");
}

TEST(GltfWriter, FilesThatAreNoImagesAreNotTakenIn)
{
    const TemporaryFolder folder;
    folder.file("passwords", "root:x:0:0");
    GltfMaker maker = square();
    maker.document["images"] = {{{"uri", "passwords"}}};
    const Scene scene = read_gltf(folder / "in.glb", maker.glb());
    const std::string written = gltf_contents(folder / "out.glb", scene, pattern(scene)).contents;
    EXPECT_EQ(written.find("root:x"), std::string::npos);
}

TEST(GltfWriter, ASceneMadeInCodeIsRefused)
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.triangles = {{0, 1, 2}};
    EXPECT_THROW(static_cast<void>(gltf_contents("out.glb", scene, pattern(scene)).contents),
                 InputError);
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

// Without colours, as it makes one of meshes that are equal.
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
        write_scene(folder / name, scene, pattern(scene), {.colors = VertexColors::keep});
        EXPECT_EQ(assimp_info(folder / name), expected) << name;
    }
}

// Two nodes and two instances show one mesh. Who is not baked keeps what it had; a mesh is copied
// and instances become nodes only where some of them are baked.
TEST(GltfWriter, WhatIsNotBakedStaysAsItIs)
{
    GltfMaker maker = square();
    const int places = maker.add_vectors<float>({0, 0, 1, 0, 0, 2});
    maker.document["nodes"] = {
        {{"mesh", 0}},
        {{"mesh", 0}},
        {{"mesh", 0},
         {"extensions",
          {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}}};
    maker.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    maker.document["scenes"][0]["nodes"] = {0, 1, 2};
    const struct {
        std::vector<bool> unbaked;  // two triangles each
        std::size_t meshes, nodes;
        std::vector<std::size_t> baked_nodes;
    } rows[] = {
        {{true, true, false, false, true, true, true, true}, 2, 3, {1}},
        {{false, true, false, true, true, true, true, true}, 3, 3, {0, 1}},
        {{true, true, true, true, true, true, false, false}, 2, 5, {4}},
    };
    for (const auto& row : rows) {
        const Written written = round_trip(maker, {.unbaked = row.unbaked});
        const json& nodes = written.document["nodes"];
        EXPECT_EQ(written.document["meshes"].size(), row.meshes);
        ASSERT_EQ(nodes.size(), row.nodes);
        std::vector<std::size_t> baked;
        for (std::size_t node = 0; node < nodes.size(); ++node) {
            if (nodes[node].contains("mesh") &&
                written.attributes(nodes[node]["mesh"]).contains("_OCCLUSION"))
                baked.push_back(node);
        }
        EXPECT_EQ(baked, row.baked_nodes);
        EXPECT_EQ(written.document["meshes"][0], maker.document["meshes"][0]);
        EXPECT_EQ(nodes[2].contains("extensions"), row.nodes == 3);
    }
}

}  // namespace
}  // namespace surfelao
