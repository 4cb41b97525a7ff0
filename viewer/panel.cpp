#include "viewer/panel.h"

#include "image/heat_map.h"

#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace surfelao {
namespace {

constexpr float kWidth = 330.0f;  // of the panel, unscaled pixels
constexpr float kGrip = 6.0f;     // how near to the wipe's line a press takes it, unscaled pixels
constexpr float kDegreesPerPixel = 0.35f;
constexpr float kZoomPerNotch = 0.88f;
constexpr int kBins = 48;

constexpr const char* kColorNames[] = {"visibility", "rays",   "difference", "bent normals",
                                       "normals",    "levels", "environment"};
constexpr const char* kSurfaceNames[] = {"triangles", "splats", "affine", "points"};

constexpr const char* kHelp[][2] = {
    {"left drag", "orbit"},
    {"right or middle drag", "pan"},
    {"wheel, + and -", "zoom"},
    {"F", "frame all"},
    {"1 .. 7", "colours, in the panel's order"},
    {"T", "next surface: triangles, splats, affine, points"},
    {"R", "ray reference on or off"},
    {"W", "wipe to the reference on or off; drag the line"},
    {"S", "reference side by side on or off"},
    {"G", "ground on or off"},
    {"Esc", "cancel what runs in the background"},
    {"Tab", "hide or show the panel"},
    {"P", "save the picture"},
    {"B", "save the baked file"},
    {"H", "this help"},
    {"Q", "quit"},
    {"drop a file", "open it"},
};

ImVec4 shown(glm::vec3 linear)
{
    return {srgb_encode(linear.r), srgb_encode(linear.g), srgb_encode(linear.b), 1.0f};
}

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

/// True when the value is final: dragging a slider asks for nothing until it is let go.
bool was_set()
{
    return ImGui::IsItemDeactivatedAfterEdit();
}

/// Apart from the engine. True when they are to be solved.
bool edit_settings(EngineSettings& engine)
{
    bool apply = false;
    if (engine.engine == Engine::rays) {
        int rays = static_cast<int>(engine.rays);
        ImGui::SliderInt("rays", &rays, 1, 4096, "%d",
                         ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
        engine.rays = static_cast<std::uint32_t>(rays);
        return was_set();
    }
    ImGui::SliderFloat("quality", &engine.quality, least_quality(engine.engine),
                       most_quality(engine.engine), "%.2f", ImGuiSliderFlags_AlwaysClamp);
    apply |= was_set();
    if (engine.engine == Engine::disks) {
        ImGui::SliderInt("passes", &engine.passes, 1, 8, "%d", ImGuiSliderFlags_AlwaysClamp);
        apply |= was_set();
        ImGui::SliderFloat("strength", &engine.strength, 0.0f, 2.0f, "%.2f",
                           ImGuiSliderFlags_AlwaysClamp);
        apply |= was_set();
    }
    return apply;
}

/// falloff: what a limit has, once there is one. True when the limit is final.
bool edit_distance(DistanceLimit& limit, Falloff& falloff)
{
    float percent = std::isfinite(limit.value) ? static_cast<float>(limit.value) : 0.0f;
    if (percent > 0.0f)
        falloff = limit.falloff;
    if (ImGui::SliderFloat("distance", &percent, 0.0f, 100.0f,
                           percent > 0.0f ? "%.1f %%" : "unlimited",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
        limit = percent > 0.0f ? DistanceLimit{percent, true, falloff} : DistanceLimit{};
    bool apply = was_set();
    bool smooth = falloff == Falloff::smooth;
    if (percent > 0.0f && ImGui::Checkbox("smooth falloff", &smooth)) {
        limit.falloff = smooth ? Falloff::smooth : Falloff::none;
        apply = true;
    }
    return apply;
}

bool view_widgets(PanelState& state)
{
    ViewOptions& view = state.view;
    bool changed = false;
    int colors = static_cast<int>(view.colors);
    if (ImGui::Combo("colours", &colors, kColorNames, IM_ARRAYSIZE(kColorNames))) {
        view.colors = static_cast<Colors>(colors);
        changed = true;
    }
    int surface = static_cast<int>(view.surface);
    if (ImGui::Combo("surface", &surface, kSurfaceNames, IM_ARRAYSIZE(kSurfaceNames))) {
        view.surface = static_cast<Surface>(surface);
        changed = true;
    }
    if (view.surface != Surface::triangles)
        changed |= ImGui::SliderFloat("splat radius", &view.radius_scale, 0.1f, 4.0f, "%.2f",
                                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (view.colors == Colors::environment)
        changed |= ImGui::SliderFloat("exposure", &view.exposure, -6.0f, 6.0f, "%.1f EV",
                                      ImGuiSliderFlags_AlwaysClamp);
    if (view.colors == Colors::difference)
        changed |= ImGui::SliderFloat("full scale", &view.difference_scale, 0.001f, 1.0f, "%.3f",
                                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    changed |= ImGui::Checkbox("ground", &view.ground);
    return changed;
}

void progress_line(const char* what, double done)
{
    char text[64];
    std::snprintf(text, sizeof text, "%s %.0f %%", what, 100.0 * done);
    ImGui::ProgressBar(static_cast<float>(done), ImVec2(-1.0f, 0.0f), text);
}

void stage_lines(const SessionState& s)
{
    if (s.build_s)
        ImGui::Text("read %.3f s   build %.3f s   solve %.3f s", s.read_s, *s.build_s, s.solve_s);
    else
        ImGui::Text("read %.3f s   solve %.3f s", s.read_s, s.solve_s);
    if (!s.reference.empty() && s.reference_s)
        ImGui::Text("reference %.3f s", *s.reference_s);
    else if (!s.reference.empty())
        ImGui::TextUnformatted("reference from the cache");
    if (s.error)
        ImGui::Text("RMSE %.4f   bias %+.4f\n95 %% %.4f   max %.4f", s.error->rmse, s.error->bias,
                    s.error->p95, s.error->max);
}

/// Of an answer that is still on the device when nothing else runs: drafts are not worth the wait.
void histogram(const Session& session)
{
    const SessionState& s = session.state();
    if (!s.is_solved || (!session.has_read_answer() && session.solving()))
        return;
    const std::vector<Occlusion>& occlusion = session.occlusion();
    std::array<std::size_t, kBins> bins{};
    const std::size_t vertices = s.model->geometry.positions.size();
    for (std::size_t v = 0; v < vertices; ++v) {
        const float position = occlusion[v].occlusion * static_cast<float>(kBins);
        ++bins[std::min(static_cast<std::size_t>(position), bins.size() - 1)];
    }
    // roots, so that the many open vertices do not flatten the rest
    const float most = std::sqrt(static_cast<float>(*std::max_element(bins.begin(), bins.end())));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, 70.0f * ImGui::GetIO().FontGlobalScale);
    const float step = size.x / kBins;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, ImVec2(corner.x + size.x, corner.y + size.y),
                       ImGui::GetColorU32(ImGuiCol_FrameBg));
    for (std::size_t i = 0; i < bins.size(); ++i) {
        const float left = corner.x + step * static_cast<float>(i);
        const float height = size.y * std::sqrt(static_cast<float>(bins[i])) / std::max(most, 1.0f);
        list.AddRectFilled(ImVec2(left, corner.y + size.y - height),
                           ImVec2(left + step - 1.0f, corner.y + size.y),
                           ImGui::GetColorU32(ImGuiCol_PlotHistogram));
    }
    const char* title = "vertices by occlusion 0 .. 1, root scale";
    list.AddText(ImVec2(corner.x + size.x - ImGui::CalcTextSize(title).x - 4.0f, corner.y),
                 ImGui::GetColorU32(ImGuiCol_Text), title);
    ImGui::Dummy(size);
    if (ImGui::IsItemHovered()) {
        const float at = (ImGui::GetIO().MousePos.x - corner.x) / step;
        const auto bin =
            static_cast<std::size_t>(std::clamp(at, 0.0f, static_cast<float>(kBins - 1)));
        ImGui::SetTooltip("%zu vertices from %.2f to %.2f", bins[bin],
                          static_cast<double>(bin) / kBins, static_cast<double>(bin + 1) / kBins);
    }
}

/// The twin of draw_heat_legend, in the lower right corner of the window.
void legend(const char* title, float low, float high)
{
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(display.x - 10.0f, display.y - 10.0f), ImGuiCond_Always,
                            ImVec2(1.0f, 1.0f));
    ImGui::Begin("##legend", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings);
    ImGui::TextUnformatted(title);
    const float scale = ImGui::GetIO().FontGlobalScale;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size(220.0f * scale, 14.0f * scale);
    constexpr int kSteps = 32;
    for (int i = 0; i < kSteps; ++i) {
        const auto at = [&](int step) {
            return corner.x + size.x * static_cast<float>(step) / kSteps;
        };
        const auto color = [](int step) {
            return ImGui::GetColorU32(shown(heat_color(static_cast<float>(step) / kSteps)));
        };
        ImGui::GetWindowDrawList()->AddRectFilledMultiColor(
            ImVec2(at(i), corner.y), ImVec2(at(i + 1), corner.y + size.y), color(i), color(i + 1),
            color(i + 1), color(i));
    }
    ImGui::Dummy(size);
    ImGui::Text("%.3g", static_cast<double>(low));
    ImGui::SameLine(size.x - 30.0f * scale);
    ImGui::Text("%.3g", static_cast<double>(high));
    ImGui::End();
}

void help_window(bool& open)
{
    ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x - 10.0f, 10.0f), ImGuiCond_Always,
                            ImVec2(1.0f, 0.0f));
    if (ImGui::Begin("Keys", &open,
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                         ImGuiWindowFlags_NoSavedSettings) &&
        ImGui::BeginTable("keys", 2)) {
        for (const auto& line : kHelp) {
            ImGui::TableNextColumn();
            ImGui::TextColored(ImVec4(1.0f, 0.8f, 0.5f, 1.0f), "%s", line[0]);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line[1]);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

void switch_place(PanelState& state, ReferencePlace place)
{
    state.reference_place = state.reference_place == place ? ReferencePlace::nowhere : place;
}

/// One key that the widgets leave to the picture.
void press(char key, PanelState& state, PanelInput& input)
{
    input.view_changed |= std::string_view("1234567TGWS").find(key) != std::string_view::npos;
    switch (key) {
        case 'T':
            state.view.surface =
                static_cast<Surface>((static_cast<int>(state.view.surface) + 1) % 4);
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
            if (key >= '1' && key <= '7')
                state.view.colors = static_cast<Colors>(key - '1');
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

/// Nothing else can be used while it is open.
void question_window(const SaveQuestion& question, SaveReply& reply)
{
    constexpr const char* kTitle = "Save";
    if (!ImGui::IsPopupOpen(kTitle))
        ImGui::OpenPopup(kTitle);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * display.x, 0.5f * display.y), ImGuiCond_Always,
                            ImVec2(0.5f, 0.5f));
    if (!ImGui::BeginPopupModal(kTitle, nullptr,
                                ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings))
        return;
    const std::string name = question.path.string();
    if (question.is_input)
        ImGui::Text("%s was read and is never replaced.", name.c_str());
    else
        ImGui::Text("%s exists. Replace it?", name.c_str());
    const auto button = [&](const char* label, SaveReply meaning) {
        if (ImGui::Button(label))
            reply = meaning;
        ImGui::SameLine();
    };
    if (!question.is_input)
        button("Replace (R)", SaveReply::replace);
    button("Keep both (K)", SaveReply::keep_both);
    button("Cancel (Esc)", SaveReply::cancel);
    if (reply != SaveReply::none)
        ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
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
    if (state.view.colors == Colors::difference)
        legend("occlusion difference to rays", 0.0f, state.view.difference_scale);
    if (state.view.colors == Colors::levels && session.state().model) {
        const glm::vec2 range = level_range(*session.state().model);
        legend("octree level", range.x, range.y);
    }
    const float left = input.covered * display.x;
    const float line =
        left +
        (display.x - left) * (state.reference_place == ReferencePlace::wipe ? state.wipe : 0.5f);
    if (state.reference_place != ReferencePlace::nowhere)
        place_labels(line, name_of(state.settings.engine).c_str(),
                     session.state().reference.empty() ? "no rays yet" : "rays");
    mouse(state, input, line, left);
    if (input.view_changed && needs_reference(state))
        state.wants_reference = true;
    ImGui::Render();
    return input;
}

void Panel::solver_widgets(PanelState& state)
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
                    shown_state.model->geometry.positions.size(),
                    shown_state.model->geometry.triangles.size());
    else if (!session.opening())
        ImGui::TextUnformatted("Drop a mesh file on this window.");
    if (session.opening())
        ImGui::TextUnformatted("reading ...");

    if (ImGui::CollapsingHeader("Solve", ImGuiTreeNodeFlags_DefaultOpen)) {
        solver_widgets(state);
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
        else if (needs_reference(state) && shown_state.model && shown_state.reference.empty())
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
