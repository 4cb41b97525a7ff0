#include "viewer/panel.h"

#include "viewer/panel_widgets.h"
#include "viewer/render.h"

#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

constexpr float kWidth = 330.0f;  // of the panel, unscaled pixels
constexpr float kGrip = 6.0f;     // how near to the wipe's line a press takes it, unscaled pixels
constexpr float kDegreesPerPixel = 0.35f;
constexpr float kZoomPerNotch = 0.88f;
void style_widgets(float scale)
{
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 0.0f;
    style.FrameRounding = 3.0f;
    style.GrabRounding = 3.0f;
    style.WindowBorderSize = 0.0f;
    style.Colors[ImGuiCol_WindowBg].w = 0.92f;
    style.Colors[ImGuiCol_PopupBg].w = 1.0f;
    style.ScaleAllSizes(scale);
    ImGui::GetIO().FontGlobalScale = scale;
}

void switch_place(PanelState& state, ReferencePlace place)
{
    state.reference_place = state.reference_place == place ? ReferencePlace::nowhere : place;
}

/// One key that the widgets leave to the picture.
void press(char key, PanelState& state, PanelInput& input)
{
    input.view_changed |= std::string_view("1234567890ATGWS").find(key) != std::string_view::npos;
    switch (key) {
        case 'A':
            state.shows_atlas = !state.shows_atlas;
            break;
        case 'T':
            state.view.surface = static_cast<Shape>((static_cast<int>(state.view.surface) + 1) % 4);
            break;
        case 'G':
            state.view.ground = !state.view.ground;
            break;
        case 'W':
            switch_place(state, ReferencePlace::wipe);
            break;
        case 'S':
            switch_place(state, ReferencePlace::side_by_side);
            break;
        case 'R':
            state.wants_reference = !state.wants_reference;
            break;
        case 'H':
            state.shows_help = !state.shows_help;
            break;
        case 'F':
            input.frame_all = true;
            break;
        case 'P':
            input.save_picture = true;
            break;
        case 'B':
            input.save_baked = true;
            break;
        case 'Q':
            input.close = true;
            break;
        case Panel::kEscape:
            input.cancel = true;
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
            if (key >= '0' && key <= '9')
                state.view.colors = static_cast<Colors>((key - '1' + 10) % 10);
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

/// What is on which side, and the line between.
void place_labels(float x, const char* left, const char* right)
{
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImU32 color = IM_COL32(255, 255, 255, 150);
    const float margin = 8.0f * ImGui::GetIO().FontGlobalScale;
    list.AddLine(ImVec2(x, 0.0f), ImVec2(x, ImGui::GetIO().DisplaySize.y), color, 1.0f);
    list.AddText(ImVec2(x - margin - ImGui::CalcTextSize(left).x, margin), color, left);
    list.AddText(ImVec2(x + margin, margin), color, right);
}

}  // namespace

Panel::Panel(GLFWwindow* window, float scale)
{
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // leaves no file behind
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
    style_widgets(scale);
}

Panel::~Panel()
{
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void choose_engine(PanelState& state, Engine engine, Device device)
{
    EngineSettings& settings = state.settings.engine;
    settings.device = device;
    if (engine == settings.engine)
        return;
    state.qualities[settings.engine] = settings.quality;
    settings.engine = engine;
    settings.quality = state.qualities.try_emplace(engine, kGood).first->second;
}

std::string name_of(const EngineChoice& choice)
{
    return name_of(choice.engine) + (choice.device == Device::gpu ? " on GPU" : "");
}

bool needs_reference(const PanelState& state)
{
    return needs_reference(state.view) || state.reference_place != ReferencePlace::nowhere;
}

PanelInput Panel::build(PanelState& state, const Session& session, const PanelFigures& figures,
                        std::string_view keys)
{
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    PanelInput input;
    if (!ImGui::GetIO().WantTextInput) {
        for (const char key : keys) {
            if (!state.question)
                press(key, state, input);
            else if (input.reply == SaveReply::none)
                input.reply = reply_of(key, *state.question);
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
        widgets(state, session, figures, input);
    }
    if (state.shows_help)
        help_window(state.shows_help);
    if (state.question)
        question_window(*state.question, input.reply);
    if (const std::shared_ptr<const Model>& model = session.state().model) {
        if (const auto shown = legend_of(*model, session.state().layout.get(), state.view))
            legend(shown->title, shown->low, shown->high);
    }
    const float left = input.covered * display.x;
    const float line =
        left +
        (display.x - left) * (state.reference_place == ReferencePlace::wipe ? state.wipe : 0.5f);
    if (state.reference_place != ReferencePlace::nowhere)
        place_labels(line, name_of(state.settings.engine).c_str(),
                     session.state().has_reference() ? "rays" : "no rays yet");
    mouse(state, input, line, left);
    if (input.view_changed && needs_reference(state))
        state.wants_reference = true;
    ImGui::Render();
    return input;
}

void Panel::solver_widgets(PanelState& state, const Session& session)
{
    if (!ImGui::IsAnyItemActive())
        edited_ = state.settings;
    if (ImGui::BeginCombo("engine", name_of(edited_.engine).c_str())) {
        for (const Engine engine : {Engine::masks, Engine::disks, Engine::rays}) {
            for (const Device device : {Device::cpu, Device::gpu}) {
                if (!runs_on(engine, device))
                    continue;
                const EngineChoice choice = {.engine = engine, .device = device};
                const bool is_chosen =
                    engine == edited_.engine.engine && device == edited_.engine.device;
                if (ImGui::Selectable(name_of(choice).c_str(), is_chosen)) {
                    choose_engine(state, engine, device);
                    edited_ = state.settings;
                }
            }
        }
        ImGui::EndCombo();
    }
    bool apply = edit_settings(edited_.engine);
    apply |= edit_distance(edited_.max_distance, falloff_);
    apply |= edit_ground(edited_.ground, session.state().model.get());
    apply |= edit_target(edited_.target);
    apply |= edit_texels(edited_.texels, texels_);
    if (apply)
        state.settings = edited_;
}

void Panel::mouse(PanelState& state, PanelInput& input, float wipe_x, float left)
{
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse)
        return;
    const bool at_line = state.reference_place == ReferencePlace::wipe &&
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
            input.orbit_deg = kDegreesPerPixel * glm::vec2(-io.MouseDelta.x, io.MouseDelta.y);
        }
    }
    if (drags(ImGuiMouseButton_Right) || drags(ImGuiMouseButton_Middle))
        input.pan = glm::vec2(io.MouseDelta.x, -io.MouseDelta.y) / std::max(1.0f, io.DisplaySize.y);
    input.zoom *= std::pow(kZoomPerNotch, io.MouseWheel);
}

void Panel::widgets(PanelState& state, const Session& session, const PanelFigures& figures,
                    PanelInput& input)
{
    const SessionState& shown_state = session.state();
    ImGui::Begin("surfelao", nullptr,
                 ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse);
    ImGui::PushItemWidth(-100.0f * ImGui::GetIO().FontGlobalScale);
    if (shown_state.model)
        ImGui::Text("%s\n%zu vertices, %zu triangles", shown_state.path.filename().c_str(),
                    shown_state.model->geometry().positions.size(),
                    shown_state.model->geometry().triangles.size());
    else if (!session.opening())
        ImGui::TextUnformatted("Drop a mesh file on this window.");
    if (session.opening())
        ImGui::TextUnformatted("reading ...");

    if (ImGui::CollapsingHeader("Solve", ImGuiTreeNodeFlags_DefaultOpen)) {
        solver_widgets(state, session);
        if (session.solving() && !session.opening()) {
            progress_line(!shown_state.is_solved ? "draft" : "solving", session.solve_progress());
            input.cancel |= ImGui::Button("cancel");
        } else if (session.was_cancelled() && shown_state.model) {
            ImGui::TextUnformatted(!shown_state.is_solved ? "cancelled"
                                   : shown_state.is_draft ? "cancelled: the draft is shown"
                                                          : "cancelled: the last answer is shown");
            ImGui::SameLine();
            input.solve_again |= ImGui::SmallButton("solve");
        }
        stage_lines(shown_state);
        histogram(session);
    }
    if (shown_state.model && ImGui::CollapsingHeader("Parts"))
        edit_parts(shown_state.model->mesh->scene, state.settings.parts);
    if (ImGui::CollapsingHeader("Show", ImGuiTreeNodeFlags_DefaultOpen)) {
        input.view_changed |= view_widgets(state);
        input.frame_all |= ImGui::Button("frame all");
    }
    if (ImGui::CollapsingHeader("Ray reference", ImGuiTreeNodeFlags_DefaultOpen)) {
        ImGui::Checkbox("trace", &state.wants_reference);
        ImGui::SameLine();
        int half = state.reference_rays / 2;
        if (ImGui::SliderInt("rays##reference", &half, 8, 4096, "2 x %d",
                             ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
            state.reference_rays = 2 * half;
        int place = static_cast<int>(state.reference_place);
        if (ImGui::Combo("comparison", &place, "none\0wipe\0side by side\0")) {
            state.reference_place = static_cast<ReferencePlace>(place);
            input.view_changed = true;
        }
        if (session.tracing())
            progress_line("tracing", session.trace_progress());
        else if (needs_reference(state) && shown_state.model && !shown_state.has_reference())
            ImGui::TextUnformatted("not traced: the result is shown instead");
    }
    if (ImGui::CollapsingHeader("Save")) {
        ImGui::InputText("##picture", state.picture_path, sizeof state.picture_path);
        ImGui::SameLine();
        input.save_picture |= ImGui::Button("picture");
        ImGui::InputText("##baked", state.baked_path, sizeof state.baked_path);
        ImGui::SameLine();
        input.save_baked |= ImGui::Button("baked");
        for (const std::filesystem::path& file : figures.written)
            ImGui::TextDisabled("wrote %s", file.c_str());
    }
    ImGui::Separator();
    ImGui::Text("%.1f ms (%.0f frames/s), %d samples", figures.frame_ms,
                figures.frame_ms > 0.0 ? 1000.0 / figures.frame_ms : 0.0, figures.samples);
    ImGui::TextDisabled("%s", figures.device.c_str());
    if (ImGui::SmallButton("keys (H)"))
        state.shows_help = !state.shows_help;
    const ImVec4 warning(1.0f, 0.55f, 0.45f, 1.0f);
    ImGui::PushTextWrapPos(0.0f);
    if (!shown_state.message.empty())
        ImGui::TextColored(warning, "%s", shown_state.message.c_str());
    if (!figures.note.empty())
        ImGui::TextUnformatted(figures.note.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopItemWidth();
    ImGui::End();
}

void Panel::draw()
{
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace surfelao
