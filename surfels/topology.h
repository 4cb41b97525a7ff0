/// topology.h: what the surface is like: closed, oriented, manifold, and which way it faces.
///
/// All of it is over positions (Geometry::welded), so seams in the file do not open a surface.
///
///     faces at an edge   directions     called
///     1                                 boundary
///     2                  opposite       good
///     2                  same           misoriented
///     3 or more                         non-manifold
///
/// Of several triangles over the same three positions one counts, with the winding of the majority;
/// none where both windings are equally many (a sheet without thickness encloses nothing).
///
/// A body is what hangs together over edges. It is closed when every edge has as many faces in the
/// one direction as in the other, with all triangles or with those that count: then, manifold or
/// not, it is the boundary of a solid, and its signed volume (divergence theorem: sum of
/// a.(b x c) / 6) says which way it faces.
#pragma once

#include "surfels/geometry.h"
#include "surfels/surfel.h"

#include <cstdint>
#include <vector>

namespace surfelao {

/// From which side a surfel occludes in the disk engine (the masks and the rays are two-sided).
enum class OccluderSide : std::uint8_t {
    back,   ///< part of an outward-facing body, closed but for small holes (3 % of its area) and
            ///< patches turned the wrong way: seen from outside, its far side casts
    front,  ///< the same, but the triangles face inward
    both,   ///< part of an open surface, or of one without volume
};

struct Topology {
    std::uint64_t component_count = 0;           ///< connected over positions
    std::uint64_t closed_component_count = 0;    ///< with bodies, all of them closed
    std::uint64_t boundary_edge_count = 0;       ///< one face
    std::uint64_t nonmanifold_edge_count = 0;    ///< more than two faces
    std::uint64_t misoriented_edge_count = 0;    ///< two faces in the same direction
    std::uint64_t duplicate_triangle_count = 0;  ///< same three positions as an earlier triangle
    std::uint64_t solid_count = 0;               ///< bodies with a side, `back` or `front`
    std::uint64_t inward_count = 0;              ///< of those, `front`: they face inward
    /// One per scene vertex: what all bodies at its position agree on, else `both`.
    std::vector<OccluderSide> sides;
};

/// O(n), and O(k log k) for a vertex with k triangles. Equal input gives equal bytes. Fewer than
/// 2^31 / 3 triangles (edges.h).
[[nodiscard]] Topology analyse_topology(const Geometry& geometry);

/// Per surfel: the side of the surface at its vertex.
[[nodiscard]] std::vector<OccluderSide> sides_of(const SurfelCloud& cloud,
                                                 const Topology& topology);

}  // namespace surfelao
