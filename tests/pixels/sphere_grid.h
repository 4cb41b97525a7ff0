/// sphere_grid.h: AO grids whose cells are known in closed form.
#pragma once

#include "grid/ao_grid.h"
#include "grid/cone.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {

/// What a ball of that radius about the origin hides: alpha = (1 - sqrt(1 - (r / d)^2)) / 2,
/// |m| = pi (r / d)^2, towards it; cells inside are those of its surface. Harmonics: those of the
/// cone to l = 2 with the cone's own c_2 = (cos h - cos^3 h) / 2.
inline AoGrid sphere_grid(double radius, double half, int cells, GridStore store, GridBorder border)
{
    AoGrid grid;
    grid.cells = glm::ivec3(cells);
    grid.low = glm::dvec3(-half);
    grid.high = glm::dvec3(half);
    grid.inner = glm::vec3(static_cast<float>(1.05 * radius / half));
    grid.store = store;
    grid.border = border;
    constexpr double kPi = 3.14159265358979;
    for (int z = 0; z < cells; ++z) {
        for (int y = 0; y < cells; ++y) {
            for (int x = 0; x < cells; ++x) {
                const glm::dvec3 place = place_of(grid, {x, y, z});
                const double sine = std::min(1.0, radius / std::max(1e-9, glm::length(place)));
                const double cosine = std::sqrt(1.0 - sine * sine);
                const double alpha = 0.5 * (1.0 - cosine);
                const glm::dvec3 axis = -place / std::max(1e-9, glm::length(place));
                if (std::max({x, y, z}) == cells - 1 || std::min({x, y, z}) == 0)
                    grid.border_value = std::max(grid.border_value, static_cast<float>(alpha));
                if (store == GridStore::cone) {
                    for (int axis_number = 0; axis_number < 3; ++axis_number)
                        grid.values.push_back(
                            static_cast<float>(0.25 * sine * sine * axis[axis_number]));
                    grid.values.push_back(static_cast<float>(alpha));
                    continue;
                }
                const double bands[] = {2.0 * kPi * (1.0 - cosine), kPi * sine * sine,
                                        kPi * cosine * sine * sine};
                const Harmonics along = harmonics_along(glm::vec3(axis));
                for (std::size_t k = 0; k < kHarmonics; ++k)
                    grid.values.push_back(static_cast<float>(bands[k == 0  ? 0
                                                                   : k < 4 ? 1
                                                                           : 2]) *
                                          along[k]);
            }
        }
    }
    return grid;
}

}  // namespace surfelao
