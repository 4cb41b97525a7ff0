// A map of occlusion in a glTF result: over the file's own coordinates, and out again.
#include "gltf_map_cases.h"
#include "temporary_folder.h"
#include "written_gltf.h"

#include "files/gltf_uri.h"
#include "files/maker_mark.h"
#include "files/sidecars.h"

#include <tiny_gltf.h>

#include <gtest/gtest.h>

#include <optional>

namespace surfelao {
namespace {

using nlohmann::json;
using test::baked;
using test::GltfMaker;
using test::map_cases;
using test::map_over;
using test::MapCase;
using test::packed_square;
using test::painted_square;
using test::primitive;
using test::take_apart;
using test::two_texels;
using test::Way;
using test::Written;

/// One that another reader loads; it decodes the pictures.
tinygltf::Model load_back(const std::filesystem::path& path)
{
    tinygltf::TinyGLTF reader;
    tinygltf::Model model;
    std::string error, warning;
    const bool is_loaded = path.extension() == ".glb"
                               ? reader.LoadBinaryFromFile(&model, &error, &warning, path)
                               : reader.LoadASCIIFromFile(&model, &error, &warning, path);
    EXPECT_TRUE(is_loaded) << error;
    EXPECT_EQ(warning, "");
    return model;
}

/// What a reader sees of the map on a primitive; empty without one.
std::vector<unsigned char> shown_map(const tinygltf::Model& model, const tinygltf::Primitive& of)
{
    if (of.material < 0)
        return {};
    const tinygltf::OcclusionTextureInfo& info =
        model.materials.at(static_cast<std::size_t>(of.material)).occlusionTexture;
    if (info.index < 0)
        return {};
    EXPECT_TRUE(of.attributes.contains("TEXCOORD_" + std::to_string(info.texCoord)));
    EXPECT_EQ(info.strength, 1.0);
    const tinygltf::Texture& texture = model.textures.at(static_cast<std::size_t>(info.index));
    const tinygltf::Sampler& sampler = model.samplers.at(static_cast<std::size_t>(texture.sampler));
    EXPECT_EQ(sampler.wrapS, TINYGLTF_TEXTURE_WRAP_REPEAT);
    const tinygltf::Image& image = model.images.at(static_cast<std::size_t>(texture.source));
    std::vector<unsigned char> red;
    for (std::size_t i = 0; i < image.image.size(); i += static_cast<std::size_t>(image.component))
        red.push_back(image.image[i]);
    return red;
}

TEST(GltfMap, EveryMaterialWithTheCoordinatesShowsIt)
{
    const TemporaryFolder folder;
    for (const MapCase& made : map_cases()) {
        const json before = made.maker.document;
        for (const char* name : {"out.glb", "out put.gltf"}) {
            const Scene scene = read_gltf("in.glb", made.maker.glb());
            EXPECT_EQ(write_scene_with_map(folder / name, scene, map_over(0)), made.notes);
            const tinygltf::Model model = load_back(folder / name);
            const std::vector<tinygltf::Primitive>& primitives = model.meshes[0].primitives;
            EXPECT_EQ(shown_map(model, primitives[0]), (std::vector<unsigned char>{0, 255}));
            const std::size_t old_materials = before.value("materials", json::array()).size();
            EXPECT_EQ(primitives[0].material, made.material.value_or(old_materials)) << made.name;
            EXPECT_EQ(model.materials.size(), old_materials + (made.material ? 0 : 1));

            // nothing else changes
            const Written written = take_apart(contents_of(folder / name));
            json rest = written.document["meshes"];
            rest[0]["primitives"][0].erase("material");
            json wanted = before["meshes"];
            wanted[0]["primitives"][0].erase("material");
            EXPECT_EQ(rest, wanted) << made.name;
            EXPECT_EQ(written.document["nodes"], before["nodes"]) << made.name;
            EXPECT_EQ(written.document["accessors"], before["accessors"]) << made.name;
            for (std::size_t m = 0; m < old_materials; ++m) {
                json material = written.document["materials"][m];
                if (made.material == m)
                    material.erase("occlusionTexture");
                EXPECT_EQ(material, before["materials"][m]) << made.name;
            }
        }
        EXPECT_EQ(folder.file_count(), 3);  // out.glb, out put.gltf, out put.ao.png
        EXPECT_EQ(contents_of(folder / "out put.ao.png"), two_texels());
    }
}

TEST(GltfMap, LiesOverTheSetThatIsNamed)
{
    GltfMaker maker = painted_square();
    const Scene scene = read_gltf("in.glb", maker.glb());
    EXPECT_THROW((void)gltf_contents_with_map("out.glb", scene, map_over(1)), InputError);
    primitive(maker)["attributes"]["TEXCOORD_1"] = primitive(maker)["attributes"]["TEXCOORD_0"];
    const Scene both = read_gltf("in.glb", maker.glb());
    const Written written =
        take_apart(gltf_contents_with_map("out.glb", both, map_over(1)).contents);
    EXPECT_EQ(written.document["materials"][0]["occlusionTexture"],
              (json{{"index", 1}, {"texCoord", 1}}));
}

// A page for each material: two primitives with materials of their own, one without.
TEST(GltfMap, MaterialsHaveMapsOfTheirOwn)
{
    GltfMaker maker = painted_square();
    maker.add("materials", {{"name", "iron"}});
    json& primitives = maker.document["meshes"][0]["primitives"];
    for (const json& material : {json(1), json()}) {
        primitives.push_back(primitives[0]);
        primitives.back().erase("material");
        if (!material.is_null())
            primitives.back()["material"] = material;
    }
    const std::string bytes = maker.glb();
    for (const char* path : {"out.glb", "out.gltf"}) {
        const Scene scene = read_gltf("in.glb", bytes);
        OcclusionMap map = map_over(0);
        map.more_pngs = {"second", "third"};
        map.pages = {0, 0, 2, 2, 1, 1};
        const std::string once = gltf_contents_with_map(path, scene, map).contents;
        EXPECT_EQ(gltf_contents_with_map(path, read_gltf(path, once), map).contents, once);
        const Written written = take_apart(once);
        const json& document = written.document;
        const std::string pngs[] = {two_texels(), "third", "second"};
        for (std::size_t p = 0; p < 3; ++p) {
            const json& in_file = document["meshes"][0]["primitives"][p];
            const json& material = document["materials"][in_file["material"].get<std::size_t>()];
            const json& texture =
                document["textures"][material["occlusionTexture"]["index"].get<std::size_t>()];
            const json& image = document["images"][texture["source"].get<std::size_t>()];
            const json& view = document["bufferViews"][image["bufferView"].get<std::size_t>()];
            EXPECT_EQ(written.bin.substr(view["byteOffset"].get<std::size_t>(),
                                         view["byteLength"].get<std::size_t>()),
                      pngs[p]);
        }
    }
}

TEST(GltfMap, NodesThatShareAMeshShareTheMap)
{
    GltfMaker maker = painted_square();
    maker.add("nodes", {{"mesh", 0}, {"translation", {0, 0, 1}}});
    maker.document["scenes"][0]["nodes"] = {0, 1};
    const std::string once = baked("out.glb", maker.glb(), Way::map);
    EXPECT_EQ(take_apart(once).document["meshes"], maker.document["meshes"]);
    EXPECT_EQ(take_apart(once).document["nodes"], maker.document["nodes"]);
    EXPECT_TRUE(baked("out.glb", once, Way::map) == once);
}

// A result whose materials and textures another program has moved about is still no original.
TEST(GltfMap, AnEditedResultHasOneMap)
{
    json edited = take_apart(baked("x.glb", packed_square().glb(), Way::map)).document;
    const std::string bin = take_apart(baked("x.glb", packed_square().glb(), Way::map)).bin;
    for (const char* list : {"images", "textures", "materials"})
        edited[list].push_back({{"name", "new"}});
    const GltfMaker maker{edited, bin};
    const Written again = take_apart(baked("x.glb", maker.glb(), Way::map));
    const json& materials = again.document["materials"];
    const std::size_t material = again.document["meshes"][0]["primitives"][0]["material"];
    EXPECT_EQ(materials[material]["occlusionTexture"]["index"],
              again.document["textures"].size() - 1);
    EXPECT_EQ(materials[material]["occlusionTexture"]["extras"][kMarkKey], 0);
    EXPECT_EQ(materials[0], packed_square().document["materials"][0]);
}

TEST(GltfMap, TheFileBesideIsReplacedOnlyWhereItIsOurs)
{
    const TemporaryFolder folder;
    const Scene scene = read_gltf("in.glb", painted_square().glb());
    const auto refusal_of = [&](const char* name) -> std::string {
        try {
            static_cast<void>(write_scene_with_map(folder / name, scene, map_over(0)));
        } catch (const InputError& error) {
            return std::string(error.what()).substr(folder.path().string().size() + 1);
        }
        return "";
    };
    EXPECT_EQ(refusal_of("ours.gltf"), "");
    EXPECT_EQ(refusal_of("ours.gltf"), "");
    EXPECT_EQ(sidecars_of(folder / "ours.gltf"), std::vector{folder / "ours.ao.png"});

    // the picture of a user, whose model names it or does not
    folder.file("own.ao.png", "a picture");
    const std::string refused =
        "own.ao.png: exists and is of no result at own.gltf, which would replace it; use .glb";
    EXPECT_EQ(refusal_of("own.gltf"), refused);
    GltfMaker own = painted_square();
    own.document["images"][0] = {{"uri", "own.ao.png"}, {"name", "bark"}};
    const std::string text = own.gltf(make_data_uri("application/octet-stream", own.bin));
    folder.file("own.gltf", text);
    EXPECT_EQ(refusal_of("own.gltf"), refused);
    EXPECT_EQ(contents_of(folder / "own.ao.png"), "a picture");
    EXPECT_EQ(contents_of(folder / "own.gltf"), text);
    EXPECT_EQ(refusal_of("own.glb"), "");
}

TEST(GltfMap, OtherFormatsAreRefused)
{
    const auto refusal_of = [](const char* input, const char* output) -> std::string {
        try {
            check_output_with_map(input, output);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(refusal_of("a.gltf", "b.off"),
              "b.off: a map goes into .glb, .gltf, .obj and .ply only, use .png, .tif or .exr for "
              "the map alone");
    EXPECT_EQ(refusal_of("a.ply", "b.glb"), "");
    EXPECT_EQ(map_file_of("a/b.c.gltf"), "a/b.c.ao.png");
    EXPECT_EQ(map_file_of("a/b.glb"), std::nullopt);
}

}  // namespace
}  // namespace surfelao
