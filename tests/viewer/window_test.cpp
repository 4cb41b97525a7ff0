// The window itself, on the display that DISPLAY names: xvfb-run in CMakeLists.txt.

#include "viewer/window.h"

#include "image/image_file.h"
#include "scenes.h"
#include "surfels/scene_io.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace surfelao {
namespace {

class Window : public testing::Test {
protected:
    void SetUp() override
    {
        if (!std::getenv("DISPLAY"))
            GTEST_SKIP() << "there is no display";
    }
};

/// A box, as a file of its own for each test.
std::filesystem::path box_file()
{
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) /
        (std::string("surfelao_window_") +
         testing::UnitTest::GetInstance()->current_test_info()->name() + ".ply");
    const Scene box = scenes::box({0, 0, 0}, {1, 1, 1}, 4);
    write_scene(path, box, std::vector<Occlusion>(box.positions.size()));
    return path;
}

/// All open; counts how often it is asked.
Services open_everywhere(std::atomic<int>& calls)
{
    Services all;
    all.engines = {{.name = "open"}};
    all.solve = [&calls](const Model& model, const SolveSettings&, const Progress&) {
        ++calls;
        std::vector<Occlusion> occlusion;
        for (const Receiver& receiver : model.receivers)
            occlusion.push_back({0.0f, receiver.normal});
        return Solved{std::move(occlusion)};
    };
    all.measure = [](auto, auto) { return ErrorFigures{}; };
    return all;
}

double share(const Image& image, auto condition)
{
    return static_cast<double>(std::count_if(image.pixels.begin(), image.pixels.end(), condition)) /
           static_cast<double>(image.pixels.size());
}

// Light pixels are the box, saturated blue ones belong to the widgets.
TEST_F(Window, ShowsTheModelAndTheWidgetsAndMovesWithoutSolving)
{
    std::atomic<int> calls{0};
    int frames_with_model = 0;
    Image last;
    WindowOptions options;
    options.input = box_file();
    options.width = 800;
    options.height = 600;
    options.on_frame = [&](const Image& shown, const Session& session) {
        frames_with_model += !session.state().occlusion.empty();
        last = shown;
        return frames_with_model < 5;
    };
    show_window(options, open_everywhere(calls));
    ASSERT_EQ(last.width, 800);
    ASSERT_EQ(last.height, 600);
    EXPECT_GT(share(last, [](const glm::vec4& p) { return p.r > 0.8f; }), 0.1);
    EXPECT_GT(share(last, [](const glm::vec4& p) { return p.b > 0.03f && p.b > 3.0f * p.r; }),
              0.01);
    EXPECT_EQ(calls, 1);
    write_image(std::filesystem::path(testing::TempDir()) / "surfelao_window.png", last);
}

TEST_F(Window, EverySurfaceAndColourIsDrawn)
{
    for (int colors = 0; colors < 7; ++colors) {
        std::atomic<int> calls{0};
        WindowOptions options;
        options.input = box_file();
        options.width = 320;
        options.height = 240;
        options.panel.view.surface = static_cast<Surface>(colors % 4);
        options.panel.view.colors = static_cast<Colors>(colors);
        options.panel.reference_rays = 2;
        options.on_frame = [&](const Image&, const Session& session) {
            EXPECT_EQ(session.state().message, "");
            return session.state().occlusion.empty();
        };
        show_window(options, open_everywhere(calls));
        EXPECT_EQ(calls, 1) << colors;
    }
}

TEST_F(Window, AFileThatCannotBeReadIsNoCrash)
{
    std::atomic<int> calls{0};
    std::string message;
    WindowOptions options;
    options.input = "none.obj";
    options.width = 320;
    options.height = 240;
    options.on_frame = [&](const Image&, const Session& session) {
        message = session.state().message;
        return message.empty();
    };
    show_window(options, open_everywhere(calls));
    EXPECT_NE(message.find("none.obj"), std::string::npos);
    EXPECT_EQ(calls, 0);
}

// In the environment of the tests that have no display this is the only one that runs.
TEST(WindowWithoutDisplay, IsAClearError)
{
    if (std::getenv("DISPLAY"))
        GTEST_SKIP() << "there is a display";
    std::atomic<int> calls{0};
    try {
        show_window({}, open_everywhere(calls));
        FAIL() << "a window was opened";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("no window can be opened: "), std::string::npos);
    }
}

}  // namespace
}  // namespace surfelao
