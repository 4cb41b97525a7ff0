#include "surfels/surfel.h"

namespace surfelao {

std::vector<Surfel> surfels_at_vertices(const Geometry& geometry)
{
    std::vector<Surfel> surfels;
    for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
        if (geometry.areas[v] > 0.0f)
            surfels.push_back(
                {geometry.positions[v], geometry.areas[v], geometry.normals[v], 0.0f});
    }
    return surfels;
}

}  // namespace surfelao
