/// mask_solids.h: which triangles belong to small closed bodies, of which one side is enough.
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

/// One per triangle: whether its body is closed, convex, with outward triangles, and of at most
/// kMostOfSolid triangles. A body is what hangs together at welded vertices. O(n) and O(k^2) per
/// body of k triangles.
[[nodiscard]] std::vector<std::uint8_t> small_solids(const Geometry& geometry);

inline constexpr std::size_t kMostOfSolid = 64;

}  // namespace surfelao
