/// gltf_maps.h: a map of occlusion in a glTF. Internal to the glTF writer.
#pragma once

#include "files/gltf_added.h"
#include "files/gltf_asset.h"
#include "files/scene_io.h"

#include <filesystem>
#include <string>
#include <vector>

namespace surfelao {

/// Adds the map to the materials of the primitives in the scene, as gltf_contents_with_map() says,
/// for a result at `path`. Primitives of which nothing was baked (WriteOptions::unbaked) stay as
/// they are. The document is the asset's, so far without results. Returns notes.
[[nodiscard]] std::vector<std::string> add_map(nlohmann::json& document, const GltfAsset& asset,
                                               const Scene& scene, const OcclusionMap& map,
                                               const std::filesystem::path& path,
                                               const std::vector<bool>& unbaked, AddedData& added);

/// The same for a blended map, as gltf_contents_with_blended_map() says.
[[nodiscard]] std::vector<std::string> add_blended_map(nlohmann::json& document,
                                                       const GltfAsset& asset, const Scene& scene,
                                                       const BlendedMap& map,
                                                       const std::vector<bool>& unbaked,
                                                       AddedData& added);

}  // namespace surfelao
