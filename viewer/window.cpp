#include "viewer/window.h"

#include "gpu/context.h"
#include "image/image_file.h"
#include "surfels/errors.h"
#include "surfels/scene_io.h"
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
          context_(adopt_context(window)),
          renderer_(context_),
          session_(services),
          panel_state_(options.panel),
          panel_(window, content_scale(window))
    {
        if (options.environment)
            renderer_.set_environment(*options.environment);
        glfwSetWindowUserPointer(window, &dropped_);
        glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
            if (count > 0)
                *static_cast<std::string*>(glfwGetWindowUserPointer(w)) = paths[count - 1];
        });
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
        const bool drawing = has_view() && (!sum_ || sum_->count() < kMostSamples);
        if (drawing || options_.on_frame)
            glfwPollEvents();
        else
            glfwWaitEventsTimeout(session_.solving() || session_.tracing() ? kPollSeconds
                                                                           : kIdleSeconds);
        if (!dropped_.empty())
            session_.open(std::exchange(dropped_, {}), options_.up);
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
        int width = 1, height = 1;
        glfwGetFramebufferSize(window_, &width, &height);
        const Model& model = *session_.state().model;
        try {
            camera_ =
                parse_camera(options_.camera, {.points = model.seen,
                                               .frame_centre = model.geometry.frame.centre,
                                               .frame_diagonal = model.geometry.frame.diagonal,
                                               .up = model.up,
                                               .aspect = static_cast<float>(std::max(1, width)) /
                                                         static_cast<float>(std::max(1, height))});
        } catch (const InputError& error) {
            note_ = error.what();
            camera_ = frame_points(model.seen, model.up, 1.0f);
        }
        restart();
    }

    /// The picture begins anew.
    void restart()
    {
        if (sum_)
            sum_->clear();
    }

    /// One more sample of the model, then the widgets over it. False = close.
    bool frame(int width, int height)
    {
        take_results();
        if (!target_ || target_->width() != width || target_->height() != height) {
            target_.emplace(renderer_.make_target(width, height));
            sum_.emplace(context_, width, height);
        }
        const PanelInput input = panel_.build(panel_state_, session_, figures());
        apply(input);

        const Framebuffer shown = Framebuffer::window(context_, width, height);
        if (has_view())
            draw_model(shown);
        else
            shown.clear_color(glm::vec4(0.16f, 0.17f, 0.18f, 1.0f));
        panel_.draw();

        bool keep_open = !input.close;
        if (options_.on_frame)
            keep_open &= options_.on_frame(read_window(shown), session_);
        glfwSwapBuffers(window_);
        return keep_open;
    }

    void draw_model(const Framebuffer& shown)
    {
        if (sum_->count() < kMostSamples) {
            const auto start = std::chrono::steady_clock::now();
            // a reference that is not there yet is not shown instead of the result
            ViewOptions view = panel_state_.view;
            if (session_.state().reference.empty())
                view.wipe = 1.0f;
            renderer_.draw_frame(*target_, camera_, view, sample_shift(sum_->count()));
            sum_->add(*target_);
            context_.finish("drawing the model");
            const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
            frame_ms_ = 1000.0 * passed.count();
        }
        sum_->show(shown);
    }

    PanelFigures figures() const
    {
        const GlInfo& info = context_.info();
        return {frame_ms_, sum_->count(), note_, info.renderer};
    }

    void apply(const PanelInput& input)
    {
        session_.solve(panel_state_.settings);
        session_.want_reference(panel_state_.wants_reference
                                    ? static_cast<std::uint32_t>(panel_state_.reference_rays)
                                    : 0);
        if (input.cancel)
            session_.cancel();
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
        if (!has_view() || sum_->count() == 0)
            return "there is no picture yet";
        Image image = sum_->mean();
        draw_legend(image, *session_.state().model, panel_state_.view);
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
        return std::string("saved ") + panel_state_.baked_path;
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
    GlContext context_;
    Renderer renderer_;
    Session session_;
    PanelState panel_state_;
    Panel panel_;
    Camera camera_;
    std::optional<Framebuffer> target_;
    std::optional<SampleSum> sum_;
    std::string dropped_, note_;
    double frame_ms_ = 0.0;
};

}  // namespace

void show_window(const WindowOptions& options, const Services& services)
{
    const WindowSystem system;
    const WindowHandle window = open_window(options.width, options.height);
    Viewer(options, services, window.get()).run();
}

}  // namespace surfelao
