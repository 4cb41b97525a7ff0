#include "bake/bent_space.h"

#include "atlas/tangents.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <utility>
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

BentEncoder bent_encoder(const Mesh& mesh, const MapLayout& layout, BentSpace space,
                         bool green_down)
{
    BentEncoder encoder;
    if (space == BentSpace::world) {
        encoder.encode = [](std::size_t, const SurfacePoint&, glm::vec3 direction) {
            return direction;
        };
    } else if (space == BentSpace::object) {
        encoder.encode = [&mesh, parts = parts_of_triangles(mesh.scene)](
                             std::size_t, const SurfacePoint& point, glm::vec3 direction) {
            const std::uint32_t part = parts[mesh.geometry.scene_triangle(point.triangle)];
            const glm::dvec3 turned =
                glm::transpose(mesh.scene.parts[part].to_world) * glm::dvec3(direction);
            const double length = glm::length(turned);
            return length > 0.0 ? glm::vec3(turned / length) : glm::vec3(0.0f);
        };
    } else if (space == BentSpace::tangent) {
        std::vector<Tangents> tangents;
        for (const UvSet& uvs : layout.pages)
            tangents.push_back(make_tangents(mesh, uvs));
        encoder.is_of_chart = true;
        encoder.encode = [&mesh, tangents = std::move(tangents), green_down](
                             std::size_t page, const SurfacePoint& point, glm::vec3 direction) {
            return to_tangent_space(mesh, tangents[page], point, direction, green_down);
        };
    }
    return encoder;
}

}  // namespace surfelao
