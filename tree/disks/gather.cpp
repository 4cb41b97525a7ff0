#include "tree/disks/gather.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

// Three of Highway's instruction sets are enough: what every processor has, AVX2 and AVX-512.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tree/disks/gather.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace surfelao {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, kGroupSize>;
using Vec = hn::Vec<Tag>;

using Mask = hn::Mask<Tag>;

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
    const FarVisibility* back;    ///< null: one-sided
    const Surfel* triangle = {};  ///< null: round
};

/// The receivers of one vector and what they have summed up so far.
struct Sums {
    Vec3 position, normal;
    Vec occlusion;
    Vec3 direction;
    Vec3 towards;  ///< the ground, straight to it
    Vec height;    ///< >= 0, over it or below it
};

HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b)
{
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
            hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

HWY_INLINE Vec3 add(const Vec3& a, const Vec3& b)
{
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

HWY_INLINE Vec3 scaled(const Vec3& a, const Vec& s)
{
    return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}

HWY_INLINE Vec3 select(const Mask& mask, const Vec3& a, const Vec3& b)
{
    return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y),
            hn::IfThenElse(mask, a.z, b.z)};
}

/// A vector of no length stays one.
HWY_INLINE Vec3 unit(const Vec3& a)
{
    const Tag tag;
    const Vec length2 = hn::Max(dot(a, a), hn::Set(tag, kTinyLength * kTinyLength));
    return scaled(a, hn::Div(hn::Set(tag, 1.0f), hn::Sqrt(length2)));
}

/// What the arc between two unit vectors adds to triangle_moment(); (Hill, Heitz 2016)'s rational
/// function of the cosine for the angle over its sine and 2 pi.
HWY_INLINE Vec3 moment_of_arc(const Vec3& a, const Vec3& b)
{
    const Tag tag;
    const auto set = [&](float value) { return hn::Set(tag, value); };
    const Vec x = dot(a, b);
    const Vec y = hn::Abs(x);
    const Vec above =
        hn::Add(set(kArc[0]), hn::Mul(hn::Add(set(kArc[1]), hn::Mul(set(kArc[2]), y)), y));
    const Vec below = hn::Add(set(kArc[3]), hn::Mul(hn::Add(set(kArc[4]), y), y));
    const Vec acute = hn::Div(above, below);
    const Vec3 across = cross(a, b);
    const Vec sine2 = hn::Max(dot(across, across), set(kLeastSine2));
    const Vec obtuse = hn::Sub(hn::Div(set(0.5f), hn::Sqrt(sine2)), acute);
    return scaled(across, hn::IfThenElse(hn::Gt(x, hn::Zero(tag)), acute, obtuse));
}

/// triangle_moment() for all lanes. c: from the receivers to its centroid.
HWY_INLINE Vec3 moment_of_triangle(const Surfel& triangle, const Vec3& c, const Vec3& normal)
{
    const Tag tag;
    const Vec zero = hn::Zero(tag);
    const auto corner = [&](const glm::vec3& from_centroid) {
        return unit(add(c, {hn::Set(tag, from_centroid.x), hn::Set(tag, from_centroid.y),
                            hn::Set(tag, from_centroid.z)}));
    };
    const Vec3 corners[] = {corner(triangle.corners[0]), corner(triangle.corners[1]),
                            corner(-triangle.corners[0] - triangle.corners[1])};
    const Vec heights[] = {dot(corners[0], normal), dot(corners[1], normal),
                           dot(corners[2], normal)};
    Vec3 moment = {zero, zero, zero}, leaves = moment, returns = moment;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const Mask from = hn::Gt(heights[i], zero), to = hn::Gt(heights[j], zero);
        const Vec3 horizon = unit(
            add(scaled(corners[i], hn::Abs(heights[j])), scaled(corners[j], hn::Abs(heights[i]))));
        const Vec3 arc =
            moment_of_arc(select(from, corners[i], horizon), select(to, corners[j], horizon));
        moment = select(hn::Or(from, to), add(moment, arc), moment);
        leaves = select(hn::AndNot(to, from), horizon, leaves);
        returns = select(hn::AndNot(from, to), horizon, returns);
    }
    return add(moment, moment_of_arc(leaves, returns));
}

/// ground_weight() for one disk.
template <bool kLimited>
HWY_INLINE Vec weight_of_ground(const Disk& disk, const Definition& definition, const Sums& sums,
                                const Vec3& c, const Vec& distance)
{
    const Tag tag;
    const Vec zero = hn::Zero(tag);
    const Vec one = hn::Set(tag, 1.0f);
    const Vec along = dot(c, sums.towards);
    const auto in_range = [&](const Vec& x) { return hn::Min(one, hn::Max(zero, x)); };
    const auto share_of = [&](const Vec& inside) {
        const Vec width = hn::Set(tag, 2.0f * std::sqrt(disk.all));
        return in_range(hn::Add(hn::Set(tag, 0.5f), hn::Div(inside, width)));
    };
    if (!kLimited)
        return share_of(along);
    const Vec edge = hn::Div(sums.height, hn::Set(tag, definition.max_distance));
    const Vec wide = hn::Mul(hn::Mul(distance, distance), hn::Sub(one, hn::Mul(edge, edge)));
    const Vec share = hn::Mul(share_of(hn::Sub(along, hn::Mul(distance, edge))),
                              in_range(hn::Div(wide, hn::Set(tag, disk.all))));
    if (definition.falloff == Falloff::none)
        return share;
    const Vec hit =
        hn::Div(hn::Mul(sums.height, distance), hn::Max(along, hn::Set(tag, kTinyLength)));
    const Vec t = hn::Div(hit, hn::Set(tag, definition.max_distance));
    const Vec y = hn::Max(zero, hn::Sub(one, hn::Mul(t, t)));
    return hn::Mul(share, hn::Mul(y, y));
}

template <bool kTwoSided, bool kBunnell, bool kLimited, bool kGround>
HWY_INLINE void add_disk(const Disk& disk, const Definition& definition, Sums& sums)
{
    const Tag tag;
    const Vec zero = hn::Zero(tag);
    const Vec one = hn::Set(tag, 1.0f);
    const Vec3 c = {hn::Sub(hn::Set(tag, disk.center.x), sums.position.x),
                    hn::Sub(hn::Set(tag, disk.center.y), sums.position.y),
                    hn::Sub(hn::Set(tag, disk.center.z), sums.position.z)};
    const Vec d2 = hn::Add(dot(c, c), hn::Set(tag, kTinyLength * kTinyLength));
    // one division for both 1 / d^2 and 1 / (d^2 + area / pi)
    const Vec d2_and_area = hn::Add(d2, hn::Set(tag, disk.all));
    const Vec reciprocal = hn::Div(one, hn::Mul(d2, d2_and_area));
    const Vec inverse2 = hn::Mul(d2_and_area, reciprocal);
    const Vec inverse = hn::Mul(hn::Sqrt(d2), inverse2);
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
        const Vec flat = hn::Mul(hn::Mul(hn::Set(tag, disk.flat), facing), height);
        const Vec spread = hn::Mul(hn::Set(tag, disk.spread), at_receiver);
        form_factor = hn::Mul(hn::Add(flat, spread), hn::Mul(d2, reciprocal));
        form_factor = hn::IfThenElseZero(hn::Gt(at_receiver, zero), form_factor);
    }

    Vec3 w = scaled(c, inverse);
    const Mask near = hn::Ge(x, hn::Set(tag, kNearDisk));
    if (!kBunnell && disk.triangle && !hn::AllFalse(tag, near)) {
        const Vec3 moment = moment_of_triangle(*disk.triangle, c, sums.normal);
        const Vec cover = hn::Abs(dot(moment, sums.normal));
        const Mask casts = kTwoSided ? near : hn::And(near, hn::Gt(at_disk, zero));
        form_factor = hn::IfThenElse(near, hn::IfThenElseZero(casts, cover), form_factor);
        // the moment points along the normal of a triangle whose corners turn the one way
        w = select(near, unit(scaled(moment, hn::CopySign(one, dot(moment, sums.normal)))), w);
    }

    Vec seen = hn::Add(hn::Set(tag, disk.front->constant), dot(w, disk.front->slope));
    if (kTwoSided) {
        const Vec other = hn::Add(hn::Set(tag, disk.back->constant), dot(w, disk.back->slope));
        seen = hn::IfThenElse(hn::Ge(at_disk, zero), seen, other);
    }
    form_factor = hn::Mul(form_factor, hn::Min(one, hn::Max(zero, seen)));
    const Vec distance = hn::Mul(d2, inverse);
    Vec weight = one;
    if (kLimited) {
        const Vec limit = hn::Set(tag, definition.max_distance);
        if (definition.falloff == Falloff::none) {
            const Vec width =
                hn::Min(hn::Mul(hn::Set(tag, 2.0f), hn::Sqrt(hn::Set(tag, disk.all))), limit);
            weight = hn::Add(hn::Set(tag, 0.5f), hn::Div(hn::Sub(limit, distance), width));
            weight = hn::Min(one, hn::Max(zero, weight));
        } else {
            const Vec t = hn::Div(distance, limit);
            const Vec y = hn::Max(zero, hn::Sub(one, hn::Mul(t, t)));
            weight = hn::Mul(y, y);
        }
    }
    if (kGround) {
        const Vec ground = weight_of_ground<kLimited>(disk, definition, sums, c, distance);
        weight = hn::Max(zero, hn::Sub(weight, ground));
    }
    if (kLimited || kGround)
        form_factor = hn::Mul(form_factor, weight);

    sums.occlusion = hn::Add(sums.occlusion, form_factor);
    sums.direction = add(sums.direction, scaled(w, form_factor));
}

/// Indices that grow without a check per element: room() first, then write at end().
struct IndexList {
    std::vector<std::uint32_t> items;
    std::size_t count = 0;

    void room(std::size_t more)
    {
        if (count + more > items.size())
            items.resize(2 * (count + more));
    }
    std::uint32_t* end() { return items.data() + count; }
};

/// The disks that one group sums up, and the queues that lead there; kept between groups for their
/// memory.
struct DiskList {
    IndexList nodes;
    IndexList surfels;
    IndexList open_nodes;
    IndexList near_surfels;
};

using IndexTag = hn::RebindToUnsigned<Tag>;
using OffsetTag = hn::RebindToSigned<Tag>;
using Indices = hn::Vec<IndexTag>;

/// The next indices of a queue; lanes from `count` on are 0 and not in `valid`.
struct Batch {
    std::size_t count;
    Indices indices;
    Mask valid;
};

HWY_INLINE Batch take_batch(IndexList& queue, std::size_t first)
{
    const Tag tag;
    const IndexTag index_tag;
    queue.room(hn::Lanes(tag));
    const std::size_t count = std::min(queue.count - first, hn::Lanes(tag));
    return {count,
            hn::IfThenElseZero(hn::FirstN(index_tag, count),
                               hn::LoadU(index_tag, queue.items.data() + first)),
            hn::FirstN(tag, count)};
}

HWY_INLINE void append(IndexList& list, const Indices& indices, const Mask& mask)
{
    const IndexTag index_tag;
    list.room(hn::Lanes(index_tag));
    list.count +=
        hn::CompressStore(indices, hn::RebindMask(index_tag, mask), index_tag, list.end());
}

/// One float of each of an array's elements: `field` points into the first, `stride` is in floats.
HWY_INLINE Vec gather_field(const float* field, int stride, const Indices& indices)
{
    const OffsetTag offset_tag;
    return hn::GatherIndex(Tag(), field,
                           hn::Mul(hn::BitCast(offset_tag, indices), hn::Set(offset_tag, stride)));
}

HWY_INLINE Vec3 gather_field(const glm::vec3& field, int stride, const Indices& indices)
{
    return {gather_field(&field.x, stride, indices), gather_field(&field.y, stride, indices),
            gather_field(&field.z, stride, indices)};
}

/// Where the balls at these offsets from the group's centre lie below every receiver's horizon
/// (rise_of_cone).
HWY_INLINE Mask below_horizons(const ReceiverGroup& group, const Vec3& offset, const Vec& distance2,
                               const Vec& radius)
{
    const Tag tag;
    const Vec along = dot(offset, glm::vec3(group.axis[0], group.axis[1], group.axis[2]));
    const Vec top = hn::Add(
        hn::Add(hn::Mul(along, hn::Set(tag, group.cone_cos)), hn::Set(tag, rise_of_cone(group))),
        radius);
    const Vec across2 = hn::Sub(distance2, hn::Mul(along, along));
    const Vec reach2 = hn::Mul(across2, hn::Set(tag, group.cone_sin * group.cone_sin));
    return hn::And(hn::Lt(top, hn::Zero(tag)), hn::Lt(reach2, hn::Mul(top, top)));
}

HWY_INLINE Vec3 from_center(const ReceiverGroup& group, const Vec3& point)
{
    const Tag tag;
    return {hn::Sub(point.x, hn::Set(tag, group.center[0])),
            hn::Sub(point.y, hn::Set(tag, group.center[1])),
            hn::Sub(point.z, hn::Set(tag, group.center[2]))};
}

/// The children of an inner node, or the surfels of a leaf, to their queue.
HWY_INLINE void open_node(const Octree& octree, std::uint32_t index, DiskList& list)
{
    const OctreeNode& node = octree.nodes[index];
    if (node.next == index + 1) {
        list.near_surfels.room(node.surfel_count);
        for (std::uint32_t k = 0; k < node.surfel_count; ++k)
            list.near_surfels.end()[k] = node.first_surfel + k;
        list.near_surfels.count += node.surfel_count;
        return;
    }
    list.open_nodes.room(8);
    for (std::uint32_t child = index + 1; child < node.next; child = octree.nodes[child].next)
        list.open_nodes.items[list.open_nodes.count++] = child;
}

inline bool is_in(const NodeRange& range, std::uint32_t node)
{
    return node >= range.begin && node < range.end;
}

/// Fills list.nodes and list.surfels. One walk for the whole group, breadth first: the order does
/// not depend on how many nodes are tested at once.
void list_disks(const Octree& octree, const ReceiverGroup& group, const GatherSettings& settings,
                DiskList& list)
{
    const Tag tag;
    const IndexTag index_tag;
    for (IndexList* each : {&list.nodes, &list.surfels, &list.open_nodes, &list.near_surfels})
        each->count = 0;

    for (std::uint32_t root = 0; root < octree.nodes.size(); root = octree.nodes[root].next) {
        if (is_in(settings.left_out[0], root) || is_in(settings.left_out[1], root))
            continue;
        list.open_nodes.room(1);
        list.open_nodes.items[list.open_nodes.count++] = root;
    }

    const Vec one = hn::Set(tag, 1.0f);
    const Vec group_radius = hn::Set(tag, group.radius);
    const Vec reach = hn::Set(tag, settings.definition.max_distance + group.radius);
    const Vec inner_reach = hn::Set(tag, settings.definition.max_distance - group.radius);
    const Vec per_opening = hn::Set(tag, 1.0f / settings.opening);
    constexpr int kNodeStride = sizeof(OctreeNode) / sizeof(float);
    for (std::size_t at = 0; at < list.open_nodes.count;) {
        const Batch batch = take_batch(list.open_nodes, at);
        at += batch.count;
        const OctreeNode& first = octree.nodes[0];
        const Vec3 offset =
            from_center(group, gather_field(first.center, kNodeStride, batch.indices));
        const Vec radius = gather_field(&first.radius, kNodeStride, batch.indices);
        const Vec flatness = gather_field(&first.flatness, kNodeStride, batch.indices);
        const Vec distance2 = dot(offset, offset);
        const Vec limit = hn::Add(reach, radius);
        const Mask out = hn::Or(hn::Gt(distance2, hn::Mul(limit, limit)),
                                below_horizons(group, offset, distance2, radius));
        const Vec fold = hn::Mul(hn::Set(tag, kFoldPenalty), hn::Sub(one, flatness));
        Vec size = hn::Mul(radius, hn::Add(one, fold));
        const Vec inside = hn::Max(hn::Zero(tag), hn::Sub(inner_reach, size));
        const Mask crosses_limit = hn::Gt(distance2, hn::Mul(inside, inside));
        size = hn::Mul(size, hn::IfThenElse(crosses_limit, hn::Set(tag, kLimitPenalty), one));
        const Vec far = hn::Add(hn::Mul(size, per_opening), group_radius);
        const Mask is_far = hn::Gt(distance2, hn::Mul(far, far));
        const Mask alive = hn::AndNot(out, batch.valid);
        append(list.nodes, batch.indices, hn::And(alive, is_far));

        HWY_ALIGN std::uint32_t near[kGroupSize];
        const std::size_t near_count = hn::CompressStore(
            batch.indices, hn::RebindMask(index_tag, hn::AndNot(is_far, alive)), index_tag, near);
        for (std::size_t i = 0; i < near_count; ++i)
            open_node(octree, near[i], list);
    }

    const Vec behind = hn::Set(tag, -group.radius);
    const std::uint32_t two_sided = settings.all_two_sided ? 0 : octree.two_sided_surfels;
    constexpr int kSurfelStride = sizeof(Surfel) / sizeof(float);
    for (std::size_t at = 0; at < list.near_surfels.count;) {
        const Batch batch = take_batch(list.near_surfels, at);
        at += batch.count;
        const Surfel& first = octree.surfels[0];
        const Vec3 offset =
            from_center(group, gather_field(first.position, kSurfelStride, batch.indices));
        const Vec3 normal = gather_field(first.normal, kSurfelStride, batch.indices);
        const Vec reach_up = gather_field(&first.reach, kSurfelStride, batch.indices);
        // one-sided and facing all receivers: occludes none of them
        const Mask one_sided =
            hn::RebindMask(tag, hn::Lt(batch.indices, hn::Set(index_tag, two_sided)));
        const Mask facing = hn::And(one_sided, hn::Lt(dot(offset, normal), behind));
        const Mask out =
            hn::Or(facing, below_horizons(group, offset, dot(offset, offset), reach_up));
        append(list.surfels, batch.indices, hn::AndNot(out, batch.valid));
    }
}

template <bool kBunnell, bool kLimited, bool kGround>
HWY_INLINE void add_list(const Octree& octree, const EmitterVisibility& visibility,
                         const DiskList& list, const GatherSettings& settings, Sums& sums)
{
    constexpr float kInvPi = std::numbers::inv_pi_v<float>;
    const std::uint32_t two_sided_nodes = settings.all_two_sided ? 0 : octree.two_sided_nodes;
    const std::uint32_t two_sided_surfels = settings.all_two_sided ? 0 : octree.two_sided_surfels;
    for (std::size_t k = 0; k < list.nodes.count; ++k) {
        const std::uint32_t i = list.nodes.items[k];
        const OctreeNode& node = octree.nodes[i];
        const float all = node.area * kInvPi;
        const float flat = node.flatness * all;
        Disk disk = {node.center, node.normal,          flat,
                     all,         0.25f * (all - flat), &visibility.node_front[i],
                     nullptr};
        if (i < two_sided_nodes) {
            add_disk<false, kBunnell, kLimited, kGround>(disk, settings.definition, sums);
        } else {
            disk.spread = 0.5f * (all - flat);
            disk.back = &visibility.node_back[i];
            add_disk<true, kBunnell, kLimited, kGround>(disk, settings.definition, sums);
        }
    }
    for (std::size_t k = 0; k < list.surfels.count; ++k) {
        const std::uint32_t s = list.surfels.items[k];
        const Surfel& surfel = octree.surfels[s];
        const float area = surfel.area * kInvPi;
        Disk disk = {surfel.position,
                     surfel.normal,
                     area,
                     area,
                     0.0f,
                     &visibility.surfel_front[s],
                     nullptr,
                     surfel.reach > 0.0f && !settings.only_disks ? &surfel : nullptr};
        if (s < two_sided_surfels) {
            add_disk<false, kBunnell, kLimited, kGround>(disk, settings.definition, sums);
        } else {
            disk.back = &visibility.surfel_back[s];
            add_disk<true, kBunnell, kLimited, kGround>(disk, settings.definition, sums);
        }
    }
}

void add_disks(const Octree& octree, const EmitterVisibility& visibility, const DiskList& list,
               const GatherSettings& settings, Sums& sums)
{
    const bool limited = std::isfinite(settings.definition.max_distance);
    if (settings.definition.ground && limited)
        add_list<false, true, true>(octree, visibility, list, settings, sums);
    else if (settings.definition.ground)
        add_list<false, false, true>(octree, visibility, list, settings, sums);
    else if (settings.definition.kernel == Kernel::bunnell && limited)
        add_list<true, true, false>(octree, visibility, list, settings, sums);
    else if (settings.definition.kernel == Kernel::bunnell)
        add_list<true, false, false>(octree, visibility, list, settings, sums);
    else if (limited)
        add_list<false, true, false>(octree, visibility, list, settings, sums);
    else
        add_list<false, false, false>(octree, visibility, list, settings, sums);
}

/// sight_of() for all lanes.
HWY_INLINE void look_at(const Ground& ground, Sums& sums)
{
    const Tag tag;
    const Vec height = hn::Sub(dot(sums.position, ground.up), hn::Set(tag, ground.height));
    const Vec turn =
        hn::IfThenElse(hn::Lt(height, hn::Zero(tag)), hn::Set(tag, 1.0f), hn::Set(tag, -1.0f));
    sums.height = hn::Abs(height);
    sums.towards = {hn::Mul(turn, hn::Set(tag, ground.up.x)),
                    hn::Mul(turn, hn::Set(tag, ground.up.y)),
                    hn::Mul(turn, hn::Set(tag, ground.up.z))};
}

void gather(const Octree& octree, const EmitterVisibility& visibility, const ReceiverGroups& groups,
            std::span<const std::uint32_t> leaves, const GatherSettings& settings,
            std::span<DiskSum> out)
{
    const Tag tag;
    DiskList list;
    for (const std::uint32_t leaf : leaves) {
        const ReceiverGroup& group = groups.groups[leaf];
        list_disks(octree, group, settings, list);
        for (std::size_t first = group.begin; first < group.end; first += hn::Lanes(tag)) {
            const auto load = [&](const std::array<RawVector<float>, 3>& columns) {
                return Vec3{hn::LoadU(tag, columns[0].data() + first),
                            hn::LoadU(tag, columns[1].data() + first),
                            hn::LoadU(tag, columns[2].data() + first)};
            };
            const Vec zero = hn::Zero(tag);
            Sums sums = {load(groups.position), load(groups.normal), zero,
                         {zero, zero, zero},    {zero, zero, zero},  zero};
            if (settings.definition.ground)
                look_at(*settings.definition.ground, sums);
            add_disks(octree, visibility, list, settings, sums);

            HWY_ALIGN float lanes[4][kGroupSize];
            hn::Store(sums.occlusion, tag, lanes[0]);
            hn::Store(sums.direction.x, tag, lanes[1]);
            hn::Store(sums.direction.y, tag, lanes[2]);
            hn::Store(sums.direction.z, tag, lanes[3]);
            for (std::size_t lane = 0; lane < hn::Lanes(tag) && first + lane < group.end; ++lane)
                out[groups.order[first + lane]] = {
                    lanes[0][lane], {lanes[1][lane], lanes[2][lane], lanes[3][lane]}};
        }
    }
}

GatherCount count(const Octree& octree, const ReceiverGroups& groups,
                  const GatherSettings& settings)
{
    GatherCount sum;
    DiskList list;
    for (const std::uint32_t leaf : groups.leaves) {
        list_disks(octree, groups.groups[leaf], settings, list);
        sum.tested_nodes += static_cast<double>(list.open_nodes.count);
        sum.nodes += static_cast<double>(list.nodes.count);
        sum.surfels += static_cast<double>(list.surfels.count);
    }
    const double per_group =
        1.0 / static_cast<double>(std::max<std::size_t>(1, groups.leaves.size()));
    return {per_group * sum.tested_nodes, per_group * sum.nodes, per_group * sum.surfels};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace surfelao
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surfelao {

HWY_EXPORT(gather);
HWY_EXPORT(count);

void gather_disks(const Octree& octree, const EmitterVisibility& visibility,
                  const ReceiverGroups& groups, std::span<const std::uint32_t> leaves,
                  const GatherSettings& settings, std::span<DiskSum> sums)
{
    HWY_DYNAMIC_DISPATCH(gather)(octree, visibility, groups, leaves, settings, sums);
}

GatherCount count_gather(const Octree& octree, const ReceiverGroups& groups,
                         const GatherSettings& settings)
{
    return HWY_DYNAMIC_DISPATCH(count)(octree, groups, settings);
}

}  // namespace surfelao
#endif
