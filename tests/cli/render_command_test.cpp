#include "image/image_file.h"
#include "program.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

class RenderCommand : public testing::Test {
protected:
    void SetUp() override
    {
        write_obj(folder_ / "a.obj", scenes::bumpy_sphere(4));
        // the leak checker may die where Mesa's threads end while the program does
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
    }

    /// A small picture with these options besides.
    Outcome render(const char* output, std::vector<std::string> options = {}) const
    {
        std::vector<std::string> arguments = {
            "render", folder_ / input_, "-o", folder_ / output, "--width", "64", "--height",
            "48",     "--samples",      "2",  "--context",      "osmesa"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return run(folder_.path(), arguments);
    }
    void expect_all_differ(const std::vector<std::vector<std::string>>& all_options) const
    {
        std::vector<std::vector<glm::vec4>> pictures;
        for (const std::vector<std::string>& options : all_options) {
            const Outcome outcome = render("x.png", options);
            ASSERT_EQ(outcome.code, 0) << outcome.err;
            pictures.push_back(read_image(folder_ / "x.png").pixels);
            for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
                EXPECT_NE(pictures[i], pictures.back()) << i << " and " << pictures.size() - 1;
        }
    }
    TemporaryFolder folder_;
    const char* input_ = "a.obj";
};

// Straight alpha in .png, premultiplied in .exr: read back they are the same picture.
TEST_F(RenderCommand, LeavesTheBackgroundTransparentInBothFormats)
{
    const std::vector<std::string> clear = {"--background", "transparent"};
    ASSERT_EQ(render("x.png", clear).code, 0);
    ASSERT_EQ(render("x.exr", clear).code, 0);
    const Image png = read_image(folder_ / "x.png"), exr = read_image(folder_ / "x.exr");
    EXPECT_EQ(png.at(0, 0).a, 0.0f);
    EXPECT_EQ(png.at(32, 24).a, 1.0f);
    for (std::size_t i = 0; i < png.pixels.size(); ++i) {
        EXPECT_NEAR(png.pixels[i].a, exr.pixels[i].a, 0.6f / 255.0f);
        EXPECT_NEAR(srgb_encode(png.pixels[i].g) * exr.pixels[i].a,
                    srgb_encode(exr.pixels[i].g) * exr.pixels[i].a, 0.6f / 255.0f);
    }
    const std::vector<std::string> blue = {"--background", "#0000ff"};
    ASSERT_EQ(render("x.png", blue).code, 0);
    EXPECT_EQ(read_image(folder_ / "x.png").at(0, 0), glm::vec4(0.0f, 0.0f, 1.0f, 1.0f));
}

TEST_F(RenderCommand, RefusesColoursThatDoNotGoTogether)
{
    const std::vector<std::vector<std::string>> wrong = {
        {"--background", "pink"},
        {"--background", "#12345"},
        {"--signed"},
        {"--difference-scale", "auto"},
        {"--mode", "difference", "--difference-scale", "7"},
        {"--colormap", "diverging"}};
    for (const std::vector<std::string>& options : wrong)
        EXPECT_EQ(render("x.png", options).code, 2) << options[0];
    EXPECT_EQ(render("x.jpg", {"--background", "transparent"}).code, 2);
}

TEST_F(RenderCommand, WritesAPictureOfTheSizeAskedFor)
{
    for (const char* name : {"x.png", "x.jpg", "x.exr"}) {
        const Outcome outcome = render(name);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        EXPECT_TRUE(outcome.out.ends_with("\nwrote " + (folder_ / name).string() + "\n"))
            << outcome.out;
        const Image image = read_image(folder_ / name);
        EXPECT_EQ(image.width, 64);
        EXPECT_EQ(image.height, 48);
    }
}

TEST_F(RenderCommand, EveryModeAndSurfaceIsAnotherPicture)
{
    expect_all_differ({
        {},
        {"--surface", "splats"},
        {"--surface", "affine"},
        {"--surface", "points"},
        {"--mode", "rays", "--reference-rays", "16"},
        {"--mode", "difference", "--reference-rays", "16"},
        {"--mode", "bent-normals"},
        {"--mode", "normals"},
        {"--mode", "levels"},
        {"--mode", "environment"},
        {"--mode", "headlight"},
        {"--wireframe"},
        {"--no-ground"},
        {"--camera", "azimuth=90"},
        {"--normals", "flat"},
        {"--crease", "80"},
        {"--values", "point"},
        {"--values", "point", "--offset", "1%"},
    });
}

// Two walls in an arch, in two charts.
TEST_F(RenderCommand, MapsAreShownOnTheModelAndFlatSlow)
{
    folder_.file("red.mtl", "newmtl red\nKd 1 0 0\n");
    folder_.file("walls.obj",
                 "mtllib red.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\n"
                 "vt 0 0\nvt .4 0\nvt .4 1\nvt 0 1\nvt .5 0\nvt 1 0\nvt 1 1\nvt .5 1\n"
                 "usemtl red\nf 1/1 2/2 3/3 4/4\nf 1/5 4/6 6/7 5/8\n");
    input_ = "walls.obj";
    expect_all_differ({
        {},
        {"--mode", "textured"},
        {"--at", "texels", "--size", "16"},
        {"--at", "texels", "--mode", "difference", "--reference-rays", "16"},
        {"--at", "texels", "--mode", "bent-normals"},
        {"--at", "texels", "--mode", "charts"},
        {"--at", "texels", "--mode", "density"},
        {"--at", "texels", "--mode", "textured"},
        {"--at", "texels", "--atlas"},
        {"--at", "texels", "--atlas", "--mode", "normals"},
        {"--at", "texels", "--atlas", "--mode", "charts"},
    });
    EXPECT_NE(render("x.png", {"--at", "texels", "--size", "20"})
                  .out.find("20 x 20 texels, 2 charts, 12.6 texels per unit"),
              std::string::npos);
}

TEST_F(RenderCommand, RefusesWhatCannotBeDoneInOneSentence)
{
    const auto refused = [&](int code, const char* words, const char* output,
                             const std::vector<std::string>& options) {
        const Outcome outcome = render(output, options);
        EXPECT_EQ(outcome.code, code) << words;
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
        EXPECT_FALSE(fs::exists(folder_ / output));
    };
    refused(1, "written as .png, .jpg or .exr", "x.bmp", {});
    refused(1, "none.hdr: no such file", "x.png", {"--environment", "none.hdr"});
    refused(1, "cannot be read as a picture", "x.png",
            {"--environment", (folder_ / "a.obj").string()});
    refused(2, "--camera: \"azimuth=x\"", "x.png", {"--camera", "azimuth=x"});
    refused(2, "only for --mode environment", "x.png",
            {"--environment", "sky.hdr", "--mode", "rays"});
    refused(2, "--reference-rays must be an even number", "x.png", {"--reference-rays", "15"});
    refused(2, "--mode", "x.png", {"--mode", "colourful"});
    refused(2, "--crease", "x.png", {"--crease", "181"});
    refused(2, "for --at texels", "x.png", {"--size", "64"});
    refused(2, "for --at texels", "x.png", {"--mode", "charts"});
    refused(2, "for --at texels", "x.png", {"--atlas"});
    refused(2, "for --surface triangles", "x.png", {"--at", "texels", "--surface", "splats"});
    refused(2, "for --surface triangles", "x.png", {"--mode", "textured", "--surface", "points"});
    refused(2, "for --surface triangles", "x.png", {"--cull", "--surface", "points"});
    refused(2, "for --at vertices", "x.png", {"--at", "texels", "--mode", "levels"});
    refused(2, "not --atlas", "x.png", {"--at", "texels", "--atlas", "--wireframe"});
    refused(1, "a.obj: has no texture coordinates of number 1", "x.png",
            {"--at", "texels", "--uv", "1"});
    refused(1, "the offset must be smaller than the scene", "x.png", {"--offset", "1000"});
}

TEST_F(RenderCommand, RefusesToReplaceWhatItReads)
{
    fs::copy_file(folder_ / "a.obj", folder_ / "a.png");
    fs::create_symlink("a.png", folder_ / "link.png");
    const std::string before = contents_of(folder_ / "a.png");
    const auto refused = [&](const std::string& words, const std::vector<std::string>& arguments) {
        const Outcome outcome = run(folder_.path(), arguments);
        EXPECT_EQ(outcome.code, 2);
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    };
    refused("a.png", {"render", folder_ / "a.png", "-o", folder_ / "link.png"});
    refused("a.png", {"render", folder_ / "a.obj", "-o", folder_ / "link.png", "--environment",
                      folder_ / "a.png"});
    EXPECT_EQ(contents_of(folder_ / "a.png"), before);
}

// 16,384 is the most that software draws; 32,768 the most that may be asked for.
TEST_F(RenderCommand, RefusesASizeThatTheDeviceCannotDraw)
{
    const Outcome outcome =
        run(folder_.path(), {"render", folder_ / "a.obj", "-o", folder_ / "x.png", "--width",
                             "32768", "--height", "8", "--context", "osmesa"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("pixels was asked for"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder_ / "x.png"));
}

// EGL finds no driver then; OSMesa brings its own.
TEST_F(RenderCommand, WithoutADriverItSaysSoInOneSentenceAndAutoDrawsBySoftware)
{
    setenv("LIBGL_DRIVERS_PATH", "/nowhere", 1);
    const auto draw = [&](const char* output, const char* context) {
        return run(folder_.path(), {"render", folder_ / "a.obj", "-o", folder_ / output, "--width",
                                    "64", "--height", "48", "--context", context});
    };
    const Outcome refused = draw("x.png", "egl");
    const Outcome drawn = draw("y.png", "auto");
    unsetenv("LIBGL_DRIVERS_PATH");
    EXPECT_EQ(refused.code, 1);
    EXPECT_EQ(refused.err.rfind("surfelao: no OpenGL context can be had: ", 0), 0u) << refused.err;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_FALSE(fs::exists(folder_ / "x.png"));
    EXPECT_EQ(drawn.code, 0) << drawn.err;
}

TEST(ViewCommand, RefusesWhatTheWindowCannotShow)
{
    const TemporaryFolder folder;
    for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
             {"--normals", "mean"},
             {"--crease", "-1"},
             {"--values", "both"},
             {"--offset", "0"},
             {"--max-distance", "5"},
             {"--kernel", "bunnell"},
             {"--engine", "gtao"},
             {"--engine", "vo", "--at", "cubemaps"},
             {"--taps", "8"},
             {"--guard", "5", "--at", "pixels", "--engine", "vo"},
             {"--guard", "5%", "--at", "grid"},
             {"--resolution", "8", "--at", "pixels"},
             {"--size", "64", "--at", "grid"},
             {"--ground", "y", "--at", "pixels", "--engine", "vo"},
             {"--mode", "coverage"},
             {"--mode", "levels", "--at", "pixels"}}) {
        std::vector<std::string> arguments = {"view"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = run(folder.path(), arguments);
        EXPECT_EQ(outcome.code, 2) << options[0];
        EXPECT_NE(outcome.err.find(options[0]), std::string::npos) << outcome.err;
    }
}

TEST(ViewCommand, WithoutADisplayItSaysSoAndFails)
{
    if (std::getenv("DISPLAY"))
        GTEST_SKIP() << "there is a display";
    const TemporaryFolder folder;
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"view"},
             {"view", "--at", "pixels", "--engine", "vo", "--guard", "5%"},
             {"view", "--at", "grid", "--resolution", "8", "--store", "sh"}}) {
        const Outcome outcome = run(folder.path(), words);
        EXPECT_EQ(outcome.code, 1);
        EXPECT_NE(outcome.err.find("no window can be opened"), std::string::npos) << outcome.err;
    }
}

}  // namespace
}  // namespace surfelao
