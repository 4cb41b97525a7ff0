#include "surfels/receiver.h"

namespace surfelao {

std::vector<Receiver> receivers_at_vertices(const Geometry& geometry, float offset)
{
    std::vector<Receiver> receivers(geometry.positions.size());
    for (std::size_t v = 0; v < receivers.size(); ++v) {
        const glm::vec3 normal = geometry.normals[v];
        receivers[v] = {geometry.positions[v] + offset * normal, normal};
    }
    return receivers;
}

}  // namespace surfelao
