/// base_colors.h: what a file paints its surfaces with.
#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
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

/// Whether light goes through.
enum class Opacity {
    solid,
    cut,    ///< nothing is where the alpha is below a cutoff (glTF's MASK, OBJ's map_d)
    clear,  ///< it does all over (glTF's BLEND and transmission, OBJ's d < 1)
};

struct BaseColor {
    std::string name;        ///< in the file; may be empty
    glm::vec3 factor{1.0f};  ///< linear light; multiplies the picture
    std::optional<std::uint32_t> picture;
    std::uint32_t uv_set = 0;  ///< Scene::uvs, where the picture's top row is v = 0
    glm::dmat2 uv_matrix{
        1.0};  ///< times the coordinates, and the offset, gives those of the picture
    glm::dvec2 uv_offset{0.0};
    Opacity opacity = Opacity::solid;
    float alpha = 1.0f;   ///< multiplies that of the picture
    float cutoff = 0.5f;  ///< Opacity::cut
    std::optional<std::uint32_t> alpha_picture = {};
    bool grey_is_alpha = false;  ///< of an alpha picture without an alpha of its own
};

struct BaseColors {
    std::vector<BaseColor> materials;
    std::vector<std::uint32_t> triangles;  ///< per scene triangle: its material
    std::vector<PictureSource> pictures = {};
};

}  // namespace surfelao
