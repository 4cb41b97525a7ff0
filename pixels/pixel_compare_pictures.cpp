#include "pixels/pixel_compare.h"

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

constexpr Rgb kNothingSeen = {216, 224, 236};
constexpr std::uint32_t kPictureMargin = 8;  // pixels around what is seen

/// The part of a picture that is shown, in pixels, row 0 at the bottom.
struct ShownPart {
    std::uint32_t left = 0, low = 0, width = 0, height = 0;
};

ShownPart shown_of(const SeenPixels& seen)
{
    const auto columns = static_cast<std::uint32_t>(seen.width);
    std::uint32_t left = columns, right = 0;
    for (const std::uint32_t pixel : seen.pixels) {
        left = std::min(left, pixel % columns);
        right = std::max(right, pixel % columns);
    }
    const std::uint32_t low = seen.pixels.front() / columns, high = seen.pixels.back() / columns;
    left -= std::min(left, kPictureMargin);
    right = std::min(right + kPictureMargin, columns - 1);
    const std::uint32_t bottom = low - std::min(low, kPictureMargin);
    const std::uint32_t top =
        std::min(high + kPictureMargin, static_cast<std::uint32_t>(seen.height) - 1);
    return {left, bottom, right - left + 1, top - bottom + 1};
}

/// color(i): of seen.pixels[i].
template <class Color>
Picture picture_of(const SeenPixels& seen, const Color& color)
{
    const ShownPart shown = shown_of(seen);
    std::vector<Rgb> pixels(std::size_t{shown.width} * shown.height, kNothingSeen);
    const auto columns = static_cast<std::uint32_t>(seen.width);
    for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
        const std::uint32_t x = seen.pixels[i] % columns - shown.left;
        const std::uint32_t y = shown.height - 1 - (seen.pixels[i] / columns - shown.low);
        pixels[std::size_t{y} * shown.width + x] = color(i);
    }

    const std::uint32_t cell = (shown.width + kWidestPicture - 1) / kWidestPicture;
    const std::uint32_t width = (shown.width + cell - 1) / cell;
    const std::uint32_t height = (shown.height + cell - 1) / cell;
    Picture picture{static_cast<int>(width), static_cast<int>(height), {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            std::uint32_t sums[3] = {0, 0, 0}, count = 0;
            for (std::uint32_t v = y * cell; v < std::min((y + 1) * cell, shown.height); ++v) {
                for (std::uint32_t u = x * cell; u < std::min((x + 1) * cell, shown.width); ++u) {
                    const Rgb& one = pixels[std::size_t{v} * shown.width + u];
                    for (std::size_t i = 0; i < 3; ++i)
                        sums[i] += one[i];
                    ++count;
                }
            }
            Rgb& mean = picture.pixels.emplace_back();
            for (std::size_t i = 0; i < 3; ++i)
                mean[i] = static_cast<std::uint8_t>((sums[i] + count / 2) / count);
        }
    }
    return picture;
}

}  // namespace

Picture occlusion_picture(const SeenPixels& seen, std::span<const Occlusion> values)
{
    return picture_of(seen, [&](std::size_t i) -> Rgb {
        const float visibility = std::clamp(1.0f - values[i].occlusion, 0.0f, 1.0f);
        const auto grey = static_cast<std::uint8_t>(std::lround(255.0f * visibility));
        return {grey, grey, grey};
    });
}

Picture difference_picture(const SeenPixels& seen, std::span<const Occlusion> answers,
                           std::span<const Occlusion> reference)
{
    return picture_of(seen, [&](std::size_t i) {
        return error_color(answers[i].occlusion - reference[i].occlusion, kFullPixelError);
    });
}

}  // namespace surfelao
