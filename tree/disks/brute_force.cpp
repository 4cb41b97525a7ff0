#include "tree/disks/brute_force.h"

#include "surfels/for_all.h"
#include "tree/disks/correction.h"
#include "tree/disks/form_factor.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

struct Sum {
    double occlusion = 0.0;
    glm::dvec3 direction{0.0};
};

struct Far {
    glm::dvec3 slope{0.0};
    double constant = 1.0;
};

/// far[0]: on the side of the casting normal; far[1]: on the other.
using FarSides = std::vector<Far>[2];

Sum gather(const Octree& octree, const FarSides& far, const GatherSettings& settings,
           const Receiver& receiver)
{
    const Definition& definition = settings.definition;
    Sum sum;
    const glm::dvec3 position(receiver.position);
    const glm::dvec3 normal(receiver.normal);
    for (std::size_t s = 0; s < octree.surfels.size(); ++s) {
        const Surfel& surfel = octree.surfels[s];
        const bool two_sided = settings.all_two_sided || s >= octree.two_sided_surfels;
        const glm::dvec3 c = glm::dvec3(surfel.position) - position;
        const double distance = std::sqrt(glm::dot(c, c) + double{kTinyLength} * kTinyLength);
        const bool behind = glm::dot(c, glm::dvec3(surfel.normal)) >= 0.0;
        const Far& beyond = far[behind ? 0 : 1][s];
        glm::dvec3 w = c / distance;
        double share =
            disk_form_factor(definition.kernel, position, normal,
                             {surfel.position, surfel.normal, surfel.area, surfel.area, two_sided});
        if (!settings.only_disks && is_near_triangle(definition.kernel, c, surfel)) {
            const glm::dvec3 moment = triangle_moment(c, normal, surfel);
            share = two_sided || behind ? glm::dot(moment, normal) : 0.0;
            w = moment / std::max(glm::length(moment), double{kTinyLength});
        }
        double weight = distance_weight(definition, distance, surfel.area);
        if (definition.ground) {
            const GroundSight sight = sight_of(*definition.ground, receiver.position);
            weight = std::max(0.0, weight - ground_weight(definition, sight, c, surfel.area));
        }
        const double term =
            share * weight * std::clamp(beyond.constant + glm::dot(beyond.slope, w), 0.0, 1.0);
        sum.occlusion += term;
        sum.direction += term * w;
    }
    if (definition.ground) {
        sum.occlusion += ground_share(definition, receiver);
        sum.direction += glm::dvec3(ground_direction(definition, receiver));
    }
    return sum;
}

Sum capped(const Sum& sum)
{
    const double scale = 1.0 / std::max(1.0, sum.occlusion);
    return {scale * sum.occlusion, scale * sum.direction};
}

}  // namespace

DiskResult solve_disks_brute_force(const Octree& octree, std::span<const Receiver> receivers,
                                   const DiskOptions& options)
{
    const std::size_t count = octree.surfels.size();
    const GatherSettings settings = gather_settings(options);
    const GatherSettings beyond = beyond_settings(options);
    const bool two_sided = settings.all_two_sided || octree.two_sided_surfels < count;

    DiskResult result;
    FarSides far = {std::vector<Far>(count), std::vector<Far>(count)};
    for (int pass = 1; pass < options.passes; ++pass) {
        const FarSides before = {far[0], far[1]};
        std::vector<double> changes(count, 0.0);
        for (int side = 0; side < (two_sided ? 2 : 1); ++side) {
            const std::vector<Receiver> asked = far_sides(octree, side == 0 ? 1.0f : -1.0f);
            for_tasks(count, [&](std::size_t s) {
                const Receiver& at = asked[s];
                const glm::vec3 normal = at.normal;
                Sum sum = gather(octree, before, beyond, at);
                const double divisor =
                    pass == 1 ? 1.0 + sum.occlusion : std::max(1.0, sum.occlusion);
                sum = {sum.occlusion / divisor, sum.direction / divisor};
                const glm::dvec3 mean = 2.0 / 3.0 * glm::dvec3(normal);
                const glm::dvec3 slope = -4.0 * (sum.direction - sum.occlusion * mean);
                const double constant = 1.0 - sum.occlusion - glm::dot(slope, mean);
                const double weight = correction_weight(pass);
                Far& now = far[side][s];
                now.slope += weight * (slope - now.slope);
                now.constant += weight * (constant - now.constant);
                const Far& then = before[side][s];
                changes[s] += std::pow(
                    now.constant - then.constant + glm::dot(now.slope - then.slope, mean), 2);
            });
        }
        double change = 0.0;
        for (const double each : changes)
            change += each;
        const double changed = static_cast<double>(count * (two_sided ? 2 : 1));
        result.residuals.push_back(count > 0 ? std::sqrt(change / changed) : 0.0);
        if (result.residuals.back() <= kSettled)
            break;
    }

    result.occlusion.resize(receivers.size());
    for_tasks(receivers.size(), [&](std::size_t i) {
        if (receivers[i].normal == glm::vec3(0.0f))
            return;
        const Sum sum = gather(octree, far, settings, receivers[i]);
        const glm::dvec3 normal(receivers[i].normal);
        const glm::dvec3 open = 2.0 / 3.0 * normal - capped(sum).direction;
        Occlusion& out = result.occlusion[i];
        out.occlusion = static_cast<float>(std::clamp(options.strength * sum.occlusion, 0.0, 1.0));
        out.bent_normal = sum.occlusion < 1.0 ? bent_normal_of(glm::vec3(open), receivers[i].normal)
                                              : receivers[i].normal;
    });
    return result;
}

}  // namespace surfelao
