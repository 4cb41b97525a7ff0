#include "image/difference.h"

#include "image/color_map.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

TEST(CompareImages, EqualImagesDoNotDiffer)
{
    const Image image(4, 4, glm::vec4(0.3f, 0.5f, 0.7f, 1.0f));
    const ImageDifference difference = compare_images(image, image);
    EXPECT_EQ(difference.mean, 0.0);
    EXPECT_EQ(difference.share_beyond, 0.0);
    EXPECT_EQ(difference.largest, 0.0f);
}

// One of four pixels differs, in one channel, by half of the shown range.
TEST(CompareImages, MeasuresShownValues)
{
    const Image a(2, 2, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    Image b = a;
    b.at(1, 0).g = srgb_decode(0.5f);
    const ImageDifference difference = compare_images(a, b);
    EXPECT_NEAR(difference.mean, 0.125, 1e-6);
    EXPECT_EQ(difference.share_beyond, 0.25);
    EXPECT_NEAR(difference.largest, 0.5f, 1e-6f);
    EXPECT_EQ(compare_images(a, b, 0.6f).share_beyond, 0.0);
}

TEST(CompareImages, IgnoresAlpha)
{
    const Image a(1, 1, glm::vec4(0.5f, 0.5f, 0.5f, 0.0f));
    const Image b(1, 1, glm::vec4(0.5f, 0.5f, 0.5f, 1.0f));
    EXPECT_EQ(compare_images(a, b).largest, 0.0f);
}

TEST(DifferenceImage, ShowsTheHottestColourAtFullScale)
{
    const Image a(2, 1, glm::vec4(0.0f));
    Image b = a;
    b.at(1, 0).r = srgb_decode(0.5f);
    const Image difference = difference_image(a, b, 0.25f);
    EXPECT_EQ(glm::vec3(difference.at(0, 0)), map_color(ColorMap::heat, 0.0f));
    EXPECT_EQ(glm::vec3(difference.at(1, 0)), map_color(ColorMap::heat, 1.0f));
}

}  // namespace
}  // namespace surfelao
