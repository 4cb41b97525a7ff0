/// base_colors.h: what a file paints its surfaces with.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

/// A picture as it stands in a file: of its own, or within the mesh's.
struct PictureSource {
    std::string name;            ///< for messages
    std::filesystem::path file;  ///< empty: the bytes below
    std::string bytes;           ///< of a .png, .jpg or the like
};

struct BaseColor {
    std::string name;        ///< in the file; may be empty
    glm::vec3 factor{1.0f};  ///< linear light; multiplies the picture
    std::optional<std::uint32_t> picture;
    std::uint32_t uv_set = 0;  ///< Scene::uvs, where the picture's top row is v = 0
};

struct BaseColors {
    std::vector<BaseColor> materials;
    std::vector<std::uint32_t> triangles;  ///< per scene triangle: its material
    std::vector<PictureSource> pictures = {};
};

}  // namespace surfelao
