/// screen_samples.h: where the screen-space methods look, made on the CPU: the same on every
/// device.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <vector>

namespace surfelao {

/// Offsets in the unit ball (w = 0), evenly: the cubes of their lengths are (k + 1/2) / n, by the
/// cube root; the square root would put a quarter of them, not an eighth, into the inner half.
/// paired: 2 k + 1 lies opposite of 2 k, and n counts pairs. count: even where paired.
[[nodiscard]] std::vector<glm::vec4> ball_samples(int count, bool paired);

/// The same in the unit disk (z = w = 0), by the square root.
[[nodiscard]] std::vector<glm::vec4> disk_samples(int count, bool paired);

/// Lines through the unit ball at places x, y of the disk: x, y, half length sqrt(1 - x^2 - y^2),
/// volume. The volume is that of the ball over the sample's Voronoi cell in the disk, by the areas
/// of a grid's squares; volumes sum to 1. O(count) per square.
[[nodiscard]] std::vector<glm::vec4> line_samples(int count, bool paired);

/// Offsets in the unit disk, from the rim inwards.
[[nodiscard]] std::vector<glm::vec2> probe_offsets(int count);

/// Random pairs in [0, 1), row by row. The first, which all pixels share where there is no noise,
/// is chosen: no direction of 4 or 6 is along the pixels' rows, columns or 30 degrees off them,
/// where samples lie on the border of two pixels and devices differ.
inline constexpr int kNoiseSide = 64;  // texels, as the origin's table of turns
[[nodiscard]] std::vector<glm::vec2> noise_pairs();

}  // namespace surfelao
