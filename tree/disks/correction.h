/// correction.h: the steps between the passes of the disk engine, for solve_disks and for scenes
/// that move (disk_memory.h).
#pragma once

#include "surfels/progress.h"
#include "surfels/share.h"
#include "tree/disks/disks.h"
#include "tree/disks/gather.h"

#include <span>

namespace surfelao {

/// How receivers are asked. A limit may end inside a body, in front of its back: then every surface
/// casts from both sides.
[[nodiscard]] GatherSettings gather_settings(const DiskOptions& options);

/// How the emitters are asked what lies beyond them: half the range of a limit is what is left, on
/// average, beyond a disk, and nothing that still counts has the ground beyond it. What a disk is
/// to its neighbours only weighs it, so they are no triangles: that costs less, and the error was
/// measured to be smaller.
[[nodiscard]] GatherSettings beyond_settings(const DiskOptions& options);

/// gather_disks on all cores. leaves: those of the groups that are asked.
void gather_all(const Octree& octree, const EmitterVisibility& visibility,
                const ReceiverGroups& groups, const ShareRange& leaves,
                const GatherSettings& settings, std::span<DiskSum> sums, ProgressMeter& meter);

/// Moves the visibility of surfels, on the side of their normal (sign 1) or the other (-1), by what
/// of the way the pass goes to what the sums there say: to a linear function with the same mean
/// over the hemisphere (cosine-weighted) as 1 - occlusion. Its slope is what least squares gives
/// along the surface, where the mean square of w is 1/4. Along the normal w varies less (variance
/// 1/18 about its mean 2/3) and least squares would mostly amplify errors: the same factor there
/// was measured to be best. pass: from 1 on. Returns the sum of the squared changes of the mean.
/// All spans of one length.
double update_visibility(std::span<const Surfel> surfels, float sign, std::span<const DiskSum> sums,
                         int pass, std::span<FarVisibility> visibility);

/// A node's visibility: the mean over its surfels, by area; two-sided surfels that face against the
/// node give their other side. same, other, nodes: one per surfel and node of the octree; other may
/// be empty.
void average_over_nodes(const Octree& octree, const NodeRange& of,
                        std::span<const FarVisibility> same, std::span<const FarVisibility> other,
                        std::span<FarVisibility> nodes);

/// The disks have left out what the ground covers.
void add_ground(const Definition& definition, std::span<const Receiver> receivers,
                std::span<DiskSum> sums);

/// The answer that a sum is.
[[nodiscard]] Occlusion to_occlusion(const DiskSum& sum, const glm::vec3& normal, float strength);

}  // namespace surfelao
