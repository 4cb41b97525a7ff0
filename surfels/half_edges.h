/// half_edges.h: what only a half-edge mesh (OpenMesh) can say about a surface: its holes as loops,
/// its handles, where it stops being a manifold, and who is next to whom on it.
///
/// All of it is over positions (Geometry::welded), so seams in the file do not open a surface.
#pragma once

#include "surfels/geometry.h"

#include <array>
#include <cstdint>
#include <vector>

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

/// The triangles across the three sides of one; side k runs from its corner k to the next.
using Neighbours = std::array<std::uint32_t, 3>;
inline constexpr std::uint32_t kNoTriangle = 0xffffffff;

/// Per triangle its neighbours; kNoTriangle at borders. Neighbours are mutual, run along their
/// common side in opposite directions, and around each vertex they make fans of a manifold: what
/// one half-edge mesh does not hold together with the triangles before it (a second sheet over the
/// same edges, the third face at one) goes to the next mesh, up to kMostMeshes, and has its
/// neighbours there. In fans of more than kLargestFan triangles some sides have none.
/// O(n kLargestFan) at worst, O(n) on ordinary meshes; equal input gives equal bytes.
[[nodiscard]] std::vector<Neighbours> neighbours_of(const Geometry& geometry);

inline constexpr std::uint32_t kMostMeshes = 16;

}  // namespace surfelao
