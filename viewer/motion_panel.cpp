#include "viewer/motion_panel.h"

#include "pixels/seen.h"
#include "viewer/tip.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

namespace surfelao {
namespace {

// pixels at a scale of 1
constexpr float kArrow = 90.0f;
constexpr float kReach = 7.0f;  // how near to a handle a press takes it
constexpr float kClick = 4.0f;  // less is a click, more a drag

constexpr ImU32 kHandleColors[] = {IM_COL32(0, 0, 0, 0),        IM_COL32(235, 70, 60, 255),
                                   IM_COL32(110, 200, 60, 255), IM_COL32(70, 130, 250, 255),
                                   IM_COL32(235, 70, 60, 255),  IM_COL32(110, 200, 60, 255),
                                   IM_COL32(70, 130, 250, 255), IM_COL32(240, 240, 240, 255)};
constexpr ImU32 kLit = IM_COL32(255, 215, 60, 255);
constexpr ImU32 kBox = IM_COL32(255, 160, 40, 150);

float pixel_scale()
{
    return std::max(1.0f, ImGui::GetIO().DisplayFramebufferScale.y);
}

/// From the window's pixels, y upwards, to ImGui's places.
ImVec2 place_in_window(glm::vec2 pixel)
{
    const float scale = pixel_scale();
    return {pixel.x / scale, ImGui::GetIO().DisplaySize.y - pixel.y / scale};
}

glm::vec2 mouse_pixel()
{
    const ImGuiIO& io = ImGui::GetIO();
    return pixel_scale() * glm::vec2(io.MousePos.x, io.DisplaySize.y - io.MousePos.y);
}

glm::vec2 corner_of(const Rect& picture)
{
    return {picture.x, picture.y};
}

bool is_in(const Rect& picture, glm::vec2 pixel)
{
    const glm::vec2 at = pixel - corner_of(picture);
    return at.x >= 0.0f && at.y >= 0.0f && at.x < static_cast<float>(picture.width) &&
           at.y < static_cast<float>(picture.height);
}

View view_in(const MotionView& view, const Rect& picture)
{
    return view_of(view.camera, picture.width, picture.height);
}

float arrow_pixels()
{
    return kArrow * ImGui::GetIO().FontGlobalScale * pixel_scale();
}

float reach_pixels()
{
    return kReach * ImGui::GetIO().FontGlobalScale * pixel_scale();
}

std::string title_of(const std::vector<std::string>& animations, std::size_t index)
{
    const std::string& name = animations[index];
    return name.empty() ? "animation " + std::to_string(index) : name;
}

}  // namespace

bool MotionPanel::deselect()
{
    if (!mover_.selected())
        return false;
    mover_.select(std::nullopt);
    return true;
}

glm::dvec3 MotionPanel::centre_of(std::uint32_t movable) const
{
    return mover_.middle_of(movable) + mover_.move_of(movable).translation;
}

void MotionPanel::widgets(double draw_ms)
{
    const bool has_something = mover_.selected() || !mover_.animations().empty();
    if (has_something && !was_open_) {
        ImGui::SetNextItemOpen(true);
        was_open_ = true;
    }
    if (!ImGui::CollapsingHeader("Move"))
        return;
    if (!mover_.refusal().empty()) {
        ImGui::TextWrapped("%s", mover_.refusal().c_str());
        return;
    }
    if (!mover_.movables())
        return;
    part_list();
    if (mover_.selected())
        numbers(*mover_.selected());
    else
        ImGui::TextDisabled("click a part to move it");
    ImGui::BeginDisabled(!mover_.is_moved());
    if (ImGui::SmallButton("reset all"))
        mover_.reset_all();
    ImGui::EndDisabled();
    tip("all parts go back to where the file has them");
    ImGui::SameLine();
    ImGui::BeginDisabled(!mover_.can_undo());
    if (ImGui::SmallButton("undo (Z)"))
        mover_.undo();
    ImGui::EndDisabled();
    tip("takes back the last move");
    if (!mover_.animations().empty())
        playing();
    figures(draw_ms);
    if (!mover_.message().empty())
        ImGui::TextWrapped("%s", mover_.message().c_str());
}

void MotionPanel::part_list()
{
    constexpr float kRows = 5.5f;
    const std::vector<Movable>& list = mover_.movables()->list;
    const float rows = std::min(kRows, static_cast<float>(list.size()) + 0.5f);
    if (!ImGui::BeginListBox("##movables",
                             ImVec2(-1.0f, rows * ImGui::GetTextLineHeightWithSpacing())))
        return;
    const auto selected = mover_.selected();
    if (selected && listed_ != selected)
        ImGui::SetScrollY(ImGui::GetTextLineHeightWithSpacing() *
                          (static_cast<float>(*selected) - 1.0f));
    listed_ = selected;
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(list.size()));
    while (clipper.Step()) {
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const auto movable = static_cast<std::uint32_t>(i);
            ImGui::PushID(i);
            if (ImGui::Selectable(list[movable].name.c_str(), selected == movable)) {
                mover_.select(movable);
                listed_ = movable;
            }
            if (ImGui::IsItemHovered())
                ImGui::SetTooltip("%s, %llu triangles", list[movable].name.c_str(),
                                  static_cast<unsigned long long>(list[movable].triangles));
            ImGui::PopID();
        }
    }
    ImGui::EndListBox();
}

void MotionPanel::numbers(std::uint32_t movable)
{
    const PartMove before = mover_.move_of(movable);
    PartMove move = before;
    const double diagonal = mover_.base()->geometry().frame.diagonal;
    const auto edited = [&](bool is_edited) {
        if (ImGui::IsItemActivated())
            mover_.remember();
        holds_widget_ |= ImGui::IsItemActive();
        return is_edited;
    };
    ImGui::PushItemWidth(-60.0f * ImGui::GetIO().FontGlobalScale);
    glm::dvec3 translation = diagonal * before.translation;
    if (edited(ImGui::DragScalarN("move", ImGuiDataType_Double, &translation.x, 3,
                                  static_cast<float>(0.001 * diagonal), nullptr, nullptr, "%.4g")))
        move.translation = translation / diagonal;
    tip("along x, y, z in the file's units: drag, or double-click to type");
    glm::dvec3 degrees = degrees_of(before.rotation);
    if (edited(ImGui::DragScalarN("turn", ImGuiDataType_Double, &degrees.x, 3, 0.5f, nullptr,
                                  nullptr, "%.1f")))
        move.rotation = rotation_of(degrees);
    tip("about x, then y, then z, in degrees");
    constexpr double kLeastScale = 0.01, kMostScale = 100.0;
    double scale = before.scale;
    if (edited(ImGui::DragScalar("scale", ImGuiDataType_Double, &scale, 0.005f, &kLeastScale,
                                 &kMostScale, "%.3f", ImGuiSliderFlags_AlwaysClamp)))
        move.scale = scale;
    tip("about the part's middle, 0.01 to 100");
    ImGui::PopItemWidth();
    if (move != before)
        mover_.set_move(movable, move);
    ImGui::BeginDisabled(move == PartMove{});
    if (ImGui::SmallButton("reset part")) {
        mover_.remember();
        mover_.set_move(movable, {});
    }
    ImGui::EndDisabled();
    tip("this part goes back to where the file has it");
    ImGui::SameLine();
}

void MotionPanel::playing()
{
    const std::vector<std::string>& animations = mover_.animations();
    const std::string shown =
        mover_.chosen() ? title_of(animations, *mover_.chosen()) : "as it was read";
    if (ImGui::BeginCombo("plays", shown.c_str())) {
        if (ImGui::Selectable("as it was read", !mover_.chosen()))
            mover_.choose(std::nullopt);
        for (std::size_t i = 0; i < animations.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));
            if (ImGui::Selectable(title_of(animations, i).c_str(), mover_.chosen() == i))
                mover_.choose(i);
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    tip("which of the file's animations is shown");
    if (!mover_.is_ready())
        return;
    Player& player = mover_.player();
    double seconds = player.seconds;
    if (ImGui::SliderScalar("seconds", ImGuiDataType_Double, &seconds, &player.first, &player.last,
                            "%.3f", ImGuiSliderFlags_AlwaysClamp)) {
        player.is_playing = false;
        player.seek(seconds);
    }
    holds_widget_ |= ImGui::IsItemActive();
    tip("the moment of the animation that is shown");
    if (ImGui::Button(player.is_playing ? "pause (space)" : "play (space)"))
        player.toggle();
    tip("each frame shows the time at which it is asked for, however long solving takes");
    ImGui::SameLine();
    ImGui::Checkbox("loop", &player.loops);
    tip("begins anew at its end");
    constexpr double kSlowest = 0.05, kFastest = 4.0;
    ImGui::SliderScalar("speed", ImGuiDataType_Double, &player.speed, &kSlowest, &kFastest,
                        "%.2f x", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    tip("times the file's own, 0.05 to 4");
}

void MotionPanel::figures(double draw_ms) const
{
    const MovingFrame* frame = mover_.last_frame();
    if (!frame)
        return;
    const FrameReport& report = frame->report;
    ImGui::Text("pose %.1f  place %.1f  tree %.1f\nsolve %.1f  draw %.1f ms", 1e3 * frame->pose_s,
                1e3 * report.place, 1e3 * report.tree, 1e3 * report.solve, draw_ms);
    ImGui::TextWrapped("%llu of %zu receivers solved%s",
                       static_cast<unsigned long long>(report.solved), frame->receivers,
                       frame->is_whole ? "" : ", draft");
    if (report.bound > 0.0f)
        ImGui::Text("the others are off by %.4f at most", static_cast<double>(report.bound));
    if (mover_.frames_per_second() > 0.0)
        ImGui::Text("%.1f frames/s solved", mover_.frames_per_second());
}

void MotionPanel::draw_box(const MotionView& view, const Rect& picture)
{
    const Movables& movables = *mover_.movables();
    glm::vec3 low(std::numeric_limits<float>::max()), high = -low;
    for (const glm::uvec3 triangle : view.triangles) {
        if (movables.of_vertex[triangle.x] != *mover_.selected())
            continue;
        for (int k = 0; k < 3; ++k) {
            low = glm::min(low, view.positions[triangle[k]]);
            high = glm::max(high, view.positions[triangle[k]]);
        }
    }
    if (low.x > high.x)
        return;
    const View seen = view_in(view, picture);
    const auto corner = [&](int i) {
        const glm::dvec3 p((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                           (i & 4) != 0 ? high.z : low.z);
        return pixel_of(seen, picture.width, picture.height, p);
    };
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (int i = 0; i < 8; ++i) {
        for (const int bit : {1, 2, 4}) {
            const auto a = corner(i), b = corner(i | bit);
            if ((i & bit) == 0 && a && b)
                list.AddLine(place_in_window(corner_of(picture) + *a),
                             place_in_window(corner_of(picture) + *b), kBox,
                             1.5f * ImGui::GetIO().FontGlobalScale);
        }
    }
}

void MotionPanel::draw_gizmo(const Gizmo& gizmo, const Rect& picture, GizmoHandle lit) const
{
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float scale = ImGui::GetIO().FontGlobalScale;
    for (const Gizmo::Line& line : gizmo.lines()) {
        std::vector<ImVec2> points;
        for (const glm::vec2 point : line.points)
            points.push_back(place_in_window(corner_of(picture) + point));
        const bool is_lit = line.handle == lit;
        const ImU32 color = is_lit ? kLit : kHandleColors[static_cast<int>(line.handle)];
        const bool is_arrow = line.handle <= GizmoHandle::move_z;
        const float width = (is_lit ? 3.5f : is_arrow ? 2.5f : 1.5f) * scale;
        list.AddPolyline(points.data(), static_cast<int>(points.size()), color, ImDrawFlags_None,
                         width);
        if (is_arrow && !points.empty())
            list.AddCircleFilled(points.back(), 4.5f * scale, color);
    }
}

bool MotionPanel::start_drag(const MotionView& view, const Rect& picture, glm::vec2 pixel)
{
    const std::uint32_t movable = *mover_.selected();
    const glm::dvec3 centre = centre_of(movable);
    const View seen = view_in(view, picture);
    const Gizmo gizmo(seen, picture.width, picture.height, centre, arrow_pixels());
    const GizmoHandle handle = is_in(picture, pixel) && !ImGui::GetIO().WantCaptureMouse
                                   ? gizmo.handle_at(pixel - corner_of(picture), reach_pixels())
                                   : GizmoHandle::none;
    draw_gizmo(gizmo, picture, handle);
    if (handle == GizmoHandle::none)
        return false;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        mover_.remember();
        drag_ = Drag{
            handle,  mover_.move_of(movable),
            centre,  sight_ray(seen, picture.width, picture.height, pixel - corner_of(picture)),
            picture, length_of_pixels(seen, picture.height, centre, arrow_pixels())};
    }
    return true;
}

void MotionPanel::go_on(const MotionView& view, glm::vec2 mouse)
{
    const Rect& picture = drag_->picture;
    const View seen = view_in(view, picture);
    const std::uint32_t movable = *mover_.selected();
    mover_.set_move(
        movable, dragged(drag_->start, drag_->handle, drag_->centre, drag_->from,
                         sight_ray(seen, picture.width, picture.height, mouse - corner_of(picture)),
                         seen.forward, drag_->radius));
    draw_gizmo(Gizmo(seen, picture.width, picture.height, centre_of(movable), arrow_pixels()),
               picture, drag_->handle);
}

void MotionPanel::pick(const MotionView& view, const Rect& picture, glm::vec2 pixel)
{
    const SightRay ray = sight_ray(view_in(view, picture), picture.width, picture.height,
                                   pixel - corner_of(picture));
    const auto found = point_under(view.positions, view.triangles, ray, view.is_culled);
    if (found)
        mover_.select_vertex(view.triangles[found->triangle].x);
    else
        mover_.select(std::nullopt);
}

bool MotionPanel::mouse(const MotionView& view)
{
    const ImGuiIO& io = ImGui::GetIO();
    const glm::vec2 pixel = mouse_pixel();
    if (drag_ && (!mover_.selected() || !ImGui::IsMouseDown(ImGuiMouseButton_Left)))
        drag_.reset();
    bool is_taken = drag_.has_value();
    if (mover_.selected() && mover_.movables()) {
        for (const Rect& picture : view.pictures)
            draw_box(view, picture);
        if (drag_)
            go_on(view, pixel);
        else
            for (const Rect& picture : view.pictures)
                is_taken |= start_drag(view, picture, pixel);
    }
    // widgets that are not drawn any more hold nothing
    mover_.hold(drag_.has_value() || std::exchange(holds_widget_, false));
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left))
        is_pressed_ = !io.WantCaptureMouse && !is_taken;
    if (is_pressed_ && ImGui::IsMouseReleased(ImGuiMouseButton_Left)) {
        is_pressed_ = false;
        const float most = kClick * io.FontGlobalScale;
        for (const Rect& picture : view.pictures) {
            if (io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] < most * most &&
                is_in(picture, pixel) && mover_.movables())
                pick(view, picture, pixel);
        }
    }
    return is_taken;
}

}  // namespace surfelao
