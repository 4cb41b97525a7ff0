/// masks.h: occlusion as a bit per direction: clusters and triangles drawn into hemisphere masks.
///
/// Not sums but visibility: several layers count once. Nodes of a tree over triangles are oriented
/// rectangles; near ones are opened down to single triangles; all are drawn as convex polygons into
/// a six-face bit raster held in SIMD registers. Groups of neighbouring receivers share the far
/// part.
#pragma once

#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"

#include <memory>
#include <span>
#include <vector>

namespace surfelao {

struct MaskTree;  ///< opaque; immutable once built, read by any number of threads

/// The scene's triangles as a tree of oriented rectangles. O(n log n), all cores.
[[nodiscard]] std::shared_ptr<const MaskTree> build_mask_tree(const Geometry& geometry);

struct MaskOptions {
    Definition definition;
    // the members of the one parameter family follow here
};

/// One Occlusion per receiver. All cores, same bytes for any number of threads. Throws Cancelled.
[[nodiscard]] std::vector<Occlusion> solve_masks(const MaskTree& tree,
                                                 std::span<const Receiver> receivers,
                                                 const MaskOptions& options,
                                                 const Progress& progress = {});

}  // namespace surfelao
