/// gltf_nodes.h: where the nodes of a glTF stand. Internal to the glTF reader and writer.
#pragma once

#include "files/gltf_asset.h"

#include <glm/mat4x4.hpp>

#include <filesystem>
#include <optional>
#include <vector>

namespace tinygltf {
class Model;
}

namespace surfelao {

/// Scale, then rotation, then translation. The rotation must be a unit_rotation().
[[nodiscard]] glm::dmat4 matrix_of(const GltfPlacement& placement);

/// The quaternion at unit length; nothing where it has none (zero, infinity). What is of unit
/// length but for rounding stays as it is, so that a value written and read again gives the same
/// matrix.
[[nodiscard]] std::optional<glm::dvec4> unit_rotation(const glm::dvec4& rotation);

/// A visible node that uses a mesh.
struct MeshNode {
    std::size_t node;
    std::size_t mesh;
    std::optional<std::size_t> skin;
};

/// A node of the scene, and which uses of meshes lie on it or below.
struct NodeBranch {
    std::size_t node = 0;
    std::size_t first_use = 0, end_use = 0;  ///< into PlacedNodes::mesh_nodes
};

struct PlacedNodes {
    std::vector<MeshNode> mesh_nodes;  ///< of the scene, a node before its children
    std::vector<NodeBranch> branches;  ///< of the scene, a node before its children
    std::vector<glm::dmat4> world;  ///< per node; of the scene's nodes and the used skins' joints
    std::size_t hidden_count = 0;   ///< nodes with a mesh that KHR_node_visibility hides
};

/// The nodes of the default scene (else the first; a file without scenes: all roots). The last rows
/// of the matrices are exactly 0 0 0 1. A node that is not visible hides all below it; it still
/// moves joints.
///
/// Throws InputError naming a node that has two parents, is on a cycle, or has a transform that is
/// not affine or not finite. O(nodes), without recursion.
[[nodiscard]] PlacedNodes place_nodes(const tinygltf::Model& model,
                                      const std::filesystem::path& path);

}  // namespace surfelao
