#include "image/image_file.h"

#include "surfels/errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

namespace surfelao {
namespace {

/// A folder for one test, empty at its start and gone at its end.
class ImageFile : public testing::Test {
protected:
    void SetUp() override
    {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  (std::string("surfelao_") +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directory(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path path(const char* name) const { return folder_ / name; }

    std::filesystem::path write_text(const char* name, const std::string& text) const
    {
        std::ofstream(path(name), std::ios::binary) << text;
        return path(name);
    }

private:
    std::filesystem::path folder_;
};

/// A gradient whose top left pixel is red and whose lower right pixel is blue.
Image gradient(float alpha = 1.0f)
{
    Image image(7, 5);
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 7; ++x) {
            const float share = static_cast<float>(x + y) / 10.0f;
            image.at(x, y) = glm::vec4(1.0f - share, 0.5f, share, alpha);
        }
    }
    return image;
}

std::string message_of(const auto& work)
{
    try {
        work();
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing was thrown";
}

void expect_shown_near(const Image& a, const Image& b, float tolerance)
{
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(srgb_encode(a.pixels[i][c]), srgb_encode(b.pixels[i][c]), tolerance) << i;
        EXPECT_NEAR(a.pixels[i].a, b.pixels[i].a, tolerance) << i;
    }
}

TEST_F(ImageFile, PngKeepsShownValuesToHalfAStep)
{
    write_image(path("a.png"), gradient());
    expect_shown_near(read_image(path("a.png")), gradient(), 0.5f / 255.0f + 1e-5f);
}

TEST_F(ImageFile, AlphaStaysStraight)
{
    for (const char* name : {"a.png", "a.exr"}) {
        write_image(path(name), gradient(0.25f));
        expect_shown_near(read_image(path(name)), gradient(0.25f), 0.5f / 255.0f + 1e-5f);
    }
}

TEST_F(ImageFile, ExrKeepsEveryBit)
{
    Image image = gradient();
    image.at(3, 2) = glm::vec4(1234.5f, 1e-7f, -0.25f, 1.0f);
    write_image(path("a.exr"), image);
    EXPECT_EQ(read_image(path("a.exr")).pixels, image.pixels);
}

// Lossy, with halved colour resolution: a smooth picture is what it can hold.
TEST_F(ImageFile, JpgKeepsASmoothPicture)
{
    const Image image(32, 32, glm::vec4(0.2f, 0.5f, 0.7f, 1.0f));
    for (const char* name : {"a.jpg", "a.jpeg", "a.JPG"}) {
        write_image(path(name), image);
        expect_shown_near(read_image(path(name)), image, 3.0f / 255.0f);
    }
}

// Radiance RGBE, four bytes a pixel: (128, 64, 32) * 2^(131 - 136) = 4, 2, 1. Below eight columns
// the format has no run lengths.
TEST_F(ImageFile, RadianceHdrIsReadAsLinearLight)
{
    const std::string pixel("\x80\x40\x20\x83", 4);
    write_text("sky.hdr",
               "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n" + pixel + pixel + pixel + pixel);
    const Image sky = read_image(path("sky.hdr"));
    ASSERT_EQ(sky.pixels.size(), 4u);
    EXPECT_EQ(sky.width, 2);
    for (const glm::vec4& p : sky.pixels) {
        EXPECT_NEAR(p.r, 4.0f, 0.05f);  // readers differ by half a step of the 8-bit mantissa
        EXPECT_NEAR(p.g, 2.0f, 0.05f);
        EXPECT_NEAR(p.b, 1.0f, 0.05f);
        EXPECT_EQ(p.a, 1.0f);
    }
}

// Netpbm's grey format as the smallest grey picture there is.
TEST_F(ImageFile, GreyBecomesRgb)
{
    const Image image = read_image(write_text("grey.pgm", std::string("P5 2 1 255\n\x00\xff", 13)));
    ASSERT_EQ(image.pixels.size(), 2u);
    EXPECT_EQ(image.at(0, 0), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    EXPECT_EQ(image.at(1, 0), glm::vec4(1.0f));
}

TEST_F(ImageFile, ErrorsNameFileAndFault)
{
    EXPECT_NE(
        message_of([&] { (void)read_image(path("none.png")); }).find("none.png: no such file"),
        std::string::npos);
    EXPECT_NE(message_of([&] { (void)read_image(path("")); }).find("is a folder"),
              std::string::npos);
    for (const char* name : {"text.png", "text.exr", "text.hdr", "text.jpg", "text"}) {
        const std::filesystem::path file = write_text(name, "this is not a picture");
        EXPECT_NE(message_of([&] {
                      (void)read_image(file);
                  }).find(std::string(name) + ": cannot be read as a picture: "),
                  std::string::npos)
            << name << ": " << message_of([&] { (void)read_image(file); });
    }
}

TEST_F(ImageFile, CutFilesAreRefused)
{
    Image noise(64, 64, glm::vec4(1.0f));
    for (std::size_t i = 0; i < noise.pixels.size(); ++i)
        noise.pixels[i].r = static_cast<float>(i * 2654435761u % 1000u) / 1000.0f;
    for (const char* name : {"cut.png", "cut.exr"}) {
        write_image(path(name), noise);
        std::filesystem::resize_file(path(name), std::filesystem::file_size(path(name)) / 2);
        EXPECT_THROW((void)read_image(path(name)), InputError) << name;
    }
}

TEST_F(ImageFile, ValuesThatAreNotFiniteAreRefusedWithTheirPlace)
{
    Image image = gradient();
    image.at(2, 3).g = std::numeric_limits<float>::infinity();
    write_image(path("sun.exr"), image);
    EXPECT_NE(message_of([&] {
                  (void)read_image(path("sun.exr"));
              }).find("sun.exr: pixel 2, 3 is not finite"),
              std::string::npos);
}

TEST_F(ImageFile, ImpossibleOutputsAreRefusedAndLeaveNothing)
{
    EXPECT_THROW(write_image(path("a.bmp"), gradient()), InputError);
    EXPECT_THROW(write_image(path("a"), gradient()), InputError);
    EXPECT_THROW(write_image(path("none/a.png"), gradient()), InputError);
    EXPECT_THROW(write_image(path("a.png"), Image()), InputError);
    std::filesystem::create_directory(path("folder.png"));
    EXPECT_THROW(write_image(path("folder.png"), gradient()), InputError);
    EXPECT_TRUE(std::filesystem::is_empty(path("folder.png")));
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
}

TEST_F(ImageFile, MapsHoldTheirNumbersAsTheyAre)
{
    for (const std::uint32_t channels : {1u, 3u}) {
        Map map(3, 2, channels, 1.0f);
        map.values[map.index(1, 0)] = 0.25f;
        map.values[map.index(2, 1)] = 0.0f;
        for (const auto& [name, depth, steps] : {std::tuple("a.png", MapDepth::byte, 255.0f),
                                                 {"b.png", MapDepth::half, 65535.0f},
                                                 {"c.tif", MapDepth::byte, 255.0f},
                                                 {"d.tif", MapDepth::whole, 0.0f},
                                                 {"e.exr", MapDepth::half, 0.0f},
                                                 {"f.exr", MapDepth::whole, 0.0f}}) {
            write_map(path(name), map, depth);
            const Image image = read_image(path(name));
            ASSERT_EQ(image.width, 3) << name;
            ASSERT_EQ(image.height, 2) << name;
            // whole numbers are read as sRGB: back to what is stored
            const auto stored = [&image, has_steps = steps > 0.0f](int x, int y) {
                const float value = image.at(x, y).r;
                return has_steps ? srgb_encode(value) : value;
            };
            const float quarter = steps > 0.0f ? std::round(0.25f * steps) / steps : 0.25f;
            EXPECT_NEAR(stored(1, 0), quarter, 1e-5) << name;
            EXPECT_NEAR(stored(2, 1), 0.0f, 1e-6) << name;
            EXPECT_NEAR(stored(0, 0), 1.0f, 1e-6) << name;
        }
        for (const auto& [name, depth] :
             {std::pair("a.png", MapDepth::byte), {"b.png", MapDepth::half}}) {
            std::ifstream file(path(name), std::ios::binary);
            const std::string contents(std::istreambuf_iterator<char>(file), {});
            EXPECT_TRUE(map_bytes(map, depth) == contents) << name;
        }
    }
    EXPECT_THROW((void)map_bytes(Map(1, 1, 1), MapDepth::whole), SettingsError);
    EXPECT_THROW((void)map_bytes(Map(), MapDepth::byte), SettingsError);
    for (const auto& [name, depth] : {std::pair("a.png", MapDepth::whole),
                                      {"a.exr", MapDepth::byte},
                                      {"a.jpg", MapDepth::byte},
                                      {"none/a.png", MapDepth::byte}})
        EXPECT_THROW(check_map_output(path(name), depth), InputError) << name;
}

}  // namespace
}  // namespace surfelao
