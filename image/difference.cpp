#include "image/difference.h"

#include "image/color_map.h"
#include "surfels/errors.h"

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

float shown_difference(const glm::vec4& a, const glm::vec4& b)
{
    float largest = 0.0f;
    for (int c = 0; c < 3; ++c)
        largest = std::max(largest, std::abs(srgb_encode(a[c]) - srgb_encode(b[c])));
    return largest;
}

void check_alike(const Image& a, const Image& b)
{
    SURFELAO_CHECK(a.width == b.width && a.height == b.height && !a.pixels.empty());
}

}  // namespace

ImageDifference compare_images(const Image& a, const Image& b, float tolerance)
{
    check_alike(a, b);
    ImageDifference result;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const float difference = shown_difference(a.pixels[i], b.pixels[i]);
        result.mean += difference;
        result.share_beyond += difference > tolerance ? 1.0 : 0.0;
        result.largest = std::max(result.largest, difference);
    }
    result.mean /= static_cast<double>(a.pixels.size());
    result.share_beyond /= static_cast<double>(a.pixels.size());
    return result;
}

Image difference_image(const Image& a, const Image& b, float full_scale)
{
    check_alike(a, b);
    SURFELAO_CHECK(full_scale > 0.0f);
    Image result(a.width, a.height);
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        result.pixels[i] = glm::vec4(
            map_color(ColorMap::heat, shown_difference(a.pixels[i], b.pixels[i]) / full_scale),
            1.0f);
    return result;
}

}  // namespace surfelao
