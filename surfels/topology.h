/// topology.h: what the surface is like: closed, oriented, manifold, and which way it faces.
#pragma once

#include "surfels/geometry.h"

#include <cstdint>
#include <vector>

namespace surfelao {

/// From which side a surfel occludes in the disk engine (the masks and the rays are two-sided).
enum class OccluderSide : std::uint8_t {
    back,   ///< part of a closed, outward-facing body: seen from outside, its far side casts
    front,  ///< part of a closed body whose triangles face inward
    both,   ///< open, non-manifold or inconsistently oriented
};

struct Topology {
    std::uint64_t component_count = 0;  ///< connected over welded vertices
    std::uint64_t closed_component_count =
        0;  ///< every edge has exactly two oppositely directed faces
    std::uint64_t boundary_edge_count = 0;     ///< one face
    std::uint64_t nonmanifold_edge_count = 0;  ///< more than two faces
    std::uint64_t misoriented_edge_count =
        0;  ///< two faces that run along it in the same direction
    std::uint64_t duplicate_triangle_count = 0;  ///< same three positions as an earlier triangle
    std::vector<OccluderSide> sides;             ///< one per scene vertex
};

/// O(n log n). Uses OpenMesh for connectivity where the surface is manifold; edges that OpenMesh
/// refuses are counted from the welded edge list.
[[nodiscard]] Topology analyse_topology(const Geometry& geometry);

}  // namespace surfelao
