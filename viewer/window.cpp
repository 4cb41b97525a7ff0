#include "viewer/window.h"

#include "image/color_map.h"
#include "image/image_file.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"
#include "viewer/atlas_picture.h"
#include "viewer/native_window.h"
#include "viewer/output_files.h"
#include "viewer/render.h"
#include "viewer/renderer.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

constexpr int kMostSamples = 32;       // a view at rest is done then
constexpr double kPollSeconds = 0.03;  // while something runs in the background
constexpr double kIdleSeconds = 0.5;
constexpr int kEchoFrames = 4;  // after an event: widgets take some until they stand still

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

/// The window with all that belongs to it, made and destroyed with its context current.
class Viewer {
public:
    Viewer(const WindowOptions& options, GLFWwindow* window)
        : options_(options),
          window_(window),
          inbox_(window),
          context_(adopt_context(window)),
          renderer_(context_),
          panel_state_(options.panel),
          panel_(window, content_scale(window))
    {
        if (options.environment)
            renderer_.set_environment(*options.environment);
        for (const std::filesystem::path& path : options.other_inputs)
            files_.add_input(path);
        panel_state_.wants_reference |= needs_reference(panel_state_);
        session_.solve(panel_state_.settings);
        if (!options.input.empty())
            session_.open(options.input, options.up, options.reading);
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

    /// Every file that was saved.
    const std::vector<std::filesystem::path>& written() const { return files_.written(); }

private:
    void wait_for_events()
    {
        const bool drawing = has_view() && (panes_.empty() || samples() < most_samples());
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
        if (inbox_.path.empty())
            return;
        PartChoice& parts = panel_state_.settings.parts;  // names are of the file that is shown
        parts.exclude = parts.receivers = {};
        session_.open(std::exchange(inbox_.path, {}), options_.up, panel_state_.settings);
    }

    bool has_view() const { return session_.state().model != nullptr; }

    /// What the background threads have finished goes to the device.
    void take_results()
    {
        const Session::Changes changes = session_.update();
        const SessionState& state = session_.state();
        try {
            if (changes.model) {
                renderer_.set_model(*state.model);
                shown_layout_.reset();
                paint_.reset();
            }
            if (changes.file) {
                note_.clear();
                files_.add_input(state.path);
                glfwSetWindowTitle(window_,
                                   (state.path.filename().string() + " - surfelao").c_str());
                frame_all();
            }
            if (changes.occlusion) {
                renderer_.set_occlusion(session_.occlusion());
                take_map();
            }
            if (changes.reference && state.map_reference)
                renderer_.set_map_reference(*state.map_reference);
            else if (changes.reference)
                renderer_.set_reference(state.reference);
            if (changes.model || changes.occlusion || changes.reference)
                restart();
        } catch (const std::exception& error) {
            note_ = error.what();
        }
    }

    /// The answer's map, or that it has none.
    void take_map()
    {
        const SessionState& state = session_.state();
        if (!state.layout)
            renderer_.forget_layout();
        else if (state.layout != shown_layout_)
            renderer_.set_layout(*state.model->mesh, *state.layout);
        shown_layout_ = state.layout;
        if (state.map)
            renderer_.set_map(*state.map);
    }

    /// Read when it is first wanted.
    void take_paint()
    {
        if (paint_ || shown_view().colors != Colors::textured)
            return;
        paint_ = base_paint_of(*session_.state().model->mesh);
        renderer_.set_paint(*paint_);
        if (!paint_->notes.empty())
            note_ = paint_->notes.front();
    }

    bool shows_atlas() const { return panel_state_.shows_atlas && session_.state().layout; }
    int most_samples() const { return shows_atlas() ? 1 : kMostSamples; }

    void frame_all()
    {
        const Rect seen = panes_.empty() ? Rect{0, 0, 1, 1} : panes_.front().place;
        const Model& model = *session_.state().model;
        try {
            camera_ = parse_camera(
                options_.camera,
                {.points = model.seen,
                 .frame_centre = model.geometry().frame.centre,
                 .frame_diagonal = model.geometry().frame.diagonal,
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
        const bool traced = session_.state().has_reference();
        const ReferencePlace place = panel_state_.reference_place;
        std::vector<std::pair<Rect, float>> wanted;
        if (place == ReferencePlace::side_by_side && part.width > 1) {
            const int half = part.width / 2;
            wanted = {
                {{part.x, part.y, half, part.height}, 1.0f},
                {{part.x + half, part.y, part.width - half, part.height}, traced ? 0.0f : 1.0f}};
        } else {
            wanted = {{part, traced && place == ReferencePlace::wipe ? panel_state_.wipe : 1.0f}};
        }
        const auto same = [](const Pane& pane, const std::pair<Rect, float>& other) {
            const Rect &a = pane.place, &b = other.first;
            return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height;
        };
        if (!std::equal(panes_.begin(), panes_.end(), wanted.begin(), wanted.end(), same)) {
            panes_.clear();
            for (const auto& [rect, wipe] : wanted)
                panes_.emplace_back(renderer_, context_, rect, wipe);
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
        const bool has_values = state.is_solved || view.colors == Colors::levels ||
                                view.colors == Colors::textured ||
                                (view.colors == Colors::rays && state.has_reference());
        if (!has_values)
            view.colors = Colors::normals;
        return view;
    }

    void draw_model(const Framebuffer& shown)
    {
        if (samples() < most_samples()) {
            take_paint();
            Stopwatch watch;
            for (Pane& pane : panes_) {
                ViewOptions view = shown_view();
                view.wipe = pane.wipe;
                if (shows_atlas()) {
                    pane.sum.add(flat_map(pane, view));
                    continue;
                }
                renderer_.draw_frame(pane.target, camera_, view, sample_shift(pane.sum.count()));
                pane.sum.add(pane.target);
            }
            context_.finish("drawing the model");
            frame_ms_ = 1000.0 * watch.lap();
        }
        for (const Pane& pane : panes_)
            pane.sum.show(shown, {pane.place.x, pane.place.y});
    }

    /// The rays' where the pane shows them alone.
    Image flat_map(const Pane& pane, const ViewOptions& view) const
    {
        const SessionState& state = session_.state();
        const ModelMap* rays = state.map_reference.get();
        const SurfaceData data{.layout = state.layout.get(),
                               .map = rays && pane.wipe == 0.0f ? rays : state.map.get(),
                               .reference = rays,
                               .paint = paint_ ? &*paint_ : nullptr};
        return atlas_picture(*state.model->mesh, data, view, pane.place.width, pane.place.height);
    }

    PanelFigures figures() const
    {
        const GlInfo& info = context_.info();
        return {frame_ms_, samples(), note_, info.renderer, files_.written()};
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
            ask_or_save(Saved::picture, panel_state_.picture_path);
        if (input.save_baked)
            ask_or_save(Saved::baked, panel_state_.baked_path);
        if (input.reply != SaveReply::none && panel_state_.question)
            answer(*std::exchange(panel_state_.question, std::nullopt), input.reply);
    }

    /// What would be lost is asked about first.
    void ask_or_save(Saved what, const std::filesystem::path& path)
    {
        const Standing standing = files_.standing_of(path);
        if (standing == Standing::nothing || standing == Standing::written)
            save(what, path);
        else
            panel_state_.question = SaveQuestion{what, path, standing == Standing::input};
    }

    void answer(const SaveQuestion& question, SaveReply reply)
    {
        if (reply == SaveReply::keep_both)
            save(question.what, next_free_name(question.path));
        else if (reply == SaveReply::cancel)
            note_ = "not saved";
        else if (files_.standing_of(question.path) == Standing::input)
            ask_or_save(question.what, question.path);  // it was opened meanwhile
        else
            save(question.what, question.path);
    }

    /// Whatever fails is told in the window.
    void save(Saved what, const std::filesystem::path& path)
    {
        const SessionState& state = session_.state();
        const bool has_content =
            what == Saved::picture ? has_view() && samples() > 0 : state.is_solved;
        if (!has_content) {
            note_ = what == Saved::picture ? "there is no picture yet" : "nothing is solved yet";
            return;
        }
        try {
            if (what == Saved::picture)
                save_picture(path);
            else
                session_.save(path);
            files_.add_written(path);
            note_ = "saved " + path.string();
            if (what == Saved::baked && state.is_draft)
                note_ += ", of the draft";
        } catch (const std::exception& error) {
            note_ = error.what();
        }
    }

    void save_picture(const std::filesystem::path& path)
    {
        std::vector<Image> images;
        for (const Pane& pane : panes_)
            images.push_back(pane.sum.mean());
        Image image = joined(images);
        if (const auto legend =
                legend_of(*session_.state().model, session_.state().layout.get(), shown_view()))
            draw_heat_legend(image, legend->title, legend->low, legend->high);
        write_image(path, image);
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
    std::shared_ptr<const ModelLayout> shown_layout_;  ///< that the renderer has
    std::optional<BasePaint> paint_;                   ///< of the model; empty until it is wanted
    OutputFiles files_;
    std::string note_;
    double frame_ms_ = 0.0;
    int echo_frames_ = 0;
};

}  // namespace

std::vector<std::filesystem::path> show_window(const WindowOptions& options)
{
    const WindowSystem system;
    const WindowHandle window = open_window(options.width, options.height);
    Viewer viewer(options, window.get());
    viewer.run();
    return viewer.written();
}

}  // namespace surfelao
