/// gpu_disks.h: the disk engine on the GPU.
///
/// What it measures and how is said in tree/disks/disks.h; this is the same computation, step by
/// step, with all data on the device between its first and its last pass: the octree as one array
/// of records (shaders/disk_record.glsl), groups of sixteen receivers that open the same nodes as
/// on the CPU. Results agree with solve_disks to 1e-4 but where rounding tips the opening of a node
/// (tests say how often).
#pragma once

#include "gpu/context.h"
#include "tree/disks/disks.h"

#include <span>

namespace surfelao {

/// As solve_disks. The context must be current. Throws std::runtime_error when the device cannot
/// hold the scene or is lost, Cancelled.
[[nodiscard]] DiskResult solve_disks_gpu(const GlContext& context, const Octree& octree,
                                         std::span<const Receiver> receivers,
                                         const DiskOptions& options, const Progress& progress = {});

}  // namespace surfelao
