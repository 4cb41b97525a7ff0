#include "image/image_file.h"
#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

class PixelCommand : public testing::Test {
protected:
    void SetUp() override
    {
        write_obj(folder_ / "a.obj", scenes::bumpy_sphere(6));
        folder_.file("cloud.xyz", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n");
        // the leak checker may die where Mesa's threads end while the program does
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
    }
    /// A small picture unless they say otherwise.
    std::vector<std::string> words(const char* output, const std::vector<std::string>& options,
                                   const char* input = "a.obj") const
    {
        std::vector<std::string> words = {"render", folder_ / input, "-o",        folder_ / output,
                                          "--at",   "pixels",        "--context", "osmesa"};
        words.insert(words.end(), options.begin(), options.end());
        const std::vector<std::pair<const char*, const char*>> small = {
            {"--width", "48"}, {"--height", "32"}, {"--samples", "4"}};
        for (const auto& [name, value] : small) {
            if (std::ranges::find(options, name) == options.end())
                words.insert(words.end(), {name, value});
        }
        return words;
    }
    Image drawn(const char* output, const std::vector<std::string>& options = {}) const
    {
        const Outcome outcome = run(folder_.path(), words(output, options));
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        EXPECT_TRUE(outcome.out.ends_with("\nwrote " + (folder_ / output).string() + "\n"));
        return read_image(folder_ / output);
    }
    TemporaryFolder folder_;
};

// The middle is all there, the corners are not, and the border is in between. A number of a .png is
// 255 times the visibility, that of an .exr the visibility itself.
TEST_F(PixelCommand, WritesVisibilityWithCoverageAsAlpha)
{
    const Image png = drawn("x.png"), exr = drawn("x.exr");
    ASSERT_EQ(png.pixels.size(), 48u * 32u);
    EXPECT_EQ(png.at(24, 16).a, 1.0f);
    EXPECT_EQ(png.at(0, 0).a, 0.0f);
    EXPECT_TRUE(std::ranges::any_of(
        png.pixels, [](const glm::vec4& pixel) { return std::abs(pixel.a - 0.5f) < 0.01f; }));
    float least = 1.0f;
    for (std::size_t i = 0; i < png.pixels.size(); ++i) {
        EXPECT_NEAR(png.pixels[i].a, exr.pixels[i].a, 0.51f / 255.0f);
        const float visibility = png.pixels[i].a > 0.0f ? exr.pixels[i].r : 0.0f;
        EXPECT_NEAR(srgb_encode(png.pixels[i].r), visibility, 0.51f / 255.0f);
        least = png.pixels[i].a > 0.0f ? std::min(least, visibility) : least;
    }
    EXPECT_LT(least, 0.8f);
    // and without alpha, before the background that other pictures have
    const Image jpg = drawn("x.jpg");
    const Outcome other =
        run(folder_.path(), {"render", folder_ / "a.obj", "-o", folder_ / "y.jpg", "--width", "48",
                             "--height", "32", "--no-ground", "--context", "osmesa"});
    EXPECT_EQ(other.code, 0) << other.err;
    const Image at_vertices = read_image(folder_ / "y.jpg");
    for (const int y : {0, 31})
        EXPECT_NEAR(srgb_encode(jpg.at(0, y).g), srgb_encode(at_vertices.at(0, y).g), 0.03f);
}

TEST_F(PixelCommand, EveryModeAndSettingIsAnotherPictureSlow)
{
    std::vector<std::vector<glm::vec4>> pictures;
    for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
             {},
             {"--samples", "1"},
             {"--mode", "rays", "--reference-rays", "16"},
             {"--mode", "difference", "--reference-rays", "16"},
             {"--mode", "bent-normals"},
             {"--mode", "normals"},
             {"--mode", "environment"},
             {"--max-distance", "10%"},
             {"--max-distance", "10%", "--falloff", "smooth"},
             {"--ground"},
             {"--engine", "disks"},
             {"--engine", "gtao"},
             {"--engine", "gtao", "--taps", "8"},
             {"--engine", "gtao", "--set", "power=1"},
             {"--engine", "gtao", "--guard", "10%", "--camera", "distance=0.5"},
             {"--engine", "gtao", "--camera", "distance=0.5"},
             {"--camera", "azimuth=90"},
         }) {
        pictures.push_back(drawn("x.exr", options).pixels);
        for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
            EXPECT_TRUE(pictures[i] != pictures.back()) << i << " and " << pictures.size() - 1;
    }
}

// A red square that is open: its colour, not that of a texture's neighbour.
TEST_F(PixelCommand, TheFilesColoursAreMultiplied)
{
    folder_.file("red.mtl", "newmtl red\nKd 0.5 0 0\n");
    folder_.file("red.obj",
                 "mtllib red.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\n"
                 "f 1 2 3 4\n");
    const Outcome outcome = run(folder_.path(), words("x.exr", {"--mode", "textured"}, "red.obj"));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const glm::vec4 middle = read_image(folder_ / "x.exr").at(24, 16);
    EXPECT_GT(middle.r, 0.1f);
    EXPECT_EQ(middle.g, 0.0f);
    EXPECT_EQ(middle.a, 1.0f);
}

TEST_F(PixelCommand, RefusesWhatDoesNotGoTogetherInOneSentence)
{
    const auto refused = [&](const char* sentence, const std::vector<std::string>& options,
                             const char* input = "a.obj") {
        const Outcome outcome = run(folder_.path(), words("x.png", options, input));
        EXPECT_EQ(outcome.code, 2) << sentence;
        EXPECT_NE(outcome.err.find(sentence), std::string::npos) << outcome.err;
        EXPECT_FALSE(fs::exists(folder_ / "x.png"));
    };
    refused("has points only, no faces: --at points.", {}, "cloud.xyz");
    refused("--mode charts and density are for --at texels.", {"--mode", "charts"});
    refused("--mode levels is for --at vertices.", {"--mode", "levels"});
    refused("--at pixels and cubemaps are for --surface triangles.", {"--surface", "splats"});
    refused("--atlas is for --at texels.", {"--atlas"});
    refused("--wireframe and --cull are for --at vertices and texels.", {"--cull"});
    refused("are for --at texels.", {"--size", "64"});
    refused("--taps, --set and --guard are for --engine ssao-disc", {"--taps", "8"});
    refused("no setting 'colour'", {"--engine", "gtao", "--set", "colour=1"});
    refused("\"power\" is not NAME=VALUE", {"--engine", "gtao", "--set", "power"});
    refused("--set hbao.bias=1 is for --engine hbao.",
            {"--engine", "gtao", "--set", "hbao.bias=1"});
    refused("\"10\" is not a number from 0% to 100%.", {"--engine", "gtao", "--guard", "10"});
    refused("gtao has --taps and --set.", {"--engine", "gtao", "--quality", "good"});
    refused("gtao knows only what is seen.", {"--engine", "gtao", "--ground"});
    refused("gtao knows none.", {"--engine", "gtao", "--mode", "bent-normals"});
    refused("--kernel bunnell is only for --engine disks or rays.",
            {"--engine", "gtao", "--kernel", "bunnell"});
    refused("--kernel bunnell is only for --engine disks or rays.", {"--kernel", "bunnell"});
}

TEST_F(PixelCommand, ScreenMethodsAndPixelsAreForThoseWhoKnowThem)
{
    const auto refused = [&](const char* sentence, const std::vector<std::string>& arguments) {
        const Outcome outcome = run(folder_.path(), arguments);
        EXPECT_EQ(outcome.code, 2) << sentence;
        EXPECT_NE(outcome.err.find(sentence), std::string::npos) << outcome.err;
    };
    const std::string in = folder_ / "a.obj", out = folder_ / "x.png", mesh = folder_ / "x.ply";
    refused("--engine gtao is for --at pixels or cubemaps.",
            {"render", in, "-o", out, "--engine", "gtao"});
    refused("--taps, --set and --guard are for --at pixels.",
            {"render", in, "-o", out, "--taps", "8"});
    refused("--at pixels is for render, compare and view.",
            {"bake", in, "-o", mesh, "--at", "pixels"});
    refused("--at cubemaps is for render, compare and view.",
            {"bake", in, "-o", mesh, "--at", "cubemaps"});
    refused("--engine", {"bake", in, "-o", mesh, "--engine", "gtao"});
    EXPECT_FALSE(fs::exists(out) || fs::exists(mesh));
}

// 2^16 rays at a million pixels.
TEST_F(PixelCommand, AnInterruptLeavesNoFile)
{
    Program program(folder_.path(),
                    words("x.png", {"--width", "1280", "--height", "720", "--samples", "1",
                                    "--engine", "rays", "--rays", "65536"}));
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    program.send(SIGINT);
    const Outcome outcome = program.wait();
    EXPECT_EQ(outcome.code, 128 + SIGINT);
    EXPECT_FALSE(fs::exists(folder_ / "x.png"));
}

}  // namespace
}  // namespace surfelao
