#include "tree/disk_gather.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

// Three of Highway's instruction sets are enough: what every processor has, AVX2 and AVX-512.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tree/disk_gather.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace surfelao {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, kGroupSize>;
using Vec = hn::Vec<Tag>;

struct Vec3 {
    Vec x, y, z;
};

HWY_INLINE Vec dot(const Vec3& a, const Vec3& b)
{
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE Vec dot(const Vec3& a, const glm::vec3& b)
{
    const Tag tag;
    return hn::Add(hn::Add(hn::Mul(a.x, hn::Set(tag, b.x)), hn::Mul(a.y, hn::Set(tag, b.y))),
                   hn::Mul(a.z, hn::Set(tag, b.z)));
}

/// One disk with its constants, the same for all lanes.
struct Disk {
    glm::vec3 center;
    glm::vec3 normal;
    float flat;    ///< flat_area / pi
    float all;     ///< area / pi
    float spread;  ///< (area - flat_area) / pi, times the share of it that is seen from any side
    const FarVisibility* front;
    const FarVisibility* back;  ///< null: one-sided
};

/// The receivers of one vector and what they have summed up so far.
struct Sums {
    Vec3 position, normal;
    Vec occlusion;
    Vec3 direction;
};

template <bool kTwoSided, bool kBunnell, bool kLimited>
HWY_INLINE void add_disk(const Disk& disk, const Definition& definition, Sums& sums)
{
    const Tag tag;
    const Vec zero = hn::Zero(tag);
    const Vec one = hn::Set(tag, 1.0f);
    const Vec3 c = {hn::Sub(hn::Set(tag, disk.center.x), sums.position.x),
                    hn::Sub(hn::Set(tag, disk.center.y), sums.position.y),
                    hn::Sub(hn::Set(tag, disk.center.z), sums.position.z)};
    const Vec d2 = hn::Add(dot(c, c), hn::Set(tag, kTinyLength * kTinyLength));
    const Vec inverse = hn::Div(one, hn::Sqrt(d2));
    const Vec inverse2 = hn::Mul(inverse, inverse);
    const Vec at_receiver = hn::Max(zero, hn::Mul(dot(c, sums.normal), inverse));
    const Vec at_disk = hn::Mul(dot(c, disk.normal), inverse);
    const Vec facing = kTwoSided ? hn::Abs(at_disk) : hn::Max(zero, at_disk);
    const Vec x = hn::Mul(hn::Set(tag, disk.flat), inverse2);

    Vec form_factor;
    if (kBunnell) {
        const Vec cone = hn::Sub(one, hn::Div(one, hn::Sqrt(hn::Add(one, x))));
        const Vec ramp = hn::Min(one, hn::Mul(hn::Set(tag, 4.0f), at_receiver));
        form_factor = hn::Mul(hn::Mul(cone, facing), ramp);
    } else {
        const Vec second = hn::IfThenElseZero(hn::Lt(x, hn::Set(tag, kNearDisk)), x);
        const Vec steep =
            hn::Sub(hn::Set(tag, 2.0f), hn::Mul(hn::Set(tag, 3.0f), hn::Mul(at_disk, at_disk)));
        const Vec correction =
            hn::Add(hn::Mul(at_receiver, steep), hn::Mul(at_disk, dot(sums.normal, disk.normal)));
        const Vec height = hn::Max(zero, hn::Add(at_receiver, hn::Mul(second, correction)));
        const Vec flat = hn::Mul(hn::Mul(x, facing), height);
        const Vec spread = hn::Mul(hn::Mul(hn::Set(tag, disk.spread), inverse2), at_receiver);
        const Vec all = hn::Add(one, hn::Mul(hn::Set(tag, disk.all), inverse2));
        form_factor =
            hn::IfThenElseZero(hn::Gt(at_receiver, zero), hn::Div(hn::Add(flat, spread), all));
    }

    Vec seen =
        hn::Add(hn::Set(tag, disk.front->constant), hn::Mul(dot(c, disk.front->slope), inverse));
    if (kTwoSided) {
        const Vec other =
            hn::Add(hn::Set(tag, disk.back->constant), hn::Mul(dot(c, disk.back->slope), inverse));
        seen = hn::IfThenElse(hn::Ge(at_disk, zero), seen, other);
    }
    form_factor = hn::Mul(form_factor, hn::Min(one, hn::Max(zero, seen)));
    if (kLimited) {
        const Vec limit = hn::Set(tag, definition.max_distance);
        const Vec distance = hn::Mul(d2, inverse);
        Vec weight;
        if (definition.falloff == Falloff::none) {
            const Vec width = hn::Mul(hn::Set(tag, 2.0f), hn::Sqrt(hn::Set(tag, disk.all)));
            weight = hn::Add(hn::Set(tag, 0.5f), hn::Div(hn::Sub(limit, distance), width));
            weight = hn::Min(one, hn::Max(zero, weight));
        } else {
            const Vec t = hn::Div(distance, limit);
            const Vec y = hn::Max(zero, hn::Sub(one, hn::Mul(t, t)));
            weight = hn::Mul(y, y);
        }
        form_factor = hn::Mul(form_factor, weight);
    }

    sums.occlusion = hn::Add(sums.occlusion, form_factor);
    const Vec along = hn::Mul(form_factor, inverse);
    sums.direction.x = hn::Add(sums.direction.x, hn::Mul(along, c.x));
    sums.direction.y = hn::Add(sums.direction.y, hn::Mul(along, c.y));
    sums.direction.z = hn::Add(sums.direction.z, hn::Mul(along, c.z));
}

/// The disks that one group sums up, as indices; kept between groups for its memory.
struct DiskList {
    std::vector<std::uint32_t> nodes;
    std::vector<std::uint32_t> leaves;
};

/// Walks the tree once for the whole group, opening for its nearest receiver.
void list_disks(const Octree& octree, const ReceiverGroup& group, const GatherSettings& settings,
                DiskList& list)
{
    list.nodes.clear();
    list.leaves.clear();
    const float reach = settings.definition.max_distance;
    const auto count = static_cast<std::uint32_t>(octree.nodes.size());
    for (std::uint32_t i = 0; i < count;) {
        const OctreeNode& node = octree.nodes[i];
        const float distance = glm::distance(node.center, group.center) - group.radius;
        if (distance - node.radius > reach) {
            i = node.next;
        } else if (node.radius < settings.opening * distance) {
            list.nodes.push_back(i);
            i = node.next;
        } else {
            if (node.next == i + 1)
                list.leaves.push_back(i);
            ++i;
        }
    }
}

template <bool kBunnell, bool kLimited>
HWY_INLINE void add_list(const Octree& octree, const EmitterVisibility& visibility,
                         const DiskList& list, const GatherSettings& settings, Sums& sums)
{
    constexpr float kInvPi = std::numbers::inv_pi_v<float>;
    const std::uint32_t two_sided_nodes = settings.all_two_sided ? 0 : octree.two_sided_nodes;
    const std::uint32_t two_sided_surfels = settings.all_two_sided ? 0 : octree.two_sided_surfels;
    for (const std::uint32_t i : list.nodes) {
        const OctreeNode& node = octree.nodes[i];
        const float rest = std::max(0.0f, node.area - node.flat_area) * kInvPi;
        Disk disk = {node.center,
                     node.normal,
                     node.flat_area * kInvPi,
                     node.area * kInvPi,
                     0.25f * rest,
                     &visibility.node_front[i],
                     nullptr};
        if (i < two_sided_nodes) {
            add_disk<false, kBunnell, kLimited>(disk, settings.definition, sums);
        } else {
            disk.spread = 0.5f * rest;
            disk.back = &visibility.node_back[i];
            add_disk<true, kBunnell, kLimited>(disk, settings.definition, sums);
        }
    }
    for (const std::uint32_t leaf : list.leaves) {
        const std::uint32_t first = octree.nodes[leaf].first_surfel;
        for (std::uint32_t s = first; s < first + octree.nodes[leaf].surfel_count; ++s) {
            const Surfel& surfel = octree.surfels[s];
            const float area = surfel.area * kInvPi;
            Disk disk = {
                surfel.position, surfel.normal, area, area, 0.0f, &visibility.surfel_front[s],
                nullptr};
            if (s < two_sided_surfels) {
                add_disk<false, kBunnell, kLimited>(disk, settings.definition, sums);
            } else {
                disk.back = &visibility.surfel_back[s];
                add_disk<true, kBunnell, kLimited>(disk, settings.definition, sums);
            }
        }
    }
}

void gather(const Octree& octree, const EmitterVisibility& visibility,
            std::span<const ReceiverGroup> groups, const GatherSettings& settings,
            std::span<DiskSum> out)
{
    const Tag tag;
    const bool bunnell = settings.definition.kernel == Kernel::bunnell;
    const bool limited = std::isfinite(settings.definition.max_distance);
    DiskList list;
    for (const ReceiverGroup& group : groups) {
        list_disks(octree, group, settings, list);
        for (std::size_t first = 0; first < kGroupSize; first += hn::Lanes(tag)) {
            const auto load = [&](const std::array<ReceiverGroup::Lanes, 3>& lanes) {
                return Vec3{hn::LoadU(tag, lanes[0].data() + first),
                            hn::LoadU(tag, lanes[1].data() + first),
                            hn::LoadU(tag, lanes[2].data() + first)};
            };
            const Vec zero = hn::Zero(tag);
            Sums sums = {load(group.position), load(group.normal), zero, {zero, zero, zero}};
            if (bunnell && limited)
                add_list<true, true>(octree, visibility, list, settings, sums);
            else if (bunnell)
                add_list<true, false>(octree, visibility, list, settings, sums);
            else if (limited)
                add_list<false, true>(octree, visibility, list, settings, sums);
            else
                add_list<false, false>(octree, visibility, list, settings, sums);

            HWY_ALIGN float lanes[4][kGroupSize];
            hn::Store(sums.occlusion, tag, lanes[0]);
            hn::Store(sums.direction.x, tag, lanes[1]);
            hn::Store(sums.direction.y, tag, lanes[2]);
            hn::Store(sums.direction.z, tag, lanes[3]);
            for (std::size_t lane = 0; lane < hn::Lanes(tag) && first + lane < group.count; ++lane)
                out[group.receiver[first + lane]] = {
                    lanes[0][lane], {lanes[1][lane], lanes[2][lane], lanes[3][lane]}};
        }
    }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace surfelao
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surfelao {

HWY_EXPORT(gather);

void gather_disks(const Octree& octree, const EmitterVisibility& visibility,
                  std::span<const ReceiverGroup> groups, const GatherSettings& settings,
                  std::span<DiskSum> sums)
{
    HWY_DYNAMIC_DISPATCH(gather)(octree, visibility, groups, settings, sums);
}

}  // namespace surfelao
#endif
