/// closest_hit.h: what a ray meets first, and what of a surface is nearest.
///
/// Based on:
///   Ericson. Real-Time Collision Detection. 2005, section 5.1.5 (the nearest point of a triangle)
#pragma once

#include "reference/rays.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

struct Ray {
    glm::vec3 origin{0.0f};     ///< unit frame
    glm::vec3 direction{0.0f};  ///< of unit length
    float length = 0.0f;        ///< how far it reaches, in diagonals; may be infinite
};

struct ClosestHit {
    static constexpr std::uint32_t kNone = 0xffffffff;

    std::uint32_t triangle = kNone;  ///< of the scene's geometry; kNone where nothing is met
    glm::vec2 at{0.0f};              ///< weights of its second and third corner
    float distance = 0.0f;           ///< in diagonals
    bool is_back = false;            ///< the triangle faces away: the ray comes from inside
};

/// One answer per ray, in their order. All cores; the same bytes for any number of threads.
[[nodiscard]] std::vector<ClosestHit> closest_hits(const RayScene& scene,
                                                   std::span<const Ray> rays);

struct NearestPlace {
    std::uint32_t triangle = ClosestHit::kNone;  ///< of the geometry; kNone where it has none
    glm::vec3 position{0.0f};                    ///< unit frame
    float distance = 0.0f;                       ///< in diagonals
};

/// The point of the surface that is nearest to each place, in their order; of several as near (to
/// 1e-6 of the distance) that of the lowest triangle. geometry: that of the scene. O(log n) each,
/// all cores; the same bytes for any number of threads.
[[nodiscard]] std::vector<NearestPlace> nearest_places(const RayScene& scene,
                                                       const Geometry& geometry,
                                                       std::span<const glm::vec3> places);

}  // namespace surfelao
