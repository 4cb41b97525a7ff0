/// surfel.h: an oriented disk that stands for a piece of surface.
#pragma once

#include "surfels/geometry.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace surfelao {

/// A flat disk, seen from its front or its back as OccluderSide (topology.h) says.
/// 32 bytes: SIMD code fetches the fields of several surfels by that stride.
struct Surfel {
    glm::vec3 position{0.0f};  ///< unit frame
    float area = 0.0f;         ///< in diagonals squared; the disk's radius is sqrt(area / pi)
    glm::vec3 normal{0.0f};    ///< unit length
    float padding = 0.0f;      ///< of no meaning
};
static_assert(sizeof(Surfel) == 32);

/// One surfel per distinct vertex position: area = a third of the adjacent triangles' areas. The
/// areas sum to the area of the mesh. Positions without area give no surfel. O(n).
[[nodiscard]] std::vector<Surfel> surfels_at_vertices(const Geometry& geometry);

struct SurfelCloud {
    std::vector<Surfel> surfels;
    std::vector<std::uint32_t> vertices;  ///< per surfel: whose side of the surface is its own
};

/// The surface as disks of no very different sizes: as surfels_at_vertices, but triangles that are
/// large give their area to disks inside of them, in k x k equal cells, and not to their corners.
/// Large is more than 1 / kFewestSurfels of the whole area, or more than kLargeSurfel times what a
/// vertex has in the mean. So a body of few triangles becomes some thousands of disks, a fine mesh
/// of even triangles stays as it is, and fewer than 4 max(kFewestSurfels, n / kLargeSurfel)
/// are added. The areas sum to the area of the mesh. O(n).
[[nodiscard]] SurfelCloud surfels_of(const Geometry& geometry);

/// The largest area of a triangle of this geometry that is not large.
[[nodiscard]] double large_area(const Geometry& geometry);

/// surfels_of() for a part of a larger scene. largest: large_area() of that scene.
[[nodiscard]] SurfelCloud surfels_of(const Geometry& part, double largest);

inline constexpr std::uint32_t kFewestSurfels = 4096;
inline constexpr double kLargeSurfel = 16.0;

}  // namespace surfelao
