/// gltf_old_results.h: takes what an earlier bake added out of a glTF, so that baking twice gives
/// the file that baking once does. Internal to the glTF writer.
#pragma once

#include "files/gltf_asset.h"

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace surfelao {

/// Removes the accessors of `_OCCLUSION` and `_BENT_NORMAL`, their buffer views and bytes from the
/// document and its buffers, where the document carries the mark of a bake (maker_mark.h) and they
/// are the last of their kind, as the writer left them, and used by nothing else. Otherwise, as
/// where COLOR_0 was written with them or another program has added to the file since, nothing is
/// done and they stay as unused bytes. The attributes themselves stay: the scene's parts get new
/// ones, and a mesh outside them is a reason to do nothing.
void drop_old_results(nlohmann::json& document, std::vector<GltfBuffer>& buffers,
                      const Scene& scene);

}  // namespace surfelao
