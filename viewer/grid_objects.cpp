#include "viewer/grid_objects.h"

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

}  // namespace surfelao
