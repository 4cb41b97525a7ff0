#include "bake/bent_space.h"

#include "atlas/tangents.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
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

/// The file's own coordinates of a layout of tiles: those of one page next to the other.
UvSet joined_tiles(const MapLayout& layout)
{
    UvSet joined;
    joined.corners.assign(layout.pages[0].corners.size(), glm::uvec3(UvSet::kNone));
    for (std::size_t p = 0; p < layout.pages.size(); ++p) {
        const UvSet& page = layout.pages[p];
        const std::uint32_t number = layout.tiles[p] - 1001;
        const glm::dvec2 tile(number % 10, -static_cast<double>(number / 10));
        for (std::size_t t = 0; t < page.corners.size(); ++t) {
            if (page.corners[t].x == UvSet::kNone)
                continue;
            for (int k = 0; k < 3; ++k) {
                joined.corners[t][k] = static_cast<std::uint32_t>(joined.values.size());
                joined.values.push_back(page.values[page.corners[t][k]] + tile);
            }
        }
    }
    return joined;
}

/// Per page; one for all tiles.
std::vector<Tangents> tangents_of_pages(const Mesh& mesh, const MapLayout& layout)
{
    if (!layout.tiles.empty())
        return {make_tangents(mesh, joined_tiles(layout), mesh.scene.tangents)};
    std::vector<Tangents> tangents;
    for (const UvSet& page : layout.pages)
        tangents.push_back(make_tangents(mesh, page, mesh.scene.tangents));
    return tangents;
}

}  // namespace

BentEncoder bent_encoder(const Mesh& mesh, const MapLayout& layout, BentSpace space,
                         bool green_down)
{
    switch (space) {
        case BentSpace::none:
            return {};
        case BentSpace::world:
            return [](std::size_t, const SurfacePoint&, glm::vec3 direction) { return direction; };
        case BentSpace::object:
            break;
        case BentSpace::tangent:
            return [&mesh, green_down, tangents = tangents_of_pages(mesh, layout)](
                       std::size_t page, const SurfacePoint& point, glm::vec3 direction) {
                return to_tangent_space(mesh, tangents[std::min(page, tangents.size() - 1)], point,
                                        direction, green_down);
            };
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
