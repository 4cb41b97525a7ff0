#include "image/image.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

TEST(Image, RowsRunFromTheTopAndPixelsAreFilled)
{
    Image image(3, 2, glm::vec4(0.25f));
    ASSERT_EQ(image.pixels.size(), 6u);
    EXPECT_EQ(image.at(2, 1), glm::vec4(0.25f));
    image.at(1, 1) = glm::vec4(1.0f);
    EXPECT_EQ(image.pixels[4], glm::vec4(1.0f));
}

// The values of IEC 61966-2-1: both ends, the joint of its two pieces, and mid grey.
TEST(Srgb, MatchesTheStandard)
{
    EXPECT_EQ(srgb_encode(0.0f), 0.0f);
    EXPECT_FLOAT_EQ(srgb_encode(1.0f), 1.0f);
    EXPECT_NEAR(srgb_encode(0.0031308f), 0.04045f, 1e-6f);
    EXPECT_NEAR(srgb_encode(0.21404114f), 0.5f, 1e-6f);
    EXPECT_EQ(srgb_encode(-1.0f), 0.0f);
    EXPECT_FLOAT_EQ(srgb_encode(7.0f), 1.0f);
}

TEST(Srgb, DecodeUndoesEncode)
{
    for (int i = 0; i <= 255; ++i) {
        const float shown = static_cast<float>(i) / 255.0f;
        EXPECT_NEAR(srgb_encode(srgb_decode(shown)), shown, 1e-6f) << i;
    }
}

// Two columns, black and white: uv 0.25 and 0.75 are their centres, and the edges meet half way.
TEST(SamplePanorama, InterpolatesAndWrapsAround)
{
    Image image(2, 1, glm::vec4(0.0f));
    image.at(1, 0) = glm::vec4(1.0f);
    EXPECT_FLOAT_EQ(sample_panorama(image, {0.25f, 0.5f}).r, 0.0f);
    EXPECT_FLOAT_EQ(sample_panorama(image, {0.75f, 0.5f}).r, 1.0f);
    EXPECT_FLOAT_EQ(sample_panorama(image, {0.5f, 0.5f}).r, 0.5f);
    EXPECT_FLOAT_EQ(sample_panorama(image, {0.0f, 0.0f}).r, 0.5f);
    EXPECT_FLOAT_EQ(sample_panorama(image, {1.0f, 1.0f}).r, 0.5f);
}

TEST(SamplePanorama, DoesNotWrapOverThePoles)
{
    Image image(1, 2, glm::vec4(0.0f));
    image.at(0, 1) = glm::vec4(1.0f);
    EXPECT_FLOAT_EQ(sample_panorama(image, {0.5f, 0.0f}).r, 0.0f);
    EXPECT_FLOAT_EQ(sample_panorama(image, {0.5f, 1.0f}).r, 1.0f);
}

}  // namespace
}  // namespace surfelao
