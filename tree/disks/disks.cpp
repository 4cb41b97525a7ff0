#include "tree/disks/disks.h"

#include "surfels/errors.h"
#include "surfels/surface.h"
#include "tree/disks/correction.h"
#include "tree/disks/gather.h"
#include "tree/receiver_groups.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

/// One side of all surfels: where they are asked, and what was found.
struct FarSide {
    ReceiverGroups groups;
    std::vector<DiskSum> sums;

    FarSide(const Octree& octree, float side)
        : groups(group_receivers(far_sides(octree, side))), sums(octree.surfels.size())
    {
    }
};

/// kUnsolved for the receivers of all but these leaves.
void mark_others(const ReceiverGroups& groups, const ShareRange& leaves,
                 std::vector<Occlusion>& occlusion)
{
    for (std::size_t leaf = 0; leaf < groups.leaves.size(); ++leaf) {
        if (leaf >= leaves.begin && leaf < leaves.end)
            continue;
        const ReceiverGroup& group = groups.groups[groups.leaves[leaf]];
        for (std::uint32_t i = group.begin; i < group.end; ++i)
            occlusion[groups.order[i]] = kUnsolved;
    }
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

    const GatherSettings settings = gather_settings(options);
    const GatherSettings beyond = beyond_settings(options);
    const bool two_sided =
        settings.all_two_sided || octree.two_sided_surfels < octree.surfels.size();

    std::vector<FarSide> sides;
    if (options.passes > 1)
        sides.emplace_back(octree, 1.0f);
    if (options.passes > 1 && two_sided)
        sides.emplace_back(octree, -1.0f);
    std::vector<ReceiverGroups> groups;
    std::uint64_t work = 0, work_of_pass = 0;
    for (const std::span<const Receiver> receivers : lists) {
        groups.push_back(group_receivers(receivers));
        const ShareRange leaves = range_of(options.share, groups.back().leaves.size());
        work += leaves.end - leaves.begin;
    }
    for (const FarSide& side : sides)
        work_of_pass += side.groups.leaves.size();
    work += work_of_pass * static_cast<unsigned>(options.passes - 1);
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
            gather_all(octree, visibility, side.groups, {0, side.groups.leaves.size()}, beyond,
                       side.sums, meter);
        double change =
            update_visibility(octree.surfels, 1.0f, sides[0].sums, pass, visibility.surfel_front);
        if (two_sided)
            change += update_visibility(octree.surfels, -1.0f, sides[1].sums, pass,
                                        visibility.surfel_back);
        const NodeRange all{0, static_cast<std::uint32_t>(octree.nodes.size())};
        average_over_nodes(octree, all, visibility.surfel_front, visibility.surfel_back,
                           visibility.node_front);
        if (two_sided)
            average_over_nodes(octree, all, visibility.surfel_back, visibility.surfel_front,
                               visibility.node_back);
        const double count = static_cast<double>(sides.size() * octree.surfels.size());
        residuals.push_back(count > 0.0 ? std::sqrt(change / count) : 0.0);
        if (residuals.back() <= kSettled) {
            meter.add(work_of_pass * static_cast<unsigned>(options.passes - 1 - pass));
            break;
        }
    }

    std::vector<DiskResult> results;
    for (std::size_t list = 0; list < lists.size(); ++list) {
        const std::span<const Receiver> receivers = lists[list];
        std::vector<DiskSum> sums(receivers.size());
        const ShareRange leaves = range_of(options.share, groups[list].leaves.size());
        gather_all(octree, visibility, groups[list], leaves, settings, sums, meter);
        DiskResult& result = results.emplace_back();
        result.residuals = residuals;
        result.occlusion.resize(receivers.size());
        if (definition.ground)
            add_ground(definition, receivers, sums);
        for (std::size_t i = 0; i < receivers.size(); ++i)
            result.occlusion[i] = to_occlusion(sums[i], receivers[i].normal, options.strength);
        mark_others(groups[list], leaves, result.occlusion);
    }
    return results;
}

}  // namespace surfelao
