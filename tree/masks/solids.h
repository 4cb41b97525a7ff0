/// solids.h: which triangles belong to small closed bodies, of which one side is enough.
///
/// A ray that meets a closed body with outward triangles leaves it through one that faces away from
/// the ray's origin, wherever the origin is: along the ray, triangles facing away minus triangles
/// facing the origin are the winding number of the origin, which is not negative. So triangles that
/// face the receiver may be left out without changing what is covered.
///
/// Internal to the mask engine; masks.h is its door.
#pragma once

#include "surfels/geometry.h"

#include <cstdint>
#include <vector>

namespace surfelao {

/// One per triangle: whether its body has at most kMaskMostOfSolid triangles, is closed (every edge
/// in both directions equally often), and shows all of them from behind to the middle of its
/// corners: the winding number falls from there outward and is nowhere negative. A body is what
/// hangs together at welded vertices. O(n), and a sort for each small body.
[[nodiscard]] std::vector<std::uint8_t> small_solids(const Geometry& geometry);

}  // namespace surfelao
