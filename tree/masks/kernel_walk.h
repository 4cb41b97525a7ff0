/// kernel_walk.h: which nodes are drawn, for whom (part of kernel_body.h).
#pragma once

#include "tree/masks/constants.h"
#include "tree/masks/kernel.h"
#include "tree/masks/kernel_stream.h"
#include "tree/masks/simd.h"

#include <cstring>

namespace surfelao::SURFELAO_MASK_ISA {
namespace {

constexpr std::uint32_t kGrown =
    0x80000000u;  ///< in a list: the polygon is kMaskHollowGrowth larger

/// MaskNode as columns.
struct Node16 {
    Float16 field[16];

    Vector16 center() const { return {field[0], field[1], field[2]}; }
    Float16 radius() const { return field[3]; }
    Vector16 skew() const { return {field[4], field[5], field[6]}; }
    Float16 thickness() const { return field[7]; }
    Vector16 axis_a() const { return {field[8], field[9], field[10]}; }
    Float16 open_radius() const { return field[11]; }
    Vector16 axis_b() const { return {field[12], field[13], field[14]}; }
    Int16 links() const { return as_int(field[15]); }
    Int16 first_child() const { return links() & all(kMaskFirstChild); }
    Bool16 is_sheet() const { return negative(links()); }  ///< kMaskSheet is the highest bit
    Bool16 is_hollow() const { return nonzero(links() & all(kMaskHollow)); }
    Bool16 is_triangle() const { return nonzero(links() & all(kMaskTriangle)); }

    /// Unit; zero where there is no area.
    SURFELAO_MASK_INLINE Vector16 normal() const
    {
        const Vector16 n = cross(axis_a(), axis_b());
        return n * inverse_sqrt(max(dot(n, n), all(kMaskTiny)));
    }
};

/// One node for all lanes.
SURFELAO_MASK_INLINE Node16 broadcast_node(const float* fields)
{
    Node16 node;
    for (int k = 0; k < kLanes; ++k)
        node.field[k] = all(fields[k]);
    return node;
}

/// A triangle's are the first three.
template <int kCorners>
SURFELAO_MASK_INLINE void corners_of(const Node16& node, Vector16 origin, Float16 grow,
                                     Vector16* corner)
{
    const Vector16 center = node.center() - origin;
    const Vector16 even = center + node.skew(), odd = center - node.skew();
    const Vector16 a = node.axis_a() * grow, b = node.axis_b() * grow;
    corner[0] = even + a;
    corner[1] = odd + b;
    corner[2] = even - a;
    if constexpr (kCorners == 4)
        corner[3] = odd - b;
}

/// A call clears all vector registers away: only where it is needed.
SURFELAO_MASK_INLINE void make_room(MaskBuffer<std::uint32_t>& list, std::size_t count)
{
    if (count > list.capacity) [[unlikely]]
        reserve(list, count);
}
SURFELAO_MASK_INLINE void append(MaskBuffer<std::uint32_t>& list, Int16 index, Bool16 chosen)
{
    make_room(list, list.count + kLanes);
    store(list.data + list.count, pack(index, chosen));
    list.count += count_of(chosen);
}

void move_to(MaskFlow& flow, const float* center)
{
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            flow.change[i] += flow.slope[i][j] * (center[j] - flow.center[j]);
    }
    for (int i = 0; i < 3; ++i)
        flow.center[i] = center[i];
}

/// A group of receivers, each number in all lanes.
struct Group16 {
    Vector16 center, axis;
    Float16 radius, cone_cos, cone_sin, rise;

    SURFELAO_MASK_INLINE explicit Group16(const ReceiverGroup& group)
        : center(broadcast(group.center)),
          axis(broadcast(group.axis)),
          radius(all(group.radius)),
          cone_cos(all(group.cone_cos)),
          cone_sin(all(group.cone_sin)),
          rise(all(group.rise))
    {
    }
};

/// Sixteen nodes as a group sees them.
struct Sight16 {
    Float16 distance;  ///< of the node's centre
    Float16 nearest;   ///< of what is nearest of the node
    Float16 away;      ///< of the centre, along the node's normal: negative where its front is seen
    Float16 relax;     ///< 1 / sqrt of the most that the node may weigh
    Bool16 alive;      ///< may be above a receiver's horizon, within the limit
};

/// How high above any of the group's horizons the nodes may reach, and so how much they may weigh.
SURFELAO_MASK_INLINE Sight16 see(float graze, float limit, const Group16& group, const Node16& node,
                                 Bool16 active)
{
    const Float16 zero = all(0.0f);
    const Vector16 to_node = node.center() - group.center;
    const Float16 distance2 = max(dot(to_node, to_node), all(kMaskTiny));
    const Float16 inverse = inverse_sqrt(distance2);
    const Float16 distance = distance2 * inverse;
    const Float16 height = dot(to_node, group.axis);
    const Float16 aside = sqrt(max(fms(distance, distance, height * height), zero));
    const Float16 raised = fma(height, group.cone_cos, aside * group.cone_sin);
    const Float16 base = select(height < group.cone_cos * distance, raised, distance);
    const Vector16 normal = node.normal();
    const Float16 facing = dot(normal, group.axis);
    const Float16 tilt = sqrt(max(all(1.0f) - facing * facing, zero)) + group.cone_sin;
    const Float16 slab = min(node.radius(), fma(node.radius(), tilt, node.thickness()));
    const Float16 top = base + slab + group.rise;
    const Float16 nearest = distance - node.radius();
    const Bool16 alive = active & (top > max(all(graze) * (nearest - group.radius), zero)) &
                         (nearest - group.radius < all(limit));
    const Float16 weight = min(max(top * inverse, all(kMaskImportanceFloor)), all(1.0f));
    return {distance, nearest, dot(to_node, normal), inverse_sqrt(weight), alive};
}

/// Whether the shorter side of a cluster is wide enough for cracks beside it.
SURFELAO_MASK_INLINE Bool16 wide(const MaskSettings& settings, const Node16& node, Float16 distance)
{
    const Vector16 side = node.axis_a() + node.axis_b();
    const Float16 least =
        min(all(kMaskNarrowSheet), all(kMaskNarrowCluster * settings.cluster)) * distance;
    return least * least < dot(side, side);
}

/// Draws the chosen of 16 nodes into the group's mask.
SURFELAO_MASK_INLINE void draw_shared(Streams& streams, const Node16& node, Vector16 origin,
                                      Float16 grow, Bool16 chosen, Bool16 sheet)
{
    Vector16 corner[4];
    corners_of<4>(node, origin, grow, corner);
    const auto add = [&]<int kCorners, bool kSheet>(Stream<kCorners, kSheet>& stream,
                                                    Bool16 lanes) {
        Vector16 packed[kCorners];
        for (int i = 0; i < kCorners; ++i)
            packed[i] = pack(corner[i], lanes);
        stream.add(packed, all(0u), count_of(lanes));
    };
    const Bool16 triangle = node.is_triangle();
    add(streams.triangles, chosen & triangle);
    add(streams.rectangles, without(chosen, sheet | triangle));
    add(streams.sheets, chosen & sheet);
}

/// Puts the chosen of 16 nodes on the lists of what is drawn for each receiver.
SURFELAO_MASK_INLINE void list(MaskScratch& scratch, const Node16& node, Int16 index, Bool16 chosen,
                               Bool16 sheet)
{
    const Bool16 triangle = node.is_triangle();
    append(scratch.triangles, index, chosen & triangle);
    append(scratch.rectangles, index, without(chosen, sheet | triangle));
    append(scratch.sheets, index, chosen & sheet);
}

/// Puts the children of the chosen nodes behind the frontier.
SURFELAO_MASK_INLINE void open(const MaskWorld& world, const Node16& node, Bool16 chosen,
                               MaskBuffer<std::uint32_t>& frontier)
{
    make_room(frontier, frontier.count + 2 * kLanes + kLanes);
    append(frontier, node.first_child(), chosen);
    const unsigned added = count_of(chosen);
    std::uint32_t* child = frontier.data + frontier.count - added;
    for (unsigned i = 0; i < added; ++i) {
        child[added + i] = child[i] + 1;
        __builtin_prefetch(world.nodes + kLanes * static_cast<std::size_t>(child[i]));
        __builtin_prefetch(world.nodes + kLanes * static_cast<std::size_t>(child[i] + 1));
    }
    frontier.count += added;
}

/// Through scratch.frontier, which grows meanwhile, to its end: far nodes are drawn into the
/// group's mask; a leaf group lists the rest as polygons, an inner group hands it down.
template <bool kLeaf>
void walk(const MaskWorld& world, const ReceiverGroup& of, MaskBuffer<std::uint32_t>* out,
          MaskShared& shared_part, MaskScratch& scratch)
{
    const MaskSettings& settings = world.settings;
    move_to(shared_part.flow, of.center);
    Slope slope(of, settings.limits);
    Streams streams(world, shared_part.mask[0], &slope);
    const Group16 group(of);
    const Float16 zero = all(0.0f);
    const Float16 share = all(kLeaf ? settings.share_leaf : settings.share_inner);
    const float limit = settings.limits.distance[settings.limits.count - 1];
    const Float16 exact_radius = all(settings.exact_radius);
    const Int16 solid = all(settings.one_sided ? kMaskSolid : 0u);
    MaskBuffer<std::uint32_t>& frontier = scratch.frontier;

    // level by level: what is opened now is looked at later, when it has come from memory
    for (std::size_t done = 0; done < frontier.count;) {
        // where fewer than 16 are left the first stands in for the missing
        const std::size_t left = frontier.count - done;
        const unsigned count = left < kLanes ? static_cast<unsigned>(left) : kLanes;
        alignas(64) std::uint32_t index[kLanes];
        store(index, load(frontier.data + done));
        done += count;
        for (unsigned i = count; i < kLanes; ++i)
            index[i] = index[0];
        Node16 node;
        load_transposed(world.nodes, index, node.field);

        const Sight16 sight = see(settings.graze, limit, group, node, first_lanes(count));
        const Float16 farthest = sight.distance + node.radius() + group.radius;
        const Float16 cluster =
            min(all(settings.cluster) * sight.relax, all(settings.cluster_limit)) *
            select(all(limit) < farthest, all(settings.crossing), all(1.0f));
        const Bool16 one_sided = nonzero(node.links() & solid);
        const Bool16 exact = node.open_radius() < exact_radius;
        const Bool16 has_cracks = wide(settings, node, sight.distance);
        const Bool16 sheet = without(node.is_sheet(), exact) & has_cracks;
        // a front that is hollow goes on beyond its rim
        const Bool16 hollow = node.is_hollow() & (sight.away < zero);
        const Bool16 small = exact | (node.open_radius() < cluster * sight.distance);
        const Bool16 far = group.radius < share * sight.relax * sight.nearest;
        const Bool16 shared = sight.alive & small & far;
        const Bool16 drawn = without(shared, one_sided & (sight.away < zero));
        if (bits(drawn) != 0) {
            const Float16 grow = select(sheet & hollow, all(kMaskHollowGrowth), all(1.0f));
            // what is exact is so from the centre alone: a receiver elsewhere sees it part from its
            // neighbours
            const Bool16 moved =
                without(exact & has_cracks & (zero < group.radius), node.is_triangle());
            draw_shared(streams, node, group.center, grow, drawn, sheet | moved);
        }

        const Bool16 rest =
            without(sight.alive, shared | (one_sided & (sight.away < zero - group.radius)));
        Bool16 opened;
        if constexpr (kLeaf) {
            const Float16 nearer = sight.distance - group.radius;
            const Bool16 listed = rest & (exact | (node.open_radius() < cluster * nearer));
            opened = without(rest, listed);
            if (bits(listed) != 0)
                list(scratch, node, load(index) | select(hollow, all(kGrown), all(0u)), listed,
                     sheet);
        } else {
            opened = without(rest, small) & (group.radius < node.radius());
            const Bool16 handed = without(rest, opened);
            if (bits(handed) != 0)
                append(*out, load(index), handed);
        }
        if (bits(opened) != 0)
            open(world, node, opened, frontier);
    }
    streams.finish();
    slope.finish(shared_part.flow);
}

void start_frontier(MaskScratch& scratch, const std::uint32_t* in, std::size_t in_count)
{
    MaskBuffer<std::uint32_t>& frontier = scratch.frontier;
    reserve(frontier, in_count + kLanes);
    if (in_count > 0)
        std::memcpy(frontier.data, in, in_count * sizeof(std::uint32_t));
    frontier.count = in_count;
}

}  // namespace
}  // namespace surfelao::SURFELAO_MASK_ISA
