#include "reference/sobol.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

namespace surfelao {
namespace {

constexpr glm::vec3 kAxis{0, 0, 1};

/// Undoes the concentric map: where in the unit square a direction over +z comes from.
std::pair<float, float> square_of(float x, float y)
{
    const float radius = std::hypot(x, y);
    const float quarter = 0.78539816f;
    float a = 0, b = 0;
    if (std::fabs(x) > std::fabs(y)) {
        a = std::copysign(radius, x);
        b = a * std::atan(y / x) / quarter;
    } else {
        b = std::copysign(radius, y);
        a = b * std::atan(x / y) / quarter;
    }
    return {0.5f * (a + 1.0f), 0.5f * (b + 1.0f)};
}

TEST(Sobol, ScrambledPointsFillEveryDyadicCellOnce)
{
    const std::uint32_t count = 256;
    const SobolPoints points = sobol_points_by_cell(count);
    for (std::uint32_t seed : {0u, 1u, 99u}) {
        std::set<std::pair<int, int>> square_cells, slabs;
        for (std::uint32_t first = 0; first < count; first += kPacket) {
            DirectionPacket packet;
            fill_directions(points, first, hemisphere_over(kAxis, seed, 5), packet);
            for (int lane = 0; lane < kPacket; ++lane) {
                const auto [u, v] = square_of(packet.x[lane], packet.y[lane]);
                square_cells.insert({int(u * 16), int(v * 16)});
                slabs.insert({int(u * 64), int(v * 4)});
            }
        }
        EXPECT_EQ(square_cells.size(), count) << "seed " << seed;
        EXPECT_EQ(slabs.size(), count) << "seed " << seed;
    }
}

TEST(Sobol, APacketFillsOneCell)
{
    const SobolPoints points = sobol_points_by_cell(256);
    for (std::uint32_t first = 0; first < 256; first += kPacket) {
        DirectionPacket packet;
        fill_directions(points, first, hemisphere_over(kAxis, 3, 8), packet);
        std::set<std::pair<int, int>> cells;
        for (int lane = 0; lane < kPacket; ++lane) {
            const auto [u, v] = square_of(packet.x[lane], packet.y[lane]);
            cells.insert({int(u * 4), int(v * 4)});
        }
        EXPECT_EQ(cells.size(), 1u) << "packet at " << first;
    }
}

TEST(Sobol, DirectionsAreUnitAboveTheHorizonAndKnowTheirCosine)
{
    const SobolPoints points = sobol_points_by_cell(64);
    for (const glm::vec3 normal :
         {kAxis, -kAxis, glm::vec3(1, 0, 0), glm::normalize(glm::vec3(-0.3f, 0.8f, -0.9f))}) {
        const Hemisphere hemisphere = hemisphere_over(normal, 1, 2);
        EXPECT_NEAR(glm::dot(hemisphere.x, hemisphere.y), 0.0f, 1e-6f);
        EXPECT_NEAR(glm::length(hemisphere.x), 1.0f, 1e-6f);
        for (std::uint32_t first = 0; first < 64; first += kPacket) {
            DirectionPacket packet;
            fill_directions(points, first, hemisphere, packet);
            for (int lane = 0; lane < kPacket; ++lane) {
                const glm::vec3 w(packet.x[lane], packet.y[lane], packet.z[lane]);
                EXPECT_NEAR(glm::length(w), 1.0f, 1e-6f);
                EXPECT_GE(packet.cosine[lane], 0.0f);
                EXPECT_NEAR(glm::dot(w, normal), packet.cosine[lane], 1e-6f);
            }
        }
    }
}

// Odd counts: the tables are padded to whole packets with points that are not new.
TEST(Sobol, TablesReachToTheEndOfTheLastPacket)
{
    for (std::uint32_t count : {1u, 15u, 16u, 17u, 100u}) {
        const SobolPoints points = sobol_points_by_cell(count);
        EXPECT_EQ(points.reversed_u.size() % kPacket, 0u);
        EXPECT_GE(points.reversed_u.size(), count);
        EXPECT_EQ(
            std::set<std::uint32_t>(points.reversed_u.begin(), points.reversed_u.end()).size(),
            count);
    }
}

TEST(Sobol, ReceiversAndSeedsHaveScramblesOfTheirOwn)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
        for (std::uint32_t receiver = 0; receiver < 100; ++receiver) {
            const Hemisphere h = hemisphere_over(kAxis, seed, receiver);
            seen.insert({h.scramble_u, h.scramble_v});
        }
    }
    EXPECT_EQ(seen.size(), 1000u);
}

}  // namespace
}  // namespace surfelao
