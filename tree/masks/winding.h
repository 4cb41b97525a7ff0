/// winding.h: meshes whose triangles are wound at random.
///
/// The tree clusters by place and normal. A surface whose triangles face both ways in turns falls
/// apart into two clusters full of gaps, which leak. Occlusion does not ask how a triangle is
/// wound, so such meshes are wound alike before the tree is built.
#pragma once

#include "surfels/geometry.h"

namespace surfelao {

/// Whether more than kMaskTurnedShare of the triangles face away from the normals of all their
/// vertices: next to none do where the winding is one or changes from part to part. Looks at
/// kMaskTurnedSample triangles.
[[nodiscard]] bool is_winding_mixed(const Geometry& geometry);

/// Turns triangles so that neighbours over an edge of exactly two triangles run along it in
/// opposite directions; the first triangle of what hangs together by such edges stays (where that
/// is impossible, as on a Moebius strip, some edge is left over). O(n), as edges.h.
void wind_alike(Geometry& geometry);

}  // namespace surfelao
