/// laid_out.h: maps of worlds made in code.
#pragma once

#include "atlas/layout.h"
#include "surfels/scene.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <functional>

namespace surfelao {

/// Where a triangle's corner at p lies, on which page.
struct Spot {
    std::uint32_t page = 0;
    glm::dvec2 uv{0.0};
};
/// Of a point and the middle of its triangle.
using Placing = std::function<Spot(glm::dvec3 p, glm::dvec3 middle)>;

inline MapLayout laid_out(const Scene& scene, MapSize size, std::uint32_t pages,
                          const Placing& place)
{
    MapLayout layout{.size = size, .pages = std::vector<UvSet>(pages)};
    for (UvSet& page : layout.pages)
        page.corners.assign(scene.triangles.size(), glm::uvec3(UvSet::kNone));
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        glm::dvec3 corners[3], middle(0.0);
        for (int k = 0; k < 3; ++k) {
            corners[k] = scene.positions[scene.triangles[t][k]];
            middle += corners[k] / 3.0;
        }
        for (int k = 0; k < 3; ++k) {
            const Spot spot = place(corners[k], middle);
            UvSet& page = layout.pages[spot.page];
            page.corners[t][k] = static_cast<std::uint32_t>(page.values.size());
            page.values.push_back(spot.uv);
        }
    }
    return layout;
}

/// The six sides of a cube or of a sphere made of one, each turned by another angle.
inline Spot side_of_cube(glm::dvec3 p, glm::dvec3 middle)
{
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(middle[k]) > std::abs(middle[axis]))
            axis = k;
    const int chart = 2 * axis + (middle[axis] > 0.0 ? 1 : 0);
    const glm::dvec2 flat(p[(axis + 1) % 3],
                          middle[axis] > 0.0 ? p[(axis + 2) % 3] : -p[(axis + 2) % 3]);
    const double angle = 0.3 + chart, c = std::cos(angle), s = std::sin(angle);
    const glm::dvec2 turned(c * flat.x - s * flat.y, s * flat.x + c * flat.y);
    return {0, glm::dvec2((chart % 3 + 0.5) / 3.0, (chart / 3 + 0.5) / 2.0) + 0.12 * turned};
}

}  // namespace surfelao
