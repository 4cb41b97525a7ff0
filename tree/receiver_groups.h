/// receiver_groups.h: receivers as a binary tree of groups that share what is far from them.
///
/// All point-based engines use it. The disks make one list of disks for each leaf, opened for the
/// nearest of its receivers, which all of them then sum in SIMD lanes. That is faster than a walk
/// for each and, since more is taken directly, more exact (Barnes. A Modified Tree Code: Don't
/// Laugh; It Runs. 1990). The masks hand what is not yet far enough down the tree.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/raw_vector.h"
#include "surfels/receiver.h"
#include "tree/receiver_group.h"

#include <glm/mat3x3.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace surfelao {

inline constexpr std::uint32_t kGroupSize = 16;  ///< receivers in a leaf at most

/// Groups own ranges of `order` and of the columns. Leaf k holds the receivers from 16 k on, so all
/// leaves but the last are full.
struct ReceiverGroups {
    std::vector<ReceiverGroup> groups;  ///< groups[0] is the root; empty without receivers
    std::vector<std::uint32_t> leaves;  ///< into groups
    RawVector<std::uint32_t> order;     ///< into the receivers
    /// Position and normal in the frame: x, y, z each. Readable for kGroupSize values beyond the
    /// end, zeros.
    std::array<RawVector<float>, 3> position, normal;
};

/// Split in two at the median of the longest extent, again and again. frame: a rotation from the
/// unit frame to that of the groups. Receivers without a normal are left out. O(n log n), all
/// cores, same bytes for any number of threads.
[[nodiscard]] ReceiverGroups group_receivers(std::span<const Receiver> receivers,
                                             const glm::mat3& frame = glm::mat3(1.0f));

/// The same, forgetting all receivers on the way. `answers`, empty before, grows to one for each as
/// they go, whose bent normals are their normals from then on.
[[nodiscard]] ReceiverGroups group_receivers(std::span<const Receiver> receivers,
                                             const glm::mat3& frame,
                                             std::vector<Occlusion>& answers,
                                             const ForgetReceivers& forget);

/// With v from `center` to a point, along = dot(v, axis) and across = |v - along * axis|, no
/// receiver has the point higher above its tangent plane than along * cone_cos + across * cone_sin
/// + this, where that is negative. Infinite where the cone is a half-space or more.
[[nodiscard]] inline float rise_of_cone(const ReceiverGroup& group)
{
    return group.cone_cos > 0.0f ? group.rise : std::numeric_limits<float>::infinity();
}

}  // namespace surfelao
