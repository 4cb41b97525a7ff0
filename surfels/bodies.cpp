#include "surfels/bodies.h"

#include <algorithm>
#include <utility>

namespace surfelao {

std::vector<BodyMesh> split_bodies(const Geometry& geometry,
                                   std::span<const std::uint32_t> body_of_triangle)
{
    std::uint32_t count = 1;
    for (const std::uint32_t body : body_of_triangle)
        count = std::max(count, body + 1);
    std::vector<BodyMesh> bodies(count);
    const auto triangles = members_of(body_of_triangle, count);
    std::vector<std::uint32_t> owner(geometry.positions.size(), count), place(owner.size());
    for (std::uint32_t b = 0; b < count; ++b) {
        BodyMesh& body = bodies[b];
        body.triangles.reserve(triangles[b].size());
        for (const std::uint32_t t : triangles[b]) {
            glm::uvec3& corners = body.triangles.emplace_back(geometry.triangles[t]);
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t vertex = corners[k];
                if (std::exchange(owner[vertex], b) != b) {
                    place[vertex] = static_cast<std::uint32_t>(body.vertices.size());
                    body.vertices.push_back(vertex);
                }
                corners[k] = place[vertex];
            }
        }
    }
    return bodies;
}

std::vector<std::vector<std::uint32_t>> members_of(std::span<const std::uint32_t> body_of,
                                                   std::size_t bodies)
{
    std::vector<std::vector<std::uint32_t>> members(bodies);
    for (std::size_t i = 0; i < body_of.size(); ++i)
        members[body_of[i]].push_back(static_cast<std::uint32_t>(i));
    return members;
}

}  // namespace surfelao
