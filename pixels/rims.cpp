#include "pixels/rims.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace surfelao {
namespace {

/// Triangles that are looked at from one place: those at a corner of a usual mesh.
constexpr std::size_t kMostBetween = 8;

/// From triangle to triangle: what is in front of one may itself be behind another.
constexpr int kMostSteps = 4;

glm::vec3 corner_of(const Geometry& geometry, std::uint32_t triangle, int corner)
{
    return geometry.positions[geometry.triangles[triangle][corner]];
}

glm::dvec3 middle_of(const Geometry& geometry, std::uint32_t triangle)
{
    return (glm::dvec3(corner_of(geometry, triangle, 0)) +
            glm::dvec3(corner_of(geometry, triangle, 1)) +
            glm::dvec3(corner_of(geometry, triangle, 2))) /
           3.0;
}

/// Whether a place lies on the eye's side of a triangle's plane.
bool is_before(const Geometry& geometry, const View& view, std::uint32_t triangle, glm::dvec3 place)
{
    const glm::dvec3 a(corner_of(geometry, triangle, 0));
    const glm::dvec3 face = glm::cross(glm::dvec3(corner_of(geometry, triangle, 1)) - a,
                                       glm::dvec3(corner_of(geometry, triangle, 2)) - a);
    const glm::dvec3 to_eye =
        view.lens.orthographic ? -glm::dvec3(view.forward) : glm::dvec3(view.eye) - a;
    return (glm::dot(place - a, face) > 0.0) == (glm::dot(to_eye, face) > 0.0);
}

/// Whether a line passes as near to a place as a rim is wide, in pixels.
bool is_near(const glm::vec2& place, const glm::vec2& a, const glm::vec2& b)
{
    const glm::vec2 line = b - a, off = place - a;
    const float area = line.x * off.y - line.y * off.x;
    return area * area <= kRimWidth * kRimWidth * glm::dot(line, line);
}

}  // namespace

SurfacePoint Rims::nearer(const Projected& projected, const SurfacePoint& point) const
{
    SurfacePoint nearest = point;
    for (int i = 0; i < kMostSteps; ++i) {
        const SurfacePoint next = step(projected, nearest);
        if (next.triangle == nearest.triangle)
            break;
        nearest = next;
    }
    return nearest;
}

bool Rims::is_in_front(const View& view, std::uint32_t other, std::uint32_t triangle) const
{
    return is_before(geometry_, view, triangle, middle_of(geometry_, other)) &&
           !is_before(geometry_, view, other, middle_of(geometry_, triangle));
}

SurfacePoint Rims::step(const Projected& projected, const SurfacePoint& point) const
{
    const glm::uvec3 own = geometry_.triangles[point.triangle];
    const glm::vec3 position = (1.0f - point.at.x - point.at.y) * projected.place(own.x) +
                               point.at.x * projected.place(own.y) +
                               point.at.y * projected.place(own.z);
    if (Projected::is_before_eye(position))
        return point;
    const glm::vec2 place = projected.in_picture(position);
    // triangles seen edge-on may lie between the point's and the nearer one
    std::array<std::uint32_t, kMostBetween> reached{point.triangle};
    std::size_t count = 1;
    for (std::size_t n = 0; n < count; ++n) {
        const glm::uvec3 triangle = geometry_.triangles[reached[n]];
        std::array<glm::vec2, 3> corners_at;
        for (int i = 0; i < 3; ++i) {
            if (Projected::is_before_eye(projected.place(triangle[i])))
                return point;
            corners_at[i] = projected.pixel(triangle[i]);
        }
        for (int i = 0; i < 3; ++i) {
            const int next = (i + 1) % 3;
            const glm::vec2 a = corners_at[i], b = corners_at[next];
            if (!is_near(place, a, b))
                continue;
            const float length2 = glm::dot(b - a, b - a);
            const float along = length2 > 0.0f
                                    ? glm::clamp(glm::dot(place - a, b - a) / length2, 0.0f, 1.0f)
                                    : 0.0f;
            if (glm::distance(place, glm::mix(a, b, along)) > kRimWidth)
                continue;
            const std::uint32_t from = welded(reached[n], i), to = welded(reached[n], next);
            for (const std::uint32_t other_corner : corners_[from]) {
                const std::uint32_t other = other_corner / 3;
                int end = 0;
                while (end < 3 && welded(other, end) != to)
                    ++end;
                const auto known = reached.begin() + static_cast<std::ptrdiff_t>(count);
                if (end == 3 || std::find(reached.begin(), known, other) != known)
                    continue;
                if (is_in_front(projected.view(), other, point.triangle)) {
                    float weights[3] = {};
                    weights[other_corner % 3] += 1.0f - along;
                    weights[end] += along;
                    return {other, glm::vec2(weights[1], weights[2])};
                }
                if (count < reached.size())
                    reached[count++] = other;
            }
        }
    }
    return point;
}

}  // namespace surfelao
