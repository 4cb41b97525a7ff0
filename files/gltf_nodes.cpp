#include "files/gltf_nodes.h"

#include "files/gltf_resolve.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// Entries of the last row of a node's matrix may be this far from 0 0 0 1 (rounding of exporters).
constexpr double kAffineTolerance = 1e-6;

/// Lengths of quaternions this close to 1 are 1: some roundings of a division.
constexpr double kUnitTolerance = 1e-14;

constexpr std::int32_t kNoParent = -1;

/// The parent of each node. Refuses everything that is not a forest.
std::vector<std::int32_t> find_parents(const tinygltf::Model& model, const fs::path& path)
{
    std::vector<std::int32_t> parents(model.nodes.size(), kNoParent);
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        for (const int child : model.nodes[i].children) {
            std::int32_t& parent = parents[static_cast<std::size_t>(child)];
            if (parent != kNoParent)
                fail_gltf(path, numbered("node", static_cast<std::size_t>(child)),
                          "is a child of node " + std::to_string(parent) + " and again of node " +
                              std::to_string(i));
            parent = static_cast<std::int32_t>(i);
        }
    }
    // with one parent each, what no root reaches is a cycle
    std::vector<bool> reached(parents.size(), false);
    std::vector<std::size_t> pending;
    for (std::size_t i = 0; i < parents.size(); ++i) {
        if (parents[i] == kNoParent)
            pending.push_back(i);
    }
    while (!pending.empty()) {
        const std::size_t node = pending.back();
        pending.pop_back();
        reached[node] = true;
        for (const int child : model.nodes[node].children)
            pending.push_back(static_cast<std::size_t>(child));
    }
    const auto cyclic = std::find(reached.begin(), reached.end(), false);
    if (cyclic != reached.end())
        fail_gltf(path, numbered("node", static_cast<std::size_t>(cyclic - reached.begin())),
                  "is on or below a cycle of nodes");
    return parents;
}

/// The nodes that the scene begins with.
std::vector<std::size_t> find_roots(const tinygltf::Model& model,
                                    const std::vector<std::int32_t>& parents, const fs::path& path)
{
    std::vector<std::size_t> roots;
    if (model.scenes.empty()) {
        for (std::size_t i = 0; i < parents.size(); ++i) {
            if (parents[i] == kNoParent)
                roots.push_back(i);
        }
        return roots;
    }
    const auto scene = static_cast<std::size_t>(std::max(model.defaultScene, 0));
    std::vector<bool> listed(parents.size(), false);
    for (const int entry : model.scenes[scene].nodes) {
        const auto node = static_cast<std::size_t>(entry);
        if (parents[node] != kNoParent)
            fail_gltf(path, numbered("scene", scene),
                      "lists " + numbered("node", node) + ", which is a child of node " +
                          std::to_string(parents[node]));
        if (listed[node])
            fail_gltf(path, numbered("scene", scene), "lists " + numbered("node", node) + " twice");
        listed[node] = true;
        roots.push_back(node);
    }
    return roots;
}

/// The node's transform; its last row is exactly 0 0 0 1.
glm::dmat4 local_matrix(const tinygltf::Model& model, std::size_t index, const fs::path& path)
{
    const tinygltf::Node& node = model.nodes[index];
    if (!node.matrix.empty()) {
        glm::dmat4 matrix;
        for (int i = 0; i < 16; ++i)
            matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
        for (int column = 0; column < 4; ++column) {
            const double expected = column == 3 ? 1.0 : 0.0;
            if (!(std::abs(matrix[column][3] - expected) <= kAffineTolerance))
                fail_gltf(path, numbered("node", index) + ": matrix",
                          "does not end in the row 0 0 0 1: it is no affine transform");
            matrix[column][3] = expected;
        }
        return matrix;
    }
    GltfPlacement placement;
    if (!node.rotation.empty()) {
        const std::vector<double>& r = node.rotation;
        const std::optional<glm::dvec4> rotation = unit_rotation({r[0], r[1], r[2], r[3]});
        if (!rotation)
            fail_gltf(path, numbered("node", index) + ": rotation",
                      "has a length of zero or infinity");
        placement.rotation = *rotation;
    }
    if (!node.scale.empty())
        placement.scale = {node.scale[0], node.scale[1], node.scale[2]};
    if (!node.translation.empty())
        placement.translation = {node.translation[0], node.translation[1], node.translation[2]};
    return matrix_of(placement);
}

bool is_visible(const tinygltf::Node& node)
{
    const auto extension = node.extensions.find("KHR_node_visibility");
    if (extension == node.extensions.end() || !extension->second.Has("visible"))
        return true;
    return extension->second.Get("visible").Get<bool>();
}

/// Walks down from roots.
class NodePlacer {
public:
    NodePlacer(const tinygltf::Model& model, const fs::path& path)
        : model_(model), path_(path), is_placed_(model.nodes.size(), false)
    {
        placed_.world.resize(model.nodes.size(), glm::dmat4(1.0));
    }

    PlacedNodes place()
    {
        const std::vector<std::int32_t> parents = find_parents(model_, path_);
        place_below(find_roots(model_, parents, path_));
        if (!joints_are_placed()) {
            // joints outside the scene move its meshes all the same
            is_in_scene_ = false;
            std::vector<std::size_t> others;
            for (std::size_t node = 0; node < parents.size(); ++node) {
                if (parents[node] == kNoParent && !is_placed_[node])
                    others.push_back(node);
            }
            place_below(others);
        }
        return std::move(placed_);
    }

private:
    bool joints_are_placed() const
    {
        std::vector<bool> is_checked(model_.skins.size(), false);
        return std::ranges::all_of(placed_.mesh_nodes, [&](const MeshNode& use) {
            if (!use.skin || is_checked[*use.skin])
                return true;
            is_checked[*use.skin] = true;
            return std::ranges::all_of(model_.skins[*use.skin].joints, [&](int joint) {
                return is_placed_[static_cast<std::size_t>(joint)];
            });
        });
    }

    void place_below(const std::vector<std::size_t>& roots)
    {
        struct Visit {
            std::size_t node;
            glm::dmat4 parent;
            bool is_visible;
            std::size_t depth = 0;
        };
        std::vector<Visit> pending;
        std::vector<std::size_t> open;  // branches of the node at hand and those above it
        const auto close_to = [&](std::size_t depth) {
            for (; open.size() > depth; open.pop_back())
                placed_.branches[open.back()].end_use = placed_.mesh_nodes.size();
        };
        for (auto root = roots.rbegin(); root != roots.rend(); ++root)
            pending.push_back({*root, glm::dmat4(1.0), true});
        while (!pending.empty()) {
            const Visit visit = pending.back();
            pending.pop_back();
            const tinygltf::Node& node = model_.nodes[visit.node];
            const glm::dmat4 world = visit.parent * local_matrix(model_, visit.node, path_);
            for (int i = 0; i < 16; ++i) {
                if (!std::isfinite(world[i / 4][i % 4]))
                    fail_gltf(path_, numbered("node", visit.node),
                              "has a transform that is not finite");
            }
            placed_.world[visit.node] = world;
            is_placed_[visit.node] = true;
            const bool visible = visit.is_visible && is_visible(node);
            if (is_in_scene_) {
                close_to(visit.depth);
                open.push_back(placed_.branches.size());
                placed_.branches.push_back({visit.node, placed_.mesh_nodes.size(), 0});
            }
            if (node.mesh >= 0 && is_in_scene_)
                add_mesh_node(visit.node, visible);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                pending.push_back(
                    {static_cast<std::size_t>(*child), world, visible, visit.depth + 1});
        }
        close_to(0);
    }

    void add_mesh_node(std::size_t index, bool visible)
    {
        const tinygltf::Node& node = model_.nodes[index];
        if (!visible) {
            ++placed_.hidden_count;
            return;
        }
        MeshNode use{index, static_cast<std::size_t>(node.mesh), {}};
        if (node.skin >= 0)
            use.skin = static_cast<std::size_t>(node.skin);
        placed_.mesh_nodes.push_back(use);
    }

    const tinygltf::Model& model_;
    const fs::path& path_;
    std::vector<bool> is_placed_;
    bool is_in_scene_ = true;
    PlacedNodes placed_;
};

}  // namespace

glm::dmat4 matrix_of(const GltfPlacement& placement)
{
    const glm::dvec4& r = placement.rotation;
    glm::dmat4 matrix(glm::mat3_cast(glm::dquat(r.w, r.x, r.y, r.z)));
    for (int axis = 0; axis < 3; ++axis)
        matrix[axis] *= placement.scale[axis];
    matrix[3] = glm::dvec4(placement.translation, 1.0);
    return matrix;
}

std::optional<glm::dvec4> unit_rotation(const glm::dvec4& rotation)
{
    const double length = glm::length(rotation);
    if (!(length > 0.0) || !std::isfinite(length))
        return std::nullopt;
    return std::abs(length - 1.0) <= kUnitTolerance ? rotation : rotation / length;
}

PlacedNodes place_nodes(const tinygltf::Model& model, const fs::path& path)
{
    return NodePlacer(model, path).place();
}

}  // namespace surfelao
