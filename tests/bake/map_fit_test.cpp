#include "bake/map_fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace surfelao {
namespace {

/// Visible left of `edge`, closed right of it.
float step(double u, double edge)
{
    return u < edge ? 1.0f : 0.0f;
}

/// RMS over a row of what the map shows less the step.
double misfit(const Map& map, double edge)
{
    constexpr int kPlaces = 1600;
    double squares = 0.0;
    for (int i = 0; i < kPlaces; ++i) {
        const double u = 0.25 + 0.5 * (i + 0.5) / kPlaces;
        const double error = double{fetch(map, 0, {u, 0.5})} - double{step(u, edge)};
        squares += error * error;
    }
    return std::sqrt(squares / kPlaces);
}

// The edge of a shadow right beside a centre: four quarters see that most of that texel is closed.
TEST(MapFit, ShowsAnEdgeBetweenCentresBetter)
{
    constexpr double kEdge = (8.0 + 0.55) / 16.0;
    Map map(16, 4, 1);
    for (std::uint32_t y = 0; y < 4; ++y)
        for (std::uint32_t x = 0; x < 16; ++x)
            map.values[map.index(x, y)] = step((x + 0.5) / 16.0, kEdge);
    const std::vector<std::uint8_t> known(map.texels(), 1);
    const std::vector<std::uint8_t> bends = texels_that_bend(map, known);
    std::vector<MapSample> samples;
    for (std::uint32_t y = 0; y < 8; ++y) {
        for (std::uint32_t x = 0; x < 32; ++x) {
            EXPECT_EQ(bends[16 * (y / 2) + x / 2], x / 2 == 8 || x / 2 == 9 ? 1 : 0);
            const glm::dvec2 uv((x + 0.5) / 32.0, (y + 0.5) / 8.0);
            if (bends[16 * (y / 2) + x / 2] != 0)
                samples.push_back({uv, step(uv.x, kEdge), 0.25f});
        }
    }
    std::vector<std::uint8_t> is_held = known;
    for (std::size_t i = 0; i < bends.size(); ++i)
        is_held[i] &= bends[i] == 0;
    const double before = misfit(map, kEdge);
    fit_texels(map, is_held, samples);
    EXPECT_LT(misfit(map, kEdge), 0.85 * before);
}

TEST(MapFit, LeavesAFlatMapAndWhatIsUnknownAlone)
{
    Map map(8, 8, 1, 0.25f);
    map.values[9] = 0.9f;
    std::vector<std::uint8_t> known(map.texels(), 1);
    known[9] = 0;
    EXPECT_TRUE(texels_that_bend(map, known).empty());
    const Map before = map;
    fit_texels(map, known, {});
    EXPECT_EQ(map.values, before.values);
}

}  // namespace
}  // namespace surfelao
