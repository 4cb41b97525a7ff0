#include "viewer/environment.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace surfelao {
namespace {

glm::vec3 received(const Image& irradiance, glm::vec3 normal)
{
    return glm::vec3(sample_panorama(irradiance, panorama_uv(normal)));
}

TEST(Panorama, TheTopLooksUpAndTheMiddleAlongX)
{
    EXPECT_NEAR(panorama_uv({0, 1, 0}).y, 0.0f, 1e-6f);
    EXPECT_NEAR(panorama_uv({0, -1, 0}).y, 1.0f, 1e-6f);
    EXPECT_NEAR(panorama_uv({1, 0, 0}).x, 0.5f, 1e-6f);
    EXPECT_NEAR(panorama_uv({0, 0, 1}).x, 0.75f, 1e-6f);
}

TEST(Panorama, DirectionUndoesUv)
{
    for (float u : {0.1f, 0.4f, 0.9f}) {
        for (float v : {0.05f, 0.5f, 0.8f}) {
            const glm::vec2 uv = panorama_uv(panorama_direction({u, v}));
            EXPECT_NEAR(uv.x, u, 1e-5f);
            EXPECT_NEAR(uv.y, v, 1e-5f);
        }
    }
}

// 2 percent: the cosine is sampled once per light, 128 x 64 of them.
TEST(IrradianceMap, AUniformSkyGivesItself)
{
    const Image map = irradiance_map(Image(300, 150, glm::vec4(0.5f, 1.0f, 2.0f, 1.0f)));
    for (const glm::vec4& pixel : map.pixels) {
        EXPECT_NEAR(pixel.r, 0.5f, 0.01f);
        EXPECT_NEAR(pixel.g, 1.0f, 0.02f);
        EXPECT_NEAR(pixel.b, 2.0f, 0.04f);
    }
}

// Light from the upper half only: all of it reaches a floor, half of it a wall, none a ceiling.
TEST(IrradianceMap, ASkyOverADarkGroundFallsOffWithTheTilt)
{
    Image panorama(128, 64, glm::vec4(0.0f));
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 128; ++x)
            panorama.at(x, y) = glm::vec4(1.0f);
    const Image map = irradiance_map(panorama);
    EXPECT_NEAR(received(map, {0, 1, 0}).g, 1.0f, 0.02f);
    EXPECT_NEAR(received(map, {0, 0, 1}).g, 0.5f, 0.05f);
    EXPECT_NEAR(received(map, {0, -1, 0}).g, 0.0f, 0.02f);
}

// One bright pixel of a large map: its energy must not depend on the size of the map.
TEST(IrradianceMap, ASmallSunKeepsItsEnergy)
{
    const auto lit_by_sun = [](int width) {
        Image panorama(width, width / 2, glm::vec4(0.0f));
        const int side = width / 128;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                panorama.at(width / 2 + x, width / 4 + y) = glm::vec4(1000.0f);
        return received(irradiance_map(panorama), {1, 0, 0}).g;
    };
    EXPECT_NEAR(lit_by_sun(1024) / lit_by_sun(128), 1.0f, 0.02f);
}

TEST(IrradianceMap, TakesMapsOfAnySize)
{
    const Image one = irradiance_map(Image(1, 1, glm::vec4(1.0f)));
    EXPECT_GT(received(one, {0, 1, 0}).g, 0.0f);
    EXPECT_EQ(irradiance_map(Image(3, 200, glm::vec4(0.0f))).at(5, 5).g, 0.0f);
}

TEST(ShrinkPanorama, KeepsTheMeanAndLeavesSmallMapsAlone)
{
    Image panorama(300, 150);
    double sum = 0.0;
    for (std::size_t i = 0; i < panorama.pixels.size(); ++i) {
        panorama.pixels[i] = glm::vec4(static_cast<float>(i % 7));
        sum += panorama.pixels[i].r;
    }
    const Image small = shrink_panorama(panorama, 100);
    ASSERT_EQ(small.width, 100);
    ASSERT_EQ(small.height, 50);
    double small_sum = 0.0;
    for (const glm::vec4& pixel : small.pixels)
        small_sum += pixel.r;
    EXPECT_NEAR(small_sum / 5000.0, sum / 45000.0, 1e-4);
    EXPECT_EQ(shrink_panorama(panorama, 300).pixels, panorama.pixels);
}

TEST(BuiltinSky, IsBrighterAboveThanBelow)
{
    const Image map = irradiance_map(builtin_sky());
    EXPECT_GT(received(map, {0, 1, 0}).g, 2.0f * received(map, {0, -1, 0}).g);
    EXPECT_GT(received(map, {0, -1, 0}).g, 0.0f);
}

}  // namespace
}  // namespace surfelao
