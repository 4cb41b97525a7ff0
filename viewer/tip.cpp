#include "viewer/tip.h"

#include <imgui.h>

namespace surfelao {

void tip(const char* text)
{
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        return;
    constexpr float kLettersWide = 28.0f;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(kLettersWide * ImGui::GetFontSize());
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

}  // namespace surfelao
