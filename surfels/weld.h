/// weld.h: which vertices stand at one place.
#pragma once

#include "surfels/scene.h"

#include <cstdint>
#include <vector>

namespace surfelao {

/// For each vertex the lowest index of a vertex at its place: at exactly its position, or, where
/// the surface is torn open there, within float noise of it.
///
/// Exporters that write every corner of every facet (STL), or move a mesh's parts about in floats,
/// leave corners that are equal but for their last digits. Where a vertex's triangles close around
/// it nothing is missing, and nothing but its exact position is looked at. Where they do not,
/// torn vertices within kWeldDistance are taken for the same place, but never two that are
/// farther apart than kWeldShare of the shortest edge at either: so no edge vanishes, and small
/// things in big worlds keep their shape.
///
/// diagonal: of the scene's box, > 0. O(n) expected; equal input gives equal bytes.
[[nodiscard]] std::vector<std::uint32_t> weld(const Scene& scene, double diagonal);

/// Per place (an entry of `welded` that names itself) 0 where the triangles around it close. There
/// each neighbour is once the next corner and once the one before: the difference of the sums of
/// their hashes, which is returned, is zero, in whatever order they come. Where it is not, the
/// surface is torn or its winding turns. O(n)
[[nodiscard]] std::vector<std::uint32_t> tears_of(const std::vector<glm::uvec3>& triangles,
                                                  const std::vector<std::uint32_t>& welded);

/// In diagonals: 32 roundings of a float at the rim of the box (2^-24 each). What exporters leave
/// is some 3e-7 along each axis, both ways.
inline constexpr double kWeldDistance = 2e-6;
inline constexpr double kWeldShare = 0.25;

}  // namespace surfelao
