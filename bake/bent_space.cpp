#include "bake/bent_space.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <vector>

namespace surfelao {
namespace {

/// The part of each triangle of the scene.
std::vector<std::uint32_t> parts_of_triangles(const Scene& scene)
{
    std::vector<std::uint32_t> parts;
    parts.reserve(scene.triangles.size());
    for (std::uint32_t p = 0; p < scene.parts.size(); ++p)
        parts.insert(parts.end(), scene.parts[p].triangle_count, p);
    return parts;
}

}  // namespace

BentEncoder bent_encoder(const Mesh& mesh, const MapLayout&, BentSpace space, bool)
{
    switch (space) {
        case BentSpace::none:
            return {};
        case BentSpace::world:
            return [](std::size_t, const SurfacePoint&, glm::vec3 direction) { return direction; };
        case BentSpace::object:
            break;
        case BentSpace::tangent:
            break;
    }
    return [&mesh, parts = parts_of_triangles(mesh.scene)](std::size_t, const SurfacePoint& point,
                                                           glm::vec3 direction) {
        const std::uint32_t part = parts[mesh.geometry.scene_triangle(point.triangle)];
        const glm::dvec3 turned =
            glm::transpose(mesh.scene.parts[part].to_world) * glm::dvec3(direction);
        const double length = glm::length(turned);
        return length > 0.0 ? glm::vec3(turned / length) : glm::vec3(0.0f);
    };
}

}  // namespace surfelao
