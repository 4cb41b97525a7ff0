/// sidecars.h: the other files that a mesh file is made of.
#pragma once

#include <filesystem>
#include <vector>

namespace surfelao {

/// What the file refers to and what is there: buffers and images of .gltf and .glb, material files
/// of .obj and their textures, textures that a .ply names in a comment (`TextureFile`). For telling
/// whether a file belongs to a model: names are taken generously, with every reading of a name with
/// spaces in it. Empty for other formats and for what cannot be read; never throws for a fault in
/// the file. O(bytes of the file).
[[nodiscard]] std::vector<std::filesystem::path> sidecars_of(const std::filesystem::path& mesh);

}  // namespace surfelao
