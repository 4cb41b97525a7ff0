/// vertex_clusters.h: fine meshes for those who look from afar.
#pragma once

#include "surfels/geometry.h"

namespace surfelao {

/// The same surfaces with fewer vertices: those in one cell that look the same way become one, in
/// their middle, and triangles of which too little is left vanish (Rossignac, Borrel. Multi-
/// resolution 3D approximations for rendering complex scenes. 1993). Cells are columns along the
/// axis that a vertex's normal is nearest to. Only vertices around which the surface closes are
/// moved, so that open edges stay where they are and loose leaves stay whole; and only where the
/// normals of a cell differ little, so that what is thinner than a cell keeps its width. No vertex
/// moves farther than 1.5 cubes along any axis.
///
/// cube: the width of a cell in the unit frame, > 0. The frame stays. Vertices are numbered anew
/// and nothing is known of the scene's (`kept`). O(n) expected; equal input gives equal bytes.
[[nodiscard]] Geometry cluster_vertices(const Geometry& geometry, float cube);

}  // namespace surfelao
