/// gltf_links.h: what a glTF has in other files, and how a result in any folder finds it. Internal
/// to the glTF writer.
#pragma once

#include "files/gltf_asset.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace surfelao {

/// For a .glb: all buffers, and the images that lie in the folder of `model` or below, become one
/// binary chunk, which is returned: buffer 0 of the document.
[[nodiscard]] std::string gather(nlohmann::json& document, std::span<const GltfBuffer> buffers,
                                 const std::filesystem::path& model);

/// Turns all URIs that are relative to `model`, wherever they stand but in extras, so that they
/// name the same files from `path`. Those that are well formed stay as they are in one folder, and
/// those of files that are not there anywhere: their names are returned.
[[nodiscard]] std::vector<std::string> turn_uris(nlohmann::json& document,
                                                 const std::filesystem::path& model,
                                                 const std::filesystem::path& path);

/// Whether the .gltf at `path` is there and has, by this URI, a picture named as ours
/// (gltf_added.h). O(bytes of the file).
[[nodiscard]] bool names_our_picture(const std::filesystem::path& path, const std::string& uri);

/// For a .gltf at `path` whose URIs are turned: buffers that it could not be read with from there
/// (a binary chunk, files outside of its folder that are no .bin) become data URIs.
void embed_buffers(nlohmann::json& document, std::span<const GltfBuffer> buffers,
                   const std::filesystem::path& path);

}  // namespace surfelao
