/// masks.h: occlusion as a bit per direction: clusters and triangles drawn into hemisphere masks.
///
/// Not sums but visibility: several layers count once. Nodes of a tree over triangles are oriented
/// rectangles; near ones are opened down to single triangles; all are drawn as convex polygons into
/// a six-face bit raster held in SIMD registers. Groups of neighbouring receivers share the far
/// part. Occlusion is the weight of the set bits above the horizon; the bent normal comes from the
/// clear ones. Method, parameters and measurements: docs/masks.md.
///
/// Related work: Kautz, Lehtinen, Aila. Hemispherical Rasterization for Self-Shadowing of Dynamic
/// Objects. 2004. Laine, Karras. Two Methods for Fast Ray-Cast Ambient Occlusion. 2010.
#pragma once

#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"
#include "surfels/share.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace surfelao {

struct MaskTree;  ///< opaque; immutable once built, read by any number of threads

/// Leaves of a tree: with as many inner nodes, less one, what the 28 bits of a link can count.
inline constexpr std::uint64_t kMostMaskTiles = std::uint64_t{1} << 27;

/// The scene's triangles as a tree of oriented rectangles. O(n log n), all cores, at most 128 bytes
/// a triangle (half where all are in flat pairs), 250 while it is built; equal input gives equal
/// bytes for any number of threads. Throws InputError where there are more triangles than
/// kMostMaskTiles, a flat pair counting as one.
[[nodiscard]] std::shared_ptr<const MaskTree> build_mask_tree(const Geometry& geometry);

/// Instruction sets of the inner loops. The same answers but for single bits at edges that pass
/// through a bit's own direction to within rounding.
enum class MaskKernelSet {
    best,      ///< the widest that this processor has
    avx512,    ///< AVX-512 with VNNI
    avx2,      ///< AVX2 with FMA
    portable,  ///< any processor
};

/// The sets that this processor has, widest first; never empty, never contains `best`.
[[nodiscard]] std::vector<MaskKernelSet> available_mask_kernels();
[[nodiscard]] std::string_view name_of(MaskKernelSet kernel);

/// One parameter family for every mesh. `quality` is the one control: larger is slower and nearer
/// to the truth.
struct MaskOptions {
    static constexpr float kCoarsest = -1.0f;
    static constexpr float kDraft = 0.0f;
    static constexpr float kGood = 1.0f;
    static constexpr float kBest = 2.0f;
    static constexpr float kFinest = 4.0f;

    Definition definition = {};

    /// In [-1, 4]; 0, 1 and 2 are `draft`, `good` and `best`. Between whole numbers the sizes of
    /// clusters and of shared groups are interpolated geometrically.
    float quality = kGood;

    /// The oracle: every triangle drawn for every receiver, nothing shared, nothing filled. O(n)
    /// per receiver. `quality` is then without effect.
    bool exact = false;

    /// Of the groups of receivers; the others get kUnsolved, but for those without a normal.
    Share share = {};

    MaskKernelSet kernel = MaskKernelSet::best;  ///< one of available_mask_kernels(), or best
};

/// One Occlusion per receiver. All cores, same bytes for any number of threads. The definition's
/// kernel must be Kernel::cosine. Throws SettingsError where an option is out of its range or the
/// processor lacks the kernel, Cancelled. Without a ground all receivers are forgotten before it
/// answers.
[[nodiscard]] std::vector<Occlusion> solve_masks(const MaskTree& tree,
                                                 std::span<const Receiver> receivers,
                                                 const MaskOptions& options,
                                                 const Progress& progress = {},
                                                 const ForgetReceivers& forget = {});

}  // namespace surfelao
