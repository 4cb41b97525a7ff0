#include "tree/disks/disks.h"

#include "surfels/errors.h"
#include "surfels/surface.h"
#include "tree/disks/gather.h"
#include "tree/ground.h"
#include "tree/receiver_groups.h"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

using Range = tbb::blocked_range<std::size_t>;

/// Groups that one thread takes at a time: some tens of microseconds each.
constexpr std::size_t kGroupsPerTask = 16;

void gather_all(const Octree& octree, const EmitterVisibility& visibility,
                const ReceiverGroups& groups, const GatherSettings& settings,
                std::span<DiskSum> sums, ProgressMeter& meter)
{
    tbb::parallel_for(Range(0, groups.leaves.size(), kGroupsPerTask), [&](const Range& range) {
        gather_disks(octree, visibility, groups,
                     std::span(groups.leaves).subspan(range.begin(), range.size()), settings, sums);
        meter.add(range.size());
    });
}

/// Scaled down where it sums to more than a full hemisphere.
DiskSum capped(const DiskSum& sum)
{
    const float scale = 1.0f / std::max(1.0f, sum.occlusion);
    return {scale * sum.occlusion, scale * sum.direction};
}

/// A linear function with the same mean over the hemisphere (cosine-weighted) as 1 - occlusion. Its
/// slope is what least squares gives along the surface, where the mean square of w is 1/4. Along
/// the normal w varies less (variance 1/18 about its mean 2/3) and least squares would mostly
/// amplify errors: the same factor there was measured to be best.
FarVisibility fit(const DiskSum& sum, const glm::vec3& normal)
{
    const DiskSum s = capped(sum);
    const glm::vec3 mean = 2.0f / 3.0f * normal;
    const glm::vec3 slope = -4.0f * (s.direction - s.occlusion * mean);
    return {slope, 1.0f - s.occlusion - glm::dot(slope, mean)};
}

/// A node's visibility: the mean over its surfels, by area; two-sided surfels that face against the
/// node give their other side.
void average_over_nodes(const Octree& octree, std::span<const FarVisibility> same,
                        std::span<const FarVisibility> other, std::vector<FarVisibility>& nodes)
{
    tbb::parallel_for(Range(0, octree.nodes.size(), 256), [&](const Range& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
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

/// One side of all surfels: where they are asked, and what was found.
struct FarSide {
    ReceiverGroups groups;
    std::vector<DiskSum> sums;
    float sign;

    FarSide(const Octree& octree, float side)
        : groups(group_receivers(far_sides(octree, side))), sums(octree.surfels.size()), sign(side)
    {
    }

    /// Moves the surfels' visibility by `weight` of the way to what the sums say. Returns the sum
    /// of the squared changes of their mean.
    double update(const Octree& octree, float weight, std::vector<FarVisibility>& surfels) const
    {
        double change = 0.0;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const glm::vec3 normal = sign * octree.surfels[i].normal;
            const FarVisibility found = fit(sums[i], normal);
            const glm::vec3 slope = weight * (found.slope - surfels[i].slope);
            const float constant = weight * (found.constant - surfels[i].constant);
            surfels[i].slope += slope;
            surfels[i].constant += constant;
            const double mean = constant + 2.0f / 3.0f * glm::dot(slope, normal);
            change += mean * mean;
        }
        return change;
    }
};

/// The disks have left out what the ground covers.
void add_ground(const Definition& definition, std::span<const Receiver> receivers,
                std::span<DiskSum> sums)
{
    tbb::parallel_for(std::size_t{0}, receivers.size(), [&](std::size_t i) {
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

}  // namespace

void check_disk_options(const DiskOptions& options)
{
    check_definition(options.definition);
    require(options.opening >= 0.0f && options.opening < 1.0f,
            "opening of disks must be at least 0 and below 1");
    require(options.passes >= 1, "passes must be at least 1");
    require(options.strength >= 0.0f && std::isfinite(options.strength),
            "strength must be 0 or more, and finite");
}

float correction_opening(float opening)
{
    return std::max(opening, std::min(kCoarser * opening, kDraftOpening));
}

std::vector<Receiver> far_sides(const Octree& octree, float side)
{
    std::vector<Receiver> receivers(octree.surfels.size());
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const Surfel& surfel = octree.surfels[i];
        const glm::vec3 normal = side * surfel.normal;
        const float offset =
            std::clamp(kOffsetShare * std::sqrt(surfel.area), kLeastOffset, kMostOffset);
        receivers[i] = {surfel.position + offset * normal, normal, offset};
    }
    return receivers;
}

DiskResult solve_disks(const Octree& octree, std::span<const Receiver> receivers,
                       const DiskOptions& options, const Progress& progress)
{
    return std::move(solve_disk_lists(octree, {&receivers, 1}, options, progress).front());
}

std::vector<DiskResult> solve_disk_lists(const Octree& octree,
                                         std::span<const std::span<const Receiver>> lists,
                                         const DiskOptions& options, const Progress& progress)
{
    check_disk_options(options);
    const Definition& definition = options.definition;

    // A limit may end inside a body, in front of its back: then every surface casts from both
    // sides, and half the range is what is left, on average, beyond a disk.
    GatherSettings settings = {definition, options.opening, std::isfinite(definition.max_distance)};
    GatherSettings beyond = settings;
    beyond.definition.max_distance *= 0.5f;
    beyond.definition.ground.reset();  // nothing that still counts has the ground beyond it
    beyond.opening = correction_opening(options.opening);
    const bool two_sided =
        settings.all_two_sided || octree.two_sided_surfels < octree.surfels.size();

    std::vector<FarSide> sides;
    if (options.passes > 1)
        sides.emplace_back(octree, 1.0f);
    if (options.passes > 1 && two_sided)
        sides.emplace_back(octree, -1.0f);
    std::vector<ReceiverGroups> groups;
    std::uint64_t work = 0;
    for (const std::span<const Receiver> receivers : lists)
        work += groups.emplace_back(group_receivers(receivers)).leaves.size();
    for (const FarSide& side : sides)
        work += side.groups.leaves.size() * (options.passes - 1);
    ProgressMeter meter(progress, work);

    EmitterVisibility visibility;
    visibility.node_front.resize(octree.nodes.size());
    visibility.surfel_front.resize(octree.surfels.size());
    if (two_sided) {
        visibility.node_back = visibility.node_front;
        visibility.surfel_back = visibility.surfel_front;
    }

    std::vector<double> residuals;
    for (int pass = 1; pass < options.passes; ++pass) {
        for (FarSide& side : sides)
            gather_all(octree, visibility, side.groups, beyond, side.sums, meter);
        const float weight = pass == 1 ? 1.0f : kDamping;
        double change = sides[0].update(octree, weight, visibility.surfel_front);
        if (two_sided)
            change += sides[1].update(octree, weight, visibility.surfel_back);
        average_over_nodes(octree, visibility.surfel_front, visibility.surfel_back,
                           visibility.node_front);
        if (two_sided)
            average_over_nodes(octree, visibility.surfel_back, visibility.surfel_front,
                               visibility.node_back);
        const double count = static_cast<double>(sides.size() * octree.surfels.size());
        residuals.push_back(count > 0.0 ? std::sqrt(change / count) : 0.0);
        if (residuals.back() <= kSettled)
            break;
    }

    std::vector<DiskResult> results;
    for (std::size_t list = 0; list < lists.size(); ++list) {
        const std::span<const Receiver> receivers = lists[list];
        std::vector<DiskSum> sums(receivers.size());
        gather_all(octree, visibility, groups[list], settings, sums, meter);
        DiskResult& result = results.emplace_back();
        result.residuals = residuals;
        result.occlusion.resize(receivers.size());
        if (definition.ground)
            add_ground(definition, receivers, sums);
        for (std::size_t i = 0; i < receivers.size(); ++i)
            result.occlusion[i] = to_occlusion(sums[i], receivers[i].normal, options.strength);
    }
    return results;
}

}  // namespace surfelao
