#include "viewer/window.h"

#include "files/scene_io.h"
#include "gpu/context.h"
#include "image/image_file.h"
#include "surfels/errors.h"
#include "viewer/render.h"
#include "viewer/renderer.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

constexpr int kMostSamples = 32;       // a view at rest is done then
constexpr double kPollSeconds = 0.03;  // while something runs in the background
constexpr double kIdleSeconds = 0.5;
constexpr int kEchoFrames = 4;  // after an event: widgets take some until they stand still

/// The window system, for as long as a window is wanted.
class WindowSystem {
public:
    WindowSystem()
    {
        if (!glfwInit())
            throw std::runtime_error("no window can be opened: " + reason());
    }
    ~WindowSystem() { glfwTerminate(); }
    WindowSystem(const WindowSystem&) = delete;
    WindowSystem& operator=(const WindowSystem&) = delete;

    static std::string reason()
    {
        const char* text = nullptr;
        glfwGetError(&text);
        return text ? text : "the window system gives no reason";
    }
};

struct CloseWindow {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using WindowHandle = std::unique_ptr<GLFWwindow, CloseWindow>;

/// What was pressed and dropped since it was last looked at. A key that goes down and up again
/// while one frame is drawn still counts.
struct Inbox {
    std::string keys;  ///< see Panel::build
    std::string path;  ///< the last file dropped

    explicit Inbox(GLFWwindow* window)
    {
        glfwSetWindowUserPointer(window, this);
        glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
            if (count > 0)
                of(w).path = paths[count - 1];
        });
        glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
            const char sign = sign_of(key, scancode);
            const bool zooms = sign == '+' || sign == '=' || sign == '-';
            const bool down = action == GLFW_PRESS || (action == GLFW_REPEAT && zooms);
            if (down && sign != 0 && (mods & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) == 0)
                of(w).keys += sign;
        });
    }
    Inbox(const Inbox&) = delete;
    Inbox& operator=(const Inbox&) = delete;

private:
    static Inbox& of(GLFWwindow* window)
    {
        return *static_cast<Inbox*>(glfwGetWindowUserPointer(window));
    }

    /// What the keyboard's layout has printed on the key, as Panel::build wants it; 0 = nothing.
    static char sign_of(int key, int scancode)
    {
        switch (key) {
            case GLFW_KEY_ESCAPE:
                return Panel::kEscape;
            case GLFW_KEY_TAB:
                return Panel::kTab;
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
};

/// A picture of the model in a part of the window, sample by sample.
struct Pane {
    Pane(const Renderer& renderer, const GlContext& context, const Rect& part, float wipe_at)
        : place(part),
          wipe(wipe_at),
          target(renderer.make_target(part.width, part.height)),
          sum(context, part.width, part.height)
    {
    }
    Rect place;
    float wipe;  ///< ViewOptions::wipe
    Framebuffer target;
    SampleSum sum;
};

/// Left and right of each other. They are of one height.
Image joined(const std::vector<Image>& images)
{
    int width = 0;
    for (const Image& image : images)
        width += image.width;
    Image all(width, images.front().height);
    int left = 0;
    for (const Image& image : images) {
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                all.at(left + x, y) = image.at(x, y);
        left += image.width;
    }
    return all;
}

WindowHandle open_window(int width, int height)
{
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    WindowHandle window(glfwCreateWindow(width, height, "surfelao", nullptr, nullptr));
    if (!window)
        throw std::runtime_error("no window can be opened: " + WindowSystem::reason());
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

/// The window with all that belongs to it, made and destroyed with its context current.
class Viewer {
public:
    Viewer(const WindowOptions& options, const Services& services, GLFWwindow* window)
        : options_(options),
          window_(window),
          inbox_(window),
          context_(adopt_context(window)),
          renderer_(context_),
          session_(services),
          panel_state_(options.panel),
          panel_(window, content_scale(window))
    {
        if (options.environment)
            renderer_.set_environment(*options.environment);
        panel_state_.wants_reference |= needs_reference(panel_state_);
        session_.solve(panel_state_.settings);
        if (!options.input.empty())
            session_.open(options.input, options.up);
    }

    void run()
    {
        bool keep_open = true;
        while (keep_open && options_.keep_open() && !glfwWindowShouldClose(window_)) {
            wait_for_events();
            int width = 0, height = 0;
            glfwGetFramebufferSize(window_, &width, &height);
            if (width > 0 && height > 0)  // a minimised window has no pixels
                keep_open = frame(width, height);
            else
                take_results();
        }
    }

private:
    static float content_scale(GLFWwindow* window)
    {
        float x = 1.0f, y = 1.0f;
        glfwGetWindowContentScale(window, &x, &y);
        return std::max(1.0f, y);
    }

    void wait_for_events()
    {
        const bool drawing = has_view() && (panes_.empty() || samples() < kMostSamples);
        if (drawing || options_.on_frame || echo_frames_ > 0) {
            glfwPollEvents();
            echo_frames_ = std::max(0, echo_frames_ - 1);
        } else {
            const double timeout =
                session_.solving() || session_.tracing() ? kPollSeconds : kIdleSeconds;
            const double start = glfwGetTime();
            glfwWaitEventsTimeout(timeout);
            if (glfwGetTime() - start < timeout)
                echo_frames_ = kEchoFrames;
        }
        if (!inbox_.path.empty())
            session_.open(std::exchange(inbox_.path, {}), options_.up);
    }

    bool has_view() const { return session_.state().model != nullptr; }

    /// What the background threads have finished goes to the device.
    void take_results()
    {
        const Session::Changes changes = session_.update();
        const SessionState& state = session_.state();
        try {
            if (changes.model) {
                note_.clear();
                renderer_.set_model(*state.model);
                glfwSetWindowTitle(window_,
                                   (state.path.filename().string() + " - surfelao").c_str());
                frame_all();
            }
            if (changes.occlusion)
                renderer_.set_occlusion(state.occlusion);
            if (changes.reference)
                renderer_.set_reference(state.reference);
            if (changes.model || changes.occlusion || changes.reference)
                restart();
        } catch (const std::exception& error) {
            note_ = error.what();
        }
    }

    void frame_all()
    {
        const Rect seen = panes_.empty() ? Rect{0, 0, 1, 1} : panes_.front().place;
        const Model& model = *session_.state().model;
        try {
            camera_ = parse_camera(
                options_.camera,
                {.points = model.seen,
                 .frame_centre = model.geometry.frame.centre,
                 .frame_diagonal = model.geometry.frame.diagonal,
                 .up = model.up,
                 .aspect = static_cast<float>(seen.width) / static_cast<float>(seen.height)});
        } catch (const InputError& error) {
            note_ = error.what();
            camera_ = frame_points(model.seen, model.up, 1.0f);
        }
        restart();
    }

    /// The picture begins anew.
    void restart()
    {
        for (Pane& pane : panes_)
            pane.sum.clear();
    }

    int samples() const { return panes_.empty() ? 0 : panes_.front().sum.count(); }

    /// The pictures in this part of the window; they begin anew where anything is other than it
    /// was.
    void lay_out(const Rect& part)
    {
        // a reference that is not there yet is not shown instead of the result
        const bool traced = !session_.state().reference.empty();
        const Comparison comparison = panel_state_.comparison;
        std::vector<std::pair<Rect, float>> wanted;
        if (comparison == Comparison::side_by_side && part.width > 1) {
            const int half = part.width / 2;
            wanted = {
                {{part.x, part.y, half, part.height}, 1.0f},
                {{part.x + half, part.y, part.width - half, part.height}, traced ? 0.0f : 1.0f}};
        } else {
            wanted = {{part, traced && comparison == Comparison::wipe ? panel_state_.wipe : 1.0f}};
        }
        const auto same = [](const Pane& pane, const std::pair<Rect, float>& other) {
            const Rect &a = pane.place, &b = other.first;
            return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height;
        };
        if (!std::equal(panes_.begin(), panes_.end(), wanted.begin(), wanted.end(), same)) {
            panes_.clear();
            for (const auto& [place, wipe] : wanted)
                panes_.emplace_back(renderer_, context_, place, wipe);
        }
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            if (std::exchange(panes_[i].wipe, wanted[i].second) != wanted[i].second)
                restart();
        }
    }

    /// One more sample of the model, then the widgets over it. False = close.
    bool frame(int width, int height)
    {
        take_results();
        const PanelInput input =
            panel_.build(panel_state_, session_, figures(), std::exchange(inbox_.keys, {}));
        const int covered = static_cast<int>(input.covered * static_cast<float>(width));
        const bool is_first = panes_.empty();
        lay_out({covered, 0, width - covered, height});
        if (is_first && has_view())
            frame_all();
        apply(input);

        const Framebuffer shown = Framebuffer::window(context_, width, height);
        shown.clear_color(glm::vec4(0.16f, 0.17f, 0.18f, 1.0f));
        if (has_view())
            draw_model(shown);
        panel_.draw();

        bool keep_open = !input.close;
        if (options_.on_frame)
            keep_open &= options_.on_frame(read_window(shown), session_);
        glfwSwapBuffers(window_);
        return keep_open;
    }

    /// Normals until the first values have come: all open is a silhouette without a shape.
    ViewOptions shown_view() const
    {
        const SessionState& state = session_.state();
        ViewOptions view = panel_state_.view;
        const bool has_values = !state.occlusion.empty() || view.colors == Colors::levels ||
                                (view.colors == Colors::rays && !state.reference.empty());
        if (!has_values)
            view.colors = Colors::normals;
        return view;
    }

    void draw_model(const Framebuffer& shown)
    {
        if (samples() < kMostSamples) {
            const auto start = std::chrono::steady_clock::now();
            for (Pane& pane : panes_) {
                ViewOptions view = shown_view();
                view.wipe = pane.wipe;
                renderer_.draw_frame(pane.target, camera_, view, sample_shift(pane.sum.count()));
                pane.sum.add(pane.target);
            }
            context_.finish("drawing the model");
            const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
            frame_ms_ = 1000.0 * passed.count();
        }
        for (const Pane& pane : panes_)
            pane.sum.show(shown, {pane.place.x, pane.place.y});
    }

    PanelFigures figures() const
    {
        const GlInfo& info = context_.info();
        return {frame_ms_, samples(), note_, info.renderer};
    }

    void apply(const PanelInput& input)
    {
        session_.solve(panel_state_.settings);
        session_.want_reference(panel_state_.wants_reference
                                    ? static_cast<std::uint32_t>(panel_state_.reference_rays)
                                    : 0);
        if (input.cancel) {
            if (session_.tracing())
                panel_state_.wants_reference = false;
            session_.cancel();
        }
        if (input.solve_again)
            session_.solve_again();
        if (input.frame_all && has_view())
            frame_all();
        if (input.orbit_deg != glm::vec2(0.0f)) {
            orbit(camera_, input.orbit_deg.x, input.orbit_deg.y);
            restart();
        }
        if (input.pan != glm::vec2(0.0f)) {
            pan(camera_, input.pan);
            restart();
        }
        if (input.zoom != 1.0f) {
            zoom(camera_, input.zoom);
            restart();
        }
        if (input.view_changed)
            restart();
        if (input.save_picture)
            save([&] { return save_picture(); });
        if (input.save_baked)
            save([&] { return save_baked(); });
    }

    /// Whatever fails is told in the window.
    template <class Work>
    void save(Work work)
    {
        try {
            note_ = work();
        } catch (const std::exception& error) {
            note_ = error.what();
        }
    }

    std::string save_picture()
    {
        if (!has_view() || samples() == 0)
            return "there is no picture yet";
        std::vector<Image> images;
        for (const Pane& pane : panes_)
            images.push_back(pane.sum.mean());
        Image image = joined(images);
        draw_legend(image, *session_.state().model, shown_view());
        write_image(panel_state_.picture_path, image);
        return std::string("saved ") + panel_state_.picture_path;
    }

    std::string save_baked()
    {
        const SessionState& state = session_.state();
        if (state.occlusion.empty())
            return "nothing is solved yet";
        check_output(state.path, panel_state_.baked_path);
        write_scene(panel_state_.baked_path, *state.scene,
                    std::span(state.occlusion).first(state.scene->positions.size()));
        return std::string("saved ") + panel_state_.baked_path +
               (state.is_draft ? ", of the draft" : "");
    }

    /// What is on the window now, as light.
    Image read_window(const Framebuffer& shown) const
    {
        Framebuffer copy(context_, {.width = shown.width(), .height = shown.height()});
        shown.copy_to(copy);
        const std::vector<glm::vec4> texels = copy.read_color(copy.rect());
        Image image(shown.width(), shown.height());
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                const std::size_t row = static_cast<std::size_t>(image.height - 1 - y);
                const glm::vec4 texel = texels[row * static_cast<std::size_t>(image.width) +
                                               static_cast<std::size_t>(x)];
                image.at(x, y) = glm::vec4(srgb_decode(texel.r), srgb_decode(texel.g),
                                           srgb_decode(texel.b), 1.0f);
            }
        }
        return image;
    }

    const WindowOptions& options_;
    GLFWwindow* window_;
    Inbox inbox_;
    GlContext context_;
    Renderer renderer_;
    Session session_;
    PanelState panel_state_;
    Panel panel_;
    Camera camera_;
    std::vector<Pane> panes_;
    std::string note_;
    double frame_ms_ = 0.0;
    int echo_frames_ = 0;
};

}  // namespace

void show_window(const WindowOptions& options, const Services& services)
{
    const WindowSystem system;
    const WindowHandle window = open_window(options.width, options.height);
    Viewer(options, services, window.get()).run();
}

}  // namespace surfelao
