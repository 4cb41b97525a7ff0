#include "viewer/panel.h"

#include "viewer/cell_widgets.h"
#include "viewer/native_window.h"
#include "viewer/panel_widgets.h"
#include "viewer/panel_windows.h"
#include "viewer/probe_box.h"
#include "viewer/render.h"
#include "viewer/tip.h"
#include "viewer/ui_scale.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

namespace surfelao {
namespace {

constexpr float kLabels = 116.0f;  // right of widgets, unscaled pixels
constexpr float kGrip = 6.0f;      // how near to the wipe's line a press takes it, unscaled pixels
constexpr const char* kWhereTip =
    "where values lie: at vertices, in a map, at each pixel, or in cube maps or an AO grid that "
    "pixels read";
constexpr const char* kHowTip =
    "who answers: masks (near to rays), disks (rough), rays (the witness); at pixels also methods "
    "that know the picture alone, in cube maps the horizons of what a face sees";
constexpr float kDegreesPerPixel = 0.35f;
constexpr float kZoomPerNotch = 0.88f;

void switch_beside(PanelState& state, Beside beside)
{
    state.beside = state.beside == beside ? Beside::nothing : beside;
}

/// Those of how the model looks.
void press_look(char key, ViewOptions& view)
{
    switch (key) {
        case 'T':
            view.surface = static_cast<Shape>((static_cast<int>(view.surface) + 1) % 4);
            break;
        case 'G':
            view.ground = !view.ground;
            break;
        case 'L':
            view.colors = Colors::headlight;
            break;
        case 'X':
            view.wireframe = !view.wireframe;
            break;
        case 'K':
            view.cull = !view.cull;
            break;
        default:
            if (key >= '0' && key <= '9')
                view.colors = static_cast<Colors>((key - '1' + 10) % 10);
    }
}

/// One key that the widgets leave to the picture.
void press(char key, PanelState& state, MotionPanel& motion, PanelInput& input)
{
    if (state.flight.is_on && kFlightKeys.find(key) != std::string_view::npos)
        return;  // while it is held
    input.view_changed |=
        std::string_view("1234567890ATGWSLXK").find(key) != std::string_view::npos;
    switch (key) {
        case 'V':
            state.flight.is_on = !state.flight.is_on;
            break;
        case 'I':
            state.inspects = !state.inspects;
            break;
        case 'A':
            state.shows_atlas = !state.shows_atlas;
            break;
        case 'W':
            switch_beside(state, Beside::wipe);
            break;
        case 'S':
            switch_beside(state, Beside::side_by_side);
            break;
        case 'R':
            state.wants_reference = !state.wants_reference;
            break;
        case 'H':
            state.shows_help = !state.shows_help;
            break;
        case 'C':
            input.add_map = true;
            break;
        case 'F':
            input.frame_all = true;
            break;
        case 'P':
            input.files.save = Saved::picture;
            break;
        case 'B':
            input.files.save = Saved::baked;
            break;
        case 'Q':
            input.close = true;
            break;
        case Panel::kEscape:
            if (!std::exchange(state.shows_help, false) &&
                !std::exchange(state.flight.is_on, false))
                input.cancel = !motion.deselect();
            break;
        case Panel::kSpace:
            motion.play();
            break;
        case 'Z':
            motion.undo();
            break;
        case Panel::kTab:
            state.is_hidden = !state.is_hidden;
            break;
        case '+':
        case '=':
            input.zoom *= kZoomPerNotch;
            break;
        case '-':
            input.zoom /= kZoomPerNotch;
            break;
        default:
            press_look(key, state.view);
    }
}

/// One key while a question is open.
SaveReply reply_of(char key, const SaveQuestion& question)
{
    switch (key) {
        case 'R':
            return question.is_input ? SaveReply::none : SaveReply::replace;
        case 'K':
            return SaveReply::keep_both;
        case Panel::kEscape:
            return SaveReply::cancel;
        default:
            return SaveReply::none;
    }
}

/// Whether the button was already down: what the mouse did before the press is no drag.
bool drags(ImGuiMouseButton button)
{
    return ImGui::IsMouseDown(button) && !ImGui::IsMouseClicked(button);
}

/// What is on which side of a line at x, and that line. from: where the pictures begin.
void place_labels(float from, float x, const char* left, const char* right)
{
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImU32 color = IM_COL32(255, 255, 255, 150);
    const float scale = ImGui::GetIO().FontGlobalScale, margin = 8.0f * scale;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    list.AddLine(ImVec2(x, 0.0f), ImVec2(x, display.y), color, scale);
    // on several lines where the picture is narrow
    const auto label = [&](float low, float high, bool ends, const char* text) {
        const float room = high - low - 2.0f * margin;
        if (room < 3.0f * ImGui::GetFontSize())
            return;
        const ImVec2 size = ImGui::CalcTextSize(text, nullptr, false, room);
        const ImVec2 at(ends ? high - margin - size.x : low + margin, margin);
        const float around = 0.5f * margin;
        list.AddRectFilled(ImVec2(at.x - around, at.y - around),
                           ImVec2(at.x + size.x + around, at.y + size.y + around),
                           IM_COL32(0, 0, 0, 160), around);
        list.AddText(nullptr, 0.0f, at, IM_COL32_WHITE, text, nullptr, room);
    };
    label(from, x, true, left);
    label(x, display.x, false, right);
}

}  // namespace

Panel::Panel(GLFWwindow* window) : window_(window)
{
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // leaves no file behind
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

Panel::~Panel()
{
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

bool needs_reference(const PanelState& state)
{
    return needs_reference(state.view) || (state.beside != Beside::nothing && !state.right);
}

Cell right_cell(const PanelState& state)
{
    Cell cell = state.left;
    if (!state.right) {
        cell.screen.reset();
        cell.settings.engine = {};
        cell.settings.engine.engine = Engine::rays;
        return cell;
    }
    cell.at_pixels = state.right->at_pixels;
    cell.from_maps = state.right->from_maps;
    cell.grid = state.right->grid;
    cell.screen = state.right->screen;
    cell.guard = state.right->guard;
    cell.settings.engine = state.right->settings.engine;
    cell.settings.texels = state.right->settings.texels;
    return cell;
}

PanelInput Panel::build(PanelState& state, const CellView& left_view, const CellView* right_view,
                        const PanelFigures& figures, MotionPanel& motion, const MotionView& moved,
                        std::string_view keys)
{
    const Session& session = left_view.session();
    fit_scale();
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    PanelInput input;
    for (const char key : keys) {
        if (figures.question) {
            if (input.reply == SaveReply::none)
                input.reply = reply_of(key, *figures.question);
        } else if (files_.is_choosing()) {
            if (key == kEscape)
                files_.close();
        } else if (!ImGui::GetIO().WantTextInput) {
            if (key == 'O')
                files_.choose(FileKind::model);
            else
                press(key, state, motion, input);
        }
    }
    // beside the picture where there is room for both, else over it
    const float scale = ImGui::GetIO().FontGlobalScale;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    if (!state.is_hidden) {
        const bool beside = display.x > 2.0f * kWidth * scale;
        input.covered = beside ? kWidth * scale / display.x : 0.0f;
        ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
        ImGui::SetNextWindowSize(ImVec2(kWidth * scale, beside ? display.y : 0.0f));
        widgets(state, left_view, right_view, figures, motion, input);
    }
    if (state.shows_help)
        help_window(state.shows_help);
    files_.dialog(state.paths, input.files);
    if (figures.question)
        question_window(*figures.question, input.reply);
    if (const std::shared_ptr<const Model>& model = session.state().model) {
        if (const auto shown = legend_of(*model, session.state().layout.get(),
                                         options_for(state.left, state.view)))
            legend(*shown);
    }
    const float left = input.covered * display.x;
    const float line =
        left + (display.x - left) * (state.beside == Beside::wipe ? state.wipe : 0.5f);
    if (state.beside != Beside::nothing)
        place_labels(left, line, figures.labels.left.c_str(), figures.labels.right.c_str());
    const bool is_modal = figures.question || files_.is_choosing();
    input.flies = state.flight.is_on && !is_modal && !ImGui::GetIO().WantTextInput;
    if (state.inspects && !is_modal && session.state().model) {
        const bool is_right =
            right_view && state.beside != Beside::nothing && ImGui::GetIO().MousePos.x >= line;
        tell_place(moved, is_right ? *right_view : left_view,
                   is_right ? right_cell(state) : state.left);
    }
    if (is_modal || !motion.mouse(moved))
        mouse(state, input, line, left);
    if (input.view_changed && needs_reference(state))
        state.wants_reference = true;
    ImGui::Render();
    return input;
}

/// Sizes follow the display that the window is on.
void Panel::fit_scale()
{
    int width = 0, height = 0, pixels = 0, unused = 0;
    glfwGetWindowSize(window_, &width, &height);
    glfwGetFramebufferSize(window_, &pixels, &unused);
    const float ratio =
        width > 0 && pixels > 0 ? static_cast<float>(pixels) / static_cast<float>(width) : 1.0f;
    const float scale = content_scale(window_);
    if (scale == content_scale_ && ratio == pixel_ratio_)
        return;
    content_scale_ = scale;
    pixel_ratio_ = ratio;
    set_ui_scale(scale, ratio);
}

void Panel::solver_widgets(PanelState& state, const Model* model)
{
    if (!ImGui::IsAnyItemActive())
        edited_ = state.left;
    if (edited_.settings.texels)
        where_.texels = *edited_.settings.texels;
    if (edited_.grid)
        where_.grid = *edited_.grid;
    bool apply = choose_where(edited_, model, where_);
    tip(kWhereTip);
    apply |= choose_how(edited_, state.qualities);
    tip(kHowTip);
    apply |= edit_how(edited_);
    SessionSettings& question = edited_.settings;
    if (question.texels)
        apply |= edit_texels(*question.texels);
    apply |= edit_distance(question.max_distance, falloff_);
    apply |= edit_ground(question.ground, model);
    apply |= edit_target(question.target);
    if (apply)
        state.left = edited_;
}

void Panel::compare_widgets(PanelState& state, const CellView& left, const CellView* right,
                            PanelInput& input)
{
    int beside = static_cast<int>(state.beside);
    if (ImGui::Combo("beside", &beside, "nothing\0wipe\0side by side\0")) {
        state.beside = static_cast<Beside>(beside);
        input.view_changed = true;
    }
    tip("W, S: a second picture by the same camera, right of a line or in a half of its own");
    if (state.beside != Beside::nothing) {
        ImGui::PushID("right");
        if (!ImGui::IsAnyItemActive())
            edited_right_ = right_cell(state);
        bool apply = choose_where(edited_right_, left.session().state().model.get(), where_);
        tip(kWhereTip);
        apply |= choose_how(edited_right_, state.qualities);
        tip(kHowTip);
        if (state.right)
            apply |= edit_how(edited_right_);
        if (apply) {
            const bool is_reference = !edited_right_.screen &&
                                      edited_right_.settings.engine.engine == Engine::rays &&
                                      where_of(edited_right_) == where_of(state.left);
            state.right = is_reference ? std::nullopt : std::optional(edited_right_);
            input.view_changed = true;
        }
        ImGui::PopID();
    }
    ImGui::Checkbox("trace", &state.wants_reference);
    tip("R: casts rays to tell the error of what is shown, and for the pictures that need them");
    ImGui::SameLine();
    int half = state.reference_rays / 2;
    if (ImGui::SliderInt("rays##reference", &half, 8, 4096, "2 x %d",
                         ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
        state.reference_rays = 2 * half;
    tip("rays of the reference at each place, cast in two halves: 16 to 8192");
    if (right)
        cell_progress(*right);
    if (left.session().tracing())
        progress_line("tracing", left.session().trace_progress());
    else if (const std::optional<double> done = left.ray_progress())
        progress_line("rays at pixels", *done);
    else if (needs_reference(state) && left.session().state().model && !left.has_reference())
        ImGui::TextUnformatted("not traced: the result is shown instead");
    if (left.pixel_error())
        error_lines(*left.pixel_error());
}

void Panel::mouse(PanelState& state, PanelInput& input, float wipe_x, float left)
{
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse)
        return;
    const bool at_line = state.beside == Beside::wipe &&
                         std::abs(io.MousePos.x - wipe_x) < kGrip * io.FontGlobalScale;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left))
        drags_wipe_ = at_line;
    if (at_line || (drags_wipe_ && ImGui::IsMouseDown(ImGuiMouseButton_Left)))
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (drags(ImGuiMouseButton_Left)) {
        if (drags_wipe_) {
            const float width = std::max(1.0f, io.DisplaySize.x - left);
            state.wipe = std::clamp((io.MousePos.x - left) / width, 0.0f, 1.0f);
            input.view_changed = true;
        } else {
            const glm::vec2 by = kDegreesPerPixel * glm::vec2(io.MouseDelta.x, -io.MouseDelta.y);
            (state.flight.is_on ? input.look_deg : input.orbit_deg) = state.flight.is_on ? by : -by;
        }
    }
    if (drags(ImGuiMouseButton_Right) || drags(ImGuiMouseButton_Middle))
        input.pan = glm::vec2(io.MouseDelta.x, -io.MouseDelta.y) / std::max(1.0f, io.DisplaySize.y);
    const float notches = std::pow(kZoomPerNotch, io.MouseWheel);
    if (state.flight.is_on)
        state.flight.speed =
            std::clamp(state.flight.speed / notches, kLeastFlightSpeed, kMostFlightSpeed);
    else
        input.zoom *= notches;
}

namespace {

void name_model(const SessionState& state)
{
    const Geometry& geometry = state.model->geometry();
    std::string name = state.path.filename().string();
    if (!state.beside.empty())
        name += " and " + std::to_string(state.beside.size()) + " more";
    ImGui::Text(state.model->cloud ? "%s\n%zu points" : "%s\n%zu vertices, %zu triangles",
                name.c_str(), geometry.positions.size(), geometry.triangles.size());
}

/// What was drawn, and what is to be told. views: one may be null.
void foot(PanelState& state, const PanelFigures& figures, const SessionState& shown_state,
          std::initializer_list<const CellView*> views)
{
    ImGui::Separator();
    ImGui::Text("%.1f ms (%.0f frames/s), %d samples", figures.frame_ms,
                figures.frame_ms > 0.0 ? 1000.0 / figures.frame_ms : 0.0, figures.samples);
    tip("to draw the model once; samples for each pixel so far, 32 at rest");
    ImGui::TextDisabled("%s", figures.device.c_str());
    tip("what draws");
    if (ImGui::SmallButton("keys (H)"))
        state.shows_help = !state.shows_help;
    tip("lists what keys and the mouse do");
    const ImVec4 warning(1.0f, 0.55f, 0.45f, 1.0f);
    ImGui::PushTextWrapPos(0.0f);
    if (!shown_state.message.empty())
        ImGui::TextColored(warning, "%s", shown_state.message.c_str());
    for (const CellView* view : views) {
        if (view && !view->pixel_message().empty())
            ImGui::TextColored(warning, "%s", view->pixel_message().c_str());
    }
    if (!figures.note.empty())
        ImGui::TextUnformatted(figures.note.c_str());
    ImGui::PopTextWrapPos();
}

}  // namespace

void Panel::widgets(PanelState& state, const CellView& left, const CellView* right,
                    const PanelFigures& figures, MotionPanel& motion, PanelInput& input)
{
    const Session& session = left.session();
    const SessionState& shown_state = session.state();
    ImGui::Begin("surfelao", nullptr,
                 ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);  // the keys stay over it
    ImGui::PushItemWidth(-kLabels * ImGui::GetIO().FontGlobalScale);
    files_.open_widgets(figures.files, input.files);
    if (shown_state.model)
        name_model(shown_state);
    if (session.opening())
        ImGui::TextUnformatted("reading ...");

    if (ImGui::CollapsingHeader("Solve", ImGuiTreeNodeFlags_DefaultOpen)) {
        solver_widgets(state, shown_state.model.get());
        if ((session.solving() && !session.opening()) || left.pixel_progress()) {
            cell_progress(left);
            input.cancel |= ImGui::Button("cancel");
            tip("Esc: stops it; what was found stays");
        } else if (left.was_cancelled() && shown_state.model) {
            ImGui::TextUnformatted(!shown_state.is_solved ? "cancelled"
                                   : shown_state.is_draft ? "cancelled: the draft is shown"
                                                          : "cancelled: the last answer is shown");
            ImGui::SameLine();
            input.solve_again |= ImGui::SmallButton("solve");
            tip("solves it after all");
        }
        if (shown_state.model)
            stage_lines(shown_state);
        if (state.left.from_maps)
            input.place_maps |= map_lines(left);
        else if (state.left.grid)
            grid_lines(left);
        else if (state.left.at_pixels)
            pixel_lines(left);
        else
            histogram(session);
    }
    if (shown_state.model && ImGui::CollapsingHeader("Parts")) {
        if (const auto vertex =
                edit_parts(shown_state.model->mesh->scene, state.left.settings.parts))
            motion.select_vertex(*vertex);
    }
    if (ImGui::CollapsingHeader("Show", ImGuiTreeNodeFlags_DefaultOpen)) {
        input.view_changed |= view_widgets(state);
        ImGui::SameLine();
        input.frame_all |= ImGui::Button("frame all");
        tip("F: the camera sees all of the model");
        if (state.view.colors == Colors::environment)
            files_.environment_widget();
    }
    if (ImGui::CollapsingHeader("Compare", ImGuiTreeNodeFlags_DefaultOpen))
        compare_widgets(state, left, right, input);
    if (shown_state.model)
        motion.widgets(figures.frame_ms);
    if (ImGui::CollapsingHeader("Save")) {
        files_.save_widgets(state.paths, shown_state.layout != nullptr, input.files);
        for (const std::filesystem::path& file : figures.written)
            ImGui::TextDisabled("wrote %s", file.c_str());
    }
    foot(state, figures, shown_state, {&left, right});
    ImGui::PopItemWidth();
    ImGui::End();
}

void Panel::draw()
{
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace surfelao
