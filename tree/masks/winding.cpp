#include "tree/masks/winding.h"

#include "surfels/edges.h"
#include "tree/masks/constants.h"

#include <glm/geometric.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

constexpr std::uint32_t kNone = ~0u;

/// The triangle beyond each side.
struct Neighbour {
    std::uint32_t triangle = kNone;
    bool same_way = false;  ///< along the edge, so one of them is turned
};

std::vector<Neighbour> neighbours_of(const Geometry& geometry)
{
    std::vector<Neighbour> neighbours(3 * geometry.triangles.size());
    Edges(geometry).for_each([&](std::uint32_t, std::span<const EdgeSide> sides) {
        if (sides.size() != 2)
            return;
        const bool same_way = sides[0].rises() == sides[1].rises();
        neighbours[sides[0].side()] = {sides[1].triangle(), same_way};
        neighbours[sides[1].side()] = {sides[0].triangle(), same_way};
    });
    return neighbours;
}

}  // namespace

bool is_winding_mixed(const Geometry& geometry)
{
    const std::size_t count = geometry.triangles.size();
    const std::size_t stride = count / kMaskTurnedSample + 1;
    std::size_t examined = 0, away = 0;
    for (std::size_t i = 0; i < count; i += stride) {
        const glm::uvec3 t = geometry.triangles[i];
        const glm::vec3 a = geometry.positions[t.x];
        const glm::vec3 normal =
            glm::cross(geometry.positions[t.y] - a, geometry.positions[t.z] - a);
        ++examined;
        away += glm::dot(normal, geometry.normals[t.x]) < 0.0f &&
                glm::dot(normal, geometry.normals[t.y]) < 0.0f &&
                glm::dot(normal, geometry.normals[t.z]) < 0.0f;
    }
    return static_cast<double>(away) > kMaskTurnedShare * static_cast<double>(examined);
}

void wind_alike(Geometry& geometry)
{
    const std::vector<Neighbour> neighbours = neighbours_of(geometry);
    std::vector<bool> seen(geometry.triangles.size(), false);
    std::vector<bool> turned(geometry.triangles.size(), false);
    std::vector<std::uint32_t> open;
    for (std::uint32_t first = 0; first < geometry.triangles.size(); ++first) {
        if (seen[first])
            continue;
        seen[first] = true;
        open.push_back(first);
        while (!open.empty()) {
            const std::uint32_t t = open.back();
            open.pop_back();
            for (std::size_t side = 3 * std::size_t{t}; side < 3 * std::size_t{t} + 3; ++side) {
                const Neighbour& next = neighbours[side];
                if (next.triangle == kNone || seen[next.triangle])
                    continue;
                seen[next.triangle] = true;
                turned[next.triangle] = turned[t] != next.same_way;
                open.push_back(next.triangle);
            }
        }
    }
    for (std::size_t t = 0; t < turned.size(); ++t) {
        if (turned[t])
            std::swap(geometry.triangles[t].y, geometry.triangles[t].z);
    }
}

}  // namespace surfelao
