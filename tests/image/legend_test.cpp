#include "image/legend.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace surfelao {
namespace {

const Legend kLegend = {"occlusion error", 0.0f, 0.1f, ColorMap::viridis, "RMSE 0.01"};

TEST(DrawLegend, HasBothEndsOfTheMapAndStaysInTheLowerLeftCorner)
{
    const glm::vec4 paper(0.5f, 0.5f, 0.5f, 1.0f);
    Image image(320, 240, paper);
    draw_legend(image, kLegend);
    const auto has = [&](glm::vec3 color) {
        return std::any_of(image.pixels.begin(), image.pixels.end(), [&](const glm::vec4& pixel) {
            return glm::distance(glm::vec3(pixel), color) < 0.04f;  // half a column off
        });
    };
    EXPECT_TRUE(has(map_color(ColorMap::viridis, 0.0f)));
    EXPECT_TRUE(has(map_color(ColorMap::viridis, 0.5f)));
    EXPECT_TRUE(has(map_color(ColorMap::viridis, 1.0f)));
    for (int x = 0; x < 320; ++x)
        EXPECT_EQ(image.at(x, 100), paper) << x;
    for (int y = 0; y < 240; ++y)
        EXPECT_EQ(image.at(319, y), paper) << y;
}

TEST(DrawLegend, LeavesAnImageAloneThatIsTooSmall)
{
    const glm::vec4 paper(0.5f, 0.5f, 0.5f, 1.0f);
    Image image(40, 30, paper);
    draw_legend(image, kLegend);
    EXPECT_EQ(std::count(image.pixels.begin(), image.pixels.end(), paper), 40 * 30);
}

}  // namespace
}  // namespace surfelao
