/// materials.h: materials of assimp's scenes as those of glTF.
///
/// Kept: the name, base colour (a texture stands in its place), opacity (0 only of formats in which
/// it is meant), a texture of opacity where it is that of the colour, metalness and roughness where
/// the file has them, emission, the normal map, both sides. Other shading models end here.
#pragma once

#include "files/import/source_file.h"

#include <string>
#include <vector>

struct aiScene;
namespace tinygltf {
class Model;
}

namespace surfelao {

/// Adds a material of the same number for each of the scene's, with their textures: those that the
/// file holds in the buffer 0, others by their names as seen from its folder. Adds a note where
/// something is lost. A material that assimp has made for what has none, its last, is left out.
void add_materials(const aiScene& scene, const SourceFile& file, tinygltf::Model& model,
                   std::vector<std::string>& notes);

}  // namespace surfelao
