// The window itself, on the display that DISPLAY names: xvfb-run in CMakeLists.txt. Keys, drops and
// sizes come to it as the window system brings them, by GLFW's callbacks of the window.

#include "viewer/window.h"

#include "files/scene_io.h"
#include "image/image_file.h"
#include "scenes.h"
#include "temporary_folder.h"
#include "widget_finder.h"
#include "window_driver.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

bool is_light(const glm::vec4& pixel)
{
    return pixel.r > 0.8f;
}

/// The first and the last column with more light pixels than text has.
struct Extent {
    int low, high;
};
Extent light_columns(const Image& image)
{
    Extent extent{image.width, -1};
    for (int x = 0; x < image.width; ++x) {
        int count = 0;
        for (int y = 0; y < image.height; ++y)
            count += is_light(image.at(x, y));
        if (4 * count > image.height) {
            extent.low = std::min(extent.low, x);
            extent.high = std::max(extent.high, x);
        }
    }
    return extent;
}

void drop(const std::filesystem::path& path)
{
    GLFWwindow* window = glfwGetCurrentContext();
    const GLFWdropfun callback = glfwSetDropCallback(window, nullptr);
    glfwSetDropCallback(window, callback);
    const std::string name = path.string();
    const char* names[] = {name.c_str(), "not this one.obj"};
    callback(window, 2, names);
}

/// Answers that one model and one setting bring; moving brings none.
constexpr std::uint64_t kDraftAndWhole = 2;

// Light pixels are the box, saturated blue ones belong to the widgets.
TEST_F(Window, ShowsTheModelAndTheWidgetsAndMovesWithoutSolving)
{
    int frames_with_model = 0;
    std::uint64_t answers = 0;
    Image last;
    WindowOptions options;
    options.input = box_file();
    options.width = 800;
    options.height = 600;
    options.on_frame = [&](const Image& shown, const Session& session) {
        frames_with_model += session.state().is_solved;
        answers = session.state().answer_count;
        last = shown;
        return frames_with_model < 5;
    };
    (void)show_window(options);
    ASSERT_EQ(last.width, 800);
    ASSERT_EQ(last.height, 600);
    EXPECT_GT(share(last, is_light), 0.1);
    EXPECT_GT(share(last, [](const glm::vec4& p) { return p.b > 0.03f && p.b > 3.0f * p.r; }),
              0.01);
    EXPECT_LE(answers, kDraftAndWhole);
    write_image(std::filesystem::path(testing::TempDir()) / "surfelao_window.png", last);
}

// The box stands in the middle of what the panel leaves.
TEST_F(Window, TheModelStandsBesideThePanelAndMovesWhenItIsHidden)
{
    int frames = 0;
    Extent beside{}, alone{};
    WindowOptions options;
    options.input = box_file();
    options.width = 1000;
    options.height = 500;
    options.on_frame = [&](const Image& shown, const Session& session) {
        frames += session.state().is_solved;
        if (frames == 3) {
            beside = light_columns(shown);
            press(GLFW_KEY_TAB);
        }
        alone = light_columns(shown);
        return frames < 6;
    };
    (void)show_window(options);
    EXPECT_GT(beside.low, Panel::kWidth);
    EXPECT_NEAR(beside.low - Panel::kWidth, 999 - beside.high, 60);
    EXPECT_NEAR(alone.low, 999 - alone.high, 60);
}

// A white pixel would be an open place; normals of a box are no greys. No answer can be there in
// the frame that begins with the model.
TEST_F(Window, UntilTheFirstAnswerNormalsAreShown)
{
    const auto is_white = [](const glm::vec4& p) { return p.r > 0.8f && p.g > 0.8f && p.b > 0.8f; };
    const auto is_colored = [](const glm::vec4& p) {
        return std::max({p.r, p.g, p.b}) - std::min({p.r, p.g, p.b}) > 0.3f;
    };
    int frames_after = 0;
    Image before, after;
    WindowOptions options;
    options.input = box_file();
    options.width = 320;
    options.height = 240;
    options.panel.is_hidden = true;
    options.on_frame = [&](const Image& shown, const Session& session) {
        if (session.state().model && before.pixels.empty())
            before = shown;
        after = shown;
        frames_after += session.state().is_solved;
        return frames_after < 3;
    };
    (void)show_window(options);
    EXPECT_GT(share(before, is_colored), 0.1);
    EXPECT_EQ(share(before, is_white), 0.0);
    EXPECT_EQ(share(after, is_colored), 0.0);
    EXPECT_GT(share(after, is_white), 0.1);
}

TEST_F(Window, KeysThatGoDownAndUpWithinAFrameCountAndMovingSolvesNothing)
{
    int frames = 0;
    double near = 0.0, far = 0.0, framed = 0.0;
    std::uint64_t answers = 0;
    WindowOptions options;
    options.input = box_file();
    options.width = 320;
    options.height = 240;
    options.panel.is_hidden = true;
    options.on_frame = [&](const Image& shown, const Session& session) {
        frames += session.state().is_solved;
        const double light = share(shown, is_light);
        answers = session.state().answer_count;
        if (frames == 2) {
            near = light;
            for (int i = 0; i < 5; ++i)
                press(GLFW_KEY_MINUS);
        } else if (frames == 4) {
            far = light;
            press(GLFW_KEY_F);
        }
        framed = light;
        // what moves may be drawn coarsely: what has come to rest is whole
        return frames < 6 || (frames < 2000 && std::abs(framed - near) > 1e-3);
    };
    (void)show_window(options);
    EXPECT_LT(far, 0.5 * near);
    EXPECT_GT(far, 0.0);
    EXPECT_NEAR(framed, near, 1e-3);
    EXPECT_LE(answers, kDraftAndWhole);
}

TEST_F(Window, ADroppedFileIsOpenedAndABrokenOneIsToldAndChangesNothing)
{
    const std::filesystem::path good = box_file();
    const std::filesystem::path broken =
        std::filesystem::path(testing::TempDir()) / "surfelao_window_broken.ply";
    std::ofstream(broken) << "ply\nformat ascii 1.0\nelement vertex 3\n";
    std::filesystem::path shown_path;
    std::string message;
    int step = 0;
    std::uint64_t answers = 0;
    WindowOptions options;
    options.width = 320;
    options.height = 240;
    options.on_frame = [&](const Image&, const Session& session) {
        if (step == 0) {
            EXPECT_FALSE(session.state().model);
            drop(good);
            step = 1;
        } else if (step == 1 && session.state().is_solved) {
            drop(broken);
            step = 2;
        }
        shown_path = session.state().path;
        message = session.state().message;
        answers = session.state().answer_count;
        return step < 2 || message.empty();
    };
    (void)show_window(options);
    EXPECT_EQ(shown_path, good);
    EXPECT_NE(message.find("surfelao_window_broken.ply"), std::string::npos) << message;
    EXPECT_LE(answers, kDraftAndWhole);
}

/// A shallow bowl, all over as closed as its share of its whole sphere: a fiftieth.
std::filesystem::path bowl_file()
{
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / "surfelao_window_bowl.ply";
    const Scene bowl = scenes::height_field(16, [](double x, double y) {
        return -std::sqrt(4.0 - (x - 0.5) * (x - 0.5) - (y - 0.5) * (y - 0.5));
    });
    write_scene(path, bowl, std::vector<Occlusion>(bowl.positions.size()));
    return path;
}

// The answer is told to be a hundred times as dark as rays see the bowl: light is right of the line
// only.
TEST_F(Window, TheReferenceStandsRightOfTheWipeAndInThePictureBeside)
{
    for (const int key : {GLFW_KEY_W, GLFW_KEY_S}) {
        bool pressed = false;
        int frames = 0;
        Extent light{};
        WindowOptions options;
        options.input = bowl_file();
        options.up = UpAxis::z;
        options.camera = "elevation=60";
        options.width = 600;
        options.height = 200;
        options.panel.is_hidden = true;
        options.panel.view.ground = false;
        options.panel.reference_rays = 16;
        options.panel.left.settings.engine.engine = Engine::disks;
        options.panel.left.settings.engine.strength = 100.0f;
        options.on_frame = [&](const Image& shown, const Session& session) {
            if (session.state().is_solved && !std::exchange(pressed, true))
                press(key);
            frames += !session.state().reference.empty();
            light = light_columns(shown);
            return frames < 4;
        };
        (void)show_window(options);
        EXPECT_GE(light.low, 300) << static_cast<char>(key);
        EXPECT_GT(light.high, light.low + 50) << static_cast<char>(key);
    }
}

Cell cell_of_disks(bool at_pixels, float strength)
{
    Cell cell;
    cell.at_pixels = at_pixels;
    cell.settings.engine.engine = Engine::disks;
    cell.settings.engine.strength = strength;
    return cell;
}

// As above, with another cell in the rays' place: one is at vertices, the other at pixels. Until
// pixels are solved the vertices' values stand there: they are as light.
TEST_F(Window, AnyCellStandsRightOfTheWipeAndInThePictureBeside)
{
    for (const bool is_wipe : {false, true}) {
        constexpr int kMostFrames = 400;
        int frames = 0, all_frames = 0;
        Extent light{};
        WindowOptions options;
        options.input = bowl_file();
        options.up = UpAxis::z;
        options.camera = "elevation=60";
        options.width = 600;
        options.height = 200;
        options.panel.is_hidden = true;
        options.panel.view.ground = false;
        options.panel.beside = is_wipe ? Beside::wipe : Beside::side_by_side;
        options.panel.left = cell_of_disks(is_wipe, 100.0f);
        options.panel.right = cell_of_disks(!is_wipe, 0.0f);
        options.on_frame = [&](const Image& shown, const Session& session) {
            light = light_columns(shown);
            frames += session.state().is_solved && light.high > light.low + 50;
            return frames < 8 && ++all_frames < kMostFrames;
        };
        (void)show_window(options);
        EXPECT_GE(light.low, 300) << is_wipe;
        EXPECT_GT(light.high, light.low + 50) << is_wipe;
    }
}

/// Saves under these names, a pane on each side.
WindowOptions saving_options(const std::filesystem::path& input,
                             const std::filesystem::path& picture,
                             const std::filesystem::path& baked)
{
    WindowOptions options;
    options.input = input;
    options.width = 320;
    options.height = 240;
    options.panel.is_hidden = true;
    options.panel.beside = Beside::side_by_side;
    options.panel.reference_rays = 2;
    options.panel.paths = {picture.string(), baked.string()};
    return options;
}

/// Presses one key a frame, once there is an answer, and closes the window some frames later.
std::vector<std::filesystem::path> show_and_press(WindowOptions options,
                                                  const std::vector<int>& keys)
{
    std::size_t frames = 0;
    options.on_frame = [&](const Image&, const Session& session) {
        if (!session.state().is_solved || session.state().is_draft)
            return true;
        if (frames < keys.size())
            press(keys[frames]);
        return ++frames < keys.size() + 3;
    };
    return show_window(options);
}

TEST_F(Window, SavesThePictureAndTheBakedFileNamesThemAndTellsWhatCannotBeWritten)
{
    const TemporaryFolder folder;
    const std::vector<int> keys = {GLFW_KEY_P, GLFW_KEY_B, GLFW_KEY_B};
    EXPECT_TRUE(show_and_press(saving_options(box_file(), "/nowhere/x.png", "/nowhere/x.ply"), keys)
                    .empty());
    const std::filesystem::path picture = folder / "x.png", baked = folder / "x.ply";
    // the second time the baked file is this window's own: no question
    EXPECT_EQ(show_and_press(saving_options(box_file(), picture, baked), keys),
              (std::vector<std::filesystem::path>{picture, baked}));
    const Image saved = read_image(picture);
    EXPECT_EQ(saved.width, 320);
    EXPECT_EQ(saved.height, 240);
    const Scene scene = read_scene(baked);
    EXPECT_EQ(scene.positions.size(), scenes::box({0, 0, 0}, {1, 1, 1}, 4).positions.size());
}

TEST_F(Window, AFileOfSomebodyElseIsReplacedOnlyWhenThatIsTheReply)
{
    const TemporaryFolder folder;
    const std::filesystem::path picture = folder.file("x.png", "mine");
    const std::filesystem::path baked = folder.file("x.ply", "mine");
    const WindowOptions options = saving_options(box_file(), picture, baked);
    EXPECT_TRUE(show_and_press(
                    options, {GLFW_KEY_P, GLFW_KEY_ESCAPE, GLFW_KEY_B, GLFW_KEY_B, GLFW_KEY_ESCAPE})
                    .empty());
    EXPECT_EQ(contents_of(picture), "mine");
    EXPECT_EQ(contents_of(baked), "mine");
    EXPECT_EQ(show_and_press(options, {GLFW_KEY_P, GLFW_KEY_K, GLFW_KEY_B, GLFW_KEY_K}),
              (std::vector<std::filesystem::path>{folder / "x-2.png", folder / "x-2.ply"}));
    EXPECT_EQ(contents_of(baked), "mine");
    EXPECT_EQ(show_and_press(options, {GLFW_KEY_B, GLFW_KEY_R}),
              (std::vector<std::filesystem::path>{baked}));
    EXPECT_EQ(contents_of(baked), contents_of(folder / "x-2.ply"));
    EXPECT_EQ(folder.file_count(), 4);
}

// Another name, the same file.
TEST_F(Window, TheInputIsNeverReplaced)
{
    const TemporaryFolder folder;
    const std::filesystem::path input = folder / "baked.ply";
    std::filesystem::copy_file(box_file(), input);
    std::filesystem::create_symlink("baked.ply", folder / "link.ply");
    const std::string before = contents_of(input);
    const WindowOptions options = saving_options(input, folder / "x.png", folder / "link.ply");
    EXPECT_TRUE(show_and_press(options, {GLFW_KEY_B, GLFW_KEY_R, GLFW_KEY_ESCAPE}).empty());
    EXPECT_EQ(show_and_press(options, {GLFW_KEY_B, GLFW_KEY_R, GLFW_KEY_K}),
              (std::vector<std::filesystem::path>{folder / "link-2.ply"}));
    EXPECT_EQ(contents_of(input), before);
}

/// The window when this engine has solved a bumpy ball.
Image picture_of_ball(const EngineSettings& engine)
{
    const TemporaryFolder folder;
    write_obj(folder / "ball.obj", scenes::bumpy_sphere(12));
    Image last;
    int frames = 0;
    WindowOptions options;
    options.input = folder / "ball.obj";
    options.width = 320;
    options.height = 240;
    options.panel.is_hidden = true;
    options.panel.left.settings.engine = engine;
    options.on_frame = [&](const Image& shown, const Session& session) {
        EXPECT_EQ(session.state().message, "");
        frames += session.state().is_solved && !session.state().is_draft;
        last = shown;
        return frames < 4 && session.state().message.empty();
    };
    (void)show_window(options);
    return last;
}

TEST_F(Window, AnswersOfTheGpuLookLikeTheCpus)
{
    for (const Engine engine : {Engine::disks, Engine::masks}) {
        EngineSettings settings;
        settings.engine = engine;
        const Image expected = picture_of_ball(settings);
        settings.device = Device::gpu;
        const Image found = picture_of_ball(settings);
        ASSERT_EQ(found.pixels.size(), expected.pixels.size());
        double sum = 0.0;
        for (std::size_t i = 0; i < found.pixels.size(); ++i)
            sum += std::abs(found.pixels[i].r - expected.pixels[i].r);
        EXPECT_LT(sum / static_cast<double>(found.pixels.size()), 1.0 / 255.0) << name_of(engine);
        EXPECT_GT(share(found, is_light), 0.05);
    }
}

// The widget opens a list of two, the second of which is taken. The box has become small before.
TEST_F(Window, AnotherTargetInThePanelMakesTheModelAnewUnderTheSameCamera)
{
    int frames = 0, frames_after = 0;
    double small = 0.0, after = 0.0;
    WidgetFinder finder({60.0f}, 200.0f, 330.0f, 9.0f);
    ImVec2 widget(0.0f, 0.0f);
    WindowOptions options;
    options.input = box_file();
    options.width = 730;
    options.height = 500;
    options.on_frame = [&](const Image& shown, const Session& session) {
        if (!session.state().is_solved || session.state().is_draft)
            return true;
        const double light = share(shown, is_light);
        const bool is_new = session.state().model->settings.values == VertexValues::point;
        if (is_new) {
            after = light;
            return ++frames_after < 4;
        }
        if (frames == 0 && finder.go_on())
            return true;
        ++frames;
        if (frames == 2) {
            widget = finder.place_of("values").value_or(widget);
            for (int i = 0; i < 5; ++i)
                press(GLFW_KEY_MINUS);
        }
        if (frames == 6)
            small = light;
        if (frames == 8 || frames == 11)
            click(widget.x, widget.y, frames == 8 ? GLFW_PRESS : GLFW_RELEASE);
        const float second = widget.y + 2.2f * ImGui::GetFrameHeight();
        if (frames == 14 || frames == 17)
            click(widget.x, second, frames == 14 ? GLFW_PRESS : GLFW_RELEASE);
        return frames < 200;
    };
    (void)show_window(options);
    EXPECT_EQ(frames_after, 4);
    EXPECT_GT(small, 0.001);
    EXPECT_NEAR(after, small, 0.1 * small);
}

// The borders of charts, and nothing else, are of that orange.
TEST_F(Window, AMapIsShownOnTheModelAndFlat)
{
    const std::filesystem::path file =
        std::filesystem::path(testing::TempDir()) / "surfelao_window_map.obj";
    std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                           "vt .2 .2\nvt .8 .2\nvt .8 .8\nvt .2 .8\nf 1/1 2/2 3/3 4/4\n";
    const auto is_border = [](const glm::vec4& p) {
        return p.r > 0.9f && p.g < 0.5f && p.b < 0.1f;
    };
    int frames = 0;
    double on_model = 0.0, flat = 0.0;
    WindowOptions options;
    options.input = file;
    options.panel.left.settings.texels.emplace().size = 64;
    options.on_frame = [&](const Image& shown, const Session& session) {
        frames += session.state().is_solved && !session.state().is_draft;
        (frames <= 3 ? on_model : flat) = share(shown, is_border);
        if (frames == 3)
            press(GLFW_KEY_A);
        return frames < 7;
    };
    (void)show_window(options);
    EXPECT_EQ(on_model, 0.0);
    EXPECT_GT(flat, 0.001);
    EXPECT_LT(flat, 0.01);
}

TEST_F(Window, MayGetAsSmallAsItWill)
{
    int frames = 0;
    WindowOptions options;
    options.input = box_file();
    options.width = 320;
    options.height = 240;
    options.panel.beside = Beside::side_by_side;
    options.panel.reference_rays = 2;
    options.on_frame = [&](const Image& shown, const Session& session) {
        const int sizes[][2] = {{1, 1}, {2, 1}, {1, 300}, {700, 20}, {400, 300}};
        if (session.state().is_solved && ++frames <= 5)
            glfwSetWindowSize(glfwGetCurrentContext(), sizes[frames - 1][0], sizes[frames - 1][1]);
        return frames < 6 || (shown.width != 400 && frames < 100);
    };
    (void)show_window(options);
    EXPECT_GE(frames, 6);
}

TEST_F(Window, EverySurfaceAndColourIsDrawn)
{
    for (int colors = 0; colors < 7; ++colors) {
        WindowOptions options;
        options.input = box_file();
        options.width = 320;
        options.height = 240;
        options.panel.view.surface = static_cast<Shape>(colors % 4);
        options.panel.view.colors = static_cast<Colors>(colors);
        options.panel.reference_rays = 2;
        options.on_frame = [&](const Image&, const Session& session) {
            EXPECT_EQ(session.state().message, "");
            return !session.state().is_solved;
        };
        (void)show_window(options);
    }
}

TEST_F(Window, AFileThatCannotBeReadIsNoCrash)
{
    std::string message;
    WindowOptions options;
    options.input = "none.obj";
    options.width = 320;
    options.height = 240;
    options.on_frame = [&](const Image&, const Session& session) {
        message = session.state().message;
        return message.empty();
    };
    (void)show_window(options);
    EXPECT_NE(message.find("none.obj"), std::string::npos);
}

// In the environment of the tests that have no display this is the only one that runs.
TEST(WindowWithoutDisplay, IsAClearError)
{
    if (std::getenv("DISPLAY"))
        GTEST_SKIP() << "there is a display";
    try {
        (void)show_window({});
        FAIL() << "a window was opened";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("no window can be opened: "), std::string::npos);
    }
}

}  // namespace
}  // namespace surfelao
