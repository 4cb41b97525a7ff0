#include "image/color_map.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(HeatMap, EveryStepIsLighterThanTheLastAndNoneJumps)
{
    for (int i = 1; i < 256; ++i) {
        const float step = cie_lightness(heat_colors()[i]) - cie_lightness(heat_colors()[i - 1]);
        EXPECT_GT(step, 0.0f) << i;
        EXPECT_LT(step, 1.0f) << i;  // 100 / 255 would be a perfectly even one
    }
}

TEST(HeatMap, AllColoursCanBeShown)
{
    for (const glm::vec3& color : heat_colors()) {
        EXPECT_GE(std::min({color.r, color.g, color.b}), -1e-4f);
        EXPECT_LE(std::max({color.r, color.g, color.b}), 1.0f + 1e-4f);
    }
}

TEST(HeatMap, ValuesOutsideAreCut)
{
    EXPECT_EQ(heat_color(-3.0f), heat_color(0.0f));
    EXPECT_EQ(heat_color(9.0f), heat_color(1.0f));
}

TEST(HeatLegend, HasBothEndsOfTheMapAndStaysInTheLowerLeftCorner)
{
    const glm::vec4 paper(0.5f, 0.5f, 0.5f, 1.0f);
    Image image(320, 240, paper);
    draw_heat_legend(image, "occlusion error", 0.0f, 0.1f);
    const auto has = [&](glm::vec3 color) {
        return std::any_of(image.pixels.begin(), image.pixels.end(), [&](const glm::vec4& pixel) {
            return glm::distance(glm::vec3(pixel), color) < 0.02f;
        });
    };
    EXPECT_TRUE(has(heat_color(0.0f)));
    EXPECT_TRUE(has(heat_color(0.5f)));
    EXPECT_TRUE(has(heat_color(1.0f)));
    for (int x = 0; x < 320; ++x)
        EXPECT_EQ(image.at(x, 100), paper) << x;
    for (int y = 0; y < 240; ++y)
        EXPECT_EQ(image.at(319, y), paper) << y;
}

TEST(HeatLegend, LeavesAnImageAloneThatIsTooSmall)
{
    const glm::vec4 paper(0.5f, 0.5f, 0.5f, 1.0f);
    Image image(40, 30, paper);
    draw_heat_legend(image, "occlusion error", 0.0f, 0.1f);
    EXPECT_EQ(std::count(image.pixels.begin(), image.pixels.end(), paper), 40 * 30);
}

TEST(ErrorColor, IsWhiteAtZeroRedAboveBlueBelowGreyUnknown)
{
    EXPECT_EQ(error_color(0.0f, 0.1f), (Rgb{255, 255, 255}));
    EXPECT_EQ(error_color(0.1f, 0.1f), (Rgb{255, 0, 0}));
    EXPECT_EQ(error_color(-5.0f, 0.1f), (Rgb{0, 0, 255}));
    EXPECT_EQ(error_color(0.05f, 0.1f), (Rgb{255, 128, 128}));
    EXPECT_EQ(error_color(std::numeric_limits<float>::quiet_NaN(), 0.1f), (Rgb{128, 128, 128}));
}

}  // namespace
}  // namespace surfelao
