#include "files/gltf_io.h"

#include "files/file_type.h"
#include "files/gltf_added.h"
#include "files/gltf_asset.h"
#include "files/gltf_json.h"
#include "files/gltf_links.h"
#include "files/gltf_looks.h"
#include "files/gltf_maps.h"
#include "files/gltf_pose.h"
#include "files/gltf_refined.h"
#include "files/gltf_uri.h"
#include "files/gltf_uses.h"
#include "files/maker_mark.h"
#include "files/sidecars.h"
#include "surfels/errors.h"

#include <nlohmann/json.hpp>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void pad_to_four(std::string& bytes, char filler)
{
    bytes.resize((bytes.size() + 3) / 4 * 4, filler);
}

std::vector<float> occlusion_values(std::span<const Occlusion> occlusion)
{
    std::vector<float> values;
    values.reserve(occlusion.size());
    for (const Occlusion& vertex : occlusion)
        values.push_back(vertex.occlusion);
    return values;
}

/// World directions as normals of mesh space. A normal n becomes M^-T n in the world, so what comes
/// back is M^T n.
std::vector<float> bent_normal_values(std::span<const Occlusion> occlusion, const GltfPart& part)
{
    const glm::dmat3 rigid = scaled_to_one(part.to_world);
    std::vector<float> values;
    values.reserve(3 * occlusion.size());
    for (std::size_t v = 0; v < occlusion.size(); ++v) {
        const glm::dmat3 to_world =
            part.vertices_to_world.empty() ? rigid : glm::dmat3(part.vertices_to_world[v]);
        const glm::dvec3 direction = glm::dvec3(occlusion[v].bent_normal) * to_world;
        const double length = glm::length(direction);
        const glm::vec3 unit = length > 0.0 ? glm::vec3(direction / length) : glm::vec3(0.0f);
        values.insert(values.end(), {unit.x, unit.y, unit.z});
    }
    return values;
}

/// Of the primitives that a part stands for, those that share its vertices, all but those of which
/// nothing was baked.
std::vector<std::size_t> baked_primitives(const GltfAsset& asset, std::size_t part,
                                          const std::vector<bool>& unbaked)
{
    std::vector<std::size_t> baked;
    for (const GltfTriangles& triangles : asset.parts[part].primitives) {
        if (is_baked(triangles, unbaked))
            baked.push_back(triangles.primitive);
    }
    return baked;
}

/// Adds the attributes of all parts; returns notes on how they are shown.
std::vector<std::string> add_attributes(json& document, const GltfAsset& asset, const Scene& scene,
                                        std::span<const Occlusion> occlusion,
                                        const WriteOptions& options, AddedData& added)
{
    const std::vector<std::size_t> meshes =
        separate_uses(document, asset.uses, asset.baked_uses(options.unbaked));
    GltfLooks looks(document, asset, options, added);
    for (std::size_t p = 0; p < scene.parts.size(); ++p) {
        const Part& part = scene.parts[p];
        const std::vector<std::size_t> baked = baked_primitives(asset, p, options.unbaked);
        if (part.vertex_count == 0 || baked.empty())
            continue;
        const auto values = occlusion.subspan(part.first_vertex, part.vertex_count);
        const std::size_t scalar = added.add_floats(1, occlusion_values(values));
        const std::size_t bent = added.add_floats(3, bent_normal_values(values, asset.parts[p]));

        json& primitives = document["meshes"][meshes[asset.parts[p].use]]["primitives"];
        std::vector<json*> of_part;
        for (const std::size_t i : baked) {
            json& attributes = primitives[i]["attributes"];
            attributes["_OCCLUSION"] = scalar;
            attributes["_BENT_NORMAL"] = bent;
            of_part.push_back(&primitives[i]);
        }
        looks.add(of_part, values);
    }
    looks.finish();
    return looks.notes();
}

std::string make_glb(const json& document, const std::string& bin, const GltfAsset& asset,
                     const fs::path& path)
{
    std::string text = document.dump();
    pad_to_four(text, ' ');
    std::uint64_t size = 12 + 8 + text.size() + 8 + bin.size();
    for (const std::string_view chunk : asset.other_chunks)
        size += (chunk.size() + 3) / 4 * 4;
    if (size > std::numeric_limits<std::uint32_t>::max())
        throw InputError(path.string() + ": would be larger than the 4 GiB that a .glb may have");
    std::string file;
    file.reserve(size);
    const auto append_32 = [&](std::uint64_t value) {
        for (int shift = 0; shift < 32; shift += 8)
            file.push_back(static_cast<char>(value >> shift & 0xFF));
    };
    file += "glTF";
    append_32(2);
    append_32(size);
    append_32(text.size());
    file += "JSON";
    file += text;
    append_32(bin.size());
    file.append("BIN\0", 4);
    file += bin;
    for (const std::string_view chunk : asset.other_chunks) {
        file += chunk;
        pad_to_four(file, '\0');
    }
    return file;
}

/// Where the extras of the asset are no object, there is no place for a mark.
void set_mark(json& document, const std::string& mark)
{
    json& asset = document["asset"];
    const auto extras = asset.find("extras");
    if (extras != asset.end() && !extras->is_object())
        return;
    if (!mark.empty())
        asset["extras"][kMarkKey] = mark;
    else if (extras != asset.end())
        extras->erase(kMarkKey);
}

/// Adds to the document and returns notes.
using AddResult = std::function<std::vector<std::string>(json&, const GltfAsset&, AddedData&)>;

WrittenFile contents_with(const fs::path& path, const Scene& scene, const WriteOptions& options,
                          const AddResult& add)
{
    const auto* asset = dynamic_cast<const GltfAsset*>(scene.asset.get());
    if (asset == nullptr)
        throw InputError(
            path.string() +
            ": only a scene that was read from glTF can be written as glTF, use .ply or .obj");
    json document = *asset->document;
    const bool binary = type_of(path) == FileType::glb;
    std::string bytes;
    if (binary)
        bytes = gather(document, asset->buffers, asset->path);
    WrittenFile written;
    note_missing(turn_uris(document, asset->path, path), written.notes);
    if (!binary)
        embed_buffers(document, asset->buffers, path);

    const std::size_t buffer = binary ? 0 : member(document, "buffers").size();
    set_mark(document, options.mark);
    AddedData added(document);
    const std::vector<std::string> notes = add(document, *asset, added);
    written.notes.insert(written.notes.end(), notes.begin(), notes.end());
    bytes += added.finish(buffer, bytes.size());
    if (!binary && !bytes.empty())  // a map beside the file adds none
        document["buffers"].push_back({{"uri", make_data_uri("application/octet-stream", bytes)}});
    if (!bytes.empty())
        document["buffers"][buffer]["byteLength"] = bytes.size();
    written.contents = binary ? make_glb(document, bytes, *asset, path) : document.dump(2) + '\n';
    return written;
}

}  // namespace

WrittenFile gltf_contents(const fs::path& path, const Scene& scene,
                          std::span<const Occlusion> occlusion, const WriteOptions& options)
{
    SURFELAO_CHECK(occlusion.size() == scene.positions.size());
    return contents_with(
        path, scene, options, [&](json& document, const GltfAsset& asset, AddedData& added) {
            return add_attributes(document, asset, scene, occlusion, options, added);
        });
}

std::string refined_gltf(const Scene& scene, const Refinement& refinement,
                         std::span<const glm::vec3> normals)
{
    const auto& source = dynamic_cast<const GltfAsset&>(*scene.asset);
    return contents_with(source.path, scene, {},
                         [&](json& document, const GltfAsset& asset, AddedData& added) {
                             refine_meshes(document, asset, scene, refinement, normals, added);
                             return std::vector<std::string>();
                         })
        .contents;
}

WrittenFile gltf_contents_with_blended_map(const fs::path& path, const Scene& scene,
                                           const BlendedMap& map, const WriteOptions& options)
{
    return contents_with(
        path, scene, options, [&](json& document, const GltfAsset& asset, AddedData& added) {
            return add_blended_map(document, asset, scene, map, options.unbaked, added);
        });
}

WrittenFile gltf_contents_with_map(const fs::path& path, const Scene& scene,
                                   const OcclusionMap& map, const WriteOptions& options)
{
    return contents_with(
        path, scene, options, [&](json& document, const GltfAsset& asset, AddedData& added) {
            return add_map(document, asset, scene, map, path, options.unbaked, added);
        });
}

}  // namespace surfelao
