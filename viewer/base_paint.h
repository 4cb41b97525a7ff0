/// base_paint.h: what a model's surface is painted with, ready to be drawn.
#pragma once

#include "image/image.h"
#include "surfels/base_colors.h"
#include "surfels/surface.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace surfelao {

struct BasePaint {
    std::vector<BaseColor> materials;      ///< BaseColor::picture: into the pictures below
    std::vector<std::uint32_t> triangles;  ///< of the geometry: its material
    std::vector<glm::vec2> places;         ///< per corner, three a triangle: v runs down
    std::vector<Image> pictures;
    std::vector<std::string> notes;  ///< a sentence for each picture that cannot be read
};

/// Reads the pictures that the scene's file names. White where there are none, and where one cannot
/// be read. O(triangles and pixels).
[[nodiscard]] BasePaint base_paint_of(const Mesh& mesh);

/// The colour at a point of the surface, linear between pixels, repeating.
[[nodiscard]] glm::vec3 paint_at(const BasePaint& paint, const SurfacePoint& point);

}  // namespace surfelao
