/// file_type.h: the formats of meshes and clouds by the ends of their names, in any case.
#pragma once

#include <filesystem>

namespace surfelao {

enum class FileType { obj, ply, off, stl, gltf, glb, pcd, xyz, foreign, unknown };

/// .obj .ply .off .stl .gltf .glb .pcd; .xyz .pts .txt .asc are all `xyz`; .fbx .dae .zae .3ds .3mf
/// .x3d are `foreign` (foreign_io.h); `unknown` for all others.
[[nodiscard]] FileType type_of(const std::filesystem::path& path);

/// Whether it is .gltf or .glb.
[[nodiscard]] bool is_gltf(FileType type);

}  // namespace surfelao
