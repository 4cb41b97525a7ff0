/// vertex_receivers.h: some receivers of a mesh, for tests that only need to ask somewhere.
#pragma once

#include "surfels/geometry.h"
#include "surfels/receiver.h"

#include <cstddef>
#include <vector>

namespace surfelao {

/// Where a test does not care how far receivers stand off the surface, in diagonals.
inline constexpr float kVertexOffset = 1e-4f;

/// One per vertex, moved along its mean normal (Geometry::normals).
[[nodiscard]] inline std::vector<Receiver> vertex_receivers(const Geometry& geometry,
                                                            float offset = kVertexOffset)
{
    std::vector<Receiver> receivers;
    receivers.reserve(geometry.positions.size());
    for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
        const glm::vec3 normal = geometry.normals[v];
        receivers.push_back({geometry.positions[v] + offset * normal, normal, offset});
    }
    return receivers;
}

}  // namespace surfelao
