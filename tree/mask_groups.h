/// mask_groups.h: receivers as a binary tree of groups that share what is far from them.
///
/// Internal to the mask engine; masks.h is its door.
#pragma once

#include "surfels/receiver.h"
#include "tree/mask_kernel.h"

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

constexpr std::uint32_t kMaskGroupSize = 16;  ///< receivers in a leaf group at most

struct MaskGroups {
    std::vector<MaskGroup> groups;     ///< groups[0] is the root; empty without receivers
    std::vector<std::uint32_t> order;  ///< groups own ranges of this; values index the receivers
};

/// Receivers without a normal are left out. O(n log n), all cores, same result for any number of
/// threads.
[[nodiscard]] MaskGroups group_for_masks(std::span<const Receiver> receivers);

}  // namespace surfelao
