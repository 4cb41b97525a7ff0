/// gltf_map_cases.h: small glTF files that get maps of occlusion.
#pragma once

#include "gltf_maker.h"
#include "written_gltf.h"

#include "files/gltf_io.h"
#include "files/gltf_uri.h"
#include "files/maker_mark.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace surfelao::test {

/// Two texels of grey: 0 and 255.
inline std::string two_texels()
{
    return *decode_data_uri(
        "data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAAAAADRSSBWAAAAC0lEQVR42mNg+"
        "A8AAQIBANEay48AAAAASUVORK5CYII=");
}

inline const OcclusionMap& map_over(std::uint32_t set)
{
    static const OcclusionMap maps[] = {{two_texels(), 0, {}}, {two_texels(), 1, {}}};
    return maps[set];
}

/// A square with TEXCOORD_0 and no material.
inline GltfMaker laid_out_square()
{
    GltfMaker maker = square();
    primitive(maker)["attributes"]["TEXCOORD_0"] = maker.add_accessor(
        maker.add_view(bytes_of<float>({0, 0, 1, 0, 1, 1, 0, 1})), 5126, "VEC2", 4);
    return maker;
}

/// With a material whose base colour is a picture in the file.
inline GltfMaker painted_square()
{
    GltfMaker maker = laid_out_square();
    maker.add("images", {{"bufferView", maker.add_view(two_texels())}, {"mimeType", "image/png"}});
    maker.add("textures", {{"source", 0}});
    maker.add("materials",
              {{"name", "wood"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    primitive(maker)["material"] = 0;
    return maker;
}

/// Its picture is its roughness and its occlusion.
inline GltfMaker packed_square()
{
    GltfMaker maker = painted_square();
    maker.document["materials"][0] = {
        {"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}},
        {"occlusionTexture", {{"index", 0}, {"strength", 0.5}}}};
    return maker;
}

/// The same, its material used by a mesh outside of the scene and by a primitive without
/// coordinates as well.
inline GltfMaker shared(GltfMaker maker)
{
    maker.add("meshes", maker.document["meshes"][0]);
    maker.document["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", 0}}}, {"material", 0}});
    maker.add("nodes", {{"mesh", 1}});
    return maker;
}

struct MapCase {
    const char* name;
    GltfMaker maker;
    std::optional<std::size_t> material;  ///< of the primitive with the map; none: a new one
    std::vector<std::string> notes;
};

inline std::vector<MapCase> map_cases()
{
    GltfMaker plain = laid_out_square();
    plain.add("materials", {{"name", "plain"}});
    primitive(plain)["material"] = 0;
    GltfMaker colored = painted_square();
    primitive(colored)["attributes"]["COLOR_0"] =
        colored.add_vectors<float>({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0});
    const std::string replaced = "the map takes the place of the occlusionTexture of 1 material";
    const std::string without =
        "1 primitive without TEXCOORD_0 left as they are: no map lies over "
        "them";
    return {{"bare", laid_out_square(), {}, {}},
            {"plain", plain, 0, {}},
            {"painted", painted_square(), 0, {}},
            {"coloured", colored, 0, {}},
            {"packed", packed_square(), {}, {replaced}},
            {"shared", shared(painted_square()), {}, {without}},
            {"packed and shared", shared(packed_square()), {}, {replaced, without}}};
}

/// New coordinates for all corners; each has a place of its own, but in every third triangle, whose
/// corners lie where the vertex says, and the last one, which has none.
inline UvSet places_for(const Scene& scene)
{
    UvSet uvs;
    for (std::size_t v = 0; v < scene.positions.size(); ++v)
        uvs.values.emplace_back(static_cast<double>(v) / 512.0, 0.25);
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        if (t % 3 == 2) {
            uvs.corners.push_back(scene.triangles[t]);
            continue;
        }
        for (int k = 0; k < 3; ++k)
            uvs.values.emplace_back(static_cast<double>(t) / 512.0, 0.5 + k / 8.0);
        const auto end = static_cast<std::uint32_t>(uvs.values.size());
        uvs.corners.emplace_back(end - 3, end - 2, end - 1);
    }
    uvs.corners.back() = glm::uvec3(UvSet::kNone);
    return uvs;
}

/// What a bake makes.
enum class Way { vertices, map, new_map, blended };
inline constexpr Way kWays[] = {Way::vertices, Way::map, Way::new_map, Way::blended};

/// Two of three triangles on each page.
inline BlendedMap blended_for(const Scene& scene)
{
    BlendedMap map{{two_texels(), two_texels(), two_texels()}, {}};
    for (std::size_t page = 0; page < 3; ++page) {
        map.uvs[page] = places_for(scene);
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            if ((t + page) % 3 == 0)
                map.uvs[page].corners[t] = glm::uvec3(UvSet::kNone);
        }
        for (glm::dvec2& uv : map.uvs[page].values)
            uv.y += 0.0625 * static_cast<double>(page + 1);
    }
    return map;
}

/// A result at `path` of what stands there in `contents`.
inline std::string baked(const char* path, const std::string& contents, Way way)
{
    const Scene scene = read_gltf(path, contents);
    const WriteOptions options = {
        .mark = make_mark("bake", way == Way::vertices ? "vertices" : "at=texels")};
    if (way == Way::vertices)
        return gltf_contents(path, scene, pattern(scene), options).contents;
    if (way == Way::blended)
        return gltf_contents_with_blended_map(path, scene, blended_for(scene), options).contents;
    OcclusionMap map = map_over(0);
    if (way == Way::new_map)
        map.uvs = places_for(scene);
    return gltf_contents_with_map(path, scene, map, options).contents;
}

}  // namespace surfelao::test
