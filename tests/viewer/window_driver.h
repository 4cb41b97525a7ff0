/// window_driver.h: a window for tests, on the display that DISPLAY names, and what comes to it as
/// the window system brings it, by GLFW's callbacks of the window.
#pragma once

#include "files/scene_io.h"
#include "image/image.h"
#include "scenes.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace surfelao {

class Window : public testing::Test {
protected:
    void SetUp() override
    {
        if (!std::getenv("DISPLAY"))
            GTEST_SKIP() << "there is no display";
    }
};

/// A box, as a file of its own for each test.
inline std::filesystem::path box_file()
{
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) /
        (std::string("surfelao_window_") +
         testing::UnitTest::GetInstance()->current_test_info()->name() + ".ply");
    const Scene box = scenes::box({0, 0, 0}, {1, 1, 1}, 4);
    write_scene(path, box, std::vector<Occlusion>(box.positions.size()));
    return path;
}

/// A key goes down and up again before the next frame.
inline void press(int key)
{
    GLFWwindow* window = glfwGetCurrentContext();
    const GLFWkeyfun callback = glfwSetKeyCallback(window, nullptr);
    glfwSetKeyCallback(window, callback);
    const int scancode = glfwGetKeyScancode(key);
    callback(window, key, scancode, GLFW_PRESS, 0);
    callback(window, key, scancode, GLFW_RELEASE, 0);
}

/// A key goes down or up.
inline void hold(int key, int action)
{
    GLFWwindow* window = glfwGetCurrentContext();
    const GLFWkeyfun callback = glfwSetKeyCallback(window, nullptr);
    glfwSetKeyCallback(window, callback);
    callback(window, key, glfwGetKeyScancode(key), action, 0);
}

/// The left button goes down there and is let go a call later.
inline void click(double x, double y, int action)
{
    GLFWwindow* window = glfwGetCurrentContext();
    glfwSetCursorPos(window, x, y);
    const GLFWmousebuttonfun callback = glfwSetMouseButtonCallback(window, nullptr);
    glfwSetMouseButtonCallback(window, callback);
    callback(window, GLFW_MOUSE_BUTTON_LEFT, action, 0);
}

inline double share(const Image& image, auto condition)
{
    return static_cast<double>(std::count_if(image.pixels.begin(), image.pixels.end(), condition)) /
           static_cast<double>(image.pixels.size());
}

}  // namespace surfelao
