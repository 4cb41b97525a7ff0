/// pixel_fill.h: a picture of which only some pixels were solved.
#pragma once

#include "pixels/seen.h"
#include "surfels/occlusion.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Every so many columns and rows a draft solves one.
inline constexpr int kDraftStep = 4;

/// Of the seen pixels (indices, rising): those of the grid of every kDraftStep-th column and row,
/// and those that have no neighbour there. O(pixels).
[[nodiscard]] std::vector<std::uint32_t> draft_pixels(const SeenPixels& seen);

/// So many of the seen pixels, one in each of as many runs of the same length, at places in them
/// that do not repeat; all where there are fewer. The same every time.
[[nodiscard]] std::vector<std::uint32_t> spread_pixels(const SeenPixels& seen, std::size_t count);

/// Values of all seen pixels of those of draft_pixels(): between the neighbours of the grid, as far
/// as they lie in the pixel's plane and look as it does; else of the one that is most alike.
/// eye: of the picture. O(pixels).
[[nodiscard]] std::vector<Occlusion> fill_draft(const SeenPixels& seen, glm::vec3 eye,
                                                std::span<const std::uint32_t> solved,
                                                std::span<const Occlusion> values);

}  // namespace surfelao
