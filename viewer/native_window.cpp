#include "viewer/native_window.h"

#include "viewer/flight.h"
#include "viewer/panel.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

namespace surfelao {
namespace {

std::runtime_error no_window()
{
    const char* text = nullptr;
    glfwGetError(&text);
    return std::runtime_error(std::string("no window can be opened: ") +
                              (text ? text : "the window system gives no reason"));
}

Inbox& inbox_of(GLFWwindow* window)
{
    return *static_cast<Inbox*>(glfwGetWindowUserPointer(window));
}

/// What the keyboard's layout has printed on the key, as Panel::build wants it; 0 = nothing.
char sign_of(int key, int scancode)
{
    switch (key) {
        case GLFW_KEY_ESCAPE:
            return Panel::kEscape;
        case GLFW_KEY_TAB:
            return Panel::kTab;
        case GLFW_KEY_SPACE:
            return Panel::kSpace;
        case GLFW_KEY_KP_ADD:
            return '+';
        case GLFW_KEY_KP_SUBTRACT:
            return '-';
        default:
            break;
    }
    if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9)  // whatever else stands on digits
        return static_cast<char>('0' + (key - GLFW_KEY_0));
    const char* name = glfwGetKeyName(key, scancode);
    if (name == nullptr || name[0] == 0 || name[1] != 0)
        return 0;
    return name[0] >= 'a' && name[0] <= 'z' ? static_cast<char>(name[0] - 'a' + 'A') : name[0];
}

/// Keys are where they are on a US layout, whatever is printed there.
void hold_key(std::string& held, int key, int action)
{
    if (key < GLFW_KEY_A || key > GLFW_KEY_Z)
        return;
    const char sign = static_cast<char>('A' + (key - GLFW_KEY_A));
    if (kFlightKeys.find(sign) == std::string_view::npos)
        return;
    if (action == GLFW_PRESS)
        held += sign;
    else if (action == GLFW_RELEASE)
        std::erase(held, sign);
}

}  // namespace

WindowSystem::WindowSystem()
{
    if (!glfwInit())
        throw no_window();
}

WindowSystem::~WindowSystem()
{
    glfwTerminate();
}

void CloseWindow::operator()(GLFWwindow* window) const
{
    glfwDestroyWindow(window);
}

WindowHandle open_window(int width, int height)
{
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    WindowHandle window(glfwCreateWindow(width, height, "surfelao", nullptr, nullptr));
    if (!window)
        throw no_window();
    return window;
}

GlContext adopt_context(GLFWwindow* window)
{
    return GlContext::adopt({
        [](const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); },
        [window] { glfwMakeContextCurrent(window); },
        [] { glfwMakeContextCurrent(nullptr); },
    });
}

float content_scale(GLFWwindow* window)
{
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window, &x, &y);
    return std::max(1.0f, y);
}

Inbox::Inbox(GLFWwindow* window)
{
    glfwSetWindowUserPointer(window, this);
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** dropped) {
        inbox_of(w).paths.insert(inbox_of(w).paths.end(), dropped, dropped + count);
    });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
        hold_key(inbox_of(w).held, key, action);
        const char sign = sign_of(key, scancode);
        const bool zooms = sign == '+' || sign == '=' || sign == '-';
        const bool down = action == GLFW_PRESS || (action == GLFW_REPEAT && zooms);
        if (down && sign != 0 && (mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) == 0)
            inbox_of(w).keys += sign;
    });
}

}  // namespace surfelao
