#include "grid/ao_grid.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace surfelao {
namespace {

/// 3 x 4 x 5 cells in a box that is no cube, with values of x, y, z and 1, a hundredth each.
AoGrid small_grid()
{
    AoGrid grid;
    grid.cells = {3, 4, 5};
    grid.low = {-1, 10, -200};
    grid.high = {3, 11, -100};
    grid.inner = {0.3f, 0.65f, 0.8f};
    for (int z = 0; z < 5; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 3; ++x)
                for (const int value : {x, y, z, 20})
                    grid.values.push_back(0.01f * static_cast<float>(value));
    return grid;
}

TEST(AoGrid, TheWarpAndItsInverseAreOne)
{
    for (const float a : {0.1f, 0.3f, 0.65f, 0.9f}) {
        for (float x = -1.0f; x <= 1.0f; x += 0.01f) {
            EXPECT_NEAR(unwarped(warped(x, a, 0.65f), a, 0.65f), x, 1e-6f) << a;
            EXPECT_NEAR(warped(x, a, a), x, 1e-6f) << a;
        }
        EXPECT_NEAR(warped(a, a, 0.65f), 0.65f, 1e-6f);
        EXPECT_EQ(warped(-1.0f, a, 0.65f), -1.0f);
    }
}

TEST(AoGrid, CellsOfTheFacesLieOnTheBox)
{
    const AoGrid grid = small_grid();
    EXPECT_EQ(place_of(grid, {0, 0, 0}), grid.low);
    EXPECT_EQ(place_of(grid, {2, 3, 4}), grid.high);
    EXPECT_NEAR(place_of(grid, {1, 0, 0}).x, 1.0, 1e-6);
    // u = 1/2 on the inner part: x = a u / s
    EXPECT_NEAR(place_of(grid, {0, 0, 3}).z, -150.0 + 50.0 * 0.8 * 0.5 / 0.65, 1e-4);
}

TEST(AoGrid, ACellIsReadWhereItStandsAndBetweenThemTheMean)
{
    const AoGrid grid = small_grid();
    float values[4];
    for (int z = 0; z < 5; ++z) {
        for (int y = 0; y < 4; ++y) {
            for (int x = 0; x < 3; ++x) {
                read_values(grid, place_of(grid, {x, y, z}), values);
                EXPECT_NEAR(values[0], 0.01f * static_cast<float>(x), 1e-6f);
                EXPECT_NEAR(values[1], 0.01f * static_cast<float>(y), 1e-6f);
                EXPECT_NEAR(values[2], 0.01f * static_cast<float>(z), 1e-6f);
                EXPECT_NEAR(values[3], 0.2f, 1e-6f);
            }
        }
    }
    // both cells on the same side of the inner part: half way is half way
    read_values(grid, 0.5 * (place_of(grid, {0, 1, 2}) + place_of(grid, {0, 2, 2})), values);
    EXPECT_NEAR(values[1], 0.015f, 1e-6f);
}

TEST(AoGrid, BeyondTheBoxNothingIsHidden)
{
    const AoGrid grid = small_grid();
    EXPECT_EQ(occlusion_at(grid, {3.001, 10.5, -150}, {0, 0, 1}), 0.0f);
    EXPECT_GT(occlusion_at(grid, {1, 10.5, -150}, {0, 0, 1}), 0.1f);
    float values[4];
    read_values(grid, {1, 10.5, -201}, values);
    EXPECT_EQ(values[3], 0.0f);
}

TEST(AoGrid, TheFadeIsSmoothInTheLastOfTheBox)
{
    const AoGrid grid = small_grid();
    const auto weight = [&](double x) {
        return border_weight(grid, {1.0 + 2.0 * x, 10.5, -150}, 0.2f);
    };
    EXPECT_EQ(weight(1.0), 0.0f);
    EXPECT_EQ(weight(-1.0), 0.0f);
    EXPECT_NEAR(weight(1.0 - 0.5 * kGridFade), 0.5f, 1e-5f);
    EXPECT_EQ(weight(0.99 - kGridFade), 1.0f);
}

TEST(AoGrid, RescalingTakesTheBordersLargestValueAway)
{
    AoGrid grid = small_grid();
    grid.border = GridBorder::rescale;
    grid.border_value = 0.2f;
    EXPECT_EQ(border_weight(grid, {1, 10.5, -150}, 0.2f), 0.0f);
    EXPECT_EQ(border_weight(grid, {1, 10.5, -150}, 0.1f), 0.0f);
    EXPECT_NEAR(0.6f * border_weight(grid, {1, 10.5, -150}, 0.6f), 0.5f, 1e-6f);
    EXPECT_NEAR(border_weight(grid, {3, 11, -100}, 1.0f), 1.0f, 1e-6f);
}

}  // namespace
}  // namespace surfelao
