/// ground.h: what an infinite plane covers of a receiver's hemisphere, without a mesh.
///
/// Seen from a receiver the ground within a distance limit is a circular cone about the direction
/// straight to it, cut by the receiver's horizon; without a limit it is a half-space.
///
/// Based on:
///   Snyder. Area Light Sources for Real-Time Graphics. MSR-TR-96-11. 1996: a sphere, which is such
///   a cone, at the horizon
#pragma once

#include "surfels/occlusion.h"
#include "surfels/receiver.h"

#include <glm/vec3.hpp>

namespace surfelao {

/// Signed: negative below the plane.
[[nodiscard]] float height_over(const Ground& ground, glm::vec3 position);

/// The ground as one receiver sees it.
struct GroundSight {
    glm::vec3 towards{0.0f};  ///< unit length, straight to the plane
    float distance = 0.0f;    ///< >= 0, of the plane
};

[[nodiscard]] GroundSight sight_of(const Ground& ground, glm::vec3 position);

/// Cosine-weighted share of the hemisphere around n that a cone of directions w.a >= k covers.
///
///        n      c = n.a, s = sqrt(1 - c^2), r = sqrt(1 - k^2)
///      __|__a
///     /  |_/    c >= r  (all of it above the horizon)    c r^2
///     ___|/     c <= -r (nothing)                        0
///               else    (r^2 c acos(-c k / (r s)) - k t + atan(t / k)) / pi,  t = sqrt(r^2 - c^2)
///
/// Exact. cosine: c in [-1, 1]; edge: k in [0, 1].
[[nodiscard]] double cone_share(double cosine, double edge);

/// Occlusion by the ground alone within a hard limit, maybe infinite.
[[nodiscard]] float ground_share(const Ground& ground, const Receiver& receiver, float limit);

/// Occlusion by the ground alone, which the definition has: exact, with a falloff to 2e-4.
[[nodiscard]] float ground_share(const Definition& definition, const Receiver& receiver);

/// Integral of H(w) w (n.w) / pi for the ground alone, which the definition has; to 1e-3.
[[nodiscard]] glm::vec3 ground_direction(const Definition& definition, const Receiver& receiver);

}  // namespace surfelao
