#include "image/image_file.h"
#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace surfelao {
namespace {

class CubeCommand : public testing::Test {
protected:
    void SetUp() override
    {
        write_obj(folder_ / "a.obj", scenes::bumpy_sphere(6));
        write_obj(folder_ / "box.obj", scenes::box({-1, -1, -1}, {1, 1, 1}, 2));
        // the leak checker may die where Mesa's threads end while the program does
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
    }
    Outcome render(std::vector<std::string> options, const char* input = "a.obj",
                   const char* at = "cubemaps") const
    {
        std::vector<std::string> words = {
            "render", folder_ / input, "-o", folder_ / "x.png", "--at", at,          "--context",
            "osmesa", "--width",       "64", "--height",        "48",   "--samples", "1"};
        words.insert(words.end(), options.begin(), options.end());
        return run(folder_.path(), words);
    }
    /// Pixels of the last picture that are pure red.
    std::ptrdiff_t red() const
    {
        const Image image = read_image(folder_ / "x.png");
        return std::ranges::count_if(image.pixels, [](const glm::vec4& pixel) {
            return pixel.r > 0.99f && pixel.g < 0.01f && pixel.b < 0.01f && pixel.a > 0.0f;
        });
    }
    TemporaryFolder folder_;
};

TEST_F(CubeCommand, SaysHowManyMapsTheirMemoryAndWhatTheyCover)
{
    const Outcome outcome = render({"--cubemap", "0:0:4", "--cubemap", "4:0:0", "--cubemap-size",
                                    "32", "--max-distance", "50%"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("2 cube maps of 6 x 32^2, 0.1 MB; "), std::string::npos)
        << outcome.out;
    EXPECT_NE(outcome.out.find(" % of the pixels covered, "), std::string::npos);
    EXPECT_EQ(red(), 0);
}

// A map behind the body sees nothing that the camera sees.
TEST_F(CubeCommand, ShowsHolesInRedWhereAskedToAndNoneWithAutomaticMaps)
{
    ASSERT_EQ(render({"--cubemap", "0:0:-4", "--cubemap-size", "32", "--mode", "coverage",
                      "--camera", "azimuth=0,elevation=0"})
                  .code,
              0);
    EXPECT_GT(red(), 500);
    const Outcome automatic = render({"--cubemap-size", "128", "--mode", "coverage"});
    ASSERT_EQ(automatic.code, 0) << automatic.err;
    EXPECT_LT(red(), 20);
}

TEST_F(CubeCommand, LeavesHolesWhiteWhereAskedTo)
{
    const std::vector<std::string> behind = {"--cubemap", "0:0:-4",   "--cubemap-size",
                                             "32",        "--camera", "azimuth=0,elevation=0"};
    const auto darkest = [&](std::vector<std::string> options) {
        options.insert(options.begin(), behind.begin(), behind.end());
        EXPECT_EQ(render(options).code, 0);
        const Image image = read_image(folder_ / "x.png");
        float least = 1.0f;
        for (const glm::vec4& pixel : image.pixels)
            least = pixel.a > 0.99f ? std::min(least, pixel.r) : least;
        return least;
    };
    EXPECT_EQ(darkest({"--holes", "white"}), 1.0f);
    EXPECT_LT(darkest({}), 0.9f);
}

// The camera's own map sees all that the camera sees.
TEST_F(CubeCommand, PutsAMapAtTheCamera)
{
    const Outcome outcome = render({"--cubemaps", "camera", "--mode", "coverage"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("1 cube maps of 6 x 256^2"), std::string::npos) << outcome.out;
    EXPECT_LT(red(), 20);
}

TEST_F(CubeCommand, AnswersTexelsByAMethodOfTheirFace)
{
    const Outcome outcome = render(
        {"--cubemaps", "camera", "--engine", "hbao", "--taps", "24", "--max-distance", "20%"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("hbao"), std::string::npos);
}

TEST_F(CubeCommand, RefusesWhatDoesNotGoTogether)
{
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{"--cubemap", "1:2"},
                                               {"--cubemap", "1:2:3:4"},
                                               {"--cubemap", "1:2:nan"},
                                               {"--cubemaps", "auto:0"},
                                               {"--cubemaps", "auto:"},
                                               {"--cubemaps", "some"},
                                               {"--cubemap-size", "8"},
                                               {"--holes", "black"},
                                               {"--mode", "bent-normals"},
                                               {"--mode", "levels"},
                                               {"--atlas"}}) {
        const Outcome outcome = render(options);
        EXPECT_EQ(outcome.code, 2) << options[0];
        EXPECT_NE(outcome.err, "") << options[0];
    }
    for (const std::vector<std::string>& options :
         std::vector<std::vector<std::string>>{{"--cubemap", "1:2:3"},
                                               {"--cubemaps", "auto"},
                                               {"--holes", "white"},
                                               {"--mode", "coverage"}}) {
        EXPECT_EQ(render(options, "a.obj", "pixels").code, 2) << options[0];
        EXPECT_EQ(render(options, "a.obj", "vertices").code, 2) << options[0];
    }
}

// Inside of a box there is nothing but back sides.
TEST_F(CubeCommand, RefusesAPlaceInsideOfABody)
{
    const Outcome outcome = render({"--cubemap", "0.1:0:0"}, "box.obj");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("inside of a body"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace surfelao
