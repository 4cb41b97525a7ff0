/// tiles.h: flat pairs: two triangles that share an edge, lie in one plane and together are
/// one convex quadrilateral.
///
/// Internal to the mask engine; masks.h is its door.
#pragma once

#include "surfels/geometry.h"
#include "surfels/raw_vector.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace surfelao {

/// Corners in the triangles' own direction. The triangles of a pair are (x, y, z) and (z, w, x); of
/// a triangle that stays alone, z = w.
struct MaskTile {
    glm::uvec4 corners;                      ///< into Geometry::positions
    std::array<std::uint32_t, 2> triangles;  ///< twice the same one where it is alone
};

/// Whether a tile's corners at these positions may be one: a single triangle always, a pair where
/// it lies in one plane and is convex, to kMaskPairSlack.
[[nodiscard]] bool is_flat(const MaskTile& tile, std::span<const glm::vec3> positions);

/// Flat pairs may be one tile; a form that bends is better off without.
enum class MaskPairs { found, none };

/// Every triangle is in one tile. First those next to each other in the list are paired: files
/// often say so where their quadrilaterals were; then those with one and the same longest edge,
/// then the others, each time in the order of the triangles. O(n) where no vertex has many
/// triangles.
///
/// normals: one per triangle, unit or zero.
[[nodiscard]] RawVector<MaskTile> tiles_of(const Geometry& geometry,
                                           std::span<const glm::vec3> normals,
                                           MaskPairs pairs = MaskPairs::found);

}  // namespace surfelao
