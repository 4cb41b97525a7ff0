#include "image/color_map.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
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

// matplotlib's own tables at 1/16, 1/2 + 1/64 (between two knots) and 1.
TEST(ColorMap, PublishedMapsAreWhatOthersDraw)
{
    const auto check = [](ColorMap map, const std::array<Rgb, 3>& published) {
        constexpr float kPlaces[] = {0.0625f, 0.515625f, 1.0f};
        for (std::size_t i = 0; i < published.size(); ++i) {
            const Rgb found = shown_rgb(map_color(map, kPlaces[i]));
            for (std::size_t c = 0; c < 3; ++c)  // 2 of straight lines, 1 of rounding
                EXPECT_NEAR(found[c], published[i][c], 3) << static_cast<int>(map) << ' ' << i;
        }
    };
    check(ColorMap::viridis, {{Rgb{72, 24, 106}, {32, 148, 140}, {253, 231, 37}}});
    check(ColorMap::inferno, {{Rgb{11, 7, 36}, {193, 58, 81}, {252, 255, 164}}});
    check(ColorMap::turbo, {{Rgb{64, 64, 161}, {173, 250, 56}, {122, 4, 3}}});
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
