#include "tree/disks/correction.h"

#include "surfels/for_all.h"
#include "tree/ground.h"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

/// Groups that one thread takes at a time: some tens of microseconds each.
constexpr std::size_t kGroupsPerTask = 16;

}  // namespace

GatherSettings gather_settings(const DiskOptions& options)
{
    return {options.definition,
            options.opening,
            std::isfinite(options.definition.max_distance),
            false,
            {}};
}

GatherSettings beyond_settings(const DiskOptions& options)
{
    GatherSettings beyond = gather_settings(options);
    beyond.definition.max_distance *= 0.5f;
    beyond.definition.ground.reset();
    beyond.only_disks = true;
    beyond.opening = correction_opening(options.opening);
    return beyond;
}

void gather_all(const Octree& octree, const EmitterVisibility& visibility,
                const ReceiverGroups& groups, const ShareRange& leaves,
                const GatherSettings& settings, std::span<DiskSum> sums, ProgressMeter& meter)
{
    for_ranges(leaves.begin, leaves.end, kGroupsPerTask, [&](std::size_t begin, std::size_t end) {
        gather_disks(octree, visibility, groups,
                     std::span(groups.leaves).subspan(begin, end - begin), settings, sums);
        meter.add(end - begin);
    });
}

namespace {

/// Scaled down where it sums to more than a full hemisphere.
DiskSum capped(const DiskSum& sum)
{
    const float scale = 1.0f / std::max(1.0f, sum.occlusion);
    return {scale * sum.occlusion, scale * sum.direction};
}

FarVisibility fit(const DiskSum& sum, const glm::vec3& normal, int pass)
{
    const float scale = 1.0f / correction_divisor(pass, sum.occlusion);
    const DiskSum s = {scale * sum.occlusion, scale * sum.direction};
    const glm::vec3 mean = 2.0f / 3.0f * normal;
    const glm::vec3 slope = -4.0f * (s.direction - s.occlusion * mean);
    return {slope, 1.0f - s.occlusion - glm::dot(slope, mean)};
}

}  // namespace

double update_visibility(std::span<const Surfel> surfels, float sign, std::span<const DiskSum> sums,
                         int pass, std::span<FarVisibility> visibility)
{
    const float weight = correction_weight(pass);
    double change = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const glm::vec3 normal = sign * surfels[i].normal;
        const FarVisibility found = fit(sums[i], normal, pass);
        const glm::vec3 slope = weight * (found.slope - visibility[i].slope);
        const float constant = weight * (found.constant - visibility[i].constant);
        visibility[i].slope += slope;
        visibility[i].constant += constant;
        const double mean = constant + 2.0f / 3.0f * glm::dot(slope, normal);
        change += mean * mean;
    }
    return change;
}

void average_over_nodes(const Octree& octree, const NodeRange& of,
                        std::span<const FarVisibility> same, std::span<const FarVisibility> other,
                        std::span<FarVisibility> nodes)
{
    for_ranges(of.begin, of.end, 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const OctreeNode& node = octree.nodes[i];
            glm::dvec4 sum(0.0);
            double area = 0.0;
            for (std::uint32_t k = 0; k < node.surfel_count; ++k) {
                const std::uint32_t s = node.first_surfel + k;
                const Surfel& surfel = octree.surfels[s];
                const bool turned = !other.empty() && glm::dot(surfel.normal, node.normal) < 0.0f;
                const FarVisibility& far = turned ? other[s] : same[s];
                sum += static_cast<double>(surfel.area) * glm::dvec4(far.slope, far.constant);
                area += surfel.area;
            }
            sum /= area;
            nodes[i] = {glm::vec3(sum), static_cast<float>(sum.w)};
        }
    });
}

void add_ground(const Definition& definition, std::span<const Receiver> receivers,
                std::span<DiskSum> sums)
{
    for_tasks(receivers.size(), [&](std::size_t i) {
        if (receivers[i].normal == glm::vec3(0.0f))
            return;
        sums[i].occlusion += ground_share(definition, receivers[i]);
        sums[i].direction += ground_direction(definition, receivers[i]);
    });
}

Occlusion to_occlusion(const DiskSum& sum, const glm::vec3& normal, float strength)
{
    const DiskSum s = capped(sum);
    Occlusion result;
    result.occlusion = std::clamp(strength * sum.occlusion, 0.0f, 1.0f);
    // the open part of the hemisphere, whose own first moment is 2/3 of the normal
    const glm::vec3 open = 2.0f / 3.0f * normal - s.direction;
    result.bent_normal = s.occlusion < 1.0f ? bent_normal_of(open, normal) : normal;
    return result;
}

}  // namespace surfelao
