/// morton.h: points along a Morton (Z-order) curve, so that neighbours in the list are near in
/// space.
///
/// Based on:
///   Morton. A Computer Oriented Geodetic Data Base and a New Technique in File Sequencing. 1966
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// A point's place on the curve and in the input.
struct MortonKey {
    std::uint64_t code;   ///< 21 levels of 3 bits, the top level in bits 62..60, x lowest in each
    std::uint32_t index;  ///< into the points
};

/// One key per point, sorted by code, equal codes by index. The curve fills the smallest cube with
/// the box's lower corner that holds all points, with lengths beyond 1 drawn in; equal points have
/// equal codes. Points must be finite. O(n log n), all cores, same bytes for any number of threads.
[[nodiscard]] std::vector<MortonKey> morton_order(std::span<const glm::vec3> points);

}  // namespace surfelao
