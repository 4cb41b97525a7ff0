/// receiver_group.h: sixteen neighbouring receivers that walk the octree together.
///
/// One walk per group makes one list of disks, opened for the nearest of the sixteen, which all of
/// them then sum in SIMD lanes. That is faster than sixteen walks and, since more is taken
/// directly, more exact (Barnes. A Modified Tree Code: Don't Laugh; It Runs. 1990).
#pragma once

#include "surfels/receiver.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

inline constexpr std::uint32_t kGroupSize = 16;

/// Neighbours along a Morton curve. Lanes from `count` on repeat lane 0.
struct alignas(64) ReceiverGroup {
    using Lanes = std::array<float, kGroupSize>;
    std::array<Lanes, 3> position;  ///< x, y, z
    std::array<Lanes, 3> normal;
    std::array<std::uint32_t, kGroupSize> receiver;  ///< index into the receivers
    std::uint32_t count = 0;                         ///< 1 to 16 lanes stand for a receiver
    glm::vec3 center{0.0f};                          ///< the ball that holds all positions
    float radius = 0.0f;
    glm::vec3 axis{0.0f};   ///< of the cone that holds all normals
    float cone_cos = 0.0f;  ///< of the cone's half angle
    float cone_sin = 0.0f;
    /// >= 0: `center` is nowhere higher than that above a receiver's tangent plane. With v from
    /// `center` to a point, along = dot(v, axis) and across = |v - along * axis|, no receiver has
    /// the point higher above its tangent plane than along * cone_cos + across * cone_sin + sag.
    /// Infinite where the normals spread over a right angle or more to the axis.
    float sag = 0.0f;
};

/// Every receiver that has a normal, in exactly one lane. O(n log n), all cores, same bytes for any
/// number of threads.
[[nodiscard]] std::vector<ReceiverGroup> group_receivers(std::span<const Receiver> receivers);

}  // namespace surfelao
