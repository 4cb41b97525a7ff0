/// pick.h: what lies under the mouse.
#pragma once

#include "gpu/g_buffer.h"
#include "surfels/surface.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace surfelao {

/// Unit frame.
struct SightRay {
    glm::dvec3 origin{0.0}, direction{0.0, 0.0, -1.0};  ///< of unit length
};

/// pixel: of a picture of that size, from its lower left corner.
[[nodiscard]] SightRay sight_ray(const View& view, int width, int height, glm::vec2 pixel);

/// Where a point is seen; empty where it lies behind the eye.
[[nodiscard]] std::optional<glm::vec2> pixel_of(const View& view, int width, int height,
                                                glm::dvec3 point);

/// The nearest point of a triangle that the ray meets; culls: none that it meets from behind, else
/// from either side. O(n).
[[nodiscard]] std::optional<SurfacePoint> point_under(std::span<const glm::vec3> positions,
                                                      std::span<const glm::uvec3> triangles,
                                                      const SightRay& ray, bool culls = false);

}  // namespace surfelao
