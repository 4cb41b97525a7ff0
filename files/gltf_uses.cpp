#include "files/gltf_uses.h"

#include "files/maker_mark.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

namespace surfelao {
namespace {

using nlohmann::json;

/// What makes instances of a node's mesh, and what speaks of the instances.
constexpr const char* kInstanceExtensions[] = {"EXT_mesh_gpu_instancing", "EXT_instance_features"};

json numbers(const glm::dvec3& vector)
{
    return {vector.x, vector.y, vector.z};
}

/// A node that shows one instance; what is as the default has it is left out.
json instance_node(const json& parent, const GltfPlacement& instance)
{
    const GltfPlacement none;
    json node = json::object();
    for (const char* key : {"name", "weights"}) {
        if (parent.contains(key))
            node[key] = parent[key];
    }
    if (instance.translation != none.translation)
        node["translation"] = numbers(instance.translation);
    if (instance.rotation != none.rotation)
        node["rotation"] = {instance.rotation.x, instance.rotation.y, instance.rotation.z,
                            instance.rotation.w};
    if (instance.scale != none.scale)
        node["scale"] = numbers(instance.scale);
    return node;
}

/// Puts a node for each of the uses of one node under it, before its other children; returns them.
std::vector<std::size_t> split_node(json& nodes, std::span<const GltfUse> uses)
{
    const std::size_t parent = uses.front().node;
    std::vector<std::size_t> added;
    for (const GltfUse& use : uses) {
        added.push_back(nodes.size());
        nodes.push_back(instance_node(nodes[parent], *use.instance));
    }
    json& node = nodes[parent];
    json children = added;
    for (const json& child : node.value("children", json::array()))
        children.push_back(child);
    node["children"] = children;
    for (const char* key : {"mesh", "weights"})
        node.erase(key);
    for (const char* extension : kInstanceExtensions)
        node["extensions"].erase(extension);
    if (node["extensions"].empty())
        node.erase("extensions");
    return added;
}

/// Takes extensions that no node has any more out of the lists.
void forget_extensions(json& document)
{
    for (const char* extension : kInstanceExtensions) {
        const bool is_used = std::ranges::any_of(document["nodes"], [&](const json& node) {
            const auto extensions = node.find("extensions");
            return extensions != node.end() && extensions->contains(extension);
        });
        for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
            const auto names = document.find(list);
            if (is_used || names == document.end() || !names->is_array())
                continue;
            names->erase(std::remove(names->begin(), names->end(), extension), names->end());
            if (names->empty())
                document.erase(list);
        }
    }
}

/// Animations of the weights of a node that has no mesh any more.
void release_weights(json& document, const std::vector<bool>& is_split)
{
    const auto animations = document.find("animations");
    if (animations == document.end() || !animations->is_array())
        return;
    for (json& animation : *animations) {
        if (!animation.is_object() || !animation.contains("channels") ||
            !animation["channels"].is_array())
            continue;
        for (json& channel : animation["channels"]) {
            if (!channel.is_object() || !channel.contains("target") ||
                !channel["target"].is_object())
                continue;
            json& target = channel["target"];
            const json node = target.value("node", json());
            if (node.is_number_unsigned() && node.get<std::size_t>() < is_split.size() &&
                is_split[node.get<std::size_t>()] && target.contains("path") &&
                target["path"] == "weights")
                target.erase("node");
        }
    }
}

/// The node that shows each use, after nodes with instances are split.
std::vector<std::size_t> nodes_of_uses(json& document, std::span<const GltfUse> uses,
                                       const std::vector<bool>& wanted)
{
    json& nodes = document["nodes"];
    std::vector<bool> is_split(nodes.size(), false);
    std::vector<std::size_t> nodes_of;
    bool has_instances = false;
    for (std::size_t first = 0; first < uses.size();) {
        std::size_t count = 1;  // uses of one node follow each other
        while (first + count < uses.size() && uses[first + count].node == uses[first].node)
            ++count;
        const auto begin = wanted.begin() + static_cast<std::ptrdiff_t>(first);
        const auto end = begin + static_cast<std::ptrdiff_t>(count);
        if (uses[first].instance && std::find(begin, end, true) != end) {
            const std::vector<std::size_t> added = split_node(nodes, uses.subspan(first, count));
            nodes_of.insert(nodes_of.end(), added.begin(), added.end());
            is_split[uses[first].node] = has_instances = true;
        } else {
            nodes_of.insert(nodes_of.end(), count, uses[first].node);
        }
        first += count;
    }
    if (has_instances) {
        forget_extensions(document);
        release_weights(document, is_split);
    }
    return nodes_of;
}

}  // namespace

void mark_copy(json& mesh, std::size_t original)
{
    if (!mesh.contains("extras") || mesh["extras"].is_object())
        mesh["extras"][kMarkKey] = original;
}

std::vector<std::size_t> separate_uses(json& document, std::span<const GltfUse> uses,
                                       const std::vector<bool>& wanted)
{
    const std::vector<std::size_t> nodes_of = nodes_of_uses(document, uses, wanted);
    json& nodes = document["nodes"];
    json& meshes = document["meshes"];
    std::vector<bool> is_of_use(nodes.size(), false);
    for (std::size_t u = 0; u < uses.size(); ++u) {
        if (wanted[u])
            is_of_use[nodes_of[u]] = true;
        else
            nodes[nodes_of[u]]["mesh"] = uses[u].mesh;  // also of an instance that is a node now
    }
    std::vector<bool> taken(meshes.size(), false);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!is_of_use[i] && nodes[i].contains("mesh"))
            taken[nodes[i]["mesh"].get<std::size_t>()] = true;
    }
    std::vector<std::size_t> meshes_of;
    for (std::size_t u = 0; u < uses.size(); ++u) {
        std::size_t mesh = uses[u].mesh;
        if (!wanted[u]) {
            meshes_of.push_back(mesh);
            continue;
        }
        if (taken[mesh]) {
            json copy = meshes[mesh];
            mark_copy(copy, mesh);
            mesh = meshes.size();
            meshes.push_back(std::move(copy));
        } else {
            taken[mesh] = true;
        }
        nodes[nodes_of[u]]["mesh"] = mesh;
        meshes_of.push_back(mesh);
    }
    return meshes_of;
}

}  // namespace surfelao
