/// receiver.h: the points at which occlusion is asked for.
#pragma once

#include "surfels/geometry.h"

#include <glm/vec3.hpp>

#include <vector>

namespace surfelao {

/// Any (point, normal): a vertex, a texel, a pixel, a grid cell. Results are indexed by receiver.
struct Receiver {
    glm::vec3 position{0.0f};  ///< unit frame, already moved off the surface along the normal
    glm::vec3 normal{0.0f};    ///< unit length; zero = no hemisphere: occlusion 0, bent normal zero
};

/// One receiver per scene vertex, in the scene's order. offset: see occlusion.h. O(n).
[[nodiscard]] std::vector<Receiver> receivers_at_vertices(const Geometry& geometry, float offset);

}  // namespace surfelao
