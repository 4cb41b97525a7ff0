#include "tree/receiver_group.h"

#include "tree/morton.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

void set_lane(ReceiverGroup& group, std::uint32_t lane, std::uint32_t index,
              const Receiver& receiver)
{
    for (int axis = 0; axis < 3; ++axis) {
        group.position[axis][lane] = receiver.position[axis];
        group.normal[axis][lane] = receiver.normal[axis];
    }
    group.receiver[lane] = index;
}

/// The cone about the mean of the normals.
void bound_normals(ReceiverGroup& group, const glm::vec3& sum, std::span<const Receiver> receivers)
{
    float cone_cos = 1.0f;
    if (sum != glm::vec3(0.0f))
        group.axis = glm::normalize(sum);
    for (std::uint32_t lane = 0; lane < group.count; ++lane)
        cone_cos = std::min(cone_cos, glm::dot(group.axis, receivers[group.receiver[lane]].normal));
    if (cone_cos <= 0.0f)
        group.sag = std::numeric_limits<float>::infinity();
    group.cone_cos = std::max(0.0f, cone_cos);
    group.cone_sin = std::sqrt(std::max(0.0f, 1.0f - group.cone_cos * group.cone_cos));
}

}  // namespace

std::vector<ReceiverGroup> group_receivers(std::span<const Receiver> receivers)
{
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> index;
    positions.reserve(receivers.size());
    index.reserve(receivers.size());
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (receivers[i].normal == glm::vec3(0.0f))
            continue;
        positions.push_back(receivers[i].position);
        index.push_back(static_cast<std::uint32_t>(i));
    }
    const std::vector<MortonKey> order = morton_order(positions);

    std::vector<ReceiverGroup> groups((order.size() + kGroupSize - 1) / kGroupSize);
    tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
        ReceiverGroup& group = groups[g];
        const std::size_t first = g * kGroupSize;
        group.count =
            static_cast<std::uint32_t>(std::min<std::size_t>(kGroupSize, order.size() - first));
        glm::vec3 low = positions[order[first].index];
        glm::vec3 high = low;
        for (std::uint32_t lane = 0; lane < kGroupSize; ++lane) {
            const std::uint32_t at = order[first + (lane < group.count ? lane : 0)].index;
            set_lane(group, lane, index[at], receivers[index[at]]);
            low = glm::min(low, positions[at]);
            high = glm::max(high, positions[at]);
        }
        group.center = 0.5f * (low + high);
        glm::vec3 sum(0.0f);
        for (std::uint32_t lane = 0; lane < group.count; ++lane) {
            const Receiver& receiver = receivers[group.receiver[lane]];
            const glm::vec3 to_center = group.center - receiver.position;
            group.radius = std::max(group.radius, glm::length(to_center));
            group.sag = std::max(group.sag, glm::dot(receiver.normal, to_center));
            sum += receiver.normal;
        }
        bound_normals(group, sum, receivers);
    });
    return groups;
}

}  // namespace surfelao
