/// color_map.h: numbers as colours: the maps that all pictures of the project use.
///
/// The heat map says how large a number is: differences of pictures, levels, the viewer's
/// difference to rays. Lightness rises evenly from a dark blue over purple, red and orange to a
/// pale yellow, so that the map can be read in grey, in print and by the colour-blind. It is a path
/// through OKLab, in which equal steps look equal.
///
/// The error map says which way an answer is wrong: white = right, red = too dark, blue = too
/// bright, grey = nobody knows. For meshes with few errors on white, as in reports.
///
/// Based on:
///   Ottosson. A perceptual color space for image processing. 2020
#pragma once

#include "image/image.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace surfelao {

/// Linear RGB for x in [0, 1]; values outside are cut, NaN is not allowed.
[[nodiscard]] glm::vec3 heat_color(float x);

/// heat_color at 256 even steps from 0 to 1, for shaders and tables.
[[nodiscard]] const std::array<glm::vec3, 256>& heat_colors();

/// Linear RGB for things that are only to be told apart, by number: neighbours in the sequence have
/// hues far apart, and none is darker than the others by much.
[[nodiscard]] glm::vec3 label_color(std::uint32_t index);

/// As a screen shows it: 0 to 255 (sRGB).
using Rgb = std::array<std::uint8_t, 3>;

/// Of an error = answer - truth, of occlusion. Full colour at `full` and beyond; NaN is grey. full
/// > 0.
[[nodiscard]] Rgb error_color(float error, float full);

/// The `full` of all reports.
inline constexpr float kFullColorError = 0.1f;

/// Draws a legend of the heat map into the lower left corner: a bar from `low` to `high` with
/// numbers under it and `title` above (characters of lettering.h), on a dark plate. Its size
/// follows the image's height; in an image too small for it nothing is drawn. low < high.
void draw_heat_legend(Image& image, std::string_view title, float low, float high);

}  // namespace surfelao
