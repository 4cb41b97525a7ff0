/// gather.h: the inner loop of the disk engine, compiled once per instruction set.
///
/// Explicit SIMD without fused multiply-add: the widest set that the processor has is taken at run
/// time, and every set gives the same bytes.
#pragma once

#include "surfels/occlusion.h"
#include "tree/disks/form_factor.h"
#include "tree/disks/octree.h"
#include "tree/receiver_groups.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// What lies beyond every disk, on the side its casting normal points to (`front`) and, for
/// two-sided ones, on the other (`back`). Either set belongs to the nodes and surfels of one
/// Octree.
struct EmitterVisibility {
    std::vector<FarVisibility> node_front, surfel_front;  ///< one per node, per surfel
    std::vector<FarVisibility> node_back,
        surfel_back;  ///< the same, or empty where all is one-sided
};

/// What is summed over the disks for one receiver.
struct DiskSum {
    float occlusion = 0.0f;     ///< sum of weighted form factors, >= 0, may exceed 1
    glm::vec3 direction{0.0f};  ///< the same, each term times its direction
};

/// Of an octree.
struct NodeRange {
    std::uint32_t begin = 0, end = 0;
};

struct GatherSettings {
    Definition definition = {};
    float opening = 0.35f;
    bool all_two_sided = false;  ///< treat one-sided surfels as two-sided
    bool only_disks = false;     ///< near triangles too are summed as disks
    NodeRange left_out[2] = {};  ///< trees whose root stands in one of them are not looked at
};

/// sums[i] for every receiver i that stands in one of these leaves of the groups.
void gather_disks(const Octree& octree, const EmitterVisibility& visibility,
                  const ReceiverGroups& groups, std::span<const std::uint32_t> leaves,
                  const GatherSettings& settings, std::span<DiskSum> sums);

/// What one leaf costs on average.
struct GatherCount {
    double tested_nodes = 0.0;  ///< in the walk, once for the leaf
    double nodes = 0.0;         ///< summed as disks, in every lane
    double surfels = 0.0;       ///< the same, single ones
};

/// The walks alone, for benchmarks. O(leaves * log n).
[[nodiscard]] GatherCount count_gather(const Octree& octree, const ReceiverGroups& groups,
                                       const GatherSettings& settings);

}  // namespace surfelao
