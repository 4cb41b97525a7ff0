// Every control of the window, clicked as a user does, with a picture after each click: for eyes,
// and for what must not break. Minutes long, so it runs when it is asked for, at any scale:
//
//   tests/bench/viewers/window_click.sh BUILD OUT

#include "image/image_file.h"
#include "temporary_folder.h"
#include "viewer/window.h"
#include "widget_finder.h"
#include "window_driver.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

constexpr int kRest = 1;        // frames until widgets stand still
constexpr int kMostPasses = 2;  // what a click has opened is clicked in the next one

/// Finds all that is under the mouse in the panel, clicks each once, and closes what has opened.
class Clicker {
public:
    explicit Clicker(fs::path pictures) : pictures_(std::move(pictures)) {}

    /// Once a frame. False at the end.
    bool go_on(const Image& shown)
    {
        if (wait_ > 0) {
            --wait_;
            return true;
        }
        if (!steps_.empty()) {
            const auto step = steps_.front();
            steps_.pop_front();
            wait_ = kRest;
            step(shown);
            return true;
        }
        return find_next(shown);
    }

    std::size_t clicked() const { return done_.size(); }

private:
    using Step = std::function<void(const Image&)>;

    void keep(const Image& shown, const std::string& what)
    {
        char number[16];
        std::snprintf(number, sizeof number, "%03d", kept_++);
        write_image(pictures_.string() + number + what + ".png", shown);
    }

    /// What was not clicked yet, from below: what a click opens or closes moves what is under it.
    bool find_next(const Image& shown)
    {
        if (!finder_) {
            const ImGuiWindow* panel = ImGui::FindWindowByName("surfelao");
            const float step = 0.9f * ImGui::GetFontSize(), right = panel->SizeFull.x;
            finder_.emplace(std::vector<float>{0.07f * right, 0.5f * right},
                            1.5f * ImGui::GetFrameHeight(), panel->SizeFull.y - step, step);
        }
        if (finder_->go_on())
            return true;
        std::vector<ImVec2> places;
        for (const auto& [id, found] : finder_->found()) {
            if (done_.insert(id).second)
                places.push_back(found.middle());
        }
        finder_.reset();
        std::ranges::sort(places, {}, [](ImVec2 place) { return -place.y; });
        for (const ImVec2 place : places)
            add_click(place);
        if (places.empty() || ++passes_ > kMostPasses) {
            keep(shown, "end");
            return false;
        }
        return true;
    }

    void add_click(ImVec2 place)
    {
        // beside what is open, so that it closes
        const auto click_beside = [](int action) {
            const ImVec2 display = ImGui::GetIO().DisplaySize;
            click(display.x - 3.0, display.y - 3.0, action);
        };
        steps_.insert(steps_.end(), {[=](const Image&) { click(place.x, place.y, GLFW_PRESS); },
                                     [=](const Image&) { click(place.x, place.y, GLFW_RELEASE); },
                                     [this](const Image& shown) {
                                         keep(shown, "");
                                         press(GLFW_KEY_ESCAPE);
                                     },
                                     [=](const Image&) { click_beside(GLFW_PRESS); },
                                     [=](const Image&) { click_beside(GLFW_RELEASE); }});
    }

    fs::path pictures_;
    int kept_ = 0;
    int passes_ = 0;
    std::deque<Step> steps_;
    std::optional<WidgetFinder> finder_;
    std::set<ImGuiID> done_;
    int wait_ = kRest;
};

struct Start {
    std::string name;
    PanelState panel;
    fs::path input;
    std::vector<fs::path> others = {};
};

std::vector<Start> starts()
{
    const fs::path data = std::getenv("SURFELAO_DATA");
    std::vector<Start> all(7);
    all[0] = {"disks-", {}, data / "room.obj"};
    all[0].panel.left.settings.engine.engine = Engine::disks;
    all[0].panel.beside = Beside::side_by_side;
    all[0].panel.reference_rays = 16;
    all[1] = {"map-", {}, data / "room.obj"};
    all[1].panel.left.settings.texels.emplace().size = 256;
    all[1].panel.view.colors = Colors::environment;
    all[2] = {"screen-", {}, data / "room.obj"};
    all[2].panel.left.at_pixels = true;
    all[2].panel.left.screen = screen_settings(ScreenMethod::vo, 24);
    all[2].panel.left.settings.max_distance = {10.0, true};
    all[2].panel.beside = Beside::wipe;
    all[3] = {"animated-", {}, data / "robot.glb"};
    all[4] = {"nothing-", {}, {}};
    all[5] = {"grid-", {}, data / "bracket.obj"};
    all[5].panel.left.at_pixels = true;
    all[5].panel.left.grid.emplace().resolution = 16;
    all[5].panel.view.background = glm::vec4(0.0f);
    all[6] = {"maps-", {}, data / "room.obj"};
    all[6].panel.left.at_pixels = all[6].panel.left.from_maps = true;
    all[6].panel.left.screen = cube_horizon();
    all[6].others = {data / "bracket.obj"};
    for (Start& start : all)  // from outside into the room
        start.panel.view.cull = true;
    return all;
}

TEST_F(Window, DISABLED_EveryControlIsClicked)
{
    const char* out = std::getenv("SURFELAO_PICTURES");
    ASSERT_TRUE(out != nullptr && std::getenv("SURFELAO_DATA") != nullptr);
    const TemporaryFolder folder;
    fs::current_path(folder.path());
    const char* only = std::getenv("SURFELAO_START");
    for (const Start& start : starts()) {
        if (only && start.name != only + std::string("-"))
            continue;
        Clicker clicker(fs::path(out) / start.name);
        bool is_ready = start.input.empty();
        WindowOptions options;
        options.input = start.input;
        options.more_inputs = start.others;
        options.up = start.input.filename() == "room.obj" ? UpAxis::z : UpAxis::y;
        options.width = 760;
        options.height = 1000;
        options.panel = start.panel;
        options.recent_list = folder / "recent";
        options.on_frame = [&](const Image& shown, const Session& session) {
            EXPECT_EQ(session.state().message, "");
            is_ready |= session.state().is_solved;
            return !is_ready || clicker.go_on(shown);
        };
        (void)show_window(options);
        EXPECT_GT(clicker.clicked(), start.input.empty() ? 5u : 20u) << start.name;
    }
}

}  // namespace
}  // namespace surfelao
