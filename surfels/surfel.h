/// surfel.h: an oriented disk that stands for a piece of surface, and knows the piece where that is
/// one triangle.
#pragma once

#include "surfels/geometry.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace surfelao {

/// A flat disk, seen from its front or its back as OccluderSide (topology.h) says.
/// 56 bytes: SIMD code fetches the fields of several surfels by that stride.
struct Surfel {
    glm::vec3 position{0.0f};  ///< unit frame
    float area = 0.0f;         ///< in diagonals squared; the disk's radius is sqrt(area / pi)
    glm::vec3 normal{0.0f};    ///< unit length
    float reach = 0.0f;        ///< to the farthest corner of the triangle; 0: there is none
    /// From the position, the triangle's centroid, to two corners; to the third it is minus their
    /// sum.
    std::array<glm::vec3, 2> corners = {};
};
static_assert(sizeof(Surfel) == 56);

/// One surfel per distinct vertex position: area = a third of the adjacent triangles' areas. The
/// areas sum to the area of the mesh. Positions without area give no surfel. O(n).
[[nodiscard]] std::vector<Surfel> surfels_at_vertices(const Geometry& geometry);

struct SurfelCloud {
    std::vector<Surfel> surfels;
    std::vector<std::uint32_t> vertices;  ///< per surfel: whose side of the surface is its own
};

/// The surface as disks of no very different sizes: as surfels_at_vertices, but a triangle that its
/// corners cannot stand for has disks of its own and gives nothing to them: one that is larger than
/// large_area(), longer than kLongestSide times the root of that, or at an edge: its normal is
/// farther from a corner's than kSharp. It is halved across its longest side until what is left is
/// neither large nor long, or below kLeastCut of large_area(). So a body of few triangles becomes
/// some thousands of disks, a fine smooth mesh stays as it is, and no more than
/// 2 max(kFewestSurfels, n / kLargeSurfel) / kLeastCut are added to one for each triangle. The
/// areas sum to the area of the mesh. O(n).
[[nodiscard]] SurfelCloud surfels_of(const Geometry& geometry);

/// 1 / kFewestSurfels of the whole area, or kLargeSurfel times what a vertex has in the mean if
/// that is less.
[[nodiscard]] double large_area(const Geometry& geometry);

/// surfels_of() for a part of a larger scene. largest: large_area() of that scene.
[[nodiscard]] SurfelCloud surfels_of(const Geometry& part, double largest);

inline constexpr std::uint32_t kFewestSurfels = 4096;
inline constexpr double kLargeSurfel = 4.0;
inline constexpr double kLongestSide = 3.0;
inline constexpr double kLeastCut = 1.0 / 8.0;
inline constexpr float kSharp = 0.94f;  ///< cosine of 20 degrees

}  // namespace surfelao
