/// heat_map.h: numbers as colours that the eye orders the same way, and the legend that belongs to
/// them.
///
/// Lightness rises evenly from a dark blue over purple, red and orange to a pale yellow, so that
/// the map can be read in grey, in print and by the colour-blind. It is a path through OKLab, in
/// which equal steps look equal.
///
/// Based on:
///   Ottosson. A perceptual color space for image processing. 2020
#pragma once

#include "image/image.h"

#include <array>
#include <string_view>

namespace surfelao {

/// Linear RGB for x in [0, 1]; values outside are cut, NaN is not allowed.
[[nodiscard]] glm::vec3 heat_color(float x);

/// heat_color at 256 even steps from 0 to 1, for shaders and tables.
[[nodiscard]] const std::array<glm::vec3, 256>& heat_colors();

/// Draws a legend into the lower left corner: a bar from `low` to `high` with numbers under it and
/// `title` above (characters of text.h), on a dark plate. Its size follows the image's height; in
/// an image too small for it nothing is drawn. low < high.
void draw_heat_legend(Image& image, std::string_view title, float low, float high);

}  // namespace surfelao
