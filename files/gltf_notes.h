/// gltf_notes.h: what a glTF file holds and nobody honours, and what in it was let pass. Internal
/// to the glTF reader.
#pragma once

#include "files/gltf_nodes.h"

#include <string>
#include <vector>

namespace surfelao {

/// A short sentence for each kind of thing, without a full stop, for Scene::notes: hidden nodes,
/// points and lines, see-through materials, animations, and lapses against the specification that
/// leave the geometry clear (of the container: asset.notes). Takes the scene as built: asset.uses
/// and asset.group_of_primitive. O(document).
[[nodiscard]] std::vector<std::string> gltf_notes(const GltfAsset& asset, const PlacedNodes& nodes);

}  // namespace surfelao
