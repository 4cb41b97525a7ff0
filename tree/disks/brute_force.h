/// brute_force.h: the disk engine without a tree: the oracle of its tests and the yardstick of its
/// benchmark.
#pragma once

#include "tree/disks/disks.h"

namespace surfelao {

/// What solve_disks gives with opening 0, in double precision and plain loops: every surfel of
/// octree.surfels is summed for every receiver; nodes and options.opening are not looked at.
/// O(surfels * (receivers + passes * surfels)), all cores, same bytes for any number of threads.
[[nodiscard]] DiskResult solve_disks_brute_force(const Octree& octree,
                                                 std::span<const Receiver> receivers,
                                                 const DiskOptions& options);

}  // namespace surfelao
