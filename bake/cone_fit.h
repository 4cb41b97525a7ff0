/// cone_fit.h: the cone of an AO grid's cell that tells best what receivers there see.
///
/// Moments are exact for what an object hides from the whole sphere, but its cone is read by
/// receivers of all normals, and an object is no cone: in least squares of what they read, another
/// cone is nearer.
///
/// Internal to bake_grid (grid_target.h).
#pragma once

#include "surfels/occlusion.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <span>

namespace surfelao {

/// One damped step of Gauss and Newton from these moments (grid/cone.h), or the moments themselves
/// where it gains nothing. answers: of receivers at one place with these normals.
[[nodiscard]] glm::vec4 fit_cone(glm::vec4 moments, std::span<const glm::vec3> normals,
                                 std::span<const Occlusion> answers);

}  // namespace surfelao
