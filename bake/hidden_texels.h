/// hidden_texels.h: texels that nobody sees, because what they show lies inside of a body.
///
/// Under a box that stands on a floor occlusion is 1, beside it 1/2: what filters fetch at its foot
/// is a dark fringe. Such texels are taken for ones that nothing covers, and hold what surrounds
/// them.
///
///      |  box  |            a texel inside: its rays first meet the box's inner side
///      |       |
///     _|_______|_ floor     o: fringe, where the texel's centre is inside and its rest is not
///          ^    o
#pragma once

#include "image/map.h"
#include "reference/rays.h"
#include "surfels/geometry.h"
#include "surfels/receiver.h"

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Texels of less visibility may be hidden: inside of a box the masks of `draft` leave as much
/// open. Where no neighbour has more by as much, nothing is there that would show as a fringe.
inline constexpr float kHiddenVisibility = 0.1f;

/// How many texels from there on are looked at. What is shown of a texel at the foot fetches two
/// more in the next mip level, three in all; they are filled from both sides, of which the inner
/// one is dark: twice as many.
inline constexpr std::uint32_t kHiddenRings = 6;

/// Nonzero where a texel may be hidden: closed ones with such a neighbour, and others within
/// kHiddenRings of it. Empty where there is none. known: nonzero where a texel has a value.
/// O(texels).
[[nodiscard]] std::vector<std::uint8_t> texels_maybe_hidden(const Map& visibility,
                                                            std::span<const std::uint8_t> known);

/// Nonzero where a receiver stands inside of a body: more than half of 16 rays over its hemisphere
/// (of four where these agree), within the distance at which surfaces occlude, first meet the inner
/// side of one that is closed and faces outward (OccluderSide::back of surfels/topology.h). Of all
/// others nothing is guessed.
/// scene: of the geometry. All cores; O(n) for the topology where many inner sides are met.
[[nodiscard]] std::vector<std::uint8_t> inside_bodies(const Geometry& geometry,
                                                      const RayScene& scene,
                                                      std::span<const Receiver> receivers,
                                                      float max_distance);

}  // namespace surfelao
