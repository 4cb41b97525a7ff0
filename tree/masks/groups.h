/// groups.h: receivers as a binary tree of groups that share what is far from them.
///
/// Internal to the mask engine; masks.h is its door.
#pragma once

#include "surfels/receiver.h"
#include "tree/masks/kernel.h"
#include "tree/raw_vector.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Groups own ranges of `order` and of the columns.
struct MaskGroups {
    std::vector<MaskGroup> groups;   ///< groups[0] is the root; empty without receivers
    RawVector<std::uint32_t> order;  ///< into the receivers
    /// Position and normal in the mask frame: x, y, z each. Readable for kMaskGroupSize
    /// values beyond the end, zeros.
    std::array<RawVector<float>, 3> position, normal;
};

/// In the mask frame. Receivers without a normal are left out. O(n log n), all cores, same result
/// for any number of threads.
[[nodiscard]] MaskGroups group_for_masks(std::span<const Receiver> receivers);

}  // namespace surfelao
