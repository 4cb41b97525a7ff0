/// refit.h: the tree of a form that has bent, from how the tree of the form at rest was built.
///
/// The same triangles stand below the same nodes; patches are summed up anew from the new corners.
/// No sorting: about half of the time of a build. Where neighbours were cut apart at rest they
/// still lie next to each other: the planes of the cut turn with the patch.
///
/// Internal to the mask engine; masks.h is its door.
#pragma once

#include "surfels/geometry.h"
#include "surfels/raw_vector.h"
#include "tree/masks/patch.h"
#include "tree/masks/tiles.h"
#include "tree/masks/tree.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>

namespace surfelao {

/// A node as it was built.
struct MaskPlanNode {
    glm::vec3 center, normal;  ///< of its patch
    MaskRoom room;             ///< of inner nodes
    std::uint32_t below;       ///< of inner nodes: tiles of the first child
};

/// How a tree was built.
struct MaskPlan {
    RawVector<MaskTile> tiles;
    RawVector<std::uint32_t> order;  ///< tiles by their leaves
    RawVector<MaskPlanNode> nodes;   ///< one for each of the tree
    double radii = 0.0;              ///< sum over the tree's nodes
    bool has_solids = false;
};

/// The nodes of build_mask_tree. geometry: its triangles wound alike.
[[nodiscard]] RawVector<MaskNode> build_mask_nodes(const Geometry& geometry);

/// The same, and how it went.
[[nodiscard]] RawVector<MaskNode> build_mask_nodes(const Geometry& geometry, MaskPairs pairs,
                                                   MaskPlan& plan);

/// The nodes of the same triangles over other positions. Empty where a pair is flat no longer, or
/// the sum of the nodes' radii is more than kMaskRefitGrowth times the plan's.
[[nodiscard]] std::optional<RawVector<MaskNode>> refit_mask_nodes(const MaskPlan& plan,
                                                                  const Geometry& form);

}  // namespace surfelao
