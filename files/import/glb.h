/// glb.h: a scene of assimp as glTF 2.0.
///
/// Kept: nodes and their names, meshes that several nodes use, normals, all texture coordinates,
/// the first vertex colours, joints and weights (the rest pose alone, no animations, no morph
/// targets), materials as far as materials.h says. Points and lines stand there as such. Cameras
/// and lights are left out. World space is glTF's: metres where the file tells its unit, y up.
#pragma once

#include "files/import/source_file.h"

#include <string>
#include <vector>

struct aiScene;

namespace surfelao {

/// Adds sentences on what could not be kept. O(bytes of the scene). Indices out of range and
/// numbers that are none stay in it: the reader of glTF refuses them. Throws std::runtime_error
/// where the scene contradicts itself, and as metres_of_3mf().
[[nodiscard]] std::string glb_of(const aiScene& scene, const SourceFile& file,
                                 std::vector<std::string>& notes);

}  // namespace surfelao
