/// gltf_instances.h: the instances of EXT_mesh_gpu_instancing. Internal to the glTF reader.
#pragma once

#include "files/gltf_nodes.h"
#include "files/gltf_resolve.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace surfelao {

/// How many instances of its mesh the node shows; nothing where it shows the mesh itself. Throws
/// InputError where the attributes differ in length, or there are none, or the node has a skin.
[[nodiscard]] std::optional<std::size_t> instance_count(const tinygltf::Model& model,
                                                        const MeshNode& use,
                                                        const AccessorResolver& resolver);

/// Where they stand, seen from the node. Attributes of any type but unsigned int; other attributes
/// than TRANSLATION, ROTATION and SCALE move nothing. Throws InputError. O(instances).
[[nodiscard]] std::vector<GltfPlacement> read_instances(const tinygltf::Model& model,
                                                        const MeshNode& use,
                                                        const AccessorResolver& resolver);

}  // namespace surfelao
