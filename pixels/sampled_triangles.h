/// sampled_triangles.h: which triangles are seen at several places of some pixels.
///
/// A device draws every triangle once for each place, and all pixels; where only the pixels at
/// edges are asked, a loop over their places is faster by far on the CPU. So are the middles of
/// all pixels, sixteen at once, than software OpenGL, which has a shader to compile. Edge functions
/// in homogeneous coordinates: e_i(q) = (h_j x h_k) . (q, 1) is >= 0 for all three sides of a
/// triangle where the ray through q meets it, whatever lies behind the eye. They and the depth are
/// linear in the picture; a side that two triangles share has the same values in both, with
/// opposite signs, so that nothing is seen between them.
///
/// Based on:
///   Olano, Greer. Triangle Scan Conversion using 2D Homogeneous Coordinates. 1997
#pragma once

#include "pixels/projected.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Places that are looked at in one pass.
inline constexpr std::size_t kSamplesAtOnce = 16;

/// pixels: rising, of the picture: column + width * row. shifts: kSamplesAtOnce at most, of a pixel
/// from its middle, -0.5 to 0.5. Per shift, per pixel: 1 + the nearest triangle that is seen there,
/// 0 where there is none. O(triangles), and the pixels that their boxes in the picture hold. The
/// same for any number of threads.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> sampled_triangles(
    const Projected& projected, std::span<const std::uint32_t> pixels,
    std::span<const glm::vec2> shifts);

/// The same at the middle of every pixel: column + width * row.
[[nodiscard]] std::vector<std::uint32_t> middle_triangles(const Projected& projected);

}  // namespace surfelao
