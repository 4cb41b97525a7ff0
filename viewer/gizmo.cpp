#include "viewer/gizmo.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace surfelao {
namespace {

constexpr int kRingSteps = 48;
constexpr double kRingShare = 0.75;   // of an arrow's length
constexpr double kInnerShare = 0.15;  // where arrows begin, and half of the square
/// Sine of the angle between a ring's plane and the sight below which the plane is no use: a pixel
/// would be worth several times as much there.
constexpr double kEdgeOn = 0.15;

glm::dvec3 axis_of(GizmoHandle handle)
{
    glm::dvec3 axis(0.0);
    const int first =
        static_cast<int>(handle >= GizmoHandle::turn_x ? GizmoHandle::turn_x : GizmoHandle::move_x);
    axis[static_cast<int>(handle) - first] = 1.0;
    return axis;
}

/// Of the point of the line centre + t axis that is nearest to the ray: t.
double nearest_on_axis(glm::dvec3 centre, glm::dvec3 axis, const SightRay& ray)
{
    const glm::dvec3 between = ray.origin - centre;
    const double cosine = glm::dot(axis, ray.direction);
    const double sine2 = 1.0 - cosine * cosine;
    if (!(sine2 > 1e-6))  // the axis is seen as a point
        return 0.0;
    return (glm::dot(axis, between) - cosine * glm::dot(ray.direction, between)) / sine2;
}

/// Where the ray meets the plane; empty where it runs along it, or away from it.
std::optional<glm::dvec3> on_plane(glm::dvec3 centre, glm::dvec3 normal, const SightRay& ray)
{
    const double slope = glm::dot(normal, ray.direction);
    const double t = glm::dot(normal, centre - ray.origin) / slope;
    if (!(t > 0.0) || !std::isfinite(t))
        return std::nullopt;
    return ray.origin + t * ray.direction;
}

double distance_to_segment(glm::vec2 p, glm::vec2 a, glm::vec2 b)
{
    const glm::vec2 along = b - a;
    const float length2 = glm::dot(along, along);
    const float t =
        length2 > 0.0f ? glm::clamp(glm::dot(p - a, along) / length2, 0.0f, 1.0f) : 0.0f;
    return glm::distance(p, a + t * along);
}

/// Radians about the axis, from one ray to the other.
double angle_between(glm::dvec3 centre, glm::dvec3 axis, const SightRay& from, const SightRay& to,
                     double radius)
{
    if (std::abs(glm::dot(axis, glm::normalize(centre - from.origin))) < kEdgeOn) {
        const glm::dvec3 toward = glm::normalize(from.origin - centre);
        const glm::dvec3 tangent = glm::normalize(glm::cross(axis, toward));
        return (nearest_on_axis(centre, tangent, to) - nearest_on_axis(centre, tangent, from)) /
               radius;
    }
    const std::optional<glm::dvec3> a = on_plane(centre, axis, from);
    const std::optional<glm::dvec3> b = on_plane(centre, axis, to);
    if (!a || !b)
        return 0.0;
    const glm::dvec3 u = *a - centre, v = *b - centre;
    return std::atan2(glm::dot(axis, glm::cross(u, v)), glm::dot(u, v));
}

}  // namespace

double length_of_pixels(const View& view, int height, glm::dvec3 point, float pixels)
{
    const double high = view.lens.high.y - view.lens.low.y;
    const double depth =
        view.lens.orthographic ? 1.0 : static_cast<double>(to_view(view, glm::vec3(point)).z);
    return pixels / static_cast<double>(height) * high * depth;
}

Gizmo::Gizmo(const View& view, int width, int height, glm::dvec3 centre, float length)
{
    if (!pixel_of(view, width, height, centre))
        return;
    const double arrow = length_of_pixels(view, height, centre, length);
    const auto add = [&](GizmoHandle handle, const std::vector<glm::dvec3>& points) {
        Line& line = lines_.emplace_back(Line{handle, {}});
        for (const glm::dvec3& point : points) {
            if (const auto pixel = pixel_of(view, width, height, centre + arrow * point))
                line.points.push_back(*pixel);
        }
    };
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 axis(0.0), side(0.0), other(0.0);
        axis[k] = side[(k + 1) % 3] = other[(k + 2) % 3] = 1.0;
        add(static_cast<GizmoHandle>(static_cast<int>(GizmoHandle::move_x) + k),
            {kInnerShare * axis, axis});
        std::vector<glm::dvec3> ring;
        for (int i = 0; i <= kRingSteps; ++i) {
            const double angle = glm::two_pi<double>() * i / kRingSteps;
            ring.push_back(kRingShare * (std::cos(angle) * side + std::sin(angle) * other));
        }
        add(static_cast<GizmoHandle>(static_cast<int>(GizmoHandle::turn_x) + k), ring);
    }
    const glm::dvec3 right = kInnerShare * glm::dvec3(view.right);
    const glm::dvec3 up = kInnerShare * glm::dvec3(view.up);
    add(GizmoHandle::move_in_view, {right + up, right - up, -right - up, -right + up, right + up});
}

GizmoHandle Gizmo::handle_at(glm::vec2 pixel, float reach) const
{
    GizmoHandle found = GizmoHandle::none;
    double nearest = reach;
    for (const Line& line : lines_) {
        for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
            const double distance = distance_to_segment(pixel, line.points[i], line.points[i + 1]);
            if (distance < nearest) {
                nearest = distance;
                found = line.handle;
            }
        }
    }
    return found;
}

PartMove dragged(const PartMove& start, GizmoHandle handle, glm::dvec3 centre, const SightRay& from,
                 const SightRay& to, glm::dvec3 forward, double radius)
{
    PartMove move = start;
    switch (handle) {
        case GizmoHandle::none:
            break;
        case GizmoHandle::move_x:
        case GizmoHandle::move_y:
        case GizmoHandle::move_z: {
            const glm::dvec3 axis = axis_of(handle);
            move.translation +=
                axis * (nearest_on_axis(centre, axis, to) - nearest_on_axis(centre, axis, from));
            break;
        }
        case GizmoHandle::turn_x:
        case GizmoHandle::turn_y:
        case GizmoHandle::turn_z: {
            const glm::dvec3 axis = axis_of(handle);
            const double angle = angle_between(centre, axis, from, to, kRingShare * radius);
            move.rotation = glm::normalize(glm::angleAxis(angle, axis) * start.rotation);
            break;
        }
        case GizmoHandle::move_in_view: {
            const std::optional<glm::dvec3> a = on_plane(centre, forward, from);
            const std::optional<glm::dvec3> b = on_plane(centre, forward, to);
            if (a && b)
                move.translation += *b - *a;
            break;
        }
    }
    return move;
}

glm::dvec3 degrees_of(const glm::dquat& rotation)
{
    return glm::degrees(glm::eulerAngles(rotation)) + 0.0;  // no -0
}

glm::dquat rotation_of(glm::dvec3 degrees)
{
    return glm::dquat(glm::radians(degrees));
}

}  // namespace surfelao
