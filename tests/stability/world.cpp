#include "tests/stability/world.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace surfelao::stability {

glm::dvec3 World::to_unit(glm::dvec3 point) const
{
    return (point - geometry.frame.centre) / geometry.frame.diagonal;
}

Polygon World::to_unit(Polygon polygon) const
{
    for (glm::dvec3& corner : polygon)
        corner = to_unit(corner);
    return polygon;
}

World at_vertices(const Scene& scene, const Definition& definition, float offset)
{
    World world;
    world.geometry = make_geometry(scene);
    world.receivers = vertex_receivers(world.geometry, offset);
    world.definition = definition;
    return world;
}

World at_points(const Scene& scene, const std::vector<glm::dvec3>& positions, glm::vec3 normal)
{
    World world;
    world.geometry = make_geometry(scene);
    for (const glm::dvec3 position : positions) {
        world.receivers.push_back(
            {glm::vec3(world.to_unit(position)) + kVertexOffset * normal, normal, kVertexOffset});
    }
    return world;
}

World where(World world, const std::function<bool(glm::dvec3 position)>& keep)
{
    std::erase_if(world.receivers, [&](const Receiver& receiver) {
        return !keep(world.geometry.frame.centre +
                     world.geometry.frame.diagonal * glm::dvec3(receiver.position));
    });
    return world;
}

World sampled(World world, std::size_t count)
{
    const std::size_t stride = std::max<std::size_t>(1, world.receivers.size() / count);
    std::vector<Receiver> kept;
    for (std::size_t i = 0; i < world.receivers.size(); i += stride)
        kept.push_back(world.receivers[i]);
    world.receivers = std::move(kept);
    return world;
}

World with_polygons(World world, const std::vector<Polygon>& polygons)
{
    std::vector<Polygon> unit;
    for (const Polygon& polygon : polygons)
        unit.push_back(world.to_unit(polygon));
    world.answer = [unit](const Receiver& receiver) { return form_factor(receiver, unit); };
    return world;
}

World with_openings(World world, const std::vector<Polygon>& openings)
{
    world = with_polygons(std::move(world), openings);
    world.answer = [open = world.answer](const Receiver& receiver) { return 1.0 - open(receiver); };
    return world;
}

World with_constant(World world, double occlusion)
{
    world.answer = [occlusion](const Receiver&) { return occlusion; };
    return world;
}

World with_like(World world, World other,
                const std::function<std::uint32_t(std::uint32_t)>& counterpart)
{
    world.like_receiver.resize(world.receivers.size());
    std::iota(world.like_receiver.begin(), world.like_receiver.end(), 0u);
    if (counterpart) {
        for (std::uint32_t& index : world.like_receiver)
            index = counterpart(index);
    }
    world.like = std::make_shared<const World>(std::move(other));
    return world;
}

}  // namespace surfelao::stability
