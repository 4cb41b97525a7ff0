#include "viewer/window.h"

#include "image/color_map.h"
#include "image/image_file.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"
#include "viewer/cell_view.h"
#include "viewer/coarse.h"
#include "viewer/motion_panel.h"
#include "viewer/mover.h"
#include "viewer/native_window.h"
#include "viewer/open_files.h"
#include "viewer/pane.h"
#include "viewer/pane_labels.h"
#include "viewer/pane_layout.h"
#include "viewer/pane_set.h"
#include "viewer/recent_files.h"
#include "viewer/render.h"
#include "viewer/renderer.h"
#include "viewer/saver.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

constexpr int kMostSamples = 32;  // a view at rest is done then
constexpr double kPollSeconds = 0.03,
                 kIdleSeconds = 0.5;      // something runs in the background, or not
constexpr double kMovingSeconds = 0.004;  // while something moves: little beside a picture
constexpr int kEchoFrames = 4;  // after an event: widgets take some until they stand still

/// The window with all that belongs to it, made and destroyed with its context current.
class Viewer {
public:
    Viewer(const WindowOptions& options, GLFWwindow* window)
        : options_(options),
          window_(window),
          inbox_(window),
          context_(adopt_context(window)),
          left_(context_),
          panes_(context_, left_.renderer()),
          motion_panel_(mover_),
          panel_state_(options.panel),
          panel_(window),
          environment_(options.environment),
          recent_(options.recent_list),
          up_(options.up)
    {
        if (environment_)
            left_.renderer().set_environment(*environment_);
        for (const std::filesystem::path& path : options.other_inputs)
            saver_.add_input(path);
        if (!options.input.empty())
            add_open(options.input);
        for (const std::filesystem::path& path : options.more_inputs)
            add_open(path);
        panel_state_.wants_reference |= needs_reference(panel_state_);
        left_.session().solve(panel_state_.left.settings);
        mover_.begin_at(options.reading.moment);
        if (!options.input.empty())
            left_.session().open(options.input, up_, options.reading);
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
    const std::vector<std::filesystem::path>& written() const { return saver_.written(); }

private:
    void wait_for_events()
    {
        const bool drawing = has_view() && (panes_.empty() || panes_.samples() < most_samples());
        if (drawing || options_.on_frame || echo_frames_ > 0) {
            glfwPollEvents();
            echo_frames_ = std::max(0, echo_frames_ - 1);
        } else {
            const bool will_rest = panes_.is_coarse();  // and be drawn whole then
            const bool is_busy =
                left_.is_busy() || (right_ && right_->is_busy()) || mover_.is_busy();
            const bool moves = left_.is_moved() || mover_.player().is_playing;
            const double timeout = moves                  ? kMovingSeconds
                                   : is_busy || will_rest ? kPollSeconds
                                                          : kIdleSeconds;
            const double start = glfwGetTime();
            glfwWaitEventsTimeout(timeout);
            if (glfwGetTime() - start < timeout)
                echo_frames_ = kEchoFrames;
        }
        take_dropped();
    }

    /// The first is shown; the others wait in the list.
    void take_dropped()
    {
        const std::vector<std::filesystem::path> dropped = std::exchange(inbox_.paths, {});
        if (dropped.empty())
            return;
        for (const std::filesystem::path& path : dropped)
            add_open(path);
        open(dropped.front());
    }

    void open(const std::filesystem::path& path)
    {
        open_files_.turn(whole_path(path), true);
        panel_state_.left.settings.beside = open_files_.beside(whole_path(path));
        forget_names();
        const bool is_input = whole_path(path) == whole_path(options_.input);
        const ReadOptions reading = is_input ? options_.reading : ReadOptions{};
        mover_.begin_at(reading.moment);
        left_.session().open(path, up_, panel_state_.left.settings, reading);
    }

    /// Of the parts that were shown.
    void forget_names()
    {
        PartChoice& parts = panel_state_.left.settings.parts;
        parts.exclude = parts.receivers = {};
    }

    void add_open(const std::filesystem::path& path)
    {
        open_files_.add(whole_path(path));
        if (open_files_.are_together)
            saver_.add_input(path);
    }

    const SessionState& state() const { return left_.session().state(); }
    bool has_view() const { return state().model != nullptr; }

    /// What the background threads have finished goes to the device.
    void take_results()
    {
        try {
            const CellView::Changes changes = left_.update();
            if (changes.model)
                keep_view(state().model->geometry().frame);
            if (changes.model && camera_.up != up_direction(state().model->up))
                frame_all();
            if (changes.file) {
                panes_.forget_times();
                note_.clear();
                saver_.add_input(state().path);
                add_open(state().path);
                recent_.add(state().path);
                glfwSetWindowTitle(window_,
                                   (state().path.filename().string() + " - surfelao").c_str());
                frame_all();
            }
            take_right(changes.model || changes.pose || changes.bodies);
            take_moved(changes.file);
            if (changes.model || changes.pose || changes.occlusion || changes.reference ||
                changes.pixels)
                panes_.restart();
        } catch (const std::exception& error) {
            note_ = error.what();
        }
    }

    /// A frame of what moves is shown by both cells: the right one has no values of it unless its
    /// methods ask the picture alone.
    void take_moved(bool is_other_file)
    {
        if (!mover_.update(left_.session(), is_other_file, glfwGetTime()))
            return;
        left_.show_moved(mover_.base(), mover_.shown(), true);
        if (right_ && right_->session().state().model)
            right_->show_moved(mover_.base(), mover_.shown(), false);
        panes_.move(glfwGetTime());
    }

    /// The right cell is there where it is wanted, with the left one's model.
    void take_right(bool is_other_model)
    {
        const bool is_wanted =
            has_view() && panel_state_.right && panel_state_.beside != Beside::nothing;
        if (!is_wanted) {
            right_.reset();
            return;
        }
        const SessionSettings settings = right_cell(panel_state_).settings;
        if (right_ && !is_other_model) {
            right_->session().solve_as(settings);
        } else {
            if (!right_) {
                right_.emplace(context_);
                if (environment_)
                    right_->renderer().set_environment(*environment_);
            }
            right_->session().open(left_.session(), settings);
        }
        const CellView::Changes changes = right_->update();
        if (changes.model || changes.occlusion || changes.pixels)
            panes_.restart();
    }

    /// Other parts of a file have another frame: what is seen stays where it is.
    void keep_view(const Frame& frame)
    {
        const double scale = frame_.diagonal / frame.diagonal;
        move_frame(camera_, glm::vec3((frame_.centre - frame.centre) / frame.diagonal),
                   static_cast<float>(scale));
        frame_ = frame;
    }

    CellView& view_of_pane(const Pane& pane) { return pane.as.right ? *right_ : left_; }
    bool shows_atlas() const { return panel_state_.shows_atlas && state().layout; }
    /// What moves leaves its time to the engine.
    int most_samples() const
    {
        return shows_atlas() || left_.is_moved() || panes_.is_moving(glfwGetTime()) ? 1
                                                                                    : kMostSamples;
    }

    void frame_all()
    {
        const PictureSize seen = panes_.empty() ? PictureSize{1, 1} : panes_.all().front().size();
        const Model& model = *state().model;
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
        panes_.restart();
    }

    /// What lies on the pixels of the pictures.
    void look()
    {
        const bool is_whole = panel_state_.left.at_pixels && needs_reference(panel_state_);
        const PixelRays rays = {panel_state_.wants_reference
                                    ? static_cast<std::uint32_t>(panel_state_.reference_rays)
                                    : 0,
                                is_whole};
        try {
            const PictureSize size = panes_.drawn_size();
            ViewOptions view = panel_state_.view;
            view.coarse = panes_.is_coarse();
            bool has_changed = left_.look(panel_state_.left, camera_, size, rays, view);
            if (right_ && right_->session().state().model)
                has_changed |= right_->look(right_cell(panel_state_), camera_, size, {}, view);
            if (has_changed)
                panes_.restart();
        } catch (const std::exception& error) {
            note_ = error.what();
        }
    }

    /// One more sample of the model, then the widgets over it. False = close.
    bool frame(int width, int height)
    {
        take_results();
        const PanelInput input =
            panel_.build(panel_state_, left_, right_ ? &*right_ : nullptr, figures(), motion_panel_,
                         motion_view(), std::exchange(inbox_.keys, {}));
        const int covered = static_cast<int>(input.covered * static_cast<float>(width));
        const bool is_first = panes_.empty();
        panes_.lay_out(wanted_panes({covered, 0, width - covered, height}, panel_state_.beside,
                                    panel_state_.wipe, left_.has_reference(), right_.has_value()));
        if (is_first && has_view())
            frame_all();
        apply(input);
        if (input.files.save == Saved::picture || input.reply != SaveReply::none)
            panes_.rest();
        panes_.choose_detail(glfwGetTime());

        const Framebuffer shown = Framebuffer::window(context_, width, height);
        shown.clear_color(glm::vec4(0.16f, 0.17f, 0.18f, 1.0f));
        if (has_view()) {
            drawing_.lap();
            look();
            draw_model(shown);
        }
        panel_.draw();
        // these draw elsewhere, which the widgets must not follow
        save_wanted(input);
        take_wishes(input.files);

        bool keep_open = !input.close;
        if (options_.on_frame)
            keep_open &= options_.on_frame(picture_of(context_, shown), left_.session());
        glfwSwapBuffers(window_);
        return keep_open;
    }

    /// Normals until the first values have come: all open is a silhouette without a shape.
    ViewOptions shown_view(bool of_right) const
    {
        const CellView& cell = of_right ? *right_ : left_;
        ViewOptions view =
            options_for(of_right ? right_cell(panel_state_) : panel_state_.left, panel_state_.view);
        if (cell.is_moved() && needs_reference(view))
            view.colors = Colors::visibility;
        if (!cell.can_show(view.colors))
            view.colors = Colors::normals;
        view.coarse = !panes_.detail().is_whole;
        return view;
    }

    MotionView motion_view() const
    {
        MotionView view{.camera = camera_, .pictures = {}, .positions = {}, .triangles = {}};
        if (!has_view() || shows_atlas())
            return view;
        view.pictures = places_of(panes_.all());
        view.positions = left_.positions();
        view.triangles = left_.model()->geometry().triangles;
        view.is_culled = panel_state_.view.cull;
        return view;
    }

    void draw_model(const Framebuffer& shown)
    {
        if (panes_.samples() < most_samples()) {
            for (Pane& pane : panes_.all())
                add_sample(pane);
            context_.finish("drawing the model");
            frame_ms_ = 1000.0 * drawing_.lap();
            panes_.tell_time(frame_ms_);
        }
        for (const Pane& pane : panes_.all())
            pane.sum.show(shown, {pane.as.place.x, pane.as.place.y}, pane.as.shown);
    }

    void add_sample(Pane& pane)
    {
        CellView& cell = view_of_pane(pane);
        if (!cell.session().state().model)
            return;
        ViewOptions view = shown_view(pane.as.right);
        view.wipe = pane.as.wipe;
        if (panel_state_.beside == Beside::side_by_side && pane.as.wipe == 0.0f)
            view.colors = colors_of_rays(view.colors);
        if (view.colors == Colors::textured) {
            if (const auto notes = cell.take_paint(); !notes.empty())
                note_ = notes.front();
        }
        if (shows_atlas() && cell.session().state().layout) {
            pane.sum.add(flat_map(pane, cell, view));
            return;
        }
        cell.draw_frame(pane.target, camera_, view, sample_shift(pane.sum.count()));
        pane.sum.add(pane.target, panes_.detail().pixel);
    }

    PanelFigures figures() const
    {
        const GlInfo& info = context_.info();
        return {.frame_ms = frame_ms_,
                .samples = panes_.samples(),
                .note = note_,
                .device = info.renderer,
                .written = saver_.written(),
                .files = {open_files_.all(), recent_.files(),
                          has_view() ? whole_path(state().path) : std::filesystem::path(), up_,
                          &open_files_},
                .labels = labels(),
                .question = saver_.question() ? &*saver_.question() : nullptr};
    }

    void apply(const PanelInput& input)
    {
        if (has_view() && !left_.session().making())  // what fails to open leaves the last one
            panel_state_.left.settings.beside = open_files_.beside(whole_path(state().path));
        left_.session().solve(panel_state_.left.settings);
        // at pixels they are traced there
        left_.session().want_reference(panel_state_.wants_reference && !panel_state_.left.at_pixels
                                           ? static_cast<std::uint32_t>(panel_state_.reference_rays)
                                           : 0);
        if (input.cancel) {
            if (left_.session().tracing() || left_.ray_progress())
                panel_state_.wants_reference = false;
            left_.cancel();
            if (right_)
                right_->cancel();
        }
        if (input.solve_again)
            left_.solve_again();
        if (input.frame_all && has_view())
            frame_all();
        if (input.add_map)
            add_map();
        if (input.place_maps)
            place_maps();
        move_camera(input);
        if (input.view_changed)
            panes_.restart();
    }

    void move_camera(const PanelInput& input)
    {
        constexpr double kLongestStep = 0.1;  // seconds: a slow frame is no leap
        const double now = glfwGetTime();
        const double elapsed = std::min(kLongestStep, now - std::exchange(flown_at_, now));
        const Camera before = camera_;
        if (input.orbit_deg != glm::vec2(0.0f))
            orbit(camera_, input.orbit_deg.x, input.orbit_deg.y);
        if (input.look_deg != glm::vec2(0.0f))
            look_around(camera_, input.look_deg.x, input.look_deg.y);
        if (input.pan != glm::vec2(0.0f))
            pan(camera_, input.pan);
        if (input.zoom != 1.0f)
            zoom(camera_, input.zoom);
        if (input.flies)
            fly(camera_, flight_step(inbox_.held, panel_state_.flight.speed, elapsed));
        if (camera_ != before)
            panes_.move(glfwGetTime());
    }

    /// For each cell that shows some.
    void add_map()
    {
        try {
            if (has_view() && panel_state_.left.from_maps)
                note_ = left_.add_map();
            if (right_ && right_cell(panel_state_).from_maps)
                note_ = right_->add_map();
        } catch (const std::exception& error) {
            note_ = error.what();
        }
    }

    void place_maps()
    {
        if (panel_state_.left.from_maps)
            left_.place_maps();
        if (right_ && right_cell(panel_state_).from_maps)
            right_->place_maps();
    }

    /// What each side of the line shows.
    PaneLabels labels() const
    {
        if (!has_view() || panel_state_.beside == Beside::nothing)
            return {};
        if (right_)
            return {label_of(panel_state_.left, left_, shown_view(false).colors),
                    label_of(right_cell(panel_state_), *right_, shown_view(true).colors)};
        return labels_with_rays(panel_state_.left, left_, shown_view(false).colors,
                                panel_state_.beside == Beside::side_by_side);
    }

    /// After drawing, so that there is a picture.
    void save_wanted(const PanelInput& input)
    {
        Savable content{.session = left_.session(), .is_moving = left_.is_moved(), .picture = {}};
        if (has_view() && panes_.samples() > 0)
            content.picture = [&] { return picture(); };
        if (input.files.save) {
            const SavePaths& paths = panel_state_.paths;
            note_ = saver_.save(*input.files.save,
                                *input.files.save == Saved::picture ? paths.picture : paths.baked,
                                content);
        }
        if (input.reply != SaveReply::none)
            note_ = saver_.reply(input.reply, content);
    }

    Image picture() const
    {
        const bool is_split = panel_state_.beside == Beside::side_by_side;
        Image image = picture_of(panes_.all(), labels(), is_split ? 0.5f : panel_state_.wipe);
        if (const auto legend = legend_of(*state().model, state().layout.get(), shown_view(false)))
            draw_legend(image, *legend);
        return image;
    }

    void take_wishes(const FileWishes& wishes)
    {
        if (!wishes.open.empty()) {
            add_open(wishes.open);
            open(wishes.open);
        }
        switch_files(wishes);
        if (!wishes.environment.empty())
            set_environment(wishes.environment);
        if (wishes.up) {
            up_ = *wishes.up;
            Session& session = left_.session();
            session.set_up(up_);
            panel_state_.left.settings.target = session.settings().target;
            panel_state_.left.settings.ground = session.settings().ground;
        }
    }

    void switch_files(const FileWishes& wishes)
    {
        const bool is_changed = !wishes.turn.empty() || !wishes.forget.empty();
        if (wishes.together || (is_changed && open_files_.are_together))
            forget_names();
        open_files_.forget(wishes.forget);
        if (wishes.together) {
            open_files_.are_together = *wishes.together;
            for (const std::filesystem::path& path : open_files_.all())
                saver_.add_input(path);
        }
        if (wishes.turn.empty())
            return;
        const bool on = !open_files_.is_on(wishes.turn);
        open_files_.turn(wishes.turn, on);
        const auto next = std::ranges::find_if(
            open_files_.all(), [&](const auto& file) { return open_files_.is_on(file); });
        if (!on && has_view() && wishes.turn == whole_path(state().path))
            open(*next);
    }

    void set_environment(const std::filesystem::path& path)
    {
        try {
            environment_ = read_image(path);
            left_.renderer().set_environment(*environment_);
            if (right_)
                right_->renderer().set_environment(*environment_);
            saver_.add_input(path);
            note_.clear();
            panes_.restart();
        } catch (const std::exception& error) {
            note_ = error.what();
        }
    }

    const WindowOptions& options_;
    GLFWwindow* window_;
    Inbox inbox_;
    GlContext context_;
    CellView left_;
    std::optional<CellView> right_;
    PaneSet panes_;
    Mover mover_;
    MotionPanel motion_panel_;
    PanelState panel_state_;
    Panel panel_;
    Camera camera_;
    Frame frame_;  ///< that the camera is in
    std::optional<Image> environment_;
    RecentFiles recent_;
    UpAxis up_;
    OpenFiles open_files_;
    Saver saver_;
    std::string note_;
    Stopwatch drawing_;
    double frame_ms_ = 0.0;
    double flown_at_ = 0.0;  ///< glfwGetTime()
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
