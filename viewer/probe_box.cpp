#include "viewer/probe_box.h"

#include "pixels/seen.h"
#include "viewer/pick.h"
#include "viewer/probe.h"

#include <imgui.h>

#include <glm/vec2.hpp>

#include <algorithm>
#include <optional>

namespace surfelao {
namespace {

constexpr ImU32 kMarker = IM_COL32(255, 80, 200, 255);  // no colour of the gizmo's

float window_scale()
{
    return std::max(1.0f, ImGui::GetIO().DisplayFramebufferScale.y);
}

/// Where the mouse is in a picture of the window.
struct MouseInPicture {
    Rect picture;
    glm::vec2 pixel{0.0f};  ///< from the picture's lower left corner
};

/// Empty over widgets, beside the pictures, and while a button is down.
std::optional<MouseInPicture> mouse_in_picture(const MotionView& view)
{
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse || ImGui::IsAnyMouseDown() || !ImGui::IsMousePosValid())
        return std::nullopt;
    const glm::vec2 mouse =
        window_scale() * glm::vec2(io.MousePos.x, io.DisplaySize.y - io.MousePos.y);
    for (const Rect& picture : view.pictures) {
        const glm::vec2 pixel = mouse - glm::vec2(picture.x, picture.y);
        if (pixel.x >= 0.0f && pixel.y >= 0.0f && pixel.x < static_cast<float>(picture.width) &&
            pixel.y < static_cast<float>(picture.height))
            return MouseInPicture{picture, pixel};
    }
    return std::nullopt;
}

/// A marker, and the box.
void draw_reading(const Reading& reading, const MotionView& view, const Rect& picture)
{
    const View seen = view_of(view.camera, picture.width, picture.height);
    const auto pixel = pixel_of(seen, picture.width, picture.height, glm::dvec3(reading.place));
    if (!pixel)
        return;
    const ImGuiIO& io = ImGui::GetIO();
    const ImVec2 at((static_cast<float>(picture.x) + pixel->x) / window_scale(),
                    io.DisplaySize.y - (static_cast<float>(picture.y) + pixel->y) / window_scale());
    const float unit = ImGui::GetFontSize();
    ImGui::GetBackgroundDrawList()->AddCircle(at, 0.4f * unit, kMarker, 0, 2.0f);
    // beside the marker, on the side that has more room
    const bool is_left = at.x > 0.5f * io.DisplaySize.x, is_low = at.y > 0.5f * io.DisplaySize.y;
    ImGui::SetNextWindowPos(ImVec2(at.x + (is_left ? -unit : unit), at.y + (is_low ? -unit : unit)),
                            ImGuiCond_Always, ImVec2(is_left ? 1.0f : 0.0f, is_low ? 1.0f : 0.0f));
    ImGui::Begin("##reading", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::TextUnformatted(text_of(reading).c_str());
    ImGui::End();
}

}  // namespace

void tell_place(const MotionView& view, const CellView& cell_view, const Cell& cell)
{
    const std::optional<MouseInPicture> mouse = mouse_in_picture(view);
    if (!mouse)
        return;
    const Rect& picture = mouse->picture;
    const SightRay ray = sight_ray(view_of(view.camera, picture.width, picture.height),
                                   picture.width, picture.height, mouse->pixel);
    const auto point = point_under(view.positions, view.triangles, ray, view.is_culled);
    if (!point)
        return;
    // what lies on the pixels may be coarser than the window
    const auto [width, height] = cell_view.picture_size();
    const glm::vec2 share = mouse->pixel / glm::vec2(picture.width, picture.height);
    draw_reading(read_at(cell_view, cell, *point, glm::ivec2(share * glm::vec2(width, height))),
                 view, picture);
}

}  // namespace surfelao
