#include "bake/picture.h"

#include "scenes.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace surfelao {
namespace {

constexpr Rgb kWhite{255, 255, 255};

Picture draw(const Scene& scene, Rgb color)
{
    const Geometry geometry = make_geometry(scene);
    return draw_vertices(geometry, std::vector<Rgb>(geometry.positions.size(), color), 64, 48);
}

std::size_t covered(const Picture& picture)
{
    std::size_t count = 0;
    for (const Rgb pixel : picture.pixels)
        count += pixel != kWhite;
    return count;
}

TEST(Picture, ASphereIsARoundSpotInTheMiddle)
{
    const Picture picture = draw(scenes::sphere({0, 0, 0}, 1, 8), {200, 0, 0});
    ASSERT_EQ(picture.pixels.size(), 64u * 48u);
    // a circle that fills 0.96 of the height: pi/4 * 46^2 = 1662 pixels; its rim is 150 pixels
    EXPECT_NEAR(static_cast<double>(covered(picture)), 1662.0, 150.0);
    const Rgb middle = picture.pixels[24 * 64 + 32];
    EXPECT_GT(middle[0], 100);
    EXPECT_EQ(middle[1], 0);
    EXPECT_EQ(picture.pixels[0], kWhite);
}

// The near walls face away from the viewer: the far ones are seen through them.
TEST(Picture, ARoomIsSeenFromInside)
{
    const Geometry geometry = make_geometry(scenes::room({0, 0, 0}, {1, 1, 1}, 4));
    std::vector<Rgb> colors;
    for (const glm::vec3 p : geometry.positions)
        colors.push_back(p.z > 0.0f ? Rgb{0, 0, 200} : Rgb{200, 0, 0});  // near half is blue
    const Picture picture = draw_vertices(geometry, colors, 64, 48);
    const Rgb middle = picture.pixels[24 * 64 + 32];
    EXPECT_GT(middle[0], middle[2]);
}

TEST(Picture, AllInOnePointDrawsNothing)
{
    Scene point;
    point.positions.assign(3, {1, 1, 1});
    point.triangles = {{0, 1, 2}};
    EXPECT_EQ(covered(draw(point, {0, 0, 0})), 0u);
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

TEST(Png, HasTheSpecifiedChunksAndGivesThePixelsBack)
{
    const Picture picture{2, 2, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}}};
    const std::string png = png_of(picture);
    ASSERT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(png.substr(12, 4), "IHDR");
    EXPECT_EQ(big_endian(png, 16), 2u);
    EXPECT_EQ(big_endian(png, 20), 2u);
    ASSERT_EQ(png.substr(37, 4), "IDAT");
    unsigned char rows[14] = {};
    uLongf size = sizeof rows;
    ASSERT_EQ(uncompress(rows, &size, reinterpret_cast<const Bytef*>(png.data() + 41),
                         big_endian(png, 33)),
              Z_OK);
    const unsigned char expected[14] = {0, 1, 2, 3, 4, 5, 6, 0, 7, 8, 9, 10, 11, 12};
    EXPECT_EQ(std::string(rows, rows + 14), std::string(expected, expected + 14));
    EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
    EXPECT_EQ(big_endian(png, png.size() - 4), 0xAE426082u);  // CRC of an empty IEND
}

}  // namespace
}  // namespace surfelao
