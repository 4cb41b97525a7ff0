#include "files/gltf_notes.h"

#include "files/gltf_json.h"
#include "surfels/number_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
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

/// Of a primitive that the reader has taken.
std::size_t corner_count(const json& document, const json& primitive)
{
    const json& indices = member(primitive, "indices");
    const json& list = indices.is_null() ? primitive["attributes"]["POSITION"] : indices;
    // 3.0 is a whole number too
    const auto accessor = static_cast<std::size_t>(list.get<double>());
    return static_cast<std::size_t>(document["accessors"][accessor]["count"].get<double>());
}

/// What the meshes in the scene hold.
struct Kinds {
    std::size_t without_triangles = 0;  ///< primitives of points and lines
    std::size_t without_positions = 0;
    std::size_t without_triangle = 0;  ///< primitives of fewer than three corners
    std::size_t corners_left = 0;      ///< behind the last whole triangle of a list
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
                ++(member(member(primitives[p], "attributes"), "POSITION").is_number()
                       ? kinds.without_triangles
                       : kinds.without_positions);
                continue;
            }
            const std::size_t corners = corner_count(*asset.document, primitives[p]);
            if (corners < 3)
                ++kinds.without_triangle;
            else if (primitives[p].value("mode", 4.0) == 4.0)
                kinds.corners_left += corners % 3;
        }
    }
    return kinds;
}

/// Entries of a section for which `is_odd` holds.
template <typename IsOdd>
std::size_t count_odd(const json& document, const char* section, const IsOdd& is_odd)
{
    const json& entries = member(document, section);
    return entries.is_array() ? static_cast<std::size_t>(std::ranges::count_if(entries, is_odd))
                              : 0;
}

/// What the specification forbids, but leaves the geometry as clear as before.
void add_lapses(const GltfAsset& asset, std::vector<std::string>& notes)
{
    notes.insert(notes.end(), asset.notes.begin(), asset.notes.end());
    const auto add = [&](std::size_t count, const std::string& noun, const std::string& what) {
        if (count > 0)
            notes.push_back(count_text(count, noun) + ' ' + what);
    };
    const auto stride_of = [](const json& view) { return view.value("byteStride", -1.0); };
    add(count_odd(*asset.document, "bufferViews", [&](const json& v) { return stride_of(v) == 0; }),
        "bufferView", "with byteStride 0: taken as close together");
    add(count_odd(*asset.document, "bufferViews",
                  [&](const json& view) {
                      const double stride = stride_of(view);
                      return stride > 0 && (stride > 252 || std::fmod(stride, 4.0) != 0.0);
                  }),
        "bufferView", "with a byteStride that is no multiple of 4 up to 252");
    add(count_odd(*asset.document, "bufferViews",
                  [&](const json& view) {
                      const auto buffer = static_cast<std::size_t>(view.value("buffer", 0.0));
                      const double end =
                          view.value("byteOffset", 0.0) + view.value("byteLength", 0.0);
                      const std::size_t size = asset.buffers[buffer].bytes.size();
                      return size > 0 && end > static_cast<double>(size);
                  }),
        "bufferView", "longer than its buffer, by what nothing uses");
    add(count_odd(*asset.document, "accessors",
                  [](const json& accessor) {
                      return accessor.value("normalized", false) &&
                             accessor.value("componentType", 0.0) == 5126;
                  }),
        "accessor", "both float and normalized: taken as float");
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
    if (kinds.without_positions > 0)
        notes.push_back(counted(kinds.without_positions, "primitive",
                                "without POSITION is left out", "without POSITION are left out"));
    if (kinds.without_triangle > 0)
        notes.push_back(counted(kinds.without_triangle, "primitive",
                                "of fewer than three corners is left out",
                                "of fewer than three corners are left out"));
    if (kinds.corners_left > 0)
        notes.push_back(counted(kinds.corners_left, "corner",
                                "behind the last whole triangle is left out",
                                "behind the last whole triangles are left out"));
    const json& animations = member(*asset.document, "animations");
    if (animations.is_array() && !animations.empty() && !asset.is_played)
        notes.push_back(counted(animations.size(), "animation",
                                "is not played: the default pose is baked",
                                "are not played: the default pose is baked"));
    add_lapses(asset, notes);
    return notes;
}

}  // namespace surfelao
