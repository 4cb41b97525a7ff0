// Parts that are moved in the window: see window_test.cpp.

#include "viewer/window.h"

#include "window_driver.h"

namespace surfelao {
namespace {

// Its gizmo is drawn where it is then: the green of its second axis is nowhere else.
TEST_F(Window, AClickSelectsAPartAndEscapeLeavesIt)
{
    const auto is_axis = [](const glm::vec4& p) { return p.g > 0.5f && p.r < 0.25f && p.b < 0.1f; };
    int frames = 0;
    double before = 0.0, selected = 0.0, left = 0.0;
    WindowOptions options;
    options.input = box_file();
    options.width = 400;
    options.height = 300;
    options.panel.is_hidden = true;
    options.on_frame = [&](const Image& shown, const Session& session) {
        frames += session.state().is_solved && !session.state().is_draft;
        if (frames == 12)
            before = share(shown, is_axis);
        if (frames == 12 || frames == 15)
            click(200, 150, frames == 12 ? GLFW_PRESS : GLFW_RELEASE);
        if (frames == 20)
            selected = share(shown, is_axis);
        if (frames == 20)
            press(GLFW_KEY_ESCAPE);
        left = share(shown, is_axis);
        return frames < 24;
    };
    (void)show_window(options);
    EXPECT_EQ(before, 0.0);
    EXPECT_GT(selected, 0.0005);
    EXPECT_EQ(left, 0.0);
}

// W means wipe elsewhere; a picture that has moved comes to its rest again.
TEST_F(Window, InFlightAHeldKeyMovesTheCameraUntilItIsLetGo)
{
    const auto is_box = [](const glm::vec4& p) { return p.r > 0.7f; };
    int frames = 0, frames_in_flight = 0, frames_after = 0;
    double before = 0.0, after = 0.0, released = 0.0, rested = 0.0;
    WindowOptions options;
    options.input = box_file();
    options.width = 200;
    options.height = 150;
    options.panel.is_hidden = true;
    options.panel.flight.speed = 1.0f;
    options.on_frame = [&](const Image& shown, const Session& session) {
        frames += session.state().is_solved && !session.state().is_draft;
        const double seen = share(shown, is_box);
        if (frames == 5) {
            before = seen;
            press(GLFW_KEY_V);
            hold(GLFW_KEY_W, GLFW_PRESS);
        }
        if (frames > 5 && frames_after == 0 && (seen > 1.3 * before || ++frames_in_flight > 2000)) {
            after = seen;
            hold(GLFW_KEY_W, GLFW_RELEASE);
            ++frames_after;
        } else if (frames_after > 0) {
            ++frames_after;
        }
        if (frames_after == 10)
            released = seen;
        rested = seen;
        return frames_after < 40;
    };
    (void)show_window(options);
    EXPECT_GT(after, 1.3 * before);
    EXPECT_NEAR(rested, released, 0.01) << "but for smoother edges";
}

}  // namespace
}  // namespace surfelao
