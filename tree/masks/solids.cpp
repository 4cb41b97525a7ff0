#include "tree/masks/solids.h"

#include "surfels/edges.h"
#include "surfels/for_all.h"
#include "surfels/union_find.h"
#include "tree/masks/constants.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <span>

namespace surfelao {
namespace {

/// Triangles: a tetrahedron. Points of a cloud are bodies of two.
constexpr std::uint32_t kLeastOfSolid = 4;

/// From one point, the middle of the corners, all triangles are seen from behind. From there
/// outward the winding number of a closed body only falls, to 0.
bool is_star(const Geometry& geometry, std::span<const std::uint32_t> triangles)
{
    glm::vec3 sum(0.0f);
    for (const std::uint32_t triangle : triangles) {
        const glm::uvec3 t = geometry.triangles[triangle];
        for (int i = 0; i < 3; ++i)
            sum += geometry.positions[geometry.welded[t[i]]];
    }
    const glm::vec3 middle = sum / static_cast<float>(3 * triangles.size());
    return std::ranges::all_of(triangles, [&](std::uint32_t triangle) {
        const glm::uvec3 t = geometry.triangles[triangle];
        const glm::vec3 a = geometry.positions[t.x] - middle, b = geometry.positions[t.y] - middle,
                        c = geometry.positions[t.z] - middle;
        return glm::dot(a, glm::cross(b - a, c - a)) > 0.0f;
    });
}

}  // namespace

std::vector<std::uint8_t> small_solids(const Geometry& geometry)
{
    const std::size_t count = geometry.triangles.size();
    UnionFind bodies(geometry.positions.size());
    for_all(count, [&](std::size_t i) {
        const glm::uvec3 t = geometry.triangles[i];
        bodies.join(geometry.welded[t.x], geometry.welded[t.y]);
        bodies.join(geometry.welded[t.x], geometry.welded[t.z]);
    });
    std::vector<std::uint32_t> size(geometry.positions.size(), 0);
    std::vector<std::uint32_t> body(count);
    for (std::size_t t = 0; t < count; ++t)
        ++size[body[t] = bodies.root(geometry.welded[geometry.triangles[t].x])];

    // the triangles of small bodies side by side
    std::vector<std::uint32_t> members;
    for (std::uint32_t t = 0; t < count; ++t) {
        if (size[body[t]] >= kLeastOfSolid && size[body[t]] <= kMaskMostOfSolid)
            members.push_back(t);
    }
    std::vector<std::uint8_t> solid(count, 0);
    if (members.empty())
        return solid;
    std::stable_sort(members.begin(), members.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return body[a] < body[b]; });

    // closed: every edge in both directions equally often
    std::vector<std::uint8_t> open(geometry.positions.size(), 0);
    std::vector<std::uint8_t> large(count, 1);
    for (const std::uint32_t t : members)
        large[t] = 0;
    Edges(geometry, large).for_each([&](std::uint32_t, std::span<const EdgeSide> sides) {
        const auto rising = std::ranges::count_if(sides, &EdgeSide::rises);
        if (2 * static_cast<std::size_t>(rising) != sides.size())
            open[body[sides[0].triangle()]] = 1;
    });
    const auto same_body = [&](std::uint32_t a, std::uint32_t b) { return body[a] == body[b]; };
    for_each_run(std::span<const std::uint32_t>(members), same_body,
                 [&](std::span<const std::uint32_t> triangles) {
                     if (open[body[triangles[0]]] != 0 || !is_star(geometry, triangles))
                         return;
                     for (const std::uint32_t t : triangles)
                         solid[t] = 1;
                 });
    return solid;
}

}  // namespace surfelao
