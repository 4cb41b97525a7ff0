#include "pixels/seen.h"

#include "pixels/sampled_triangles.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

/// Not of unit length.
glm::vec3 face_of(const Geometry& geometry, std::uint32_t triangle)
{
    const glm::uvec3 t = geometry.triangles[triangle];
    const glm::vec3 a = geometry.positions[t.x];
    return glm::cross(geometry.positions[t.y] - a, geometry.positions[t.z] - a);
}

/// Whether a pixel's neighbours on all sides see its triangle: then this holds a square about the
/// pixel's middle whose sides are .7 pixels away from it, and so no rim (kRimWidth) is as near.
bool is_amid(std::span<const std::uint32_t> triangles, int width, int height, std::uint32_t pixel)
{
    const int x = static_cast<int>(pixel) % width, y = static_cast<int>(pixel) / width;
    const auto row = static_cast<std::size_t>(width);
    const std::uint32_t own = triangles[pixel];
    return x > 0 && x + 1 < width && y > 0 && y + 1 < height && triangles[pixel - 1] == own &&
           triangles[pixel + 1] == own && triangles[pixel - row] == own &&
           triangles[pixel + row] == own;
}

/// point_of(pixel, point): what counts there, of a point of the triangle that is seen.
template <class PointOf>
SeenPixels seen_where(const Mesh& mesh, const Projected& projected,
                      std::span<const std::uint32_t> triangles, const Offset& offset,
                      const PointOf& point_of)
{
    const View& view = projected.view();
    const int width = projected.size().x, height = projected.size().y;
    SeenPixels seen;
    seen.width = width;
    seen.height = height;
    SURFELAO_CHECK(triangles.size() ==
                   static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    seen.pixels.reserve(triangles.size() -
                        static_cast<std::size_t>(std::ranges::count(triangles, 0u)));
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (triangles[i] != 0)
            seen.pixels.push_back(static_cast<std::uint32_t>(i));
    }
    seen.points.resize(seen.pixels.size());
    const auto columns = static_cast<std::uint32_t>(width);
    for_all(seen.pixels.size(), [&](std::size_t i) {
        const std::uint32_t pixel = seen.pixels[i];
        const glm::vec2 middle = glm::vec2(pixel % columns, pixel / columns) + 0.5f;
        seen.points[i] = point_of(
            pixel, point_on_ray(mesh.geometry, view, pixel_ray(view.lens, width, height, middle),
                                triangles[pixel] - 1));
    });
    seen.receivers = receivers_facing(mesh, view, seen.points, offset);
    return seen;
}

}  // namespace

View view_of(const Camera& camera, int width, int height)
{
    const CameraAxes axes = camera_axes(camera);
    const float tan_y = std::tan(0.5f * glm::radians(camera.fovy_deg));
    const glm::vec2 half(tan_y * static_cast<float>(width) / static_cast<float>(height), tan_y);
    return {camera.eye, axes.right, axes.upwards, -axes.backwards, {-half, half, false}};
}

std::vector<glm::vec3> framed_points(const Geometry& geometry)
{
    std::vector<bool> is_used(geometry.positions.size(), false);
    for (const glm::uvec3 triangle : geometry.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            is_used[triangle[corner]] = true;
    }
    std::vector<glm::vec3> points;
    for (std::size_t v = 0; v < is_used.size(); ++v) {
        if (is_used[v])
            points.push_back(geometry.positions[v]);
    }
    return points.empty() ? geometry.positions : points;
}

// As in shaders/g_surface.frag, with doubles: a grazing triangle leaves few digits.
SurfacePoint point_on_ray(const Geometry& geometry, const View& view, const PixelRay& ray,
                          std::uint32_t triangle)
{
    const glm::uvec3 t = geometry.triangles[triangle];
    const glm::dvec3 a(geometry.positions[t.x]);
    const glm::dvec3 across = glm::dvec3(geometry.positions[t.y]) - a;
    const glm::dvec3 along = glm::dvec3(geometry.positions[t.z]) - a;
    const glm::dvec3 from = glm::dvec3(to_world(view, ray.origin)) - a;
    const glm::dvec3 direction(to_world(view, ray.direction) - view.eye);
    const double facing = -glm::dot(glm::cross(across, along), direction);
    if (facing == 0.0)
        return {triangle, glm::vec2(0.0f)};
    const glm::dvec3 turned = glm::cross(from, direction);
    glm::dvec2 at(glm::dot(turned, along) / facing, -glm::dot(turned, across) / facing);
    at = glm::clamp(at, 0.0, 1.0);
    at /= std::max(1.0, at.x + at.y);
    return {triangle, glm::vec2(at)};
}

std::vector<Receiver> receivers_facing(const Mesh& mesh, const View& view,
                                       std::span<const SurfacePoint> points, const Offset& offset)
{
    std::vector<Receiver> receivers = receivers_at(mesh.geometry, mesh.surface, points, offset);
    for_all(points.size(), [&](std::size_t i) {
        const std::uint32_t triangle = points[i].triangle;
        const glm::vec3 face = face_of(mesh.geometry, triangle);
        const glm::vec3 corner = mesh.geometry.positions[mesh.geometry.triangles[triangle].x];
        const glm::vec3 to_eye = view.lens.orthographic ? -view.forward : view.eye - corner;
        Receiver& receiver = receivers[i];
        const bool is_above = glm::dot(receiver.normal, face) >= 0.0f;
        if (is_above == (glm::dot(to_eye, face) >= 0.0f))
            return;
        const glm::vec3 up = (is_above ? 1.0f : -1.0f) * glm::normalize(face);
        receiver.position -= 2.0f * receiver.offset * up;
        receiver.normal = -receiver.normal;
    });
    return receivers;
}

SeenPixels seen_pixels(const Mesh& mesh, const View& view, int width, int height,
                       std::span<const std::uint32_t> triangles, const Offset& offset)
{
    return seen_pixels(mesh, Rims(mesh.geometry), Projected(mesh.geometry, view, width, height),
                       triangles, offset);
}

SeenPixels seen_pixels(const Mesh& mesh, const Rims& rims, const Projected& projected,
                       std::span<const std::uint32_t> triangles, const Offset& offset)
{
    const int width = projected.size().x, height = projected.size().y;
    return seen_where(
        mesh, projected, triangles, offset, [&](std::uint32_t pixel, const SurfacePoint& point) {
            return is_amid(triangles, width, height, pixel) ? point : rims.nearer(projected, point);
        });
}

SeenPixels seen_pixels(const Mesh& mesh, const Projected& projected, const Offset& offset)
{
    return seen_where(mesh, projected, middle_triangles(projected), offset,
                      [](std::uint32_t, const SurfacePoint& point) { return point; });
}

std::vector<std::uint32_t> parts_of(const Mesh& mesh)
{
    std::vector<std::uint32_t> parts(mesh.geometry.triangles.size(), 0);
    std::uint32_t part = 0;
    for (std::size_t t = 0; t < parts.size(); ++t) {
        const std::size_t triangle = mesh.geometry.scene_triangle(t);
        while (triangle >= std::size_t{mesh.scene.parts[part].first_triangle} +
                               mesh.scene.parts[part].triangle_count)
            ++part;
        parts[t] = part;
    }
    return parts;
}

}  // namespace surfelao
