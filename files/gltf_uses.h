/// gltf_uses.h: a mesh of its own for each place where a glTF shows one. Internal to the glTF
/// writer.
#pragma once

#include "files/gltf_asset.h"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <vector>

namespace surfelao {

/// Says in the extras of a mesh that it is a copy of this one, if they are an object or none.
void mark_copy(nlohmann::json& mesh, std::size_t original);

/// Gives each wanted use a mesh of its own and returns which; the others keep theirs. The first use
/// of a mesh keeps the entry, unless a node outside the uses has it too; the others get copies of
/// the entry, which share all accessors and say so in their extras.
///
/// A node with wanted instances becomes a node without a mesh, whose first children show the
/// instances where they stood. EXT_mesh_gpu_instancing and EXT_instance_features are taken off it,
/// and out of the lists of extensions where no node is left that has them: attributes of instances
/// beyond their places are gone. An animation of its morph weights has no target any more (it is to
/// be ignored then, says the specification). O(document + uses).
[[nodiscard]] std::vector<std::size_t> separate_uses(nlohmann::json& document,
                                                     std::span<const GltfUse> uses,
                                                     const std::vector<bool>& wanted);

}  // namespace surfelao
