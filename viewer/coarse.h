/// coarse.h: how a model is drawn while it moves, where the whole of it takes too long.
#pragma once

#include "surfels/geometry.h"
#include "surfels/surface.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// Fewer triangles that look alike: wedges (surfels/surface.h) that lie in one cell of a grid and
/// face one side of a cube become one of them, the one nearest their mean. Triangles that keep
/// three corners stay, each once. The cells are as large as `most` triangles of the surface's area
/// ask for, or larger where that leaves more. A surface of no more than that is returned as it is.
/// O(n log n). Equal input gives equal triangles.
///
/// Based on:
///   Rossignac, Borrel. Multi-resolution 3D approximations for rendering complex scenes. 1993
[[nodiscard]] std::vector<glm::uvec3> coarse_triangles(const Geometry& geometry,
                                                       const Surface& surface, std::size_t most);

/// What a moving model of any size has at most.
inline constexpr std::size_t kCoarseTriangles = 40'000;

/// How much of a picture is drawn.
struct Detail {
    int pixel = 1;         ///< so many of the window's pixels are one, each way
    bool is_whole = true;  ///< else ViewOptions::coarse
};
/// From fine to coarse.
inline constexpr std::array<Detail, 4> kDetails = {{{1, true}, {1, false}, {2, false}, {4, false}}};

/// A picture may take so long while something moves: with what else a frame takes, 15 a second.
inline constexpr double kMovingMs = 40.0;
/// What has not moved for so long rests.
inline constexpr double kRestSeconds = 0.15;

/// Milliseconds that each of kDetails took last; empty where it has not been drawn since the last
/// rest.
using DetailTimes = std::array<std::optional<double>, kDetails.size()>;

/// Which of kDetails to draw next while something moves: the finest one that is not known to take
/// more than kMovingMs; else the coarsest.
[[nodiscard]] std::size_t moving_detail(const DetailTimes& times);

}  // namespace surfelao
