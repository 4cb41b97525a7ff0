#include "pixels/cube_placement.h"

#include "bake/surface_error.h"
#include "reference/closest_hit.h"
#include "surfels/errors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace surfelao {
namespace {

constexpr int kGrid = 12;  // cells along each axis
constexpr int kRoundCandidates = 48;
constexpr float kRoundRadius = 0.7f;  // diagonals: a fifth of one beyond the box's ball
constexpr std::uint64_t kTargets = 4096;
constexpr int kProbes = 64;              // rays that tell whether a cell is free
constexpr float kLeastDistance = 0.01f;  // diagonals, of a candidate from the surface
constexpr float kLeastCosine = 0.15f;    // 81 degrees
constexpr float kNearEnough = 0.25f;     // diagonals: nearer maps count no more
constexpr double kOftenEnough = 0.05;    // of all cells, or of the sphere
constexpr double kEnough = 0.98;         // of the targets that can be seen
constexpr float kEndShare = 1e-4f;       // of a ray: where it ends before its target

glm::vec3 spread_direction(int i, int count)
{
    constexpr float kGoldenAngle = 2.39996323f;
    const float z = 1.0f - (2.0f * static_cast<float>(i) + 1.0f) / static_cast<float>(count);
    const float turn = kGoldenAngle * static_cast<float>(i), r = std::sqrt(1.0f - z * z);
    return {r * std::cos(turn), z, r * std::sin(turn)};
}

struct PlacementTarget {
    glm::vec3 position{0.0f}, normal{0.0f};
};

std::vector<PlacementTarget> targets_of(const Geometry& geometry)
{
    std::vector<PlacementTarget> targets;
    for (const SurfacePoint& point : surface_points(geometry, kTargets)) {
        const glm::uvec3 t = geometry.triangles[point.triangle];
        const glm::vec3 a = geometry.positions[t.x];
        const glm::vec3 across = geometry.positions[t.y] - a, along = geometry.positions[t.z] - a;
        targets.push_back({a + point.at.x * across + point.at.y * along,
                           glm::normalize(glm::cross(across, along))});
    }
    return targets;
}

/// Middles of cells that are neither inside of a body nor at the surface, and directions around.
std::vector<glm::vec3> candidates_of(const Geometry& geometry, const RayScene& scene)
{
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const glm::vec3& p : geometry.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    std::vector<glm::vec3> candidates;
    for (int cell = 0; cell < kGrid * kGrid * kGrid; ++cell) {
        const glm::vec3 at(cell % kGrid, cell / kGrid % kGrid, cell / (kGrid * kGrid));
        const glm::vec3 middle = glm::mix(low, high, (at + 0.5f) / static_cast<float>(kGrid));
        std::vector<Ray> rays;
        for (int i = 0; i < kProbes; ++i)
            rays.push_back(
                {middle, spread_direction(i, kProbes), std::numeric_limits<float>::infinity()});
        int fronts = 0, backs = 0;
        float nearest = std::numeric_limits<float>::infinity();
        for (const ClosestHit& hit : closest_hits(scene, rays)) {
            if (hit.triangle == ClosestHit::kNone)
                continue;
            nearest = std::min(nearest, hit.distance);
            ++(hit.is_back ? backs : fronts);
        }
        if (nearest >= kLeastDistance && backs <= fronts)
            candidates.push_back(middle);
    }
    for (int i = 0; i < kRoundCandidates; ++i)
        candidates.push_back(kRoundRadius * spread_direction(i, kRoundCandidates));
    return candidates;
}

/// What a map at a candidate is worth at each target; below 0 of the target's other side, 0 where
/// it is not seen.
std::vector<float> worth_of(glm::vec3 candidate, const std::vector<PlacementTarget>& targets,
                            const RayScene& scene)
{
    std::vector<float> worth(targets.size(), 0.0f);
    std::vector<Ray> rays;
    std::vector<std::size_t> asked;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const glm::vec3 d = targets[i].position - candidate;
        const float distance = glm::length(d);
        const float cosine = -glm::dot(targets[i].normal, d) / distance;
        if (!(std::abs(cosine) >= kLeastCosine))
            continue;
        const glm::vec3 size = glm::abs(d);
        worth[i] = cosine * std::max({size.x, size.y, size.z}) /
                   (distance * std::max(distance, kNearEnough));
        rays.push_back({candidate, d / distance, (1.0f - kEndShare) * distance});
        asked.push_back(i);
    }
    const std::vector<ClosestHit> hits = closest_hits(scene, rays);
    for (std::size_t k = 0; k < asked.size(); ++k) {
        if (hits[k].triangle != ClosestHit::kNone)
            worth[asked[k]] = 0.0f;
    }
    return worth;
}

/// One side of a target.
std::size_t side_of(std::size_t target, float worth)
{
    return 2 * target + (worth < 0.0f ? 1 : 0);
}

/// The first of those that add most; their number where none adds anything.
std::size_t best_candidate(const std::vector<std::vector<float>>& worth,
                           const std::vector<double>& seen)
{
    double best_gain = 0.0;
    std::size_t best = worth.size();
    for (std::size_t c = 0; c < worth.size(); ++c) {
        double gain = 0.0;
        for (std::size_t i = 0; i < worth[c].size(); ++i) {
            const float w = worth[c][i];
            if (w != 0.0f)
                gain += std::abs(double{w}) * seen[side_of(i, w)];
        }
        if (gain > best_gain) {
            best_gain = gain;
            best = c;
        }
    }
    return best;
}

}  // namespace

CubePlacement place_cube_maps(const Mesh& mesh, int most, const Progress& progress)
{
    require(most >= 1, "cube maps: one at least");
    const RayScene scene(mesh.geometry, RayScene::Build::quick);
    const std::vector<PlacementTarget> targets = targets_of(mesh.geometry);
    const std::vector<glm::vec3> candidates = candidates_of(mesh.geometry, scene);
    const std::size_t cells = candidates.size() - kRoundCandidates;
    ProgressMeter meter(progress, candidates.size());
    std::vector<std::vector<float>> worth;
    std::vector<double> seen(2 * targets.size(), 0.0);  // of each side, while no map covers it
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        worth.push_back(worth_of(candidates[c], targets, scene));
        const double eyes = 1.0 / static_cast<double>(c < cells ? cells : kRoundCandidates);
        for (std::size_t i = 0; i < targets.size(); ++i) {
            if (worth.back()[i] != 0.0f)
                seen[side_of(i, worth.back()[i])] += eyes;
        }
        meter.add(1);
    }
    for (double& eyes : seen)
        eyes = std::min(eyes, kOftenEnough);
    const double all = std::accumulate(seen.begin(), seen.end(), 0.0);
    CubePlacement placement;
    placement.candidates = static_cast<std::uint32_t>(candidates.size());
    double left = all;
    while (static_cast<int>(placement.centres.size()) < most && left > (1.0 - kEnough) * all) {
        const std::size_t best = best_candidate(worth, seen);
        if (best == candidates.size())
            break;
        placement.centres.push_back(candidates[best]);
        for (std::size_t i = 0; i < targets.size(); ++i) {
            if (worth[best][i] != 0.0f)
                seen[side_of(i, worth[best][i])] = 0.0;
        }
        left = std::accumulate(seen.begin(), seen.end(), 0.0);
    }
    placement.covered = all > 0.0 ? 1.0 - left / all : 0.0;
    return placement;
}

}  // namespace surfelao
