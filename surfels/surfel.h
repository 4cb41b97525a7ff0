/// surfel.h: an oriented disk that stands for a piece of surface.
#pragma once

#include "surfels/geometry.h"

#include <glm/vec3.hpp>

#include <vector>

namespace surfelao {

/// Two RGBA32F texels on the GPU: position.xyz area | normal.xyz 0.
struct Surfel {
    glm::vec3 position{0.0f};  ///< unit frame
    float area = 0.0f;         ///< in diagonals squared; the disk's radius is sqrt(area / pi)
    glm::vec3 normal{0.0f};    ///< unit length
    float padding = 0.0f;
};
static_assert(sizeof(Surfel) == 32);

/// One surfel per distinct vertex position: area = a third of the adjacent triangles' areas. The
/// areas sum to the area of the mesh. Positions without area give no surfel. O(n).
[[nodiscard]] std::vector<Surfel> surfels_at_vertices(const Geometry& geometry);

}  // namespace surfelao
