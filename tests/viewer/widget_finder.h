/// widget_finder.h: finds the panel's widgets as a user does: the mouse rests on place after place,
/// and ImGui tells what is under it. Nothing in the program knows of this.
#pragma once

#include "window_driver.h"

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace surfelao {

/// Goes over a part of the window, one place a frame.
class WidgetFinder {
public:
    /// columns: where it goes down, in units of the window. From `top` to `bottom` in these steps.
    WidgetFinder(std::vector<float> columns, float top, float bottom, float step)
        : columns_(std::move(columns)), top_(top), bottom_(bottom), step_(step), y_(top)
    {
    }

    /// To be called once a frame. False when it has been everywhere.
    bool go_on()
    {
        if (column_ >= columns_.size())
            return false;
        if (is_resting_)
            take();
        y_ += is_resting_ ? step_ : 0.0f;
        if (y_ > bottom_) {
            y_ = top_;
            ++column_;
        }
        is_resting_ = column_ < columns_.size();
        if (is_resting_)
            glfwSetCursorPos(glfwGetCurrentContext(), columns_[column_], y_);
        return is_resting_;
    }

    /// The middle of what was under the mouse.
    struct Found {
        ImVec2 first, last;
        bool has_tip = false;
        ImVec2 middle() const { return {0.5f * (first.x + last.x), 0.5f * (first.y + last.y)}; }
    };
    const std::map<ImGuiID, Found>& found() const { return found_; }

    /// By its label in the panel, if it was found.
    std::optional<ImVec2> place_of(const char* label) const
    {
        const auto at = found_.find(ImGui::FindWindowByName("surfelao")->GetID(label));
        return at == found_.end() ? std::nullopt : std::optional(at->second.middle());
    }

private:
    void take()
    {
        const ImGuiID id = ImGui::GetHoveredID();
        if (id == 0)
            return;
        const ImVec2 at(columns_[column_], y_);
        const ImGuiWindow* tip = ImGui::FindWindowByName("##Tooltip_00");
        Found& found = found_.try_emplace(id, Found{at, at}).first->second;
        found.last = at;
        found.has_tip |= tip != nullptr && tip->Active;
    }

    std::vector<float> columns_;
    float top_, bottom_, step_, y_;
    std::size_t column_ = 0;
    bool is_resting_ = false;
    std::map<ImGuiID, Found> found_;
};

}  // namespace surfelao
