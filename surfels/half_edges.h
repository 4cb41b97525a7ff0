/// half_edges.h: what only a half-edge mesh (OpenMesh) can say about a surface: its holes as loops,
/// its handles, and where it stops being a manifold.
///
/// All of it is over positions (Geometry::welded), so seams in the file do not open a surface.
#pragma once

#include "surfels/geometry.h"

#include <cstdint>

namespace surfelao {

struct HalfEdgeReport {
    std::uint64_t hole_count = 0;          ///< closed loops of border edges
    std::uint64_t largest_hole_edges = 0;  ///< edges of the longest loop
    std::uint64_t handle_count = 0;        ///< sum of the genus over the closed components: the
                                           ///< torus has 1; E - V - F = 2 genus - 2
    /// Triangles that no half-edge mesh holds together with the ones before them: at an edge that
    /// already has two faces or one in the same direction, at a vertex where two fans would meet,
    /// or around a vertex of more than kLargestFan triangles. The figures above leave them out.
    std::uint64_t complex_triangle_count = 0;
};

/// Adding a face walks around its corners, so a vertex of k triangles costs k^2 steps; this bounds
/// them.
inline constexpr std::uint32_t kLargestFan = 512;

/// O(n kLargestFan) at worst, O(n) on ordinary meshes; about a second for 10^6 triangles.
[[nodiscard]] HalfEdgeReport examine_half_edges(const Geometry& geometry);

}  // namespace surfelao
