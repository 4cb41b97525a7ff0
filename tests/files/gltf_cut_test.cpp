// A map over new coordinates in a glTF result: vertices are cut, and nothing else changes.
#include "gltf_map_cases.h"
#include "temporary_folder.h"

#include "files/scene_io.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace surfelao {
namespace {

using nlohmann::json;
using test::baked;
using test::bytes_of;
using test::GltfMaker;
using test::kWays;
using test::map_cases;
using test::map_over;
using test::places_for;
using test::primitive;
using test::take_apart;
using test::Way;
using test::Written;

/// Puts bytes with room for one more behind each `size` of them.
std::string with_gaps(const std::string& bytes, std::size_t size, std::size_t stride)
{
    std::string spread;
    for (std::size_t begin = 0; begin < bytes.size(); begin += size)
        spread.append(bytes, begin, size).append(stride - size, '\x7f');
    return spread;
}

/// Nine vertices, eight triangles; normals, coordinates and a number for each vertex in small
/// types. A material with a picture.
///
///     6---7---8
///     | / | / |
///     3---4---5
///     | / | / |
///     0---1---2
GltfMaker sheet()
{
    GltfMaker maker;
    const auto attribute = [&](const std::string& bytes, int stride, int component,
                               const char* type, bool normalized) {
        const int index = maker.add_accessor(maker.add_view(bytes, stride), component, type, 9);
        maker.document["accessors"].back()["normalized"] = normalized;
        return index;
    };
    std::string places, normals, uvs, numbers;
    for (std::uint8_t v = 0; v < 9; ++v) {
        const float x = v % 3, y = v / 3;
        places += bytes_of<float>({x, y, v == 4 ? 0.5f : 0.0f});
        normals += bytes_of<std::int8_t>({static_cast<std::int8_t>(v), 0, 127});
        uvs += bytes_of<std::uint16_t>({static_cast<std::uint16_t>(v * 7000), 65535});
        numbers += bytes_of<std::uint8_t>({v});
    }
    const int at = attribute(places, 12, 5126, "VEC3", false);
    maker.document["accessors"][0]["min"] = {0, 0, 0};
    maker.document["accessors"][0]["max"] = {2, 2, 0.5};
    const json attributes = {
        {"POSITION", at},
        {"NORMAL", attribute(with_gaps(normals, 3, 4), 4, 5120, "VEC3", true)},
        {"TEXCOORD_0", attribute(uvs, 4, 5123, "VEC2", true)},
        {"_ID", attribute(with_gaps(numbers, 1, 4), 4, 5121, "SCALAR", false)}};
    const int indices = maker.add_indices<std::uint8_t>(
        {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 3, 4, 7, 3, 7, 6, 4, 5, 8, 4, 8, 7});
    maker.add("images",
              {{"bufferView", maker.add_view(test::two_texels())}, {"mimeType", "image/png"}});
    maker.add("textures", {{"source", 0}});
    maker.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    maker.add("meshes", {{"primitives",
                          {{{"attributes", attributes}, {"indices", indices}, {"material", 0}}}}});
    maker.add("nodes", {{"mesh", 0}});
    maker.document["extensionsUsed"] =
        maker.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    return maker;
}

GltfMaker drawn_as(int mode, std::initializer_list<std::uint16_t> indices)
{
    GltfMaker maker = sheet();
    primitive(maker)["mode"] = mode;
    primitive(maker).erase("indices");
    if (indices.size() > 0)
        primitive(maker)["indices"] = maker.add_indices<std::uint16_t>(indices);
    return maker;
}

/// Its triangles in two primitives with the same vertices, of which one has no coordinates, and
/// lines between them.
GltfMaker split_sheet()
{
    GltfMaker maker = sheet();
    json& primitives = maker.document["meshes"][0]["primitives"];
    primitives[0]["extras"] = {{"kept", true}};
    json second = primitives[0];
    primitives[0]["indices"] =
        maker.add_indices<std::uint16_t>({0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4});
    second["indices"] = maker.add_indices<std::uint32_t>({3, 4, 7, 3, 7, 6, 4, 5, 8, 4, 8, 7});
    second["attributes"].erase("TEXCOORD_0");
    second["extras"] = "no object";
    second["mode"] = 4;
    second["material"] = maker.add("materials", {{"name", "plain"}});
    json lines = primitives[0];
    lines["mode"] = 3;
    primitives.push_back(lines);
    primitives.push_back(second);
    return maker;
}

GltfMaker sparse_sheet()
{
    GltfMaker maker = sheet();
    const int indices = maker.add_view(bytes_of<std::uint16_t>({4}));
    const int values = maker.add_view(bytes_of<float>({1, 1, 0.25f}));
    maker.document["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}}}};
    maker.document["accessors"][0]["max"] = {2, 2, 0.25};
    return maker;
}

GltfMaker moving_sheet()
{
    GltfMaker maker = sheet();
    std::string joints, weights, lift;
    for (int v = 0; v < 9; ++v) {
        joints += bytes_of<std::uint8_t>({0, static_cast<std::uint8_t>(v > 0), 0, 0});
        weights += bytes_of<float>({1.0f - v / 16.0f, v / 16.0f, 0, 0});
        lift += bytes_of<float>({0, 0, v / 4.0f});
    }
    json& of = primitive(maker);
    of["attributes"]["JOINTS_0"] = maker.add_accessor(maker.add_view(joints, 4), 5121, "VEC4", 9);
    of["attributes"]["WEIGHTS_0"] =
        maker.add_accessor(maker.add_view(weights, 16), 5126, "VEC4", 9);
    const int up = maker.add_accessor(maker.add_view(lift, 12), 5126, "VEC3", 9);
    maker.document["accessors"].back()["min"] = {0, 0, 0};
    maker.document["accessors"].back()["max"] = {0, 0, 2};
    of["targets"] = {{{"POSITION", up}}, {{"POSITION", up}, {"NORMAL", up}}};
    maker.document["meshes"][0]["weights"] = {1, 0.5};
    maker.document["nodes"] = {{{"mesh", 0}, {"skin", 0}},
                               {{"translation", {0, 0, 1}}, {"children", {2}}},
                               {{"translation", {0, 1, 0}}, {"scale", {-1, 1, 1}}}};
    maker.document["scenes"][0]["nodes"] = {0, 1};
    maker.document["skins"] = {{{"joints", {1, 2}}}};
    return maker;
}

/// Three times in the scene, once mirrored, once outside of it.
GltfMaker repeated_sheet()
{
    GltfMaker maker = sheet();
    maker.document["nodes"] = {{{"mesh", 0}},
                               {{"mesh", 0}, {"translation", {0, 0, 1}}, {"scale", {-1, 1, 1}}},
                               {{"mesh", 0}, {"translation", {0, 0, 2}}},
                               {{"mesh", 0}}};
    maker.document["scenes"][0]["nodes"] = {0, 1, 2};
    return maker;
}

GltfMaker instanced_sheet()
{
    GltfMaker maker = sheet();
    maker.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", maker.add_vectors<float>({0, 0, 1, 0, 0, 2})}};
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
        maker.document[list].push_back("EXT_mesh_gpu_instancing");
    return maker;
}

struct CutCase {
    const char* name;
    GltfMaker maker;
};

std::vector<CutCase> cut_cases()
{
    GltfMaker bare = sheet();
    for (const char* list : {"materials", "textures", "images"})
        bare.document.erase(list);
    primitive(bare).erase("material");
    return {{"sheet", sheet()},
            {"bare", bare},
            {"split", split_sheet()},
            {"sparse", sparse_sheet()},
            {"moving", moving_sheet()},
            {"strip", drawn_as(5, {0, 3, 1, 4, 2, 5, 5, 3, 3, 6, 4, 7, 5, 8})},
            {"fan", drawn_as(6, {4, 0, 1, 2, 5, 8, 7, 6, 3, 0})},
            {"without indices", drawn_as(4, {})},
            {"fan without indices", drawn_as(6, {})},
            {"repeated", repeated_sheet()},
            {"instanced", instanced_sheet()}};
}

/// A result as everybody else sees it: nothing in it is known as added.
Scene read_as_foreign(const std::string& glb)
{
    Written written = take_apart(glb);
    json& document = written.document;
    for (json& accessor : document["accessors"]) {
        accessor.erase("name");
        accessor.erase("extras");
    }
    for (const char* list : {"materials", "textures"}) {
        for (json& entry : document[list])
            entry.erase("name");
    }
    document["asset"].erase("extras");
    for (json& material : document["materials"])
        material.erase("extras");
    for (json& mesh : document["meshes"]) {
        mesh.erase("extras");
        for (json& of : mesh["primitives"])
            of.erase("extras");
    }
    return read_gltf("foreign.glb", GltfMaker{document, written.bin}.glb());
}

/// Of a corner: nothing without.
std::optional<glm::dvec2> place_in(const Scene& scene, std::size_t set, std::size_t triangle, int k)
{
    const UvSet& uvs = scene.uvs.at(set);
    const std::uint32_t at = (uvs.corners.empty() ? scene.triangles : uvs.corners)[triangle][k];
    return at == UvSet::kNone ? std::nullopt : std::optional(uvs.values.at(at));
}

/// What the map lies over: the last set that has the corner.
std::optional<glm::dvec2> place_in_map(const Scene& scene, std::size_t triangle, int k)
{
    for (std::size_t set = scene.uvs.size(); set-- > 0;) {
        if (!scene.uvs[set].empty() && place_in(scene, set, triangle, k))
            return place_in(scene, set, triangle, k);
    }
    return {};
}

TEST(GltfCut, EveryCornerHasItsPlaceAndAllElseThatItHad)
{
    for (const CutCase& made : cut_cases()) {
        const Scene scene = read_gltf("in.glb", made.maker.glb());
        const UvSet asked = places_for(scene);
        const Scene again = read_as_foreign(baked("out.glb", made.maker.glb(), Way::new_map));
        ASSERT_EQ(again.triangles.size(), scene.triangles.size()) << made.name;
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t now = again.triangles[t][k], before = scene.triangles[t][k];
                EXPECT_EQ(again.positions[now], scene.positions[before]) << made.name << t;
                EXPECT_EQ(again.normals.values[now], scene.normals.values[before]) << made.name;
                const std::uint32_t place = asked.corners[t][k];
                EXPECT_TRUE(place == UvSet::kNone ||
                            place_in_map(again, t, k) == asked.values[place])
                    << made.name << ' ' << t << ' ' << k;
            }
        }
        // the first vertices of each part are those of the file
        ASSERT_EQ(again.parts.size(), scene.parts.size()) << made.name;
        for (std::size_t p = 0; p < scene.parts.size(); ++p) {
            const Part &now = again.parts[p], &before = scene.parts[p];
            EXPECT_GE(now.vertex_count, before.vertex_count) << made.name;
            for (std::uint32_t v = 0; v < before.vertex_count; ++v)
                EXPECT_EQ(again.positions[now.first_vertex + v],
                          scene.positions[before.first_vertex + v])
                    << made.name;
        }
    }
}

TEST(GltfCut, EveryCornerIsOnThePagesOfABlendedMap)
{
    for (const CutCase& made : cut_cases()) {
        const Scene scene = read_gltf("in.glb", made.maker.glb());
        const BlendedMap asked = test::blended_for(scene);
        const std::string glb = baked("out.glb", made.maker.glb(), Way::blended);
        const Scene again = read_as_foreign(glb);
        ASSERT_EQ(again.triangles.size(), scene.triangles.size()) << made.name;
        const json document = take_apart(glb).document;
        for (const Part& part : again.parts) {
            const auto& of = document["meshes"][static_cast<std::size_t>(part.mesh)]["primitives"]
                                     [static_cast<std::size_t>(part.primitive)];
            const json& blended = document["materials"][of["material"].get<std::size_t>()]["extras"]
                                          ["surfelao"]["blended"];
            ASSERT_EQ(blended.size(), 3u) << made.name;
            const std::uint32_t first = part.first_triangle;
            for (std::size_t page = 0; page < 3; ++page) {
                const std::size_t set = blended[page]["texCoord"];
                EXPECT_EQ(document["textures"][blended[page]["index"].get<std::size_t>()]["source"],
                          document["images"].size() - 3 + page);
                for (int k = 0; k < 3; ++k) {
                    const std::uint32_t place = asked.uvs[page].corners[first][k];
                    EXPECT_EQ(place_in(again, set, first, k), place == UvSet::kNone
                                                                  ? glm::dvec2(0.0)
                                                                  : asked.uvs[page].values[place])
                        << made.name << page;
                }
            }
        }
    }
}

/// The bytes of an accessor's elements.
std::vector<std::string> elements_of(const Written& written, const json& index, std::size_t size)
{
    const json& accessor = written.document["accessors"][index.get<std::size_t>()];
    const json& view = written.document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    std::vector<std::string> elements(accessor["count"].get<std::size_t>());
    for (std::size_t i = 0; i < elements.size(); ++i)
        elements[i] =
            written.bin.substr(view.value("byteOffset", 0u) + accessor.value("byteOffset", 0u) +
                                   i * view.value("byteStride", 0u),
                               size);
    return elements;
}

TEST(GltfCut, CopiesHaveAllAttributesInTheirOwnTypes)
{
    const GltfMaker original = sheet();
    const Written written = take_apart(baked("out.glb", sheet().glb(), Way::new_map));
    const json& attributes = written.attributes(0);
    const std::vector<std::string> numbers = elements_of(written, attributes["_ID"], 1);
    ASSERT_GT(numbers.size(), 9u);
    const struct {
        const char* name;
        std::size_t size;
    } rows[] = {{"NORMAL", 3}, {"TEXCOORD_0", 4}, {"POSITION", 12}};
    for (const auto& [name, size] : rows) {
        const json& before =
            original
                .document["accessors"][primitive(original)["attributes"][name].get<std::size_t>()];
        const json& now = written.document["accessors"][attributes[name].get<std::size_t>()];
        for (const char* key : {"componentType", "type", "normalized"})
            EXPECT_EQ(now[key], before[key]) << name;
        const std::vector<std::string> elements = elements_of(written, attributes[name], size);
        ASSERT_EQ(elements.size(), numbers.size()) << name;
        for (std::size_t v = 0; v < elements.size(); ++v)
            EXPECT_EQ(elements[v], elements[static_cast<unsigned char>(numbers[v][0])]) << name;
    }
}

TEST(GltfCut, OnlyWhatMustBeIsCut)
{
    // one place for each vertex: nothing
    const GltfMaker strip = drawn_as(5, {0, 3, 1, 4, 2, 5});
    const Scene scene = read_gltf("in.glb", strip.glb());
    OcclusionMap map = map_over(0);
    map.uvs = UvSet{std::vector<glm::dvec2>(scene.positions.size(), glm::dvec2(0.5)), {}};
    const Written written = take_apart(gltf_contents_with_map("out.glb", scene, map).contents);
    json rest = written.document["meshes"];
    std::vector<float> places(18, 0.0f);  // the last three vertices are in no triangle
    std::fill_n(places.begin(), 12, 0.5f);
    EXPECT_EQ(written.floats(written.attributes(0)["TEXCOORD_1"]), places);
    rest[0]["primitives"][0]["attributes"].erase("TEXCOORD_1");
    EXPECT_EQ(rest, strip.document["meshes"]);
    EXPECT_EQ(written.document["materials"][0]["occlusionTexture"]["texCoord"], 1);
    EXPECT_EQ(written.document["samplers"][0], (json{{"name", "surfelao occlusion"},
                                                     {"magFilter", 9729},
                                                     {"minFilter", 9729},
                                                     {"wrapS", 33071},
                                                     {"wrapT", 33071}}));

    // primitives without triangles, meshes outside of the scene
    const Written repeated = take_apart(baked("out.glb", repeated_sheet().glb(), Way::new_map));
    EXPECT_EQ(repeated.document["meshes"].size(), 4u);
    EXPECT_EQ(repeated.document["meshes"][0], repeated_sheet().document["meshes"][0]);
    const Written split = take_apart(baked("out.glb", split_sheet().glb(), Way::new_map));
    EXPECT_EQ(split.document["meshes"][0]["primitives"][1],
              split_sheet().document["meshes"][0]["primitives"][1]);
    // primitives that share vertices share the copies
    EXPECT_EQ(split.attributes(0, 0)["POSITION"], split.attributes(0, 2)["POSITION"]);
    EXPECT_NE(split.attributes(0, 0)["TEXCOORD_1"], nullptr);
    EXPECT_EQ(split.attributes(0, 0)["TEXCOORD_1"], split.attributes(0, 2)["TEXCOORD_0"]);
}

/// A strip of so many vertices in a row of triangles, indices of 16 bits, each corner elsewhere.
TEST(GltfCut, IndicesWidenWhereTheyMust)
{
    for (const std::size_t corners : {65535u, 65538u}) {
        GltfMaker maker;
        std::string places, indices;
        for (const float number : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
            places += bytes_of<float>({number});
        for (std::size_t i = 0; i < corners; ++i)
            indices += bytes_of<std::uint16_t>({static_cast<std::uint16_t>(i % 3)});
        maker.add_accessor(maker.add_view(places), 5126, "VEC3", 3);
        maker.add_accessor(maker.add_view(indices), 5123, "SCALAR", corners);
        maker.add("meshes",
                  {{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}});
        maker.add("nodes", {{"mesh", 0}});
        const Scene scene = read_gltf("in.glb", maker.glb());
        OcclusionMap map = map_over(0);
        map.uvs.emplace();
        for (std::uint32_t i = 0; i < corners; ++i)
            map.uvs->values.emplace_back(i / 131072.0, 0.5);
        for (std::uint32_t i = 0; i < corners; i += 3)
            map.uvs->corners.emplace_back(i, i + 1, i + 2);
        const std::string glb = gltf_contents_with_map("out.glb", scene, map).contents;
        const Written written = take_apart(glb);
        const json& of = written.document["meshes"][0]["primitives"][0];
        const json& accessor = written.document["accessors"][of["indices"].get<std::size_t>()];
        EXPECT_EQ(accessor["componentType"], corners == 65535 ? 5123 : 5125);
        EXPECT_EQ(place_in_map(read_as_foreign(glb), corners / 3 - 1, 2), map.uvs->values.back());
    }
}

TEST(GltfCut, BakingABakedFileIsBakingTheOriginal)
{
    std::vector<CutCase> all = cut_cases();
    for (const test::MapCase& made : map_cases())
        all.push_back({made.name, made.maker});
    for (const auto& [name, maker] : all) {
        const std::string uri = make_data_uri("application/octet-stream", maker.bin);
        for (const char* path : {"out.glb", "out.gltf"}) {
            const std::string original =
                std::string(path) == "out.glb" ? maker.glb() : maker.gltf(uri);
            for (const Way first : kWays) {
                const std::string once = baked(path, original, first);
                const bool stays = std::string(name) == "instanced" && first != Way::map;
                for (const Way second : kWays)
                    EXPECT_TRUE(baked(path, once, second) == baked(path, original, second) ||
                                (stays && second == Way::map))
                        << name << ' ' << path << ' ' << int(first) << int(second);
            }
        }
    }
}

// What another program has moved about is read as it stands, never put together wrongly.
TEST(GltfCut, AnEditedResultIsReadAsItIs)
{
    const Written once = take_apart(baked("out.glb", sheet().glb(), Way::new_map));
    const struct {
        const char* name;
        void (*edit)(json&, std::string&);
    } edits[] = {{"a vertex has moved", [](json&, std::string& bin) { bin[8] = 1; }},
                 {"an attribute is new",
                  [](json& document, std::string&) {
                      json& attributes = document["meshes"][0]["primitives"][0]["attributes"];
                      attributes["_NEW"] = attributes["_ID"];
                  }},
                 {"an attribute is gone",
                  [](json& document, std::string&) {
                      document["meshes"][0]["primitives"][0]["attributes"].erase("_ID");
                  }},
                 {"accessors have moved",
                  [](json& document, std::string&) {
                      document["meshes"][0]["primitives"][0]["extras"]["surfelao"]["original"]
                              ["attributes"]["POSITION"] = 1000;
                  }},
                 {"an attribute is another", [](json& document, std::string&) {
                      document["meshes"][0]["primitives"][0]["attributes"]["_ID"] = 3;
                      document["accessors"][3]["count"] = document["accessors"].back()["count"];
                      document["accessors"][3]["bufferView"] = document["bufferViews"].size() - 1;
                  }}};
    for (const auto& [name, edit] : edits) {
        GltfMaker edited{once.document, once.bin};
        edit(edited.document, edited.bin);
        const Scene scene = read_gltf("edited.glb", edited.glb());
        EXPECT_GT(scene.positions.size(), 9u) << name;
        EXPECT_EQ(scene.triangles.size(), 8u) << name;
        // and is an original from now on: baked again and again it is the same
        const std::string again = baked("out.glb", edited.glb(), Way::new_map);
        EXPECT_EQ(read_gltf("again.glb", again).positions, scene.positions) << name;
        EXPECT_TRUE(baked("out.glb", again, Way::new_map) == again) << name;
    }
}

TEST(GltfCut, WhatCannotBeCutIsRefused)
{
    const auto refusal = [](const GltfMaker& maker) -> std::string {
        const Scene scene = read_gltf("made.glb", maker.glb());
        OcclusionMap map = map_over(0);
        map.uvs = places_for(scene);
        try {
            static_cast<void>(gltf_contents_with_map("out.glb", scene, map));
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    GltfMaker maker = sheet();
    primitive(maker)["attributes"]["_ODD"] = 77;
    EXPECT_EQ(refusal(maker), "made.glb: mesh 0 primitive 0 attributes/_ODD is no accessor");
    primitive(maker)["attributes"]["_ODD"] = primitive(maker)["indices"];
    EXPECT_EQ(refusal(maker),
              "made.glb: mesh 0 primitive 0 attributes/_ODD accessor 4 has 24 elements for 9 "
              "vertices");
}

TEST(GltfCut, PlacesOfWrongSizesAreRefused)
{
    const TemporaryFolder folder;
    const Scene scene = read_gltf("in.glb", sheet().glb());
    const UvSet good = places_for(scene);
    UvSet few = good, far = good, odd = good;
    few.corners.pop_back();
    far.corners[0].x = static_cast<std::uint32_t>(far.values.size());
    odd.values[0].x = std::numeric_limits<double>::quiet_NaN();
    for (const UvSet& uvs : {few, far, odd, UvSet{{{0, 0}}, {}}, UvSet{}}) {
        OcclusionMap map = map_over(0);
        map.uvs = uvs;
        EXPECT_THROW(write_scene_with_map(folder / "out.glb", scene, map), SettingsError);
    }
    EXPECT_EQ(folder.file_count(), 0);
}

}  // namespace
}  // namespace surfelao
