#include "tree/masks/winding.h"

#include "tree/masks/constants.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

constexpr std::uint32_t kNone = ~0u;

struct Edge {
    std::uint64_t vertices;  ///< the lower one above, the upper one below
    std::uint32_t side;      ///< 3 * triangle + the corner that it begins at
    bool rising;             ///< from the lower to the upper vertex
};

/// Sorted by vertices. Edges between vertices at one place are left out.
std::vector<Edge> edges_of(const Geometry& geometry)
{
    std::vector<Edge> edges;
    edges.reserve(3 * geometry.triangles.size());
    for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            const std::uint64_t from =
                geometry.welded[geometry.triangles[t][static_cast<int>(corner)]];
            const std::uint64_t to =
                geometry.welded[geometry.triangles[t][static_cast<int>((corner + 1) % 3)]];
            if (from != to)
                edges.push_back(
                    {std::min(from, to) << 32 | std::max(from, to), 3 * t + corner, from < to});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::pair(a.vertices, a.side) < std::pair(b.vertices, b.side);
    });
    return edges;
}

/// The triangle beyond each side.
struct Neighbour {
    std::uint32_t triangle = kNone;
    bool same_way = false;  ///< along the edge, so one of them is turned
};

std::vector<Neighbour> neighbours_of(const Geometry& geometry)
{
    const std::vector<Edge> edges = edges_of(geometry);
    std::vector<Neighbour> neighbours(3 * geometry.triangles.size());
    for (std::size_t begin = 0, end; begin < edges.size(); begin = end) {
        end = begin + 1;
        while (end < edges.size() && edges[end].vertices == edges[begin].vertices)
            ++end;
        if (end - begin != 2)
            continue;
        const Edge& a = edges[begin];
        const Edge& b = edges[begin + 1];
        neighbours[a.side] = {b.side / 3, a.rising == b.rising};
        neighbours[b.side] = {a.side / 3, a.rising == b.rising};
    }
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
