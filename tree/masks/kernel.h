/// kernel.h: the hot part of the mask engine, once per instruction set.
///
/// tree/masks/kernel_avx512.cpp, _avx2.cpp and _portable.cpp compile the one text of
/// tree/masks/kernel_body.h with their own flags. Plain data only, and no library code, goes
/// through this header: an inline function that is compiled with wide instructions must not be
/// picked by the linker for all.
///
/// Words, one meaning each, here and in shaders/masks_*:
///
///     mask      a bit per direction around a receiver, or around a group for what it shares
///     lane      one of the values of a vector: Float4 (lanes.h), Float16 (simd.h)
///     exact     a node whose triangles tile the quadrilateral that it shows: leaves, rectangles
///     cluster   a node that is drawn in place of its triangles though it is not exact
///     sheet     a cluster so flat and without gaps that its neighbours likely continue it: its
///               rim is not where the surface ends (kMaskSheet)
///     crack     a clear bit between set ones of which a sheet set one
///
/// A node is shared (drawn for the group), listed (drawn for each of its receivers), handed (left
/// to the groups below) or opened (replaced by its children).
#pragma once

#include "tree/masks/constants.h"
#include "tree/receiver_group.h"

#include <cstddef>
#include <cstdint>

namespace surfelao {

struct MaskRaster;
struct MaskOptions;

/// The hits within a distance count so much more: a hit counts the sum of the weights of all limits
/// that it is within.
struct MaskLimits {
    unsigned count;                   ///< 1 to kMaskMostLimits
    float distance[kMaskMostLimits];  ///< ascending; infinite: only alone
    float weight[kMaskMostLimits];    ///< their sum is 1
    float uncut;  ///< polygons of smaller radius belong to the limit of their middle; 0: none
};

/// The members of the parameter family and of the definition that the kernels need.
struct MaskSettings {
    /// s: a node is drawn where its open radius is below this share of its distance.
    float cluster;
    float cluster_limit;  ///< what unimportant directions may relax s to
    float crossing;       ///< of s, for nodes that a distance limit may cut
    /// u: an inner group shares what is so far that group radius over distance is below this.
    float share_inner;
    float share_leaf;    ///< r: the same for leaf groups
    float exact_radius;  ///< nodes with a smaller open_radius are never opened
    /// g: polygons whose highest corner lies below this sine of elevation over the receiver's
    /// tangent plane are not drawn.
    float graze;
    int rows;         ///< of a face of the raster: MaskRaster::rows
    bool one_sided;   ///< of small closed bodies only what faces away is drawn
    bool fill;        ///< close single-bit cracks where more than `fill_from` is covered
    float fill_from;  ///< occlusion
    float close;      ///< how much cracks of two bits count as closed where all else is
    bool has_ground;
    float ground_up[3];  ///< Definition::ground, in the mask frame
    float ground_height;
    MaskLimits limits;
};

/// Throws SettingsError for options out of their range.
[[nodiscard]] MaskSettings mask_settings(const MaskOptions& options);

/// A growing array of plain values.
template <typename T>
struct MaskBuffer {
    T* data = nullptr;
    std::size_t count = 0;
    std::size_t capacity = 0;
};
/// Makes room for `count` elements, keeps the contents. 64-byte aligned. Throws std::bad_alloc.
void reserve(MaskBuffer<std::uint32_t>& buffer, std::size_t count);
void release(MaskBuffer<std::uint32_t>& buffer);

/// Working memory of one thread.
struct MaskScratch {
    MaskBuffer<std::uint32_t> frontier;
    MaskBuffer<std::uint32_t> sheets;      ///< nodes to be drawn for each receiver of a group
    MaskBuffer<std::uint32_t> rectangles;  ///< the same, whose rims are where the surface ends
    MaskBuffer<std::uint32_t> triangles;   ///< and with three corners
};

/// What all calls share.
struct MaskWorld {
    const float* nodes;  ///< MaskNode, 16 floats each
    const MaskRaster* raster;
    MaskSettings settings;
};

/// How what far nodes cover changes with the place: a receiver at p with normal n sees
/// n.(change + slope (p - center)) more of them, had each the sky to itself. Each counts by its
/// distance (MaskLimits).
struct MaskFlow {
    float center[3];
    float change[3];      ///< from where they were drawn to `center`
    float slope[3][3];    ///< derivatives of their vector irradiance, by rows
    float irradiance[3];  ///< the sum of r (A.r) / (pi r^4) over them, A: area vectors
};

/// What far nodes cover, as seen from the centre of `flow`.
struct MaskShared {
    /// Per limit, kMaskPairWords each. What lies wholly within one limit is not in those beyond it:
    /// within a limit is covered what this one and all nearer ones hold.
    alignas(64) std::uint32_t mask[kMaskMostLimits][256];
    MaskFlow flow;
};

/// `to` becomes `from` within the first `limits` limits; beyond them stands anything.
inline void copy(const MaskShared& from, unsigned limits, MaskShared& to)
{
    __builtin_memcpy(to.mask, from.mask, limits * sizeof from.mask[0]);
    to.flow = from.flow;
}

/// What a leaf group has found within one limit of some of the nodes, to be taken up together with
/// others.
struct MaskKept {
    alignas(64) std::uint32_t shared[256];  ///< MaskShared::mask, as of the group's centre
    /// Per receiver what is covered of the faces, what lies below the horizon as if it were, and
    /// what of it sheets cover: kMaskFaces kMaskFaceWords words each.
    alignas(64) std::uint32_t drawn[16][192];
    MaskFlow flow;  ///< of all limits; only in the first
};

/// Up to 16 receivers as columns.
struct MaskReceivers {
    unsigned count;
    float position[3][16];
    float normal[3][16];
    /// What the ground leaves of the hemisphere within each limit, cosine-weighted: 1 without one.
    float sky[kMaskMostLimits][16];
    float above[16];  ///< signed height over the ground
};

struct MaskAnswers {
    float occlusion[16];
    float bent[3][16];  ///< direction of the bent normal, any length; zero where nothing is open
};

struct MaskKernel {
    const char* name;
    /// Draws the nodes of `in` that are far from the whole group into `shared`, drops those below
    /// all horizons or beyond all limits, and hands the others, opened to about the group's size,
    /// to `out`.
    void (*descend)(const MaskWorld& world, const ReceiverGroup& group, const std::uint32_t* in,
                    std::size_t in_count, MaskBuffer<std::uint32_t>& out, MaskShared& shared,
                    MaskScratch& scratch);
    /// Finishes a leaf group: the rest of `in` is opened for the group and drawn for each receiver.
    void (*solve)(const MaskWorld& world, const ReceiverGroup& group, const std::uint32_t* in,
                  std::size_t in_count, const MaskShared& from_above,
                  const MaskReceivers& receivers, MaskAnswers& answers, MaskScratch& scratch);
    /// The same, but for the answers, and without a ground. kept: one per limit, `stride` apart.
    void (*keep)(const MaskWorld& world, const ReceiverGroup& group, const std::uint32_t* in,
                 std::size_t in_count, const MaskShared& from_above, const MaskReceivers& receivers,
                 MaskKept* kept, std::size_t stride, MaskScratch& scratch);
    /// Finishes a leaf group of which some is kept; `in` is the rest. The same bits as solve() of
    /// all, but for where receivers are left out because they are closed, and for MaskFlow: how
    /// much of the rest is seen is told by each receiver's own masks, so that what is kept hides it
    /// (FlightHelmet with spot, good: largest spurious change of a frame .0127 -> .0036).
    void (*solve_kept)(const MaskWorld& world, const ReceiverGroup& group, const std::uint32_t* in,
                       std::size_t in_count, const MaskKept* kept, std::size_t stride,
                       const MaskReceivers& receivers, MaskAnswers& answers, MaskScratch& scratch);
};

extern const MaskKernel kMaskKernelPortable;
#if defined(__x86_64__)
extern const MaskKernel kMaskKernelAvx2;
extern const MaskKernel kMaskKernelAvx512;
#endif

}  // namespace surfelao
