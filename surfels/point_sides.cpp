#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/point_cloud.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace surfelao {
namespace {

/// Points whose votes are worth a thread's start.
constexpr std::size_t kVoteGrain = 1024;

/// How much more open the side is to which a normal points.
struct Vote {
    float side = 0.0f;
    float weight = 0.0f;  ///< 0: none yet, else 1
};

/// 1 where the way from one point to another lies in the planes of both, 0 where it is as steep
/// over one of them as kSteepest.
float nearness_to_planes(glm::vec3 way, glm::vec3 a, glm::vec3 b)
{
    const float steep = std::max(std::abs(glm::dot(way, a)), std::abs(glm::dot(way, b)));
    const float most2 = kSteepest * kSteepest * glm::dot(way, way);
    return most2 > 0.0f ? std::max(0.0f, 1.0f - steep * steep / most2) : 1.0f;
}

}  // namespace

std::vector<std::uint32_t> voters_of(const PointCloud& cloud)
{
    const std::size_t count = cloud.occluders.size(), step = (count - 1) / kMostVoters + 1;
    std::vector<std::uint32_t> voters;
    for (std::size_t k = 0; k < count; k += step)
        voters.push_back(cloud.occluders[k]);
    return voters;
}

void orient(PointCloud& cloud, std::span<const std::uint32_t> voters,
            std::span<const Occlusion> front, std::span<const Occlusion> back)
{
    const std::size_t count = voters.size();
    SURFELAO_CHECK(cloud.is_unoriented && front.size() == count && back.size() == count &&
                   cloud.order.size() == cloud.positions.size());
    // along the curve, where neighbours are near in memory
    std::vector<Vote> votes(cloud.positions.size()), next(votes.size());
    for (std::size_t k = 0; k < count; ++k)
        next[voters[k]] = {back[k].occlusion - front[k].occlusion, 1.0f};
    std::vector<glm::vec3> positions(votes.size()), normals(votes.size());
    for_all(votes.size(), [&](std::size_t i) {
        const std::uint32_t point = cloud.order[i];
        votes[i] = next[point];
        positions[i] = cloud.positions[point];
        normals[i] = cloud.normals[point];
    });
    const auto voted = [&](std::size_t i) -> Vote {
        float sum = votes[i].weight * votes[i].side, weights = votes[i].weight;
        for (const std::uint32_t other : cloud.neighbours[i]) {
            if (other == PointCloud::kNobody)
                continue;
            const float cosine = glm::dot(normals[i], normals[other]);
            // not across edges, nor from the other side of a thin sheet
            const float weight =
                votes[other].weight * cosine * cosine * cosine * cosine *
                nearness_to_planes(positions[other] - positions[i], normals[i], normals[other]);
            sum += std::copysign(weight, cosine) * votes[other].side;
            weights += weight;
        }
        return weights > 0.0f ? Vote{sum / weights, 1.0f} : Vote{};
    };
    for (int round = 0; round < kVoteRounds; ++round) {
        for_all(votes.size(), kVoteGrain, [&](std::size_t i) { next[i] = voted(i); });
        votes.swap(next);
    }
    std::vector<std::uint32_t> weak;
    for (std::uint32_t i = 0; i < votes.size(); ++i) {
        if (std::abs(votes[i].side) < kWeakVote)
            weak.push_back(i);
    }
    for (int round = 0; round < kWeakVoteRounds; ++round) {
        for_all(weak.size(), kVoteGrain, [&](std::size_t k) { next[k] = voted(weak[k]); });
        for (std::size_t k = 0; k < weak.size(); ++k)
            votes[weak[k]] = next[k];
    }
    for (std::size_t i = 0; i < votes.size(); ++i) {
        glm::vec3& normal = cloud.normals[cloud.order[i]];
        if (votes[i].side < 0.0f)
            normal = -normal;
        cloud.counts.weak += std::abs(votes[i].side) < kWeakVote;
    }
    cloud.is_unoriented = false;
    cloud.neighbours = {};
}

}  // namespace surfelao
