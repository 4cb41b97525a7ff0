// Files that are opened and saved: lists of them, and the window on a display (window_test.cpp).

#include "files/scene_io.h"
#include "image/image_file.h"
#include "temporary_folder.h"
#include "viewer/folder_list.h"
#include "viewer/open_files.h"
#include "viewer/recent_files.h"
#include "viewer/window.h"
#include "widget_finder.h"
#include "window_driver.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

TEST(FolderList, ShowsFoldersThenWhatIsWantedByNameAndNothingHidden)
{
    const TemporaryFolder folder;
    for (const char* name : {"b.ply", "A.ply", "c.txt", ".d.ply"})
        folder.file(name, "x");
    fs::create_directory(folder / "z");
    fs::create_directory(folder / ".z");
    std::string fault;
    const auto found = entries_of(
        folder.path(), [](const fs::path& file) { return file.extension() == ".ply"; }, fault);
    EXPECT_EQ(found, (std::vector<FolderEntry>{{"z", true}, {"A.ply", false}, {"b.ply", false}}));
    EXPECT_EQ(fault, "");
    EXPECT_TRUE(entries_of(
                    folder / "none", [](const fs::path&) { return true; }, fault)
                    .empty());
    EXPECT_NE(fault.find("none cannot be read: "), std::string::npos) << fault;
}

TEST(RecentFiles, AreTheLastTenThatAreThereTheLastFirst)
{
    const TemporaryFolder folder;
    const fs::path list = folder / "state" / "surfelao" / "recent";
    RecentFiles kept(list);
    for (int i = 0; i < 12; ++i)
        kept.add(folder.file(std::to_string(i), "x"));
    kept.add(folder / "5");
    EXPECT_EQ(kept.files().size(), kMostRecent);
    EXPECT_EQ(kept.files(), RecentFiles(list).files());
    fs::remove(folder / "9");
    const RecentFiles found(list);
    EXPECT_EQ(found.files().size(), 9u);
    EXPECT_EQ(found.files()[0], folder / "5");
    EXPECT_EQ(found.files()[1], folder / "11");
    EXPECT_EQ(found.files().back(), folder / "2");
}

TEST(RecentFiles, StandWhereTheDesktopKeepsStates)
{
    setenv("XDG_STATE_HOME", "/s", 1);
    EXPECT_EQ(recent_list_path(), "/s/surfelao/recent");
    setenv("XDG_STATE_HOME", "not/absolute", 1);  // the specification: to be ignored
    setenv("HOME", "/h", 1);
    EXPECT_EQ(recent_list_path(), "/h/.local/state/surfelao/recent");
    unsetenv("XDG_STATE_HOME");
    RecentFiles nowhere("/proc/nowhere/recent");
    nowhere.add("/proc/version");
    EXPECT_EQ(RecentFiles("").files().size(), 0u);
}

TEST(OpenFiles, ThoseThatAreOnStandInOneWorldWhereTheyAreTogether)
{
    OpenFiles files;
    for (const char* file : {"/a", "/b", "/a", "/c"})
        files.add(file);
    EXPECT_EQ(files.all(), (OpenFiles::Paths{"/a", "/b", "/c"}));
    EXPECT_EQ(files.beside("/b"), OpenFiles::Paths{});
    files.are_together = true;
    EXPECT_EQ(files.beside("/b"), (OpenFiles::Paths{"/a", "/c"}));
    files.turn("/a", false);
    EXPECT_EQ(files.beside("/b"), (OpenFiles::Paths{"/c"}));
    files.turn("/a", true);
    files.forget("/c");
    EXPECT_EQ(files.beside("/b"), (OpenFiles::Paths{"/a"}));
}

void hold(int key, int action)
{
    GLFWwindow* window = glfwGetCurrentContext();
    const GLFWkeyfun callback = glfwSetKeyCallback(window, nullptr);
    glfwSetKeyCallback(window, callback);
    callback(window, key, glfwGetKeyScancode(key), action, 0);
}

void type(const std::string& text)
{
    GLFWwindow* window = glfwGetCurrentContext();
    const GLFWcharfun callback = glfwSetCharCallback(window, nullptr);
    glfwSetCharCallback(window, callback);
    for (const char sign : text)
        callback(window, static_cast<unsigned char>(sign));
}

TEST_F(Window, OpensAFileWhosePathIsTypedAndRemembersIt)
{
    const TemporaryFolder folder;
    const fs::path file = box_file();
    fs::path shown;
    int frames = 0;
    WindowOptions options;
    options.width = 700;
    options.height = 500;
    options.recent_list = folder / "recent";
    options.on_frame = [&](const Image&, const Session& session) {
        ++frames;
        if (frames == 2)
            press(GLFW_KEY_O);
        if (frames == 8)
            type(file.string());
        if (frames == 10 || frames == 12)
            hold(GLFW_KEY_ENTER, frames == 10 ? GLFW_PRESS : GLFW_RELEASE);
        shown = session.state().path;
        return shown.empty() && frames < 2000;
    };
    (void)show_window(options);
    EXPECT_EQ(shown, file);
    EXPECT_EQ(contents_of(folder / "recent"), file.string() + '\n');
}

/// A square with texture coordinates, and a picture on it.
fs::path textured_square(const TemporaryFolder& folder)
{
    write_image(folder / "paint.png", Image(2, 2));
    folder.file("square.mtl", "newmtl m\nmap_Kd paint.png\n");
    return folder.file("square.obj",
                       "mtllib square.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                       "vt .2 .2\nvt .8 .2\nvt .8 .8\nvt .2 .8\nusemtl m\n"
                       "f 1/1 2/2 3/3 4/4\n");
}

/// Presses one key a frame once there is an answer.
std::vector<fs::path> saved_by(WindowOptions options, const std::vector<int>& keys)
{
    std::size_t frames = 0;
    options.width = 320;
    options.height = 240;
    options.panel.is_hidden = true;
    options.on_frame = [&](const Image&, const Session& session) {
        if (!session.state().is_solved || session.state().is_draft)
            return true;
        if (frames < keys.size())
            press(keys[frames]);
        return ++frames < keys.size() + 3;
    };
    return show_window(options);
}

// Its map and its materials are files of their own; a texture of the input is an input.
TEST_F(Window, NothingBesideAResultIsLostEither)
{
    const TemporaryFolder folder;
    WindowOptions options;
    options.input = textured_square(folder);
    options.panel.left.settings.texels.emplace().size = 64;
    options.panel.paths = {folder / "paint.png", folder / "x.obj"};
    const std::string paint = contents_of(folder / "paint.png");
    EXPECT_EQ(saved_by(options, {GLFW_KEY_P, GLFW_KEY_R, GLFW_KEY_ESCAPE, GLFW_KEY_B}),
              (std::vector<fs::path>{folder / "x.obj", folder / "x.ao.png", folder / "x.ao.mtl"}));
    EXPECT_EQ(contents_of(folder / "paint.png"), paint);
    folder.file("x-2.ao.png", "mine");
    EXPECT_TRUE(saved_by(options, {GLFW_KEY_B, GLFW_KEY_ESCAPE}).empty());
    EXPECT_EQ(
        saved_by(options, {GLFW_KEY_B, GLFW_KEY_K}),
        (std::vector<fs::path>{folder / "x-3.obj", folder / "x-3.ao.png", folder / "x-3.ao.mtl"}));
    EXPECT_EQ(contents_of(folder / "x-2.ao.png"), "mine");
}

// The line is of an even grey, in the middle; a plate begins left and right of it.
TEST_F(Window, ASavedPictureKeepsTheLineAndTheLabelsOfBothSides)
{
    const TemporaryFolder folder;
    WindowOptions options;
    options.input = box_file();
    options.panel.beside = Beside::side_by_side;
    options.panel.reference_rays = 2;
    options.panel.paths.picture = folder / "x.png";
    (void)saved_by(options, {GLFW_KEY_P});
    const Image saved = read_image(folder / "x.png");
    ASSERT_EQ(saved.width, 320);
    EXPECT_NEAR(saved.at(160, 10).r, 0.8f, 0.01f);
    EXPECT_NEAR(saved.at(160, 230).r, 0.8f, 0.01f);
    EXPECT_LT(saved.at(160 - 7, 7).r, 0.02f);
    EXPECT_LT(saved.at(160 + 8, 7).r, 0.02f);
}

// What is behind the box is transparent in the file, and checks on the screen.
TEST_F(Window, APictureIsSavedWithoutABackground)
{
    const TemporaryFolder folder;
    WindowOptions options;
    options.input = box_file();
    options.panel.view.background = glm::vec4(0.0f);
    options.panel.view.ground = false;
    options.panel.paths.picture = folder / "x.png";
    Image last;
    options.width = 320;
    options.height = 240;
    options.panel.is_hidden = true;
    int frames = 0;
    options.on_frame = [&](const Image& shown, const Session& session) {
        last = shown;
        if (!session.state().is_solved || session.state().is_draft)
            return true;
        if (frames == 1)
            press(GLFW_KEY_P);
        return ++frames < 4;
    };
    (void)show_window(options);
    const Image saved = read_image(folder / "x.png");
    EXPECT_EQ(saved.at(2, 2).a, 0.0f);
    EXPECT_EQ(saved.at(160, 120).a, 1.0f);
    EXPECT_NE(last.at(2, 2).r, last.at(2 + 12, 2).r);
    EXPECT_EQ(last.at(2, 2).r, last.at(2 + 24, 2).r);
}

TEST_F(Window, FilesInOneWorldAreShownTogether)
{
    const TemporaryFolder folder;
    const fs::path box = box_file();
    const Scene ball = scenes::bumpy_sphere(6);
    write_obj(folder / "ball.obj", ball);
    WidgetFinder finder({30.0f}, 60.0f, 160.0f, 8.0f);
    int step = 0;
    std::size_t shown = 0;
    WindowOptions options;
    options.input = box;
    options.more_inputs = {folder / "ball.obj"};
    options.width = 724;
    options.height = 500;
    options.on_frame = [&](const Image&, const Session& session) {
        if (!session.state().is_solved || session.state().is_draft || finder.go_on())
            return true;
        const std::optional<ImVec2> tick = finder.place_of("in one world");
        if (!tick)
            return false;
        if (step < 2)
            click(tick->x, tick->y, step++ == 0 ? GLFW_PRESS : GLFW_RELEASE);
        shown = session.state().model->geometry().positions.size();
        return session.state().beside.empty();
    };
    (void)show_window(options);
    EXPECT_EQ(shown, read_scene(box).positions.size() + ball.positions.size());
}

// Saving reads from the device, where widgets must not be drawn then.
TEST_F(Window, TheWidgetsStayWhileAPictureIsSaved)
{
    const TemporaryFolder folder;
    int frames = 0;
    double least = 1.0;
    WindowOptions options;
    options.input = box_file();
    options.width = 740;
    options.height = 300;
    options.panel.paths.picture = folder / "x.png";
    options.on_frame = [&](const Image& shown, const Session& session) {
        if (!session.state().is_solved || session.state().is_draft)
            return true;
        if (frames == 2)
            press(GLFW_KEY_P);
        least = std::min(least, share(shown, [](const glm::vec4& p) {
                             return p.b > 0.03f && p.b > 3.0f * p.r;
                         }));
        return ++frames < 6;
    };
    (void)show_window(options);
    EXPECT_EQ(folder.file_count(), 1);
    EXPECT_GT(least, 0.01);
}

// Also where a click on the panel has come after the key.
TEST_F(Window, TheKeysStandOverThePanelAndWithinANarrowWindow)
{
    int frames = 0;
    bool is_shown = false, is_behind = false, is_within = true;
    WindowOptions options;
    options.input = box_file();
    options.width = 420;
    options.height = 300;
    options.on_frame = [&](const Image&, const Session&) {
        ++frames;
        if (frames == 2)
            press(GLFW_KEY_H);
        if (frames == 4 || frames == 6)
            click(200.0, 5.0, frames == 4 ? GLFW_PRESS : GLFW_RELEASE);
        if (frames < 8)
            return true;
        const ImVector<ImGuiWindow*>& order = ImGui::GetCurrentContext()->Windows;
        const ImGuiWindow* keys = ImGui::FindWindowByName("Keys");
        is_shown = keys && keys->Active;
        is_behind = std::ranges::find(order, keys) <
                    std::ranges::find(order, ImGui::FindWindowByName("surfelao"));
        is_within = keys && keys->Pos.x >= 0.0f && keys->Pos.x + keys->Size.x <= 420.0f &&
                    keys->Pos.y + keys->Size.y <= 300.0f;
        return false;
    };
    (void)show_window(options);
    EXPECT_TRUE(is_shown);
    EXPECT_FALSE(is_behind);
    EXPECT_TRUE(is_within);
}

// Under the mouse: the panel's left column. Titles of sections say what they do.
TEST_F(Window, EveryWidgetSaysWhatItDoes)
{
    WidgetFinder finder({30.0f}, 25.0f, 850.0f, 14.0f);
    std::size_t with_tip = 0;
    std::vector<float> without;
    WindowOptions options;
    options.input = box_file();
    options.width = 724;
    options.height = 860;
    options.panel.beside = Beside::side_by_side;
    options.panel.reference_rays = 2;
    options.panel.left.settings.engine.engine = Engine::disks;
    options.on_frame = [&](const Image&, const Session& session) {
        if (!session.state().is_solved || session.state().is_draft || finder.go_on())
            return true;
        const ImGuiWindow* panel = ImGui::FindWindowByName("surfelao");
        for (const auto& [id, found] : finder.found()) {
            const auto is_called = [id = id, panel](const char* title) {
                return const_cast<ImGuiWindow*>(panel)->GetID(title) == id;
            };
            with_tip += found.has_tip;
            const bool is_title = is_called("Solve") || is_called("Parts") || is_called("Show") ||
                                  is_called("Compare") || is_called("Move") || is_called("Save");
            if (!found.has_tip && !is_title)
                without.push_back(found.first.y);
        }
        return false;
    };
    (void)show_window(options);
    EXPECT_GT(with_tip, 15u);
    EXPECT_EQ(without, std::vector<float>());
}

}  // namespace
}  // namespace surfelao
