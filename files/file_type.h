/// file_type.h: the mesh formats by the ends of their names, in any case.
#pragma once

#include <filesystem>

namespace surfelao {

enum class FileType { obj, ply, off, stl, gltf, glb, unknown };

/// .obj .ply .off .stl .gltf .glb; `unknown` for all others.
[[nodiscard]] FileType type_of(const std::filesystem::path& path);

/// Whether it is .gltf or .glb.
[[nodiscard]] bool is_gltf(FileType type);

}  // namespace surfelao
