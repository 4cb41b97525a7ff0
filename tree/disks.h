/// disks.h: occlusion by summed disk form factors over an octree of clustered surfels.
///
/// The classic: fast, preview quality, the same in GLSL (gpu/). Known limits: layers, thin parts
/// and open meshes (RMSE 0.05 and more), rooms fail. See design notes in docs/.
///
/// Based on:
///   Bunnell. Dynamic Ambient Occlusion and Indirect Lighting. GPU Gems 2, ch. 14. 2005
///   Hoberock, Jia. High-Quality Ambient Occlusion. GPU Gems 3, ch. 12. 2007
#pragma once

#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"
#include "surfels/surfel.h"
#include "surfels/topology.h"
#include "tree/octree.h"

#include <span>
#include <vector>

namespace surfelao {

struct DiskOptions {
    Definition definition;
    float opening =
        0.35f;       ///< >= 0: a node is opened while its radius / distance is above; 0 = all
    int passes = 2;  ///< >= 1: 1 = plain sum; more = damped correction of over-occlusion
    float strength = 1.0f;  ///< >= 0: occlusion is multiplied by it, then cut to [0, 1]
};

struct DiskResult {
    std::vector<Occlusion> occlusion;  ///< one per receiver
    std::vector<double> residuals;     ///< RMS change of the emitters' visibility, one per pass
};

/// O(n log n) per pass, all cores, same bytes for any number of threads. Throws Cancelled.
[[nodiscard]] DiskResult solve_disks(const Octree& octree, std::span<const Receiver> receivers,
                                     const DiskOptions& options, const Progress& progress = {});

}  // namespace surfelao
