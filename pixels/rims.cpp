#include "pixels/rims.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

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

/// In pixels; none behind the eye.
std::optional<glm::vec2> place_in(const View& view, glm::vec2 size, glm::vec3 position)
{
    const glm::vec3 p = to_view(view, position);
    if (!view.lens.orthographic && p.z <= 0.0f)
        return {};
    const glm::vec2 q = view.lens.orthographic ? glm::vec2(p) : glm::vec2(p) / p.z;
    return (q - view.lens.low) / (view.lens.high - view.lens.low) * size;
}

}  // namespace

const Buckets<std::uint32_t>& Rims::corners() const
{
    std::call_once(once_, [&] {
        corners_ = std::make_unique<const Buckets<std::uint32_t>>(
            corners_around(geometry_.triangles, geometry_.welded));
    });
    return *corners_;
}

SurfacePoint Rims::nearer(const View& view, int width, int height, const SurfacePoint& point) const
{
    SurfacePoint nearest = point;
    for (int i = 0; i < kMostSteps; ++i) {
        const SurfacePoint next = step(view, width, height, nearest);
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

SurfacePoint Rims::step(const View& view, int width, int height, const SurfacePoint& point) const
{
    const glm::vec2 size(width, height);
    const auto corner = [&](std::uint32_t triangle, int i) {
        return corner_of(geometry_, triangle, i);
    };
    const glm::vec3 position = (1.0f - point.at.x - point.at.y) * corner(point.triangle, 0) +
                               point.at.x * corner(point.triangle, 1) +
                               point.at.y * corner(point.triangle, 2);
    const auto place = place_in(view, size, position);
    // triangles seen edge-on may lie between the point's and the nearer one
    std::array<std::uint32_t, kMostBetween> reached{point.triangle};
    std::size_t count = 1;
    for (std::size_t n = 0; place && n < count; ++n) {
        std::array<glm::vec2, 3> corners_at;
        for (int i = 0; i < 3; ++i) {
            const auto corner_at = place_in(view, size, corner(reached[n], i));
            if (!corner_at)
                return point;
            corners_at[i] = *corner_at;
        }
        for (int i = 0; i < 3; ++i) {
            const int next = (i + 1) % 3;
            const glm::vec2 a = corners_at[i], b = corners_at[next];
            const float length2 = glm::dot(b - a, b - a);
            const float along = length2 > 0.0f
                                    ? glm::clamp(glm::dot(*place - a, b - a) / length2, 0.0f, 1.0f)
                                    : 0.0f;
            if (glm::distance(*place, glm::mix(a, b, along)) > kRimWidth)
                continue;
            const std::uint32_t from = welded(reached[n], i), to = welded(reached[n], next);
            for (const std::uint32_t other_corner : corners()[from]) {
                const std::uint32_t other = other_corner / 3;
                int end = 0;
                while (end < 3 && welded(other, end) != to)
                    ++end;
                const auto known = reached.begin() + static_cast<std::ptrdiff_t>(count);
                if (end == 3 || std::find(reached.begin(), known, other) != known)
                    continue;
                if (is_in_front(view, other, point.triangle)) {
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
