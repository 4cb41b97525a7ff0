/// sparse_texels.h: answers at all texels of some rows of a map, few of which are asked.
///
/// Occlusion hardly changes over a few texels but at contacts, edges, creases and seams. Every
/// second texel of every second row is asked; then
///
///     a m b       m between a and b, or amid a, b, c and d, takes their mean where
///     m m m         - their answers lie within kSparseStep,
///     c m d         - m itself lies amid them in space, and its normal amid theirs,
///
/// and is asked where not. A mean of answers is nearer to the truth than one of them: an engine's
/// small errors differ from place to place. At 1,024^2 and good the RMSE displayed is .0040 in
/// place of .0041 (stanford_bunny), .0043 of .0044 (skull), .0092 and .0202 as before (engine,
/// FlightHelmet), for .37, .42, .71 and .74 of the receivers. Those that are left are the dear
/// ones: the time of solving falls to .5 to .9.
///
/// Every fourth first, then what lies between at half the distance, leaves a third to two thirds of
/// these receivers, farther from each other and so as dear together, and misses what is narrower
/// than four texels: FlightHelmet at 512^2 .0071 beyond the floor at best in place of .0046.
///
/// Based on:
///   Ward, Rubinstein, Clear. A Ray Tracing Solution for Diffuse Interreflection. 1988: few places
///   answer for what lies around them. On a raster they need not be searched for.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/receiver.h"
#include "surfels/texels.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace surfelao {

/// Differences of occlusion up to which a mean will do: it is off by half of that at most where no
/// more than a crest lies between. (.04: a tenth fewer receivers, and up to .02 off at the foot of
/// a wall.)
inline constexpr float kSparseStep = 0.02f;

/// How far the place amid others may be from their mean, as a share of their distance: beyond, it
/// lies in another chart, in the map's padding, on a rib, or the surface is bent by more than 23
/// degrees.
inline constexpr float kSparseReach = 0.1f;

/// Cosine of the angle between the normal amid others and their mean: 2.5 degrees.
inline constexpr float kSparseTurn = 0.999f;

/// One answer for each receiver.
using AskReceivers = std::function<std::vector<Occlusion>(std::span<const Receiver>)>;

/// One answer for each texel: all those of some rows of a map of this width, by row, then column,
/// with their receivers. Texels of several sheets, and those whose centre nothing covers, are all
/// asked. Calls `ask` up to twice. O(texels), and what the asked ones take; four bytes for
/// each texel of the rows.
[[nodiscard]] std::vector<Occlusion> sparse_answers(std::span<const Texel> texels,
                                                    std::span<const Receiver> receivers,
                                                    std::uint32_t width, const AskReceivers& ask);

}  // namespace surfelao
