/// gltf_model.h: the checked document as tinygltf's structs. Internal to the glTF reader.
#pragma once

#include "files/gltf_asset.h"

#include <string>

namespace tinygltf {
class Model;
}

namespace surfelao {

/// text: what geometry_text() made of asset.document. tinygltf trusts what it reads and opens
/// files, so it is handed neither more than that lets through nor any uri. Throws InputError.
[[nodiscard]] tinygltf::Model parse_model(const GltfAsset& asset, const std::string& text);

}  // namespace surfelao
