/// kernel.h: the hot part of the mask engine, once per instruction set.
///
/// tree/masks/kernel_avx512.cpp, _avx2.cpp and _portable.cpp compile the one text of
/// tree/masks/kernel_body.h with their own flags. Plain data only, and no library code, goes
/// through this header: an inline function that is compiled with wide instructions must not be
/// picked by the linker for all.
#pragma once

#include <cstddef>
#include <cstdint>

namespace surfelao {

struct MaskRaster;
struct MaskOptions;

/// The members of the parameter family and of the definition that the kernels need.
struct MaskSettings {
    float cluster;  ///< s: a node is drawn where its radius is below this share of its distance
    float cluster_limit;  ///< what unimportant directions may relax s to
    float
        share_inner;   ///< u: group radius over distance below which a mask is shared, inner groups
    float share_leaf;  ///< r: the same for leaf groups
    float max_distance;
    float exact_radius;  ///< nodes with a smaller open_radius are never opened
    float graze;         ///< polygons whose highest corner lies below this sine of elevation over
                         ///< the receiver's tangent plane are not drawn
    bool one_sided;      ///< of small closed bodies only what faces away is drawn
    bool fill;           ///< close single-bit cracks where much is covered
    float close;         ///< how much cracks of two bits count as closed where all else is
};

/// Throws SettingsError for options out of their range.
[[nodiscard]] MaskSettings mask_settings(const MaskOptions& options);

/// Neighbouring receivers: all points within `radius` of `center`, all normals within the cone, no
/// receiver's tangent plane passes more than `rise` below the parallel plane through the centre.
struct MaskGroup {
    float center[3];
    float radius;
    float axis[3];
    float cone_cos, cone_sin;
    float rise;
    std::uint32_t begin, end;   ///< receivers, in the order of the tree
    std::uint32_t first_child;  ///< two, side by side; 0 = leaf of at most 16 receivers
};

/// In MaskNode::links: the node is a patch without gaps, whose neighbours likely continue it.
constexpr std::uint32_t kMaskSheet = 0x80000000u;
/// The node is exact and part of a small closed body: what of it faces a receiver is covered by
/// what faces away (tree/masks/solids.h).
constexpr std::uint32_t kMaskSolid = 0x40000000u;
/// The patch is hollow on the side where its normal points.
constexpr std::uint32_t kMaskHollow = 0x20000000u;
/// The node has three corners only.
constexpr std::uint32_t kMaskTriangle = 0x10000000u;
/// The rest: the first of two children side by side; 0 = leaf.
constexpr std::uint32_t kMaskFirstChild = 0x0fffffffu;

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
    MaskBuffer<std::uint32_t> clusters;    ///< nodes to be drawn for each receiver of a group
    MaskBuffer<std::uint32_t> rectangles;  ///< the same, whose rims are where the surface ends
    MaskBuffer<std::uint32_t> triangles;   ///< and with three corners
};

/// What all calls share.
struct MaskWorld {
    const float* nodes;  ///< MaskNode, 16 floats each
    const MaskRaster* raster;
    MaskSettings settings;
};

/// What far nodes cover, as seen from `center`, and how that changes with the place: a receiver at
/// p with normal n sees n.(change + slope (p - center)) more of them, had each the sky to itself.
struct MaskShared {
    alignas(64) std::uint32_t mask[256];  ///< kMaskPairWords
    float center[3];
    float change[3];      ///< from where they were drawn to `center`
    float slope[3][3];    ///< derivatives of their vector irradiance, by rows
    float irradiance[3];  ///< the sum of r (A.r) / (pi r^4) over them, A: area vectors
};

/// Up to 16 receivers as columns.
struct MaskReceivers {
    unsigned count;
    float position[3][16];
    float normal[3][16];
};

struct MaskAnswers {
    float occlusion[16];
    float bent[3][16];  ///< direction of the bent normal, any length; zero where nothing is open
};

struct MaskKernel {
    const char* name;
    /// Draws the nodes of `in` that are far from the whole group into `shared`, drops those below
    /// all horizons or beyond the limit, and hands the others, opened to about the group's size, to
    /// `out`.
    void (*descend)(const MaskWorld& world, const MaskGroup& group, const std::uint32_t* in,
                    std::size_t in_count, MaskBuffer<std::uint32_t>& out, MaskShared& shared,
                    MaskScratch& scratch);
    /// Finishes a leaf group: the rest of `in` is opened for the group and drawn for each receiver.
    void (*solve)(const MaskWorld& world, const MaskGroup& group, const std::uint32_t* in,
                  std::size_t in_count, const MaskShared& from_above,
                  const MaskReceivers& receivers, MaskAnswers& answers, MaskScratch& scratch);
};

extern const MaskKernel kMaskKernelPortable;
#if defined(__x86_64__)
extern const MaskKernel kMaskKernelAvx2;
extern const MaskKernel kMaskKernelAvx512;
#endif

}  // namespace surfelao
