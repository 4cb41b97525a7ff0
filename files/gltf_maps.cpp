#include "files/gltf_maps.h"

#include "files/gltf_cuts.h"
#include "files/gltf_json.h"
#include "files/gltf_textures.h"
#include "files/gltf_uri.h"
#include "files/gltf_uses.h"
#include "surfels/number_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

namespace surfelao {
namespace {

using nlohmann::json;

constexpr int kLinearFilter = 9729;
constexpr int kLinearMipmapLinear = 9987;
constexpr int kClampingWrap = 33071;

json clamping_sampler()
{
    return {{"magFilter", kLinearFilter},
            {"minFilter", kLinearFilter},
            {"wrapS", kClampingWrap},
            {"wrapT", kClampingWrap}};
}

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
    std::vector<std::vector<std::size_t>> sets = {};  ///< of each primitive, where they are new
};

/// A mesh of the document and a primitive of it.
using PrimitivePlace = std::pair<std::size_t, std::size_t>;

/// All that draw triangles; where not all were baked, those of which something was: a mesh that
/// some of its uses show unbaked is copied for the others.
std::set<PrimitivePlace> baked_primitives_of(json& document, const GltfAsset& asset,
                                             const std::vector<bool>& unbaked)
{
    std::set<PrimitivePlace> found;
    if (unbaked.empty()) {
        for (std::size_t mesh = 0; mesh < asset.group_of_primitive.size(); ++mesh) {
            const std::vector<std::int32_t>& groups = asset.group_of_primitive[mesh];
            for (std::size_t p = 0; p < groups.size(); ++p) {
                if (groups[p] >= 0)
                    found.emplace(mesh, p);
            }
        }
        return found;
    }
    std::vector<bool> wanted = asset.baked_uses(unbaked);
    std::set<std::size_t> shown_unbaked;
    for (std::size_t u = 0; u < wanted.size(); ++u) {
        if (!wanted[u])
            shown_unbaked.insert(asset.uses[u].mesh);
    }
    for (std::size_t u = 0; u < wanted.size(); ++u)
        wanted[u] = wanted[u] && shown_unbaked.contains(asset.uses[u].mesh);
    const std::vector<std::size_t> meshes = separate_uses(document, asset.uses, wanted);
    for (const GltfPart& part : asset.parts) {
        for (const GltfTriangles& triangles : part.primitives) {
            if (is_baked(triangles, unbaked))
                found.emplace(meshes[part.use], triangles.primitive);
        }
    }
    return found;
}

/// Those with TEXCOORD_set.
Covered with_own_places(json& document, const GltfAsset& asset, std::uint32_t set,
                        const std::vector<bool>& unbaked)
{
    const std::string name = "TEXCOORD_" + std::to_string(set);
    Covered covered;
    for (const auto& [mesh, p] : baked_primitives_of(document, asset, unbaked)) {
        json& primitive = document["meshes"][mesh]["primitives"][p];
        if (!primitive["attributes"].contains(name))
            ++covered.without;
        else if (can_be_occluded(document, primitive))
            covered.primitives.push_back({&primitive, set});
    }
    return covered;
}

/// Gives all primitives with triangles that have a place the new coordinates, each use of a mesh
/// its own.
Covered with_new_places(json& document, const GltfAsset& asset, const Scene& scene,
                        std::span<const UvSet> sets, const std::vector<bool>& unbaked,
                        AddedData& added)
{
    Covered covered;
    const std::vector<std::size_t> meshes =
        separate_uses(document, asset.uses, asset.baked_uses(unbaked));
    GltfCutter cutter(document, asset, added);
    const auto has_place = [](const UvSet& uvs, const GltfTriangles& triangles) {
        const std::span<const glm::uvec3> corners(uvs.corners);
        return corners.empty() ||
               std::ranges::any_of(
                   corners.subspan(triangles.first, triangles.count),
                   [](const glm::uvec3& corner) { return corner != glm::uvec3(UvSet::kNone); });
    };
    for (std::size_t p = 0; p < scene.parts.size(); ++p) {
        const Part& part = scene.parts[p];
        const GltfPart& in_file = asset.parts[p];
        const GltfCut cut = cut_part(scene, part, in_file, sets);
        std::vector<std::size_t> coordinates;
        for (const GltfTriangles& triangles : in_file.primitives) {
            if (triangles.count == 0 || !is_baked(triangles, unbaked))
                continue;
            if (std::ranges::none_of(sets,
                                     [&](const UvSet& uvs) { return has_place(uvs, triangles); })) {
                ++covered.without;
                continue;
            }
            for (std::size_t s = coordinates.size(); s < sets.size(); ++s)
                coordinates.push_back(added.add_floats(2, cut.places[s], kAddedCoordinates));
            json& primitive =
                document["meshes"][meshes[in_file.use]]["primitives"][triangles.primitive];
            if (!cut.copied.empty())
                cutter.cut(primitive,
                           numbered("mesh", static_cast<std::size_t>(part.mesh)) +
                               numbered(" primitive", triangles.primitive),
                           cut,
                           std::span(cut.triangles)
                               .subspan(triangles.first - part.first_triangle, triangles.count));
            std::vector<std::size_t> numbers;
            for (const std::size_t of_set : coordinates) {
                numbers.push_back(free_set(primitive["attributes"]));
                primitive["attributes"]["TEXCOORD_" + std::to_string(numbers.back())] = of_set;
            }
            if (!can_be_occluded(document, primitive))
                continue;
            covered.primitives.push_back({&primitive, numbers.front()});
            covered.sets.push_back(std::move(numbers));
        }
    }
    return covered;
}

/// From a material (null: none) to its page; pages: OcclusionMap::pages.
std::map<json, std::size_t> pages_of_materials(const json& document, const GltfAsset& asset,
                                               std::span<const std::uint32_t> pages)
{
    std::map<json, std::size_t> found;
    for (const GltfPart& part : asset.parts) {
        const json& primitives =
            member(entry(document, "meshes", asset.uses[part.use].mesh), "primitives");
        for (const GltfTriangles& triangles : part.primitives)
            if (!pages.empty() && triangles.count > 0)
                found.emplace(member(primitives.at(triangles.primitive), "material"),
                              pages[triangles.first]);
    }
    return found;
}

/// The primitives of each page.
std::vector<std::vector<Occluded>> by_page(std::span<const Occluded> primitives,
                                           const std::map<json, std::size_t>& page_of)
{
    std::vector<std::vector<Occluded>> pages;
    for (const Occluded& occluded : primitives) {
        const auto found = page_of.find(member(*occluded.primitive, "material"));
        const std::size_t page = found == page_of.end() ? 0 : found->second;
        pages.resize(std::max(pages.size(), page + 1));
        pages[page].push_back(occluded);
    }
    return pages;
}

}  // namespace

std::vector<std::string> add_map(json& document, const GltfAsset& asset, const Scene& scene,
                                 const OcclusionMap& map, const std::filesystem::path& path,
                                 const std::vector<bool>& unbaked, AddedData& added)
{
    const std::string own = "TEXCOORD_" + std::to_string(map.uv_set);
    const Covered covered =
        map.uvs ? with_new_places(document, asset, scene, std::span(&*map.uvs, 1), unbaked, added)
                : with_own_places(document, asset, map.uv_set, unbaked);
    if (covered.primitives.empty())
        fail_gltf(asset.path, "",
                  "has no primitive with " + (map.uvs ? "a place in the map" : own) +
                      ", which a map is to lie over");
    // a file's own coordinates may lie beyond [0, 1]: that map repeats
    const json repeating = {{"magFilter", kLinearFilter}, {"minFilter", kLinearMipmapLinear}};
    const std::optional<std::filesystem::path> file = map_file_of(path);
    const std::vector<std::vector<Occluded>> pages =
        by_page(covered.primitives, pages_of_materials(document, asset, map.pages));
    std::size_t replaced = 0;
    for (std::size_t page = 0; page < pages.size(); ++page) {
        if (pages[page].empty())
            continue;
        json image = {{"mimeType", "image/png"}};
        if (file && map.more_pngs.empty())
            image["uri"] = encode_uri(file->filename().string());
        else
            image["bufferView"] = added.add_bytes(page == 0 ? map.png : map.more_pngs[page - 1]);
        const std::size_t texture =
            add_occlusion_texture(document, image, map.uvs ? clamping_sampler() : repeating);
        replaced += show_occlusion_texture(document, texture, pages[page]);
    }

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

std::vector<std::string> add_blended_map(json& document, const GltfAsset& asset, const Scene& scene,
                                         const BlendedMap& map, const std::vector<bool>& unbaked,
                                         AddedData& added)
{
    const Covered covered = with_new_places(document, asset, scene, map.uvs, unbaked, added);
    if (covered.primitives.empty())
        fail_gltf(asset.path, "", "has no primitive with a place in the map");
    std::vector<std::size_t> textures;
    for (const std::string& png : map.pngs)
        textures.push_back(add_occlusion_texture(
            document, {{"mimeType", "image/png"}, {"bufferView", added.add_bytes(png)}},
            clamping_sampler()));
    std::map<std::pair<json, std::vector<std::size_t>>, std::vector<json*>> primitives_of;
    for (std::size_t p = 0; p < covered.primitives.size(); ++p) {
        json* const primitive = covered.primitives[p].primitive;
        primitives_of[{member(*primitive, "material"), covered.sets[p]}].push_back(primitive);
    }
    for (const auto& [material_and_sets, primitives] : primitives_of) {
        json blended = json::array();
        for (std::size_t page = 0; page < textures.size(); ++page)
            blended.push_back(
                {{"index", textures[page]}, {"texCoord", material_and_sets.second[page]}});
        set_blended_material(document, material_and_sets.first, std::move(blended), primitives);
    }
    std::vector<std::string> notes;
    if (covered.without > 0)
        notes.push_back(count_text(covered.without, "primitive") +
                        " without a place in it left as they are: no map lies over them");
    return notes;
}

}  // namespace surfelao
