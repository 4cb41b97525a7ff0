/// octree.h: a hierarchy over surfels in which every node is also one large disk.
///
/// Plain data. Build once, then read from any thread.
///
/// Nodes stand in preorder: a node's first child follows it directly, and `next` leads past its
/// whole subtree. So a walk needs no stack:
///
///     for (i = 0; i < nodes.size();)
///         if (far enough to stand for its surfels)
///             use nodes[i] as a disk;         i = nodes[i].next;
///         else if (nodes[i].next == i + 1)
///             use its surfels one by one;     i = nodes[i].next;
///         else
///             i = i + 1;
///
/// One-sided and two-sided surfels never share a node: the array holds two trees one after the
/// other (either may be empty), and the walk above passes through both. Octrees of several bodies
/// side by side (disk_forest.h) are walked alike: first the one-sided trees of all, then the
/// two-sided ones.
///
/// Based on:
///   Barnes, Hut. A Hierarchical O(N log N) Force-Calculation Algorithm. 1986
///   Salmon, Warren. Skeletons from the Treecode Closet. 1994: why balls about the centroid, and
///     why the error has no bound from an opening of 1/sqrt(3) on
///   Bunnell. Dynamic Ambient Occlusion and Indirect Lighting. GPU Gems 2, ch. 14. 2005
#pragma once

#include "surfels/surfel.h"
#include "surfels/topology.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// 48 bytes: SIMD code fetches the fields of several nodes by that stride. On the GPU nodes and
/// surfels are one array of records (shaders/disk_record.glsl, made by gpu/gpu_disks.cpp). Whether
/// a node is one-sided or two-sided its index tells (Octree::two_sided_nodes).
struct OctreeNode {
    glm::vec3 center{0.0f};  ///< area-weighted mean of the surfel positions
    float radius = 0.0f;     ///< the ball about `center` holds all disks below, their rims too
    glm::vec3 normal{0.0f};  ///< direction of the vector area S = sum of area * casting normal;
                             ///< unit length, or zero where S cancels
    float flatness = 0.0f;   ///< |S| / area: 1 = all normals agree, 0 = they cancel
    std::uint32_t next = 0;  ///< the node after this subtree; own index + 1 = leaf
    std::uint32_t first_surfel = 0;  ///< into Octree::surfels
    std::uint32_t surfel_count = 0;  ///< > 0, inner nodes included
    float area = 0.0f;               ///< sum of the areas; as one flat disk: flatness * area
};
static_assert(sizeof(OctreeNode) == 48);

/// How much larger than its ball a node counts in the opening test when its normals cancel wholly:
/// a folded cluster is a poor disk. Measured on closed scans: 4 gives at equal time 0.6 times the
/// error of 0; beyond 4 little changes.
inline constexpr float kFoldPenalty = 4.0f;

/// How much larger a node counts where max_distance may end inside it.
inline constexpr float kLimitPenalty = 4.0f;

/// A node stands for its surfels where this is below opening * distance.
[[nodiscard]] inline float opening_size(const OctreeNode& node)
{
    return node.radius * (1.0f + kFoldPenalty * (1.0f - node.flatness));
}

/// An empty cloud has no nodes.
struct Octree {
    std::vector<OctreeNode> nodes;
    /// The input in Morton order, one-sided ones first, so that each node owns one range. The
    /// normal is the *casting* normal m: a one-sided surfel occludes a receiver at p when dot(m,
    /// position - p) > 0. For OccluderSide::front that is the input's normal turned round.
    std::vector<Surfel> surfels;
    std::vector<std::uint32_t> source;  ///< surfels[i] was input[source[i]]
    std::uint32_t two_sided_nodes = 0;  ///< index of the first two-sided node; nodes.size() if none
    std::uint32_t two_sided_surfels = 0;  ///< index of the first two-sided surfel; size if none
};

struct OctreeOptions {
    std::uint32_t leaf_surfels = 4;  ///< >= 1: a node with at most that many is a leaf
};

/// Builds the tree in O(n log n), on all cores. Equal input gives equal bytes for any number of
/// threads. The depth is at most 21; surfels at one place (within 2^-21 of the cloud's size) end
/// together in one leaf, however many.
///
/// Surfels must be finite and have area > 0 (surfels_at_vertices guarantees it). sides: one per
/// surfel, or empty = all `back`.
[[nodiscard]] Octree build_octree(std::span<const Surfel> surfels,
                                  std::span<const OccluderSide> sides = {},
                                  const OctreeOptions& options = {});

}  // namespace surfelao
