/// disks.h: occlusion by summed disk form factors over an octree of clustered surfels.
///
/// The classic, with one thing added. Fast, preview quality, the same in GLSL (gpu/).
///
/// A ray that leaves a closed body again crosses one surface from behind for every layer it passes.
/// So each surfel occludes only what sees its back (octree.h: `casting normal`), and layers would
/// count several times. Only the last layer of a ray has nothing behind it:
///
///     occlusion along w = sum over the layers of  (1 - occlusion along w beyond that layer)
///
/// which is exact and refers to itself: the next pass weights each disk by what the pass before
/// found beyond it. The classic weights by one number for all directions; here it is a linear
/// function of the direction, fitted to the first moment of the occluders that the disk sees. That
/// halves the error, and settles in few passes where one number oscillates.
///
/// Surfaces that have no back (open, not manifold: OccluderSide::both) occlude from both sides and
/// carry two such functions, one for each side; the same is done to all surfaces where a maximum
/// distance may end between a front and its back.
///
/// A ground is no disk: what it covers is added as a whole (tree/ground.h), and disks count only
/// where it does not, or where they are nearer and a falloff makes that more.
///
/// Nearer than three radii a disk is no likeness of what it stands for. Where that is one triangle
/// (surfels_of: large ones, long ones and those at edges) the triangle is summed there, exactly and
/// cut at the horizon: coarse meshes and hard edges are as right as fine smooth ones.
///
/// Known limits: surfaces nearer to each other than three times the vertex spacing; many layers one
/// behind the other (foliage, machines: a linear function of the direction does not tell which of
/// them a ray leaves through, and three passes do not settle); a ground of few triangles that is
/// hundreds of times as wide as the model on it (surfels_of cuts triangles by the size of the whole
/// scene, not by what is near them: what lies beyond a piece is one function for all of it).
///
/// Based on:
///   Bunnell. Dynamic Ambient Occlusion and Indirect Lighting. GPU Gems 2, ch. 14. 2005
///   Hoberock, Jia. High-Quality Ambient Occlusion. GPU Gems 3, ch. 12. 2007
///   Engleson. Point-based ambient occlusion (report). 2011: Kernel::bunnell, `strength`
#pragma once

#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"
#include "surfels/share.h"
#include "surfels/surfel.h"
#include "surfels/topology.h"
#include "tree/disks/octree.h"

#include <algorithm>
#include <span>
#include <vector>

namespace surfelao {

/// A node stands for its surfels where its opening_size (octree.h: radius, more where it is folded)
/// is below opening * distance to the nearest receiver of a group. From 1/sqrt(3) = 0.577 on the
/// error of such a sum has no bound (Salmon, Warren 1994): draft is beyond, for speed. Error and
/// time on the Stanford bunny, relative to good: draft 1.18 and 0.8, best 0.97 and 1.6.
inline constexpr float kDraftOpening = 0.72f;
inline constexpr float kGoodOpening = 0.47f;
inline constexpr float kBestOpening = 0.24f;

struct DiskOptions {
    Definition definition = {};
    float opening = kGoodOpening;  ///< 0 (every surfel is summed) to below 1: a node that holds the
                                   ///< receiver is always opened
    int passes = 3;         ///< >= 1: 1 = plain sum; each further one corrects over-occlusion
    float strength = 1.0f;  ///< >= 0: occlusion is multiplied by it, then cut to [0, 1]
    /// Of the groups of receivers, of each list; the others get kUnsolved, but for those without a
    /// normal. The emitters are corrected all the same.
    Share share = {};
};

struct DiskResult {
    std::vector<Occlusion> occlusion;  ///< one per receiver
    /// RMS change of the emitters' mean visibility in each correcting pass: passes - 1 of them, or
    /// fewer where they settled below kSettled.
    std::vector<double> residuals;
};

/// Corrections stop when a pass changes the emitters by no more than this.
inline constexpr double kSettled = 5e-4;

/// The first correction sums all layers beyond a disk, each as if it were the last. How they hide
/// each other is not known yet: one layer leaves 1 - sum open, layers at random less than
/// exp(-sum), and 1 / (1 + sum) is what was measured to start from best, so a sum is divided by 1 +
/// sum. From then on sums know of layers: what is more than a full hemisphere is cut.
/// 3 passes, good, RMSE, cut at once -> so: pine .101 -> .073, mountain .018 -> .016, engine .048
/// -> .048, pandora .053 -> .058, blocks .044 -> .048, FlightHelmet .120 -> .136. With 2, cut:
/// .102, .012, .079, .092, .069, .133, in half to three quarters of the time.
[[nodiscard]] inline float correction_divisor(int pass, float occlusion)
{
    return pass == 1 ? 1.0f + occlusion : std::max(1.0f, occlusion);
}

/// The share of the way that emitters go to what a correcting pass found. The map is
/// order-reversing, so whole steps can end in a cycle of two (rooms); the first two are best taken
/// whole.
[[nodiscard]] inline float correction_weight(int pass)
{
    return pass <= 2 ? 1.0f : 0.7f;
}

/// O(n log n) per pass, all cores, same bytes for any number of threads and on every processor.
/// The first pass costs one gather at the receivers; each correcting pass one at the surfels, two
/// where any of them is two-sided. Throws Cancelled.
[[nodiscard]] DiskResult solve_disks(const Octree& octree, std::span<const Receiver> receivers,
                                     const DiskOptions& options, const Progress& progress = {});

/// The same for several lists of receivers, each as if it were asked alone; the emitters are
/// corrected once for all of them. One result per list, at least one list.
[[nodiscard]] std::vector<DiskResult> solve_disk_lists(
    const Octree& octree, std::span<const std::span<const Receiver>> lists,
    const DiskOptions& options, const Progress& progress = {});

/// The opening of the correcting passes: what lies beyond a disk only weighs it, so it is summed
/// kCoarser than the answer, up to draft. On five meshes the error stayed the same or fell, by up
/// to a tenth, and a quarter to a half of the time was saved. 0 stays 0.
[[nodiscard]] float correction_opening(float opening);
inline constexpr float kCoarser = 3.2f;

/// Throws SettingsError where an option is out of its range; solve_disks does too.
void check_disk_options(const DiskOptions& options);

/// The surfels' far sides as receivers, one per surfel: what the correcting passes ask. Off the
/// surface as surface.h has it, for a triangle as high as the surfel is wide.
/// side: +1 = where the casting normal points, -1 = the other.
[[nodiscard]] std::vector<Receiver> far_sides(const Octree& octree, float side);

}  // namespace surfelao
