/// legend.h: what the colours of a picture mean, drawn into it.
#pragma once

#include "image/color_map.h"
#include "image/image.h"

#include <string>

namespace surfelao {

struct Legend {
    std::string title;  ///< characters of lettering.h
    float low = 0.0f, high = 1.0f;
    ColorMap colors = ColorMap::heat;
    std::string note = {};  ///< a line below the numbers, "RMSE 0.0041  BIAS +0.0003"; may be empty
};

/// A number of a legend: "0.05"
[[nodiscard]] std::string legend_number(float value);

/// Draws a legend into the lower left corner: a bar from `low` to `high` with numbers under it, the
/// title above and the note below, on a dark plate. Its size follows the image's height; in an
/// image too small for it nothing is drawn. low < high.
void draw_legend(Image& image, const Legend& legend);

}  // namespace surfelao
