/// gltf_old_results.h: takes what an earlier bake added out of a glTF, so that baking a baked file
/// is baking the original. Internal to the glTF writer.
#pragma once

#include "files/gltf_asset.h"

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace surfelao {

/// Takes the attributes and occlusion textures of an earlier bake off all meshes and materials:
/// `_OCCLUSION` and `_BENT_NORMAL` where the document carries the mark of a bake (maker_mark.h),
/// and what has a name by which the writer tells its own (gltf_added.h). COLOR_0 becomes what
/// `_OWN_COLOR` is. Primitives get back the material that theirs is a copy of, and with it an
/// occlusionTexture that a map had replaced.
///
/// Accessors, views, bytes, textures and materials that nobody uses then are removed where they are
/// the last of their kind, as the writer left them. Where another program has added to the file
/// since, they stay, unused.
void drop_old_results(nlohmann::json& document, std::vector<GltfBuffer>& buffers);

}  // namespace surfelao
