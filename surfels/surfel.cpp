#include "surfels/surfel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace surfelao {
namespace {

/// A vertex that has given this much of its area away has nothing left but rounding.
constexpr float kRest = 1e-5f;

struct LargeTriangle {
    glm::uvec3 corners;
    double area;
};

/// The triangles above an area; of several over the same places only the first, as in
/// Geometry::areas.
std::vector<LargeTriangle> large_triangles(const Geometry& geometry, double area)
{
    std::vector<LargeTriangle> large;
    std::set<std::array<std::uint32_t, 3>> places;
    for (const glm::uvec3 t : geometry.triangles) {
        const glm::dvec3 a(geometry.positions[t.x]);
        const glm::dvec3 b(geometry.positions[t.y]);
        const glm::dvec3 c(geometry.positions[t.z]);
        const double triangle_area = 0.5 * glm::length(glm::cross(b - a, c - a));
        if (triangle_area <= area)
            continue;
        std::array place{geometry.welded[t.x], geometry.welded[t.y], geometry.welded[t.z]};
        std::ranges::sort(place);
        if (places.insert(place).second)
            large.push_back({t, triangle_area});
    }
    return large;
}

}  // namespace

std::vector<Surfel> surfels_at_vertices(const Geometry& geometry)
{
    std::vector<Surfel> surfels;
    for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
        if (geometry.areas[v] > 0.0f)
            surfels.push_back(
                {geometry.positions[v], geometry.areas[v], geometry.normals[v], 0.0f});
    }
    return surfels;
}

double large_area(const Geometry& geometry)
{
    double area = 0.0;
    for (const float each : geometry.areas)
        area += each;
    const double vertices = static_cast<double>(geometry.areas.size());
    return area * std::min(1.0 / kFewestSurfels, kLargeSurfel / vertices);
}

SurfelCloud surfels_of(const Geometry& geometry)
{
    return surfels_of(geometry, large_area(geometry));
}

SurfelCloud surfels_of(const Geometry& part, double largest)
{
    const std::vector<LargeTriangle> large = large_triangles(part, largest);

    // what the corners have left
    std::vector<float> areas = part.areas;
    for (const LargeTriangle& triangle : large) {
        for (int corner = 0; corner < 3; ++corner)
            areas[part.welded[triangle.corners[corner]]] -= static_cast<float>(triangle.area / 3.0);
    }
    SurfelCloud cloud;
    for (std::uint32_t v = 0; v < areas.size(); ++v) {
        if (areas[v] > kRest * part.areas[v]) {
            cloud.surfels.push_back({part.positions[v], areas[v], part.normals[v], 0.0f});
            cloud.vertices.push_back(v);
        }
    }

    for (const LargeTriangle& triangle : large) {
        const glm::dvec3 a(part.positions[triangle.corners.x]);
        const glm::dvec3 b(part.positions[triangle.corners.y]);
        const glm::dvec3 c(part.positions[triangle.corners.z]);
        const glm::vec3 normal(glm::normalize(glm::cross(b - a, c - a)));
        const int cells = static_cast<int>(std::ceil(std::sqrt(triangle.area / largest)));
        const auto add = [&](double u, double v) {
            cloud.surfels.push_back({glm::vec3(a + (b - a) * (u / cells) + (c - a) * (v / cells)),
                                     static_cast<float>(triangle.area / cells / cells), normal,
                                     0.0f});
            cloud.vertices.push_back(triangle.corners.x);
        };
        // rows of cells that lie like the triangle, and between them those that stand on their tip
        for (int v = 0; v < cells; ++v) {
            for (int u = 0; u + v < cells; ++u) {
                add(u + 1.0 / 3.0, v + 1.0 / 3.0);
                if (u + v + 1 < cells)
                    add(u + 2.0 / 3.0, v + 2.0 / 3.0);
            }
        }
    }
    return cloud;
}

}  // namespace surfelao
