#include "files/gltf_maps.h"

#include "files/gltf_cuts.h"
#include "files/gltf_json.h"
#include "files/gltf_textures.h"
#include "files/gltf_uri.h"
#include "files/gltf_uses.h"
#include "surfels/number_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <span>

namespace surfelao {
namespace {

using nlohmann::json;

constexpr int kLinearFilter = 9729;
constexpr int kLinearMipmapLinear = 9987;
constexpr int kClampingWrap = 33071;

/// Whether a primitive has no material, or one that could get a texture.
bool can_be_occluded(const json& document, const json& primitive)
{
    const json& material = member(primitive, "material");
    return material.is_null() || entry(document, "materials", material).is_object();
}

/// Primitives that the map lies over, and how many have no place for it.
struct Covered {
    std::vector<Occluded> primitives;
    std::size_t without = 0;
};

/// Those with TEXCOORD_set.
Covered with_own_places(json& document, const GltfAsset& asset, std::uint32_t set)
{
    const std::string name = "TEXCOORD_" + std::to_string(set);
    Covered covered;
    for (std::size_t mesh = 0; mesh < asset.group_of_primitive.size(); ++mesh) {
        const std::vector<std::int32_t>& groups = asset.group_of_primitive[mesh];
        for (std::size_t p = 0; p < groups.size(); ++p) {
            if (groups[p] < 0)
                continue;
            json& primitive = document["meshes"][mesh]["primitives"][p];
            if (!primitive["attributes"].contains(name))
                ++covered.without;
            else if (can_be_occluded(document, primitive))
                covered.primitives.push_back({&primitive, set});
        }
    }
    return covered;
}

/// Gives all primitives with triangles that have a place the new coordinates, each use of a mesh
/// its own.
Covered with_new_places(json& document, const GltfAsset& asset, const Scene& scene,
                        const UvSet& uvs, AddedData& added)
{
    Covered covered;
    const std::vector<std::size_t> meshes = separate_uses(document, asset.uses);
    GltfCutter cutter(document, asset, added);
    const auto has_place = [&](const GltfTriangles& triangles) {
        const std::span<const glm::uvec3> corners(uvs.corners);
        return corners.empty() ||
               std::ranges::any_of(
                   corners.subspan(triangles.first, triangles.count),
                   [](const glm::uvec3& corner) { return corner != glm::uvec3(UvSet::kNone); });
    };
    for (std::size_t p = 0; p < scene.parts.size(); ++p) {
        const Part& part = scene.parts[p];
        const GltfPart& in_file = asset.parts[p];
        const GltfCut cut = cut_part(scene, part, in_file, uvs);
        std::optional<std::size_t> coordinates;
        for (const GltfTriangles& triangles : in_file.primitives) {
            if (triangles.count == 0)
                continue;
            if (!has_place(triangles)) {
                ++covered.without;
                continue;
            }
            if (!coordinates)
                coordinates = added.add_floats(2, cut.places, kAddedCoordinates);
            json& primitive =
                document["meshes"][meshes[in_file.use]]["primitives"][triangles.primitive];
            if (!cut.copied.empty())
                cutter.cut(primitive,
                           numbered("mesh", static_cast<std::size_t>(part.mesh)) +
                               numbered(" primitive", triangles.primitive),
                           cut,
                           std::span(cut.triangles)
                               .subspan(triangles.first - part.first_triangle, triangles.count));
            const std::size_t set = free_set(primitive["attributes"]);
            primitive["attributes"]["TEXCOORD_" + std::to_string(set)] = *coordinates;
            if (can_be_occluded(document, primitive))
                covered.primitives.push_back({&primitive, set});
        }
    }
    return covered;
}

}  // namespace

std::vector<std::string> add_map(json& document, const GltfAsset& asset, const Scene& scene,
                                 const OcclusionMap& map, const std::filesystem::path& path,
                                 AddedData& added)
{
    const std::string own = "TEXCOORD_" + std::to_string(map.uv_set);
    const Covered covered = map.uvs ? with_new_places(document, asset, scene, *map.uvs, added)
                                    : with_own_places(document, asset, map.uv_set);
    if (covered.primitives.empty())
        fail_gltf(asset.path, "",
                  "has no primitive with " + (map.uvs ? "a place in the map" : own) +
                      ", which a map is to lie over");
    json image = {{"mimeType", "image/png"}};
    if (const std::optional<std::filesystem::path> file = map_file_of(path))
        image["uri"] = encode_uri(file->filename().string());
    else
        image["bufferView"] = added.add_bytes(map.png);
    // a file's own coordinates may lie beyond [0, 1]: that map repeats
    json sampler = {{"magFilter", kLinearFilter},
                    {"minFilter", map.uvs ? kLinearFilter : kLinearMipmapLinear}};
    if (map.uvs)
        sampler["wrapS"] = sampler["wrapT"] = kClampingWrap;
    const std::size_t texture = add_occlusion_texture(document, image, sampler);
    const std::size_t replaced = show_occlusion_texture(document, texture, covered.primitives);

    std::vector<std::string> notes;
    if (replaced > 0)
        notes.push_back("the map takes the place of the occlusionTexture of " +
                        count_text(replaced, "material"));
    if (covered.without > 0)
        notes.push_back(count_text(covered.without, "primitive") + " without " +
                        (map.uvs ? "a place in it" : own) +
                        " left as they are: no map lies over them");
    return notes;
}

}  // namespace surfelao
