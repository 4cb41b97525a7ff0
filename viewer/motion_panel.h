/// motion_panel.h: the widgets and the gizmo by which a user moves parts and plays animations.
#pragma once

#include "gpu/objects.h"
#include "pixels/camera.h"
#include "viewer/gizmo.h"
#include "viewer/mover.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// What the window shows of the model. Rectangles in its pixels, y upwards.
struct MotionView {
    Camera camera;
    std::vector<Rect> pictures;            ///< apart from each other, all by the same camera
    std::span<const glm::vec3> positions;  ///< as they are shown
    std::span<const glm::uvec3> triangles;
    bool is_culled = false;  ///< ViewOptions::cull
};

/// All are called between ImGui's NewFrame and Render.
class MotionPanel {
public:
    explicit MotionPanel(Mover& mover) : mover_(mover) {}

    /// A section of the panel, with its title. draw_ms: of the last frame.
    void widgets(double draw_ms);

    /// Draws gizmo and box over the pictures and takes the mouse where it is theirs: true while it
    /// is, so that nothing else follows it.
    bool mouse(const MotionView& view);

    /// Space and Z. Escape takes the selection away: false where there is none.
    void play() { mover_.player().toggle(); }
    void undo() { mover_.undo(); }
    bool deselect();
    /// The part that the scene's vertex is of.
    void select_vertex(std::uint32_t vertex) { mover_.select_vertex(vertex); }

private:
    struct Drag {
        GizmoHandle handle;
        PartMove start;
        glm::dvec3 centre;  ///< before the drag
        SightRay from;
        Rect picture;
        double radius;
    };
    void part_list();
    void numbers(std::uint32_t movable);
    void playing();
    void figures(double draw_ms) const;
    void draw_box(const MotionView& view, const Rect& picture);
    void draw_gizmo(const Gizmo& gizmo, const Rect& picture, GizmoHandle lit) const;
    bool start_drag(const MotionView& view, const Rect& picture, glm::vec2 pixel);
    void go_on(const MotionView& view, glm::vec2 mouse);
    void pick(const MotionView& view, const Rect& picture, glm::vec2 pixel);
    [[nodiscard]] glm::dvec3 centre_of(std::uint32_t movable) const;

    Mover& mover_;
    std::optional<Drag> drag_;
    bool is_pressed_ = false;  ///< in a picture, on no handle
    bool holds_widget_ = false;
    std::optional<std::uint32_t> listed_;  ///< selection that the list has scrolled to
    bool was_open_ = false;                ///< opened by itself once
};

}  // namespace surfelao
