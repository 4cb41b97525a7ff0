#include "tree/masks/solids.h"

#include "surfels/union_find.h"
#include "tree/masks/constants.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <span>

namespace surfelao {
namespace {

/// Every edge in both directions equally often, and from one point, the middle of the corners, all
/// triangles are seen from behind. From there outward the winding number only falls, to 0.
bool is_star_solid(const Geometry& geometry, std::span<const std::uint32_t> triangles)
{
    // an edge's two ends in one number
    std::array<std::uint64_t, 3 * kMaskMostOfSolid> forward, backward;
    std::size_t edges = 0;
    glm::vec3 sum(0.0f);
    for (const std::uint32_t triangle : triangles) {
        const glm::uvec3 t = geometry.triangles[triangle];
        for (int i = 0; i < 3; ++i) {
            const std::uint64_t a = geometry.welded[t[i]], b = geometry.welded[t[(i + 1) % 3]];
            forward[edges] = a << 32 | b;
            backward[edges++] = b << 32 | a;
            sum += geometry.positions[a];
        }
    }
    const glm::vec3 middle = sum / static_cast<float>(edges);
    for (const std::uint32_t triangle : triangles) {
        const glm::uvec3 t = geometry.triangles[triangle];
        const glm::vec3 a = geometry.positions[t.x] - middle, b = geometry.positions[t.y] - middle,
                        c = geometry.positions[t.z] - middle;
        if (!(glm::dot(a, glm::cross(b - a, c - a)) > 0.0f))
            return false;
    }
    const auto forward_end = forward.begin() + static_cast<std::ptrdiff_t>(edges);
    const auto backward_end = backward.begin() + static_cast<std::ptrdiff_t>(edges);
    std::sort(forward.begin(), forward_end);
    std::sort(backward.begin(), backward_end);
    return std::equal(forward.begin(), forward_end, backward.begin());
}

}  // namespace

std::vector<std::uint8_t> small_solids(const Geometry& geometry)
{
    const std::size_t count = geometry.triangles.size();
    UnionFind bodies(geometry.positions.size());
    for (const glm::uvec3 t : geometry.triangles) {
        bodies.join(geometry.welded[t.x], geometry.welded[t.y]);
        bodies.join(geometry.welded[t.x], geometry.welded[t.z]);
    }
    std::vector<std::uint32_t> size(geometry.positions.size(), 0);
    std::vector<std::uint32_t> body(count);
    for (std::size_t t = 0; t < count; ++t)
        ++size[body[t] = bodies.root(geometry.welded[geometry.triangles[t].x])];

    // the triangles of small bodies side by side
    std::vector<std::uint32_t> members;
    for (std::uint32_t t = 0; t < count; ++t) {
        if (size[body[t]] <= kMaskMostOfSolid)
            members.push_back(t);
    }
    std::stable_sort(members.begin(), members.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return body[a] < body[b]; });
    std::vector<std::uint8_t> solid(count, 0);
    for (std::size_t first = 0; first < members.size();) {
        const std::size_t last = first + size[body[members[first]]];
        const std::span<const std::uint32_t> triangles(members.data() + first, last - first);
        if (is_star_solid(geometry, triangles)) {
            for (const std::uint32_t t : triangles)
                solid[t] = 1;
        }
        first = last;
    }
    return solid;
}

}  // namespace surfelao
