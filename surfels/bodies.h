/// bodies.h: a geometry cut into bodies, each of which moves as one.
#pragma once

#include "surfels/geometry.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// A body's triangles over its own vertices, which are numbered as the triangles come to them.
struct BodyMesh {
    std::vector<std::uint32_t> vertices;  ///< of the geometry
    std::vector<glm::uvec3> triangles;    ///< in the geometry's order
};

/// body_of_triangle: one per triangle. As many bodies as it names, 0 at least; some may be empty. A
/// vertex of several bodies becomes one of each. O(n).
[[nodiscard]] std::vector<BodyMesh> split_bodies(const Geometry& geometry,
                                                 std::span<const std::uint32_t> body_of_triangle);

/// body_of: one per receiver (triangle, vertex, ...), below `bodies`. Which ones each body has,
/// rising.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> members_of(
    std::span<const std::uint32_t> body_of, std::size_t bodies);

}  // namespace surfelao
