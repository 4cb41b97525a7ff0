/// placement.h: where a rigid body is, turned, scaled and moved from where it was prepared.
#pragma once

#include "surfels/receiver.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace surfelao {

/// A similarity of the unit frame, from where a body was prepared to where it is:
/// p -> scale * rotation * p + translation.
struct Placement {
    glm::dmat3 rotation{1.0};     ///< orthonormal; of determinant -1 where it mirrors
    double scale = 1.0;           ///< > 0
    glm::dvec3 translation{0.0};  ///< in diagonals
    bool operator==(const Placement&) const = default;
};

/// The same as one matrix.
[[nodiscard]] glm::dmat4 matrix_of(const Placement& placement);

/// Back to where it was.
[[nodiscard]] Placement inverse(const Placement& placement);
/// First `before`, then `after`.
[[nodiscard]] Placement operator*(const Placement& after, const Placement& before);

/// Of an affine matrix; empty where it is no similarity to within 1e-6 (sheared, or scaled
/// unevenly), flat, or not finite. Such bodies are deformed (MovingScene::deform).
[[nodiscard]] std::optional<Placement> placement_of(const glm::dmat4& matrix);

/// Where a point of the body is.
[[nodiscard]] glm::dvec3 placed_point(const glm::dvec3& point, const Placement& placement);
/// Offsets scale with the body; where nothing has moved no bit changes.
[[nodiscard]] Receiver placed(const Receiver& receiver, const Placement& placement);

}  // namespace surfelao
