/// gizmo.h: three arrows, three rings and a square by which a part is moved in a picture.
///
///          y          arrows: along the axes of the file
///          |  __      rings:  about them
///         [ ]/  \     square: along the picture
///         / \    |
///        z   x--'     all of the same size in pixels, however far the part is
///
/// Mathematics only; lines are drawn by whoever has a picture.
#pragma once

#include "viewer/model_pose.h"
#include "viewer/pick.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace surfelao {

enum class GizmoHandle {
    none,
    move_x,
    move_y,
    move_z,
    turn_x,
    turn_y,
    turn_z,
    move_in_view,
};

/// A gizmo as it is seen in a picture.
class Gizmo {
public:
    /// centre: unit frame. length: of an arrow, in pixels.
    Gizmo(const View& view, int width, int height, glm::dvec3 centre, float length);

    struct Line {
        GizmoHandle handle;
        std::vector<glm::vec2> points;  ///< pixels, from the lower left corner
    };
    /// Empty where the centre is behind the eye.
    [[nodiscard]] const std::vector<Line>& lines() const { return lines_; }

    /// The handle whose line is nearest, if it is no farther than `reach` pixels.
    [[nodiscard]] GizmoHandle handle_at(glm::vec2 pixel, float reach) const;

private:
    std::vector<Line> lines_;
};

/// What a drag makes of a move. centre: of the part before the drag, with the move in it. from, to:
/// the rays of the pixels where the handle was taken and where the mouse is. forward: of the view.
/// Along an axis the part follows the point of the axis that is nearest to the ray. About an axis
/// it turns by the angle that the mouse has gone in the plane of the ring; where that plane is seen
/// from its edge, by the way along it over the distance `radius` of the ring.
[[nodiscard]] PartMove dragged(const PartMove& start, GizmoHandle handle, glm::dvec3 centre,
                               const SightRay& from, const SightRay& to, glm::dvec3 forward,
                               double radius);

/// How far a length of so many pixels reaches at that point. Unit frame.
[[nodiscard]] double length_of_pixels(const View& view, int height, glm::dvec3 point, float pixels);

/// A rotation as three angles, about x first, then y, then z; degrees.
[[nodiscard]] glm::dvec3 degrees_of(const glm::dquat& rotation);
[[nodiscard]] glm::dquat rotation_of(glm::dvec3 degrees);

}  // namespace surfelao
