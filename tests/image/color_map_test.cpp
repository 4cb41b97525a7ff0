#include "image/color_map.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace surfelao {
namespace {

/// CIE lightness (0 to 100) of a linear Rec. 709 colour: not the space the map was made in.
float cie_lightness(glm::vec3 color)
{
    const float y = glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f));
    return y > 0.008856f ? 116.0f * std::cbrt(y) - 16.0f : 903.3f * y;
}

TEST(ColorMap, EveryStepIsLighterThanTheLastAndNoneJumps)
{
    for (const auto& [name, map] : kColorMaps) {
        if (map == ColorMap::turbo)
            continue;  // has no such order
        for (std::size_t i = 1; i < kMapSteps; ++i) {
            const float step =
                cie_lightness(colors_of(map)[i]) - cie_lightness(colors_of(map)[i - 1]);
            EXPECT_GT(step, 0.0f) << name << ' ' << i;
            EXPECT_LT(step, 1.2f) << name << ' ' << i;  // 100 / 256 would be a perfectly even one
        }
    }
}

TEST(ColorMap, AllColoursCanBeShown)
{
    for (int map = 0; map <= static_cast<int>(ColorMap::diverging); ++map) {
        for (const glm::vec3& color : colors_of(static_cast<ColorMap>(map))) {
            EXPECT_GE(std::min({color.r, color.g, color.b}), -1e-4f) << map;
            EXPECT_LE(std::max({color.r, color.g, color.b}), 1.0f + 1e-4f) << map;
        }
    }
}

TEST(ColorMap, ValuesOutsideAreCut)
{
    EXPECT_EQ(map_color(ColorMap::heat, -3.0f), map_color(ColorMap::heat, 0.0f));
    EXPECT_EQ(map_color(ColorMap::heat, 9.0f), map_color(ColorMap::heat, 1.0f));
}

// matplotlib's own tables, 0xRRGGBB: colours 4, 12, 20 ... of 256, midway between our knots, and
// the last.
constexpr std::array<std::uint32_t, 33> kPublishedViridis = {
    0x46075A, 0x471365, 0x481D6F, 0x482878, 0x46327E, 0x443B84, 0x404588, 0x3D4E8A, 0x39568C,
    0x355F8D, 0x31678E, 0x2E6F8E, 0x2A768E, 0x277E8E, 0x25858E, 0x228D8D, 0x1F948C, 0x1E9C89,
    0x20A386, 0x25AB82, 0x2DB27D, 0x38B977, 0x46C06F, 0x56C667, 0x67CC5C, 0x7AD151, 0x8ED645,
    0xA2DA37, 0xB8DE29, 0xCDE11D, 0xE2E418, 0xF6E620, 0xFDE725};
constexpr std::array<std::uint32_t, 33> kPublishedInferno = {
    0x02010A, 0x07051B, 0x10092D, 0x1B0C41, 0x280B53, 0x360961, 0x440A68, 0x510E6C, 0x5D126E,
    0x6A176E, 0x771C6D, 0x84206B, 0x902568, 0x9D2964, 0xA92E5E, 0xB63458, 0xC13A50, 0xCC4248,
    0xD74B3F, 0xE05536, 0xE8602D, 0xEF6C23, 0xF47918, 0xF8870E, 0xFB9606, 0xFCA50A, 0xFCB418,
    0xFAC42A, 0xF7D340, 0xF3E35A, 0xF1F179, 0xF8FB9A, 0xFCFFA4};
constexpr std::array<std::uint32_t, 33> kPublishedTurbo = {
    0x351E58, 0x3D358B, 0x424BB5, 0x4661D6, 0x4776EE, 0x458AFC, 0x3D9EFE, 0x2FB2F4, 0x22C5E2,
    0x19D5CD, 0x19E3B9, 0x27EEA4, 0x3FF68A, 0x5DFC6F, 0x7DFF56, 0x99FE42, 0xAFFA37, 0xC3F134,
    0xD7E535, 0xE7D739, 0xF4C73A, 0xFBB637, 0xFEA130, 0xFD8A26, 0xF8721C, 0xF05B12, 0xE5470B,
    0xD83706, 0xC82803, 0xB41B01, 0x9E1001, 0x850702, 0x7A0403};

TEST(ColorMap, PublishedMapsAreWhatOthersDraw)
{
    const auto check = [](ColorMap map, const std::array<std::uint32_t, 33>& published) {
        for (std::size_t i = 0; i < published.size(); ++i) {
            const std::size_t index = std::min<std::size_t>(8 * i + 4, 255);
            const Rgb found = shown_rgb(map_color(map, static_cast<float>(index) / 255.0f));
            for (std::size_t c = 0; c < 3; ++c)  // 2 of straight lines, 1 of rounding
                EXPECT_NEAR(found[c], published[i] >> (16 - 8 * c) & 0xFF, 3)
                    << static_cast<int>(map) << " at " << index;
        }
    };
    check(ColorMap::viridis, kPublishedViridis);
    check(ColorMap::inferno, kPublishedInferno);
    check(ColorMap::turbo, kPublishedTurbo);
}

TEST(DivergingMap, IsWhiteInTheMiddleAndEquallyDarkAtBothEnds)
{
    const auto at = [](float difference) {
        return map_color(ColorMap::diverging,
                         difference_place(ColorMap::diverging, difference, 0.2f));
    };
    EXPECT_LT(glm::distance(at(0.0f), glm::vec3(1.0f)), 1e-5f);
    EXPECT_GT(at(0.2f).r, 3.0f * at(0.2f).b);    // too dark: red
    EXPECT_GT(at(-0.2f).b, 3.0f * at(-0.2f).r);  // too bright: blue
    EXPECT_EQ(at(0.5f), at(0.2f));
    for (const float d : {0.05f, 0.1f, 0.2f})
        EXPECT_NEAR(cie_lightness(at(d)), cie_lightness(at(-d)), 6.0f) << d;  // of 100; OKLab's own
}

TEST(RoundedScale, IsTheNextOneTwoOrFive)
{
    EXPECT_EQ(rounded_scale(0.0f), 1e-4f);
    EXPECT_EQ(rounded_scale(0.1f), 0.1f);
    EXPECT_EQ(rounded_scale(0.11f), 0.2f);
    EXPECT_EQ(rounded_scale(0.0021f), 0.005f);
    EXPECT_EQ(rounded_scale(0.06f), 0.1f);
    EXPECT_EQ(rounded_scale(0.7f), 1.0f);
}

TEST(ErrorColor, IsWhiteAtZeroRedAboveBlueBelowGreyUnknown)
{
    EXPECT_EQ(error_color(0.0f, 0.1f), (Rgb{255, 255, 255}));
    EXPECT_EQ(error_color(0.1f, 0.1f), shown_rgb(map_color(ColorMap::diverging, 1.0f)));
    EXPECT_EQ(error_color(-5.0f, 0.1f), shown_rgb(map_color(ColorMap::diverging, 0.0f)));
    EXPECT_EQ(error_color(0.05f, 0.1f), shown_rgb(map_color(ColorMap::diverging, 0.75f)));
    EXPECT_EQ(error_color(std::numeric_limits<float>::quiet_NaN(), 0.1f), (Rgb{128, 128, 128}));
}

}  // namespace
}  // namespace surfelao
