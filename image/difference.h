/// difference.h: how far two pictures of one size are apart, as they are seen.
#pragma once

#include "image/image.h"

namespace surfelao {

/// Measured on shown (sRGB) values from 0 to 1; the difference of two pixels is the largest of its
/// red, green and blue difference. Alpha is left out.
struct ImageDifference {
    double mean = 0.0;          ///< over all pixels
    double share_beyond = 0.0;  ///< share of the pixels that differ by more than the tolerance
    float largest = 0.0f;
};

/// What two software renderers may differ by: 4 of 255 steps.
inline constexpr float kShownTolerance = 4.0f / 255.0f;

/// The images must have the same size and at least one pixel. O(pixels).
[[nodiscard]] ImageDifference compare_images(const Image& a, const Image& b,
                                             float tolerance = kShownTolerance);

/// The difference of each pixel as a heat colour (color_map.h), `full_scale` and more being the
/// hottest. Same demands; full_scale > 0.
[[nodiscard]] Image difference_image(const Image& a, const Image& b, float full_scale);

}  // namespace surfelao
