/// form_factor.h: exact occlusion by polygons, the closed form that most hard cases are held
/// against. Double precision; shares nothing with any engine.
///
///            v1 ________ v2
///              /       /          1
///          v0 /_______/ v3   F = ----  |  sum over edges of  angle(v_i, v_i+1) n . unit(v_i x
///          v_i+1) |
///                                2 pi
///             o n                v: corners seen from the receiver, after the polygon is cut at
///                                the receiver's horizon (n . v >= 0)
///
/// Based on:
///   Lambert. Photometria. 1760; as in Baum, Rushmeier, Winget. Improving Radiosity Solutions
///   Through the Use of Analytically Determined Form-Factors. 1989
#pragma once

#include "surfels/receiver.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace surfelao::stability {

/// A flat polygon, convex or not, either way round.
using Polygon = std::vector<glm::dvec3>;

/// Share of the cosine-weighted hemisphere that the polygon covers, in [0, 1]. 0 when the receiver
/// lies in its plane.
[[nodiscard]] double form_factor(const Receiver& receiver, const Polygon& polygon);

/// The sum over polygons that do not hide one another from this receiver.
[[nodiscard]] double form_factor(const Receiver& receiver, std::span<const Polygon> polygons);

/// A sphere, wholly above the horizon: (R / d)^2 (n . w), w the direction of its centre.
[[nodiscard]] double sphere_form_factor(const Receiver& receiver, glm::dvec3 centre, double radius);

}  // namespace surfelao::stability
