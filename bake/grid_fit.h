/// grid_fit.h: what the cells of an AO grid hold that are inside of the object.
///
/// Nobody reads there, but between such a cell and one outside values are blended, so that it
/// decides what is read just beside the surface. There the object is asked at places between cells,
/// and the cells inside get the values by which the blends come nearest to the answers, in least
/// squares; those outside stay as they are. Cells that no place is blended of keep their values,
/// and so do the others as far as the places leave them free.
///
/// Internal to grid_target.h.
#pragma once

#include "grid/ao_grid.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Some places, in the grid's units, in each cube of eight cells of which some are inside and some
/// are not; on either side of the surface. is_inside: one per cell.
[[nodiscard]] std::vector<glm::dvec3> places_beside(const AoGrid& grid,
                                                    std::span<const std::uint8_t> is_inside);

/// places: outside of the object. values: what is right there, channels_of(store) each. The same
/// bytes for any number of threads.
void fit_inside(AoGrid& grid, std::span<const std::uint8_t> is_inside,
                std::span<const glm::dvec3> places, std::span<const float> values);

}  // namespace surfelao
