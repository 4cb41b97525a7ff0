#include "viewer/grid_objects.h"

#include <algorithm>

namespace surfelao {

std::vector<bool> resting_bodies(const PosedBodies& posed)
{
    std::vector<bool> rests;
    for (std::size_t b = 0; b < posed.poses.size(); ++b)
        rests.push_back(posed.bodies->list[b].part == Body::kNone && posed.poses[b] == BodyPose{});
    return rests;
}

GridObjects grid_objects_of(const Model& base, const Bodies& bodies, const std::vector<bool>& rests)
{
    GridObjects objects;
    objects.of_body.assign(bodies.list.size(), GridObjects::kNone);
    bool any_moves = false;
    for (std::size_t b = 0; b < rests.size(); ++b)
        any_moves |= !rests[b] && !bodies.deforms[b];
    if (!any_moves)
        return objects;
    // numbered by their first triangles
    std::uint32_t of_rest = GridObjects::kNone;
    const Geometry& geometry = base.geometry();
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        const std::uint32_t body = bodies.of_triangle[t];
        if (bodies.deforms[body])
            continue;
        std::uint32_t& object = rests[body] ? of_rest : objects.of_body[body];
        if (object == GridObjects::kNone) {
            object = static_cast<std::uint32_t>(objects.triangles.size());
            objects.triangles.emplace_back();
        }
        objects.of_body[body] = object;
        objects.triangles[object].push_back(static_cast<std::uint32_t>(geometry.scene_triangle(t)));
    }
    return objects;
}

Geometry object_alone(const Scene& scene, std::span<const std::uint32_t> triangles)
{
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t t : triangles)
        for (int corner = 0; corner < 3; ++corner)
            vertices.push_back(scene.triangles[t][corner]);
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<glm::dvec3> positions;
    for (const std::uint32_t v : vertices)
        positions.push_back(scene.positions[v]);
    std::vector<glm::uvec3> own(triangles.size());
    for (std::size_t i = 0; i < own.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner)
            own[i][corner] = static_cast<std::uint32_t>(
                std::ranges::lower_bound(vertices, scene.triangles[triangles[i]][corner]) -
                vertices.begin());
    }
    return make_geometry(make_scene(positions, own));
}

}  // namespace surfelao
