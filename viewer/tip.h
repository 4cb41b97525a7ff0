/// tip.h: what a widget does, where the mouse rests on it.
#pragma once

#include <imgui.h>

namespace surfelao {

/// Of the widget before it, also where that is greyed out.
inline void tip(const char* text)
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
