/// udim.h: texture coordinates over several tiles, a picture each (UDIM, as Mari and Blender have
/// it): tile 1001 + column + 10 row, columns 0 to 9 to the right, rows upwards.
#pragma once

#include "atlas/layout.h"

namespace surfelao {

/// Highest row of tiles: numbers have four digits.
inline constexpr int kMostTileRows = 900;

/// The pages of a layout by tile, in the order of their numbers, each triangle on the one where its
/// middle lies. Triangles left of or below the first tile, beyond the tenth column, or without a
/// place have none. layout.pages is empty where no triangle has a tile. O(triangles).
[[nodiscard]] MapLayout udim_layout(const Scene& scene, const UvSet& uvs, MapSize size);

}  // namespace surfelao
