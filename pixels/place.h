/// place.h: when two places that a picture shows count as one surface.
#pragma once

#include "gpu/g_buffer.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace surfelao {

/// Two places see the same where they lie on one triangle; or on one part, with normals that agree
/// to this cosine, and the one at most so many pixels off the plane of the other. Steps smaller
/// than that are no edges to an eye; what is seen at a grazing angle lies in one plane however long
/// the pixel is there.
inline constexpr float kLikeNormals = 0.95f;
inline constexpr float kLikePlane = 0.25f;

/// Of a surface, as a picture shows it.
struct Place {
    glm::vec3 position{0.0f};
    glm::vec3 normal{0.0f};  ///< shading normal, on the side that is seen
    std::uint32_t part = 0;
};

/// How large a pixel is on a plane that faces the eye at this place, in diagonals. height: of the
/// view's picture.
[[nodiscard]] float footprint_at(const View& view, int height, glm::vec3 position);

/// How far a place lies off another one's plane, in diagonals.
[[nodiscard]] float off_plane(const Place& place, const Place& other);

/// Whether they count as one surface. footprint: at one of them.
[[nodiscard]] bool are_like(const Place& place, const Place& other, float footprint);

}  // namespace surfelao
