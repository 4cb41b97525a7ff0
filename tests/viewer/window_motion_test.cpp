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

}  // namespace
}  // namespace surfelao
