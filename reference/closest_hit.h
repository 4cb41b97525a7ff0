/// closest_hit.h: what a ray meets first.
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

}  // namespace surfelao
