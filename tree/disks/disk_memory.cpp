#include "tree/disks/disk_memory.h"

#include "surfels/bodies.h"
#include "surfels/for_all.h"
#include "tree/disks/correction.h"
#include "tree/receiver_groups.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace surfelao {
namespace {

/// `now` becomes the groups of `at_rest`, of the same receivers, where the placement has them.
void move_groups(const ReceiverGroups& at_rest, const Placement& placement, ReceiverGroups& now)
{
    const glm::mat3 turn(placement.rotation);
    const glm::mat3 linear(placement.scale * placement.rotation);
    const glm::vec3 shift(placement.translation);
    const auto scale = static_cast<float>(placement.scale);
    if (now.order.size() != at_rest.order.size())
        now = at_rest;
    now.groups = at_rest.groups;
    for (ReceiverGroup& group : now.groups) {
        const glm::vec3 center =
            linear * glm::vec3(group.center[0], group.center[1], group.center[2]) + shift;
        const glm::vec3 axis = turn * glm::vec3(group.axis[0], group.axis[1], group.axis[2]);
        for (int i = 0; i < 3; ++i) {
            group.center[i] = center[i];
            group.axis[i] = axis[i];
        }
        group.radius *= scale;
        group.rise *= scale;
    }
    for_all(at_rest.order.size(), 8192, [&](std::size_t i) {
        const glm::vec3 p(at_rest.position[0][i], at_rest.position[1][i], at_rest.position[2][i]);
        const glm::vec3 n(at_rest.normal[0][i], at_rest.normal[1][i], at_rest.normal[2][i]);
        const glm::vec3 to = linear * p + shift, along = turn * n;
        for (int axis = 0; axis < 3; ++axis) {
            now.position[axis][i] = to[axis];
            now.normal[axis][i] = along[axis];
        }
    });
}

/// Receivers of one body, in its own space and where it stands.
struct BodyGroups {
    ReceiverGroups at_rest, now;
    std::vector<DiskSum> sums;  ///< one per receiver

    explicit BodyGroups(std::span<const Receiver> receivers)
        : at_rest(group_receivers(receivers)), now(at_rest), sums(receivers.size())
    {
    }
    ShareRange all() const { return {0, at_rest.leaves.size()}; }
};

/// One side of a body's surfels.
struct Emitters {
    float sign;
    BodyGroups groups;
    std::vector<DiskSum> own;  ///< what the body hides from them, at rest

    Emitters(const Octree& octree, float side) : sign(side), groups(far_sides(octree, side)) {}
};

struct BodyMemory {
    std::vector<std::uint32_t> members;   ///< its receivers, of all
    std::vector<Receiver> at_rest, now;   ///< the same
    std::optional<BodyGroups> receivers;  ///< empty: to be formed
    std::vector<Emitters> sides;          ///< empty: to be formed
    std::uint64_t shape = 0;              ///< of the octree that they are of
    double own_scale = 0.0;               ///< at which `own` was found; 0: not yet
};

using FarSpan = std::span<FarVisibility>;

}  // namespace

struct DiskMemory::Impl {
    DiskOptions options;
    GatherSettings settings, beyond;
    std::vector<BodyMemory> bodies;
    EmitterVisibility visibility;

    bool limited() const { return settings.all_two_sided; }

    /// Forms what is missing and moves what is there. Returns the leaves that will be asked.
    std::uint64_t prepare(const DiskForest& forest);
    /// Of a pass of the correction, leaves.
    std::uint64_t work_of_pass(const DiskForest& forest) const;
    bool is_own_found(const DiskForest::Body& body, const BodyMemory& memory) const;
    void find_own(const DiskForest::Body& body, BodyMemory& memory, ProgressMeter& meter) const;
    double correct(const DiskForest& forest, int pass, ProgressMeter& meter);
    /// Returns how many.
    std::uint64_t answer(const DiskForest& forest, std::span<Occlusion> answers,
                         ProgressMeter& meter);
};

std::uint64_t DiskMemory::Impl::prepare(const DiskForest& forest)
{
    std::uint64_t work = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const DiskForest::Body& body = forest.bodies()[b];
        BodyMemory& memory = bodies[b];
        if (!body.shown)
            continue;
        if (!memory.receivers)
            memory.receivers.emplace(memory.at_rest);
        std::ranges::transform(memory.at_rest, memory.now.begin(), [&](const Receiver& receiver) {
            return placed(receiver, body.placement);
        });
        move_groups(memory.receivers->at_rest, body.placement, memory.receivers->now);
        work += memory.receivers->at_rest.leaves.size();
        if (options.passes == 1)
            continue;
        if (memory.sides.empty() || memory.shape != body.shape) {
            memory.sides.clear();
            memory.sides.emplace_back(body.at_rest, 1.0f);
            if (limited() || body.at_rest.two_sided_surfels < body.at_rest.surfels.size())
                memory.sides.emplace_back(body.at_rest, -1.0f);
            memory.shape = body.shape;
            memory.own_scale = 0.0;
        }
        const int times = options.passes - (is_own_found(body, memory) ? 1 : 0);
        for (Emitters& side : memory.sides) {
            move_groups(side.groups.at_rest, body.placement, side.groups.now);
            work += side.groups.at_rest.leaves.size() * static_cast<unsigned>(times);
        }
    }
    return work;
}

std::uint64_t DiskMemory::Impl::work_of_pass(const DiskForest& forest) const
{
    std::uint64_t work = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (!forest.bodies()[b].shown)
            continue;
        for (const Emitters& side : bodies[b].sides)
            work += side.groups.at_rest.leaves.size();
    }
    return work;
}

/// Where distances do not count, what a body hides from itself is the same at any size.
bool DiskMemory::Impl::is_own_found(const DiskForest::Body& body, const BodyMemory& memory) const
{
    return limited() ? memory.own_scale == body.placement.scale : memory.own_scale > 0.0;
}

void DiskMemory::Impl::find_own(const DiskForest::Body& body, BodyMemory& memory,
                                ProgressMeter& meter) const
{
    memory.own_scale = 0.0;  // until all is found
    GatherSettings alone = beyond;
    alone.definition.max_distance /= static_cast<float>(body.placement.scale);
    EmitterVisibility all;
    all.node_front.resize(body.at_rest.nodes.size());
    all.surfel_front.resize(body.at_rest.surfels.size());
    if (memory.sides.size() > 1) {
        all.node_back = all.node_front;
        all.surfel_back = all.surfel_front;
    }
    for (Emitters& side : memory.sides) {
        side.own.resize(side.groups.sums.size());
        gather_all(body.at_rest, all, side.groups.at_rest, side.groups.all(), alone, side.own,
                   meter);
    }
    memory.own_scale = body.placement.scale;
}

/// One pass over the emitters of all bodies. Returns the RMS change.
double DiskMemory::Impl::correct(const DiskForest& forest, int pass, ProgressMeter& meter)
{
    const Octree& octree = forest.octree();
    double change = 0.0;
    std::size_t changed = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const DiskForest::Body& body = forest.bodies()[b];
        if (!body.shown)
            continue;
        GatherSettings asked = beyond;
        if (pass == 1) {
            if (!is_own_found(body, bodies[b]))
                find_own(body, bodies[b], meter);
            asked.left_out[0] = body.nodes[0];
            asked.left_out[1] = body.nodes[1];
        }
        const glm::mat3 turn(body.placement.rotation);
        for (Emitters& side : bodies[b].sides) {
            std::vector<DiskSum>& sums = side.groups.sums;
            gather_all(octree, visibility, side.groups.now, side.groups.all(), asked, sums, meter);
            for (std::size_t i = 0; pass == 1 && i < sums.size(); ++i) {
                sums[i].occlusion += side.own[i].occlusion;
                sums[i].direction += turn * side.own[i].direction;
            }
        }
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const DiskForest::Body& body = forest.bodies()[b];
        for (Emitters& side : bodies[b].sides) {
            if (!body.shown)
                continue;
            const std::span<const DiskSum> sums = side.groups.sums;
            FarSpan all = side.sign > 0.0f ? visibility.surfel_front : visibility.surfel_back;
            std::size_t first = 0;
            for (const NodeRange& range : body.surfels) {
                const std::size_t count = range.end - range.begin;
                change += update_visibility(std::span(octree.surfels).subspan(range.begin, count),
                                            side.sign, sums.subspan(first, count), pass,
                                            all.subspan(range.begin, count));
                first += count;
            }
            changed += sums.size();
        }
        const bool two_sided = bodies[b].sides.size() > 1;
        for (const NodeRange& range : body.nodes) {
            average_over_nodes(octree, range, visibility.surfel_front,
                               two_sided ? visibility.surfel_back : FarSpan(),
                               visibility.node_front);
            if (two_sided)
                average_over_nodes(octree, range, visibility.surfel_back, visibility.surfel_front,
                                   visibility.node_back);
        }
    }
    return changed > 0 ? std::sqrt(change / static_cast<double>(changed)) : 0.0;
}

std::uint64_t DiskMemory::Impl::answer(const DiskForest& forest, std::span<Occlusion> answers,
                                       ProgressMeter& meter)
{
    std::uint64_t count = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        BodyMemory& memory = bodies[b];
        if (!forest.bodies()[b].shown)
            continue;
        BodyGroups& asked = *memory.receivers;
        std::ranges::fill(asked.sums, DiskSum());  // those without a normal stand in no group
        gather_all(forest.octree(), visibility, asked.now, asked.all(), settings, asked.sums,
                   meter);
        if (settings.definition.ground)
            add_ground(settings.definition, memory.now, asked.sums);
        for (std::size_t i = 0; i < memory.members.size(); ++i)
            answers[memory.members[i]] =
                to_occlusion(asked.sums[i], memory.now[i].normal, options.strength);
        count += memory.members.size();
    }
    return count;
}

DiskMemory::DiskMemory(const DiskForest& forest, std::span<const Receiver> at_rest,
                       std::span<const std::uint32_t> body_of_receiver, const DiskOptions& options)
    : impl_(std::make_unique<Impl>())
{
    check_disk_options(options);
    impl_->options = options;
    impl_->settings = gather_settings(options);
    impl_->beyond = beyond_settings(options);
    impl_->bodies.resize(forest.bodies().size());
    auto members = members_of(body_of_receiver, impl_->bodies.size());
    for (std::size_t b = 0; b < members.size(); ++b) {
        BodyMemory& memory = impl_->bodies[b];
        memory.members = std::move(members[b]);
        memory.at_rest.resize(memory.members.size());
        memory.now.resize(memory.members.size());
        deform(static_cast<std::uint32_t>(b), at_rest);
    }
}
DiskMemory::~DiskMemory() = default;
DiskMemory::DiskMemory(DiskMemory&&) noexcept = default;
DiskMemory& DiskMemory::operator=(DiskMemory&&) noexcept = default;

void DiskMemory::deform(std::uint32_t body, std::span<const Receiver> at_rest)
{
    BodyMemory& memory = impl_->bodies.at(body);
    std::ranges::transform(memory.members, memory.at_rest.begin(),
                           [&](std::uint32_t i) { return at_rest[i]; });
    memory.receivers.reset();
}

DiskFrame DiskMemory::solve(const DiskForest& forest, std::span<Occlusion> answers,
                            const Progress& progress)
{
    const Octree& octree = forest.octree();
    ProgressMeter meter(progress, impl_->prepare(forest));
    EmitterVisibility& visibility = impl_->visibility;
    visibility.node_front.assign(octree.nodes.size(), {});
    visibility.surfel_front.assign(octree.surfels.size(), {});
    const bool two_sided = impl_->limited() || octree.two_sided_surfels < octree.surfels.size();
    visibility.node_back.assign(two_sided ? octree.nodes.size() : 0, {});
    visibility.surfel_back.assign(two_sided ? octree.surfels.size() : 0, {});

    DiskFrame frame;
    for (int pass = 1; pass < impl_->options.passes; ++pass) {
        frame.residuals.push_back(impl_->correct(forest, pass, meter));
        if (frame.residuals.back() <= kSettled) {
            const auto passes_left = static_cast<unsigned>(impl_->options.passes - 1 - pass);
            meter.add(passes_left * impl_->work_of_pass(forest));
            break;
        }
    }
    frame.solved = impl_->answer(forest, answers, meter);
    return frame;
}

}  // namespace surfelao
