/// obj_materials.h: the material file of an OBJ with a map of occlusion. Internal to obj_writer.cpp
/// and scene_io.cpp.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// The name of the material of faces that have none: white.
inline constexpr std::string_view kPlainObjMaterial = "surfelao_plain";

/// A file's text with all materials of `libraries`, each with the line `map_Ka MAP` behind its name
/// and no other map_Ka; other lines are theirs, with names of files as they are reached from
/// `folder`. Materials of `used` that none of them defines are added, white. The first line is a
/// comment by which is_our_materials() knows the file; options.mark follows it. Names of textures
/// that are not there are added to `missing`, materials that had another map_Ka counted.
struct ObjMaterials {
    std::string text;
    std::size_t replaced = 0;
};
[[nodiscard]] ObjMaterials obj_materials(const std::filesystem::path& folder,
                                         std::span<const std::filesystem::path> libraries,
                                         std::span<const std::string> used, std::string_view map,
                                         std::string_view mark, std::vector<std::string>& missing);

/// Whether the file at `path` is one of these, with this map.
[[nodiscard]] bool is_our_materials(const std::filesystem::path& path, std::string_view map);

}  // namespace surfelao
