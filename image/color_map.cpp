#include "image/color_map.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace surfelao {
namespace {

// The heat map's path, by taste: lightness, and the hue's turn from blue through red to yellow.
constexpr float kDarkest = 0.20f, kLightest = 0.97f;
constexpr float kFirstHueDeg = 275.0f, kHueTurnDeg = 190.0f;
constexpr float kMostChroma = 0.22f;

// The diverging map's ends, of equal lightness.
constexpr float kEndLightness = 0.5f;
constexpr float kBlueDeg = 262.0f, kRedDeg = 27.0f;
constexpr float kEndChroma = 0.20f;

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

glm::vec3 heat(float x)
{
    return most_vivid(glm::mix(kDarkest, kLightest, x), kFirstHueDeg + kHueTurnDeg * x,
                      kMostChroma * (1.0f - 0.45f * x * x));
}

glm::vec3 diverging(float x)
{
    const float strength = std::fabs(2.0f * x - 1.0f);
    return most_vivid(glm::mix(1.0f, kEndLightness, strength), x < 0.5f ? kBlueDeg : kRedDeg,
                      kEndChroma * strength);
}

// Every eighth colour of matplotlib's tables, 0xRRGGBB as shown; straight lines between them are
// within 2 of 255 steps.
using Knots = std::array<std::uint32_t, 33>;
constexpr Knots kViridis = {0x440154, 0x470D60, 0x48186A, 0x482374, 0x472D7B, 0x453681, 0x424086,
                            0x3F4989, 0x3B528B, 0x375A8D, 0x33638D, 0x2F6A8E, 0x2C728E, 0x297A8E,
                            0x26818E, 0x23898E, 0x21908C, 0x1F988B, 0x1F9F88, 0x21A685, 0x28AE80,
                            0x31B57B, 0x3EBC74, 0x4CC26C, 0x5DC963, 0x6ECE58, 0x82D34C, 0x96D83F,
                            0xABDC32, 0xC0DF24, 0xD5E21A, 0xEAE51A, 0xFDE725};
constexpr Knots kInferno = {0x000004, 0x040312, 0x0B0724, 0x150B37, 0x210C4A, 0x2E0A5A, 0x3C0965,
                            0x4A0C6B, 0x57106D, 0x63146E, 0x70196E, 0x7D1E6D, 0x89226A, 0x962766,
                            0xA32B61, 0xAF315C, 0xBB3755, 0xC63E4D, 0xD14644, 0xDB4F3B, 0xE35932,
                            0xEB6528, 0xF1711E, 0xF67F14, 0xF98D0A, 0xFB9C06, 0xFCAB0F, 0xFBBA1F,
                            0xF9CA32, 0xF5D949, 0xF2E865, 0xF3F586, 0xFCFFA4};
constexpr Knots kTurbo = {0x30123B, 0x392A73, 0x4040A1, 0x4456C7, 0x466BE3, 0x467FF6, 0x4293FF,
                          0x37A7FA, 0x29BBEC, 0x1DCDD8, 0x18DCC3, 0x1EE8B0, 0x31F299, 0x4CF97E,
                          0x6BFD64, 0x8AFF4D, 0xA3FD3C, 0xB8F735, 0xCCED34, 0xDEE037, 0xEDD03A,
                          0xF8C03A, 0xFDAE35, 0xFE982C, 0xFB8022, 0xF56817, 0xEC520F, 0xE04009,
                          0xD23105, 0xC02302, 0xAC1701, 0x950D01, 0x7A0403};

glm::vec3 between(const Knots& knots, float x)
{
    const auto shown = [&](std::size_t knot, int shift) {
        return static_cast<float>(knots[knot] >> shift & 0xFF) / 255.0f;
    };
    const float position = x * static_cast<float>(knots.size() - 1);
    const std::size_t left = std::min(static_cast<std::size_t>(position), knots.size() - 2);
    glm::vec3 linear;
    for (int c = 0; c < 3; ++c)
        linear[c] = srgb_decode(glm::mix(shown(left, 16 - 8 * c), shown(left + 1, 16 - 8 * c),
                                         position - static_cast<float>(left)));
    return linear;
}

glm::vec3 color_at(ColorMap map, float x)
{
    switch (map) {
        case ColorMap::heat:
            return heat(x);
        case ColorMap::viridis:
            return between(kViridis, x);
        case ColorMap::inferno:
            return between(kInferno, x);
        case ColorMap::turbo:
            return between(kTurbo, x);
        case ColorMap::grey:
            return oklab_to_linear(x, 0.0f, 0.0f);
        case ColorMap::diverging:
            return diverging(x);
    }
    return {};
}

MapColors table_of(ColorMap map)
{
    MapColors colors;
    for (std::size_t i = 0; i < kMapSteps; ++i)
        colors[i] = color_at(map, static_cast<float>(i) / static_cast<float>(kMapSteps - 1));
    return colors;
}

}  // namespace

const MapColors& colors_of(ColorMap map)
{
    static const std::array<MapColors, 6> tables = {
        table_of(ColorMap::heat),  table_of(ColorMap::viridis), table_of(ColorMap::inferno),
        table_of(ColorMap::turbo), table_of(ColorMap::grey),    table_of(ColorMap::diverging)};
    return tables[static_cast<std::size_t>(map)];
}

glm::vec3 map_color(ColorMap map, float x)
{
    const float position = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(kMapSteps - 1);
    const std::size_t left = std::min(static_cast<std::size_t>(position), kMapSteps - 2);
    return glm::mix(colors_of(map)[left], colors_of(map)[left + 1],
                    position - static_cast<float>(left));
}

float difference_place(ColorMap map, float difference, float full)
{
    return map == ColorMap::diverging ? 0.5f + 0.5f * difference / full
                                      : std::fabs(difference) / full;
}

glm::vec3 label_color(std::uint32_t index)
{
    // the golden angle: any few hues of the sequence are spread evenly
    const double turns = std::fmod(0.6180339887498949 * index, 1.0);
    constexpr float kLightness[] = {0.72f, 0.82f, 0.62f};
    return most_vivid(kLightness[index % 3], static_cast<float>(360.0 * turns), 0.15f);
}

Rgb shown_rgb(glm::vec3 linear)
{
    Rgb shown;
    for (int c = 0; c < 3; ++c)
        shown[static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::lround(255.0f * srgb_encode(linear[c])));
    return shown;
}

Rgb error_color(float error, float full)
{
    if (std::isnan(error))
        return {128, 128, 128};
    return shown_rgb(
        map_color(ColorMap::diverging, difference_place(ColorMap::diverging, error, full)));
}

float rounded_scale(float largest)
{
    constexpr double kLeast = 1e-4;
    constexpr double kRounding = 1.0 + 1e-6;  // 0.1f is a little more than 0.1
    const double wanted = std::max(kLeast, static_cast<double>(largest) / kRounding);
    const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
    for (const double step : {1.0, 2.0, 5.0}) {
        if (wanted <= step * decade)
            return static_cast<float>(step * decade);
    }
    return static_cast<float>(10.0 * decade);
}

}  // namespace surfelao
