#include "viewer/pick.h"

#include <glm/geometric.hpp>

#include <limits>

namespace surfelao {

SightRay sight_ray(const View& view, int width, int height, glm::vec2 pixel)
{
    const PixelRay ray = pixel_ray(view.lens, width, height, pixel);
    const glm::dvec3 from = to_world(view, ray.origin);
    const glm::dvec3 through = to_world(view, ray.origin + ray.direction);
    return {from, glm::normalize(through - from)};
}

std::optional<glm::vec2> pixel_of(const View& view, int width, int height, glm::dvec3 point)
{
    const glm::vec3 p = to_view(view, glm::vec3(point));
    if (!view.lens.orthographic && !(p.z > 0.0f))
        return std::nullopt;
    const glm::vec2 place = view.lens.orthographic ? glm::vec2(p) : glm::vec2(p) / p.z;
    return (place - view.lens.low) / (view.lens.high - view.lens.low) * glm::vec2(width, height);
}

std::optional<SurfacePoint> point_under(std::span<const glm::vec3> positions,
                                        std::span<const glm::uvec3> triangles, const SightRay& ray,
                                        bool culls)
{
    std::optional<SurfacePoint> found;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        // Moeller, Trumbore. Fast, Minimum Storage Ray/Triangle Intersection. 1997
        const glm::dvec3 a = positions[triangles[t].x];
        const glm::dvec3 ab = glm::dvec3(positions[triangles[t].y]) - a;
        const glm::dvec3 ac = glm::dvec3(positions[triangles[t].z]) - a;
        const glm::dvec3 across = glm::cross(ray.direction, ac);
        const double facing = glm::dot(ab, across);
        if (facing == 0.0 || (culls && facing < 0.0))
            continue;
        const glm::dvec3 from = ray.origin - a;
        const double u = glm::dot(from, across) / facing;
        const glm::dvec3 turned = glm::cross(from, ab);
        const double v = glm::dot(ray.direction, turned) / facing;
        const double distance = glm::dot(ac, turned) / facing;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance < nearest) {
            nearest = distance;
            found = SurfacePoint{t, glm::vec2(u, v)};
        }
    }
    return found;
}

}  // namespace surfelao
