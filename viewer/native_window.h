/// native_window.h: windows, keys and dropped files of the window system. All for the main thread.
#pragma once

#include "gpu/context.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace surfelao {

/// The window system, for as long as a window is wanted. At most one at a time.
class WindowSystem {
public:
    /// Throws std::runtime_error with the system's reason where no window can be opened.
    WindowSystem();
    ~WindowSystem();
    WindowSystem(const WindowSystem&) = delete;
    WindowSystem& operator=(const WindowSystem&) = delete;
};

struct CloseWindow {
    void operator()(GLFWwindow* window) const;
};
using WindowHandle = std::unique_ptr<GLFWwindow, CloseWindow>;

/// A window with an OpenGL 3.3 context, so wide and high in pixels of a display of 96 dpi. Throws
/// std::runtime_error with the system's reason.
[[nodiscard]] WindowHandle open_window(int width, int height);

/// Takes part in the window's context, which is current in this thread afterwards.
[[nodiscard]] GlContext adopt_context(GLFWwindow* window);

/// How many times larger than usual things are to be drawn on the window's display; at least 1.
[[nodiscard]] float content_scale(GLFWwindow* window);

/// What was pressed and dropped since it was last looked at. A key that goes down and up again
/// while one frame is drawn still counts. One per window, which it must not outlive.
struct Inbox {
    std::string keys;                          ///< see Panel::build
    std::vector<std::filesystem::path> paths;  ///< dropped
    /// Of kFlightKeys (flight.h), by their place on the keyboard: those down now.
    std::string held;

    explicit Inbox(GLFWwindow* window);
    Inbox(const Inbox&) = delete;
    Inbox& operator=(const Inbox&) = delete;
};

}  // namespace surfelao
