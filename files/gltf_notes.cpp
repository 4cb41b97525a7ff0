#include "files/gltf_notes.h"

#include "files/gltf_json.h"

#include <nlohmann/json.hpp>

#include <set>

namespace surfelao {
namespace {

using nlohmann::json;

/// "1 node" or "2 nodes", then the rest of the sentence for one or for many.
std::string counted(std::size_t count, const std::string& noun, const std::string& one,
                    const std::string& many)
{
    return std::to_string(count) + ' ' + noun + (count == 1 ? " " + one : "s " + many);
}

/// What the meshes in the scene hold.
struct Kinds {
    std::size_t without_triangles = 0;       ///< primitives of points and lines
    std::set<std::size_t> see_through = {};  ///< materials with alphaMode MASK or BLEND
};

Kinds find_kinds(const GltfAsset& asset, const PlacedNodes& nodes)
{
    Kinds kinds;
    std::set<std::size_t> seen;
    for (const MeshNode& use : nodes.mesh_nodes) {
        if (!seen.insert(use.mesh).second)
            continue;
        const json& primitives = (*asset.document)["meshes"][use.mesh]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            if (asset.group_of_primitive[use.mesh][p] < 0) {
                if (member(primitives[p]["attributes"], "POSITION").is_number())
                    ++kinds.without_triangles;
                continue;
            }
            const json& material = member(primitives[p], "material");
            const json& mode = member(entry(*asset.document, "materials", material), "alphaMode");
            if (mode == "MASK" || mode == "BLEND")
                kinds.see_through.insert(material.get<std::size_t>());
        }
    }
    return kinds;
}

}  // namespace

std::vector<std::string> gltf_notes(const GltfAsset& asset, const PlacedNodes& nodes)
{
    std::vector<std::string> notes;
    if (nodes.hidden_count > 0)
        notes.push_back(counted(nodes.hidden_count, "node", "is hidden and left out",
                                "are hidden and left out"));
    const Kinds kinds = find_kinds(asset, nodes);
    if (kinds.without_triangles > 0)
        notes.push_back(counted(kinds.without_triangles, "primitive",
                                "of points or lines is left out",
                                "of points or lines are left out"));
    if (!kinds.see_through.empty())
        notes.push_back(counted(kinds.see_through.size(), "material",
                                "with alphaMode MASK or BLEND is taken as solid",
                                "with alphaMode MASK or BLEND are taken as solid"));
    const json& animations = member(*asset.document, "animations");
    if (animations.is_array() && !animations.empty())
        notes.push_back(counted(animations.size(), "animation",
                                "is not played: the default pose is baked",
                                "are not played: the default pose is baked"));
    return notes;
}

}  // namespace surfelao
