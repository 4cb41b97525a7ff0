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

using Corners = std::array<glm::dvec3, 3>;

/// A triangle whose area its corners cannot stand for.
struct LoneTriangle {
    glm::uvec3 vertices;
    Corners corners;
};

double area_of(const Corners& corners)
{
    return 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
}

glm::dvec3 normal_of(const Corners& corners)
{
    return glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
}

/// From which corner its longest side leads to the next.
int longest_side(const Corners& corners)
{
    int longest = 0;
    for (int i = 1; i < 3; ++i) {
        if (glm::distance(corners[i], corners[(i + 1) % 3]) >
            glm::distance(corners[longest], corners[(longest + 1) % 3]))
            longest = i;
    }
    return longest;
}

/// Large or long, but no sliver, of which there would be more and more pieces.
bool is_to_cut(const Corners& corners, double largest)
{
    const int side = longest_side(corners);
    const double length = glm::distance(corners[side], corners[(side + 1) % 3]);
    const double area = area_of(corners);
    return area > largest ||
           (area > kLeastCut * largest && length > kLongestSide * std::sqrt(largest));
}

/// Of several over the same places only the first, as in Geometry::areas.
std::vector<LoneTriangle> lone_triangles(const Geometry& geometry, double largest)
{
    std::vector<LoneTriangle> lone;
    std::set<std::array<std::uint32_t, 3>> places;
    for (const glm::uvec3 t : geometry.triangles) {
        const Corners corners{geometry.positions[t.x], geometry.positions[t.y],
                              geometry.positions[t.z]};
        if (area_of(corners) == 0.0)
            continue;
        const glm::vec3 normal(normal_of(corners));
        std::array place{geometry.welded[t.x], geometry.welded[t.y], geometry.welded[t.z]};
        const bool sharp = std::ranges::any_of(place, [&](std::uint32_t vertex) {
            return glm::dot(geometry.normals[vertex], normal) < kSharp;
        });
        if (!sharp && !is_to_cut(corners, largest))
            continue;
        std::ranges::sort(place);
        if (places.insert(place).second)
            lone.push_back({t, corners});
    }
    return lone;
}

/// Appends the triangle, or what it is cut into.
void add_cells(const Corners& corners, double largest, const glm::vec3& normal,
               std::vector<Surfel>& surfels)
{
    const int side = longest_side(corners);
    const glm::dvec3 a = corners[side], b = corners[(side + 1) % 3], c = corners[(side + 2) % 3];
    if (is_to_cut(corners, largest)) {
        const glm::dvec3 middle = 0.5 * (a + b);
        add_cells({a, middle, c}, largest, normal, surfels);
        add_cells({middle, b, c}, largest, normal, surfels);
        return;
    }
    const glm::dvec3 centroid = (a + b + c) / 3.0;
    double reach = 0.0;
    for (const glm::dvec3& corner : corners)
        reach = std::max(reach, glm::distance(corner, centroid));
    surfels.push_back({glm::vec3(centroid),
                       static_cast<float>(area_of(corners)),
                       normal,
                       static_cast<float>(reach),
                       {glm::vec3(a - centroid), glm::vec3(b - centroid)}});
}

}  // namespace

std::vector<Surfel> surfels_at_vertices(const Geometry& geometry)
{
    std::vector<Surfel> surfels;
    for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
        if (geometry.areas[v] > 0.0f)
            surfels.push_back({geometry.positions[v], geometry.areas[v], geometry.normals[v]});
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
    const std::vector<LoneTriangle> lone = lone_triangles(part, largest);

    // what the corners have left
    std::vector<float> areas = part.areas;
    for (const LoneTriangle& triangle : lone) {
        for (int corner = 0; corner < 3; ++corner)
            areas[part.welded[triangle.vertices[corner]]] -=
                static_cast<float>(area_of(triangle.corners) / 3.0);
    }
    SurfelCloud cloud;
    for (std::uint32_t v = 0; v < areas.size(); ++v) {
        if (areas[v] > kRest * part.areas[v]) {
            cloud.surfels.push_back({part.positions[v], areas[v], part.normals[v]});
            cloud.vertices.push_back(v);
        }
    }

    for (const LoneTriangle& triangle : lone) {
        add_cells(triangle.corners, largest, glm::vec3(normal_of(triangle.corners)), cloud.surfels);
        cloud.vertices.resize(cloud.surfels.size(), triangle.vertices.x);
    }
    return cloud;
}

}  // namespace surfelao
