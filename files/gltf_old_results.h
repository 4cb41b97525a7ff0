/// gltf_old_results.h: takes what an earlier bake added out of a glTF, so that reading a baked file
/// is reading the original. Internal to the glTF reader.
#pragma once

#include "files/gltf_asset.h"

namespace surfelao {

/// Takes the attributes and occlusion textures of an earlier bake off all meshes and materials:
/// `_OCCLUSION` and `_BENT_NORMAL` where the document carries the mark of a bake (maker_mark.h),
/// and what has a name by which the writer tells its own (gltf_added.h). COLOR_0 becomes what
/// `_OWN_COLOR` is. Primitives get back the material that theirs is a copy of, and with it an
/// occlusionTexture that a map had replaced; the vertices that they had before they were cut
/// (gltf_cuts.h); and nodes the mesh that theirs is a copy of (gltf_uses.h), where they are alike.
///
/// Accessors, views, bytes, textures and materials that nobody uses then are removed where they are
/// the last of their kind, as the writer left them. Where another program has added to the file
/// since, they stay, unused.
///
/// The document must have passed geometry_text(). Returns whether it may have changed: then it must
/// do so again.
bool drop_old_results(GltfAsset& asset);

}  // namespace surfelao
