#include "image/color_map.h"

#include "image/lettering.h"
#include "surfels/errors.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

namespace surfelao {
namespace {

// The path, chosen by taste: lightness, and the hue's turn from blue through red to yellow.
constexpr float kDarkest = 0.20f, kLightest = 0.97f;
constexpr float kFirstHueDeg = 275.0f, kHueTurnDeg = 190.0f;
constexpr float kMostChroma = 0.22f;

/// Ottosson's inverse transform: lightness and the two opponent axes to linear Rec. 709.
glm::vec3 oklab_to_linear(float lightness, float a, float b)
{
    const float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
    const float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
    const float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
    const float l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
    return {4.0767416621f * l3 - 3.3077115913f * m3 + 0.2309699292f * s3,
            -1.2684380046f * l3 + 2.6097574011f * m3 - 0.3413193965f * s3,
            -0.0041960863f * l3 - 0.7034186147f * m3 + 1.7076147010f * s3};
}

/// The colour of that lightness and hue with the most chroma up to kMostChroma that a screen has.
glm::vec3 most_vivid(float lightness, float hue_deg, float most_chroma)
{
    const float hue = hue_deg * std::numbers::pi_v<float> / 180.0f;
    const auto color = [&](float chroma) {
        return oklab_to_linear(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
    };
    const auto is_shown = [](glm::vec3 c) {
        return std::min({c.r, c.g, c.b}) >= 0.0f && std::max({c.r, c.g, c.b}) <= 1.0f;
    };
    if (is_shown(color(most_chroma)))
        return color(most_chroma);
    float low = 0.0f;
    float high = most_chroma;
    for (int step = 0; step < 24; ++step) {
        const float middle = 0.5f * (low + high);
        (is_shown(color(middle)) ? low : high) = middle;
    }
    return color(low);
}

std::array<glm::vec3, 256> make_heat_colors()
{
    std::array<glm::vec3, 256> colors;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const float x = static_cast<float>(i) / 255.0f;
        colors[i] = most_vivid(glm::mix(kDarkest, kLightest, x), kFirstHueDeg + kHueTurnDeg * x,
                               kMostChroma * (1.0f - 0.45f * x * x));
    }
    return colors;
}

void fill(Image& image, glm::ivec2 low, glm::ivec2 high, glm::vec4 color)
{
    for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x)
            image.at(x, y) = color;
}

std::string number(float value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", static_cast<double>(value));
    return text;
}

}  // namespace

const std::array<glm::vec3, 256>& heat_colors()
{
    static const std::array<glm::vec3, 256> colors = make_heat_colors();
    return colors;
}

glm::vec3 heat_color(float x)
{
    const float position = std::clamp(x, 0.0f, 1.0f) * 255.0f;
    const std::size_t left = std::min(static_cast<std::size_t>(position), std::size_t{254});
    return glm::mix(heat_colors()[left], heat_colors()[left + 1],
                    position - static_cast<float>(left));
}

glm::vec3 label_color(std::uint32_t index)
{
    // the golden angle: any few hues of the sequence are spread evenly
    const double turns = std::fmod(0.6180339887498949 * index, 1.0);
    constexpr float kLightness[] = {0.72f, 0.82f, 0.62f};
    return most_vivid(kLightness[index % 3], static_cast<float>(360.0 * turns), 0.15f);
}

Rgb error_color(float error, float full)
{
    if (std::isnan(error))
        return {128, 128, 128};
    const float strength = std::min(1.0f, std::fabs(error) / full);
    const auto faded = static_cast<std::uint8_t>(std::lround(255.0f * (1.0f - strength)));
    if (error > 0.0f)
        return {255, faded, faded};
    return {faded, faded, 255};
}

void draw_heat_legend(Image& image, std::string_view title, float low, float high)
{
    SURFELAO_CHECK(low < high);
    // all lengths in font pixels, scaled up for tall pictures
    const int scale = std::max(1, image.height / 400);
    const int margin = 6 * scale;
    const int bar_width = std::max(text_width(title), 120) * scale;
    const int bar_height = 10 * scale;
    const int line = (kGlyphHeight + 2) * scale;
    const glm::ivec2 size(bar_width + 2 * margin, bar_height + 2 * line + 2 * margin - 2 * scale);
    const glm::ivec2 plate(margin, image.height - margin - size.y);
    if (plate.y < 0 || plate.x + size.x > image.width)
        return;

    const glm::vec4 ink(0.8f, 0.8f, 0.8f, 1.0f);
    fill(image, plate, plate + size, glm::vec4(0.008f, 0.008f, 0.010f, 1.0f));
    glm::ivec2 pen = plate + glm::ivec2(margin);
    draw_text(image, pen, title, ink, scale);
    pen.y += line;
    for (int x = 0; x < bar_width; ++x) {
        const float share = (static_cast<float>(x) + 0.5f) / static_cast<float>(bar_width);
        fill(image, pen + glm::ivec2(x, 0), pen + glm::ivec2(x + 1, bar_height),
             glm::vec4(heat_color(share), 1.0f));
    }
    pen.y += bar_height + 2 * scale;
    for (float share : {0.0f, 0.5f, 1.0f}) {
        const std::string text = number(glm::mix(low, high, share));
        const int room = bar_width - (text_width(text) - 1) * scale;
        draw_text(image, pen + glm::ivec2(static_cast<int>(share * static_cast<float>(room)), 0),
                  text, ink, scale);
    }
}

}  // namespace surfelao
