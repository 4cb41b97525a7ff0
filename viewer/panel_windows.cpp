#include "viewer/panel_windows.h"

#include "surfels/srgb.h"

#include <imgui.h>

#include <algorithm>

namespace surfelao {
namespace {

constexpr float kQuestionWide = 32.0f;  // letters

constexpr const char* kHelp[][2] = {
    {"left drag", "orbit"},
    {"right or middle drag", "pan"},
    {"wheel, + and -", "zoom"},
    {"F", "frame all"},
    {"1 .. 9, 0", "colours, in the panel's order"},
    {"A", "the map flat or on the model, where there is one"},
    {"T", "next surface: triangles, splats, affine, points"},
    {"R", "rays on or off"},
    {"W", "wipe to the right cell on or off; drag the line"},
    {"S", "the right cell side by side on or off"},
    {"L", "a light at the eye"},
    {"X", "wireframe on or off"},
    {"K", "cull backs on or off: look into a room"},
    {"I", "values under the mouse on or off"},
    {"V", "fly: W S forward and back, A D aside, E Q up and down"},
    {"  in flight", "left drag looks, wheel changes the speed, V or Esc ends it"},
    {"C", "with cube maps: one where the eye is"},
    {"G", "shadow on the ground on or off"},
    {"click", "select the part under the mouse"},
    {"drag its gizmo", "move it: arrows, rings, square"},
    {"Z", "undo the last move"},
    {"space", "play or pause the animation"},
    {"Esc", "close this help; else deselect; else cancel what runs in the background"},
    {"Tab", "hide or show the panel"},
    {"P", "save the picture"},
    {"B", "save the baked file"},
    {"H", "this help"},
    {"Q", "quit"},
    {"O", "open a file"},
    {"drop files", "open them: the first is shown"},
};

ImVec4 as_shown(glm::vec3 linear)
{
    return {srgb_encode(linear.r), srgb_encode(linear.g), srgb_encode(linear.b), 1.0f};
}

}  // namespace

void legend(const Legend& shown)
{
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(display.x - 10.0f, display.y - 10.0f), ImGuiCond_Always,
                            ImVec2(1.0f, 1.0f));
    ImGui::Begin("##legend", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings);
    ImGui::TextUnformatted(shown.title.c_str());
    const float scale = ImGui::GetIO().FontGlobalScale;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size(220.0f * scale, 14.0f * scale);
    constexpr int kBars = 32;
    for (int i = 0; i < kBars; ++i) {
        const auto at = [&](int step) {
            return corner.x + size.x * static_cast<float>(step) / kBars;
        };
        const auto color = [&](int step) {
            return ImGui::GetColorU32(
                as_shown(map_color(shown.colors, static_cast<float>(step) / kBars)));
        };
        ImGui::GetWindowDrawList()->AddRectFilledMultiColor(
            ImVec2(at(i), corner.y), ImVec2(at(i + 1), corner.y + size.y), color(i), color(i + 1),
            color(i + 1), color(i));
    }
    ImGui::Dummy(size);
    ImGui::TextUnformatted(legend_number(shown.low).c_str());
    ImGui::SameLine(size.x - 30.0f * scale);
    ImGui::TextUnformatted(legend_number(shown.high).c_str());
    ImGui::End();
}

void help_window(bool& open)
{
    const float unit = ImGui::GetFontSize();
    const float margin = 0.7f * unit, wide = 32.0f * unit;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const ImVec2 room(display.x - 2.0f * margin, display.y - 2.0f * margin);
    ImGui::SetNextWindowPos(ImVec2(display.x - margin, margin), ImGuiCond_Always,
                            ImVec2(1.0f, 0.0f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(0.0f, 0.0f), room);
    ImGui::SetNextWindowSize(ImVec2(std::min(wide, room.x), 0.0f));
    if (ImGui::Begin("Keys", &open,
                     ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                         ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings) &&
        ImGui::BeginTable("keys", 2)) {
        ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthFixed);
        ImGui::TableSetupColumn("meaning", ImGuiTableColumnFlags_WidthStretch);
        for (const auto& line : kHelp) {
            ImGui::TableNextColumn();
            ImGui::TextColored(ImVec4(1.0f, 0.8f, 0.5f, 1.0f), "%s", line[0]);
            ImGui::TableNextColumn();
            ImGui::TextWrapped("%s", line[1]);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

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
    ImGui::PushTextWrapPos(kQuestionWide * ImGui::GetFontSize());
    for (const std::filesystem::path& file : question.there)
        ImGui::TextUnformatted(file.c_str());
    ImGui::PopTextWrapPos();
    const bool is_one = question.there.size() == 1;
    if (question.is_input)
        ImGui::TextUnformatted(is_one ? "was read and is never replaced."
                                      : "exist; what was read is never replaced.");
    else
        ImGui::TextUnformatted(is_one ? "exists. Replace it?" : "exist. Replace them?");
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

}  // namespace surfelao
