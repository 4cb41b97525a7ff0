/// grid_objects.h: what of a model has an AO grid of its own where bodies move.
///
/// An object is a body that moves as one piece, and what rests is one more: what never moves, with
/// what a hand has touched and not moved, so that taking hold of something makes no other grids.
/// What bends (skins, morphs) is none.
#pragma once

#include "viewer/model_pose.h"

#include <cstdint>
#include <vector>

namespace surfelao {

/// Scene triangles of one object, rising.
using ObjectTriangles = std::vector<std::uint32_t>;

struct GridObjects {
    static constexpr std::uint32_t kNone = 0xffffffff;
    std::vector<ObjectTriangles> triangles;  ///< one per object, none of them empty
    std::vector<std::uint32_t> of_body;      ///< kNone: it bends, or has no triangle
    bool operator==(const GridObjects&) const = default;
};

/// One per body: it stands where it was, and no animation takes it from there. O(bodies).
[[nodiscard]] std::vector<bool> resting_bodies(const PosedBodies& posed);

/// Without an object where nothing else than what rests moves as one piece: the whole has one grid
/// then, as it stands. rests: resting_bodies(). O(n).
[[nodiscard]] GridObjects grid_objects_of(const Model& base, const Bodies& bodies,
                                          const std::vector<bool>& rests);

}  // namespace surfelao
