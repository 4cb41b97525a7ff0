/// kernel_solve.h: the answers of one group (part of kernel_body.h).
#pragma once

#include "tree/masks/constants.h"
#include "tree/masks/kernel.h"
#include "tree/masks/kernel_cracks.h"
#include "tree/masks/kernel_sums.h"
#include "tree/masks/kernel_walk.h"

#include <cstring>

namespace surfelao::SURFELAO_MASK_ISA {
namespace {

constexpr int kFaceWords = kMaskFaces * kMaskFaceWords;
static_assert(sizeof(MaskKept::drawn[0]) == 2 * kFaceWords * sizeof(std::uint32_t));

/// The receivers of a group, and where their masks begin.
struct Receivers16 {
    Vector16 position, normal;
    Int16 target;
};

/// Of what a group shares.
struct Visible {
    float openness;  ///< of the sky above the group's axis and the ground
    float share;     ///< covered sky over the sum of what covers it: nodes hide behind each other
};

/// n.(change + slope (p - center))
SURFELAO_MASK_INLINE Float16 changes_at(const MaskFlow& flow, const Receivers16& receivers)
{
    const Vector16 p = receivers.position - broadcast(flow.center);
    const Vector16 change = broadcast(flow.change) + Vector16{dot(broadcast(flow.slope[0]), p),
                                                              dot(broadcast(flow.slope[1]), p),
                                                              dot(broadcast(flow.slope[2]), p)};
    return dot(change, receivers.normal);
}

Visible visible_of(const MaskWorld& world, const MaskShared& shared, const float* axis)
{
    const MaskRaster& raster = *world.raster;
    const MaskLimits& limits = world.settings.limits;
    const MaskFlow& flow = shared.flow;
    const float sum =
        flow.irradiance[0] * axis[0] + flow.irradiance[1] * axis[1] + flow.irradiance[2] * axis[2];
    if (!(sum > 0.0f))
        return {1.0f, 0.0f};
    alignas(64) std::uint32_t above[kMaskWords];
    alignas(64) std::uint32_t open[kMaskWords];
    horizon(raster, axis, above);
    const float* up = world.settings.ground_up;
    const float height = up[0] * flow.center[0] + up[1] * flow.center[1] + up[2] * flow.center[2] -
                         world.settings.ground_height;
    std::memcpy(open, above, sizeof open);
    float openness = 0.0f;
    for (unsigned k = 0; k < limits.count; ++k) {
        take_ground(raster, world.settings, limits.distance[k], height, above);
        take_ground(raster, world.settings, limits.distance[k], height, open);
        open_bits(raster, open, shared.mask[k], open);
        First of_open, of_above;
        first_moments(raster, open, above, of_open, of_above);
        if (!(of_above.along(axis) > 0.0f))
            return {1.0f, 0.0f};
        openness += limits.weight[k] * (of_open.along(axis) / of_above.along(axis));
    }
    const float share = (1.0f - openness) / sum;
    return {openness, share < 1.0f ? share : 1.0f};
}

/// Draws the listed polygons from `begin` to `end`, no more than kMaskDrawnBetweenChecks, for those
/// receivers in `active` above whose horizon they reach: where the highest corner, seen as far away
/// as the centre is, or a little nearer, stands higher than the grazing strip.
template <int kCorners, bool kSheet>
SURFELAO_MASK_INLINE void draw_near(const MaskWorld& world, const MaskBuffer<std::uint32_t>& list,
                                    std::size_t begin, std::size_t end,
                                    const Receivers16& receivers, Bool16 active,
                                    Stream<kCorners, kSheet>& stream)
{
    if (bits(active) == 0)
        return;
    const Float16 zero = all(0.0f);
    const float graze2 = world.settings.graze * world.settings.graze;
    const Vector16 position = receivers.position, normal = receivers.normal;
    const auto fields_of = [&](std::uint32_t listed) {
        return world.nodes + kLanes * static_cast<std::size_t>(listed & ~kGrown);
    };
    // first which, then the drawing: what the one finds cannot be foreseen
    std::uint32_t found[kMaskDrawnBetweenChecks];
    std::uint32_t seen[kMaskDrawnBetweenChecks];
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
        const float* const fields = fields_of(list.data[i]);
        const Node16 node = broadcast_node(fields);
        // how high the highest corner is
        const Vector16 center = node.center() - position;
        const Float16 skew = kSheet ? zero : dot(node.skew(), normal);
        const Float16 a = dot(node.axis_a(), normal), b = dot(node.axis_b(), normal);
        const Float16 even = skew + max(a, zero - a);
        const Float16 odd = (kCorners == 3 ? b : max(b, zero - b)) - skew;
        const Float16 top = dot(center, normal) + max(even, odd);
        const Float16 least =
            fms(all(graze2), dot(center, center), all(graze2 * fields[3] * fields[3]));
        const Bool16 above = active & (top > zero) & (top * top > least);
        found[count] = list.data[i];
        seen[count] = bits(above);
        count += bits(above) != 0 ? 1 : 0;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const float* const fields = fields_of(found[i]);
        const Node16 node = broadcast_node(fields);
        Bool16 above = lanes_of(seen[i]);
        std::uint32_t links;
        std::memcpy(&links, fields + 15, sizeof links);
        if (!kSheet && world.settings.one_sided && (links & kMaskSolid) != 0)
            above = without(
                above, dot(cross(node.axis_a(), node.axis_b()), node.center() - position) < zero);
        Vector16 corner[kCorners];
        const float grow = kSheet && (found[i] & kGrown) != 0 ? kMaskHollowGrowth : 1.0f;
        corners_of<kCorners>(node, pack(position, above), all(grow), corner);
        stream.add(corner, pack(receivers.target, above), count_of(above));
    }
}

/// The masks of up to sixteen receivers: of each a pair for every limit.
struct Masks16 {
    unsigned limits;
    unsigned skies;  ///< of each receiver: with a ground one for every limit, else one
    alignas(64) std::uint32_t drawn[kLanes * kMaskMostLimits * kMaskPairWords];
    /// The bits of the sky above each: of its hemisphere without the ground.
    alignas(64) std::uint32_t horizons[kLanes * kMaskMostLimits * kMaskWords];
    alignas(64) std::uint32_t target[kLanes];  ///< where the masks of each begin in `drawn`
    float normals[kLanes][3];
    bool as_before[kLanes];  ///< has the sky of the receiver before it

    /// All that is shared or kept, and what is no sky as if it were covered. kept: null for none.
    SURFELAO_MASK_INLINE Masks16(const MaskWorld& world, const MaskShared& shared,
                                 const MaskReceivers& receivers, const MaskKept* kept,
                                 std::size_t stride)
        : limits(world.settings.limits.count), skies(world.settings.has_ground ? limits : 1)
    {
        for (unsigned i = 0; i < kLanes; ++i) {
            target[i] = i * limits * kMaskPairWords;
            for (int k = 0; k < 3; ++k)
                normals[i][k] = receivers.normal[k][i];
        }
        for (unsigned i = 0; i < receivers.count; ++i) {
            std::uint32_t* above = horizons + i * skies * kMaskWords;
            as_before[i] = i > 0 && !world.settings.has_ground &&
                           std::memcmp(normals[i], normals[i - 1], sizeof normals[i]) == 0;
            if (as_before[i])
                std::memcpy(above, above - kMaskWords, kMaskWords * sizeof *above);
            else
                horizon(*world.raster, normals[i], above);
            for (unsigned k = 1; k < skies; ++k)
                std::memcpy(above + k * kMaskWords, above, kMaskWords * sizeof *above);
            for (unsigned k = 0; k < skies; ++k)
                take_ground(*world.raster, world.settings, world.settings.limits.distance[k],
                            receivers.above[i], above + k * kMaskWords);
            for (unsigned k = 0; k < limits; ++k)
                begin(world.raster->words, of(i, k), shared.mask[k],
                      kept == nullptr ? nullptr : kept[k * stride].drawn[i],
                      k < skies ? above + k * kMaskWords : nullptr);
        }
    }

    /// What is covered within a limit also is within those beyond it.
    SURFELAO_MASK_INLINE void add_up(unsigned count)
    {
        for (unsigned i = 0; i < count; ++i) {
            for (unsigned k = 1; k < limits; ++k) {
                for (int w = 0; w < kMaskPairWords; w += kLanes)
                    store(of(i, k) + w, load(of(i, k) + w) | load(of(i, k - 1) + w));
            }
        }
    }

    std::uint32_t* of(unsigned receiver, unsigned limit)
    {
        return drawn + target[receiver] + limit * kMaskPairWords;
    }
    const std::uint32_t* of(unsigned receiver, unsigned limit) const
    {
        return drawn + target[receiver] + limit * kMaskPairWords;
    }
    const std::uint32_t* sky(unsigned receiver, unsigned limit) const
    {
        return horizons + (receiver * skies + (limit < skies ? limit : 0)) * kMaskWords;
    }

private:
    SURFELAO_MASK_INLINE static void begin(int words, std::uint32_t* mask,
                                           const std::uint32_t* shared, const std::uint32_t* before,
                                           const std::uint32_t* above)
    {
        for (int w = 0; w < words; w += kLanes) {
            Int16 set = load(shared + w), sheets = load(shared + kMaskWords + w);
            if (before != nullptr) {
                set = set | load(before + w);
                sheets = sheets | load(before + kFaceWords + w);
            }
            store(mask + w, above != nullptr ? set | ~load(above + w) : set);
            store(mask + kMaskWords + w, sheets);
        }
    }
};

/// Draws the lists into the masks of `count` receivers. Those in nearly closed places are finished
/// before all is drawn. kept: something is in the masks already.
void draw_lists(const MaskWorld& world, const MaskScratch& scratch, const Receivers16& receivers,
                unsigned count, bool kept, Masks16& masks)
{
    if (scratch.rectangles.count + scratch.sheets.count + scratch.triangles.count == 0)
        return;
    Streams streams(world, masks.drawn);
    alignas(64) std::uint32_t active[kLanes] = {};
    for (unsigned i = 0; i < count; ++i)
        active[i] = 1;
    const auto leave_out_closed = [&] {
        for (unsigned i = 0; i < count; ++i) {
            if (active[i] != 0 && is_closed(*world.raster, masks.of(i, 0), masks.normals[i]))
                active[i] = 0;
        }
    };
    if (kept && world.settings.fill)
        leave_out_closed();
    std::size_t before_check = kMaskDrawnBetweenChecks;
    const auto draw_list = [&](const MaskBuffer<std::uint32_t>& list, auto& stream) {
        for (std::size_t begin = 0; begin < list.count;) {
            const std::size_t left = list.count - begin;
            const std::size_t end = begin + (left < before_check ? left : before_check);
            draw_near(world, list, begin, end, receivers, nonzero(load(active)), stream);
            before_check -= end - begin;
            begin = end;
            if (before_check == 0) {
                if (world.settings.fill)
                    leave_out_closed();
                before_check = kMaskDrawnBetweenChecks;
            }
        }
    };
    draw_list(scratch.rectangles, streams.rectangles);
    draw_list(scratch.sheets, streams.sheets);
    draw_list(scratch.triangles, streams.triangles);
    streams.finish();
}

/// Takes the pinholes out of the open bits. Returns their weight.
SURFELAO_MASK_INLINE float take_pinholes(const MaskRaster& raster, const std::uint32_t* mask,
                                         const std::uint32_t* above, const float* n,
                                         std::uint32_t* open)
{
    alignas(64) std::uint32_t taken[kMaskWords];
    Int16 any = all(0u);
    for (int w = 0; w < raster.words; w += kLanes) {
        const Int16 closed = load(mask + w) | ~load(above + w);
        const Int16 pins = ~closed & pinholes(raster, closed, load(mask + kMaskWords + w));
        store(taken + w, pins);
        store(open + w, load(open + w) & ~pins);
        any = any | pins;
    }
    return bits(nonzero(any)) != 0 ? first_moments(raster, taken).along(n) : 0.0f;
}

/// How much of the sky of one receiver with normal n is open, between 0 and 1 to rounding, cracks
/// counted as closed where much is covered. A sky smaller than a bit is open. weight: of `above`.
/// `open` becomes the bits that count as open.
SURFELAO_MASK_INLINE float openness_of(const MaskWorld& world, const std::uint32_t* mask,
                                       const std::uint32_t* above, float weight, const float* n,
                                       std::uint32_t* open)
{
    const MaskRaster& raster = *world.raster;
    open_bits(raster, above, mask, open);
    if (!(weight > 0.0f))
        return 1.0f;
    const float drawn = first_moments(raster, open).along(n) / weight;
    if (!(world.settings.fill && drawn > 0.0f))
        return drawn;
    const float fill_weight = (1.0f - drawn - world.settings.fill_from) / kMaskFillRange;
    float openness = drawn;
    if (fill_weight < 1.0f) {
        const float share = fill_weight > 0.0f ? 1.0f - fill_weight : 1.0f;
        openness -= share * take_pinholes(raster, mask, above, n, open) / weight;
    }
    if (!(fill_weight > 0.0f))
        return openness;

    alignas(64) std::uint32_t filled[kMaskWords];
    // what cracks are worth; beside_all: beside narrow clusters too
    const auto cracks_of = [&](bool beside_all) {
        for (int w = 0; w < raster.words; w += kLanes) {
            // what lies below the horizon is no opening
            const Int16 closed = load(mask + w) | ~load(above + w);
            const Int16 sheets = beside_all ? closed : load(mask + kMaskWords + w);
            store(filled + w, fill(raster, closed, sheets));
            store(open + w, openings(raster, ~closed, load(filled + w)));
        }
        return drawn - first_moments(raster, open).along(n) / weight;
    };
    const float fill_share = (fill_weight < 1.0f ? fill_weight : 1.0f) * kMaskFillShare;
    const float cracks = cracks_of(false);
    openness -= fill_share * cracks;

    const float narrow_weight = (1.0f - openness - kMaskNarrowFrom) / kMaskNarrowRange;
    if (narrow_weight > 0.0f && openness > 0.0f)
        openness -=
            (narrow_weight < 1.0f ? narrow_weight : 1.0f) * fill_share * (cracks_of(true) - cracks);

    const float close_weight = (1.0f - openness - kMaskCloseFrom) / kMaskCloseRange;
    if (!(world.settings.close > 0.0f && close_weight > 0.0f && openness > 0.0f))
        return openness;
    for (int w = 0; w < raster.words; w += kLanes)
        store(open + w, ~close(raster, load(filled + w), load(mask + kMaskWords + w)));
    const float sealed = first_moments(raster, open).along(n) / weight;
    if (sealed < openness)
        openness += (close_weight < 1.0f ? close_weight : 1.0f) * world.settings.close *
                    (sealed - openness);
    return openness;
}

/// Opens the rest of what a leaf group is handed: far nodes are drawn into `shared`, the others
/// listed.
void open_rest(const MaskWorld& world, const ReceiverGroup& group, const std::uint32_t* in,
               std::size_t in_count, MaskShared& shared, MaskScratch& scratch)
{
    scratch.sheets.count = 0;
    scratch.rectangles.count = 0;
    scratch.triangles.count = 0;
    start_frontier(scratch, in, in_count);
    walk<true>(world, group, nullptr, shared, scratch);
}

Receivers16 receivers_of(const MaskReceivers& receivers, const Masks16& masks)
{
    return {{load(receivers.position[0]), load(receivers.position[1]), load(receivers.position[2])},
            {load(receivers.normal[0]), load(receivers.normal[1]), load(receivers.normal[2])},
            load(masks.target)};
}

/// What the masks are worth. others: per receiver by how much far nodes cover more that are not of
/// `shared`, as it is seen; null for none.
void answer(const MaskWorld& world, const ReceiverGroup& group, const MaskShared& shared,
            const Masks16& masks, const Receivers16& all_receivers, const MaskReceivers& receivers,
            const float* others, MaskAnswers& answers)
{
    const MaskLimits& limits = world.settings.limits;
    const Visible visible = visible_of(world, shared, group.axis);
    alignas(64) float changes[kLanes];
    store(changes, changes_at(shared.flow, all_receivers));
    float weight = 0.0f;  // of the sky
    for (unsigned i = 0; i < receivers.count; ++i) {
        const float* n = masks.normals[i];
        float openness = 0.0f, above = 0.0f, seen = 0.0f, m[6] = {};
        for (unsigned k = 0; k < limits.count; ++k) {
            alignas(64) std::uint32_t open[kMaskWords];
            if (k < masks.skies && !masks.as_before[i])
                weight = first_moments(*world.raster, masks.sky(i, k)).along(n);
            const float open_share =
                limits.weight[k] *
                openness_of(world, masks.of(i, k), masks.sky(i, k), weight, n, open);
            // the sky's size is exact, bits tell how much of it is open
            openness += open_share;
            seen += receivers.sky[k][i] * open_share;
            above += receivers.sky[k][i] * limits.weight[k];
            const Second second = second_moments(*world.raster, open);
            for (int j = 0; j < 6; ++j)
                m[j] += limits.weight[k] * static_cast<float>(second.at[j]);
        }
        const float sky = openness > 0.0f ? seen / openness : above;
        // near polygons cover what is far as they cover the open sky
        const float bare = openness < visible.openness ? openness / visible.openness : 1.0f;
        const float change =
            bare * visible.share * changes[i] + (others == nullptr ? 0.0f : others[i]);
        const float size = change < 0.0f ? -change : change;
        if (size < __builtin_inff())
            openness -= change / (1.0f + size / kMaskLargestMove);
        openness = openness < 0.0f ? 0.0f : openness > 1.0f ? 1.0f : openness;
        answers.occlusion[i] = 1.0f - sky * openness;
        answers.bent[0][i] = m[0] * n[0] + m[3] * n[1] + m[5] * n[2];
        answers.bent[1][i] = m[3] * n[0] + m[1] * n[1] + m[4] * n[2];
        answers.bent[2][i] = m[5] * n[0] + m[4] * n[1] + m[2] * n[2];
    }
}

void solve(const MaskWorld& world, const ReceiverGroup& group, const std::uint32_t* in,
           std::size_t in_count, const MaskShared& from_above, const MaskReceivers& receivers,
           MaskAnswers& answers, MaskScratch& scratch)
{
    MaskShared shared;
    copy(from_above, world.settings.limits.count, shared);
    open_rest(world, group, in, in_count, shared, scratch);
    Masks16 masks(world, shared, receivers, nullptr, 0);
    const Receivers16 all_receivers = receivers_of(receivers, masks);
    draw_lists(world, scratch, all_receivers, receivers.count, false, masks);
    masks.add_up(receivers.count);
    answer(world, group, shared, masks, all_receivers, receivers, nullptr, answers);
}

void keep(const MaskWorld& world, const ReceiverGroup& group, const std::uint32_t* in,
          std::size_t in_count, const MaskShared& from_above, const MaskReceivers& receivers,
          MaskKept* kept, std::size_t stride, MaskScratch& scratch)
{
    MaskShared shared;
    copy(from_above, world.settings.limits.count, shared);
    open_rest(world, group, in, in_count, shared, scratch);
    Masks16 masks(world, shared, receivers, nullptr, 0);
    draw_lists(world, scratch, receivers_of(receivers, masks), receivers.count, false, masks);
    kept->flow = shared.flow;
    for (unsigned k = 0; k < masks.limits; ++k) {
        MaskKept& of_limit = kept[k * stride];
        std::memcpy(of_limit.shared, shared.mask[k], sizeof of_limit.shared);
        for (unsigned i = 0; i < receivers.count; ++i) {
            const std::uint32_t* drawn = masks.of(i, k);
            for (int w = 0; w < world.raster->words; w += kLanes) {
                store(of_limit.drawn[i] + w, load(drawn + w));
                store(of_limit.drawn[i] + kFaceWords + w, load(drawn + kMaskWords + w));
            }
        }
    }
}

/// changes_at() of far nodes beside those that are kept, each by the share of the sky that they
/// cover anew over the sum of what covers it: they hide behind each other, and behind what is kept.
/// What is hidden wholly changes nothing.
SURFELAO_MASK_INLINE void seen_changes(const MaskWorld& world, const MaskShared& shared,
                                       const MaskKept* kept, std::size_t stride,
                                       const Masks16& masks, const Receivers16& receivers,
                                       unsigned count, float* changes)
{
    const MaskLimits& limits = world.settings.limits;
    const float* irradiance = shared.flow.irradiance;
    store(changes, changes_at(shared.flow, receivers));
    for (unsigned i = 0; i < count; ++i) {
        const float* n = masks.normals[i];
        const float sum = irradiance[0] * n[0] + irradiance[1] * n[1] + irradiance[2] * n[2];
        float covered = 0.0f;
        alignas(64) std::uint32_t far[kFaceWords] = {}, before[kFaceWords] = {};
        alignas(64) std::uint32_t seen[kMaskWords];
        for (unsigned k = 0; k < limits.count && sum > 0.0f; ++k) {
            const std::uint32_t* sky = masks.sky(i, k);
            for (int w = 0; w < world.raster->words; w += kLanes) {
                store(far + w, load(far + w) | load(shared.mask[k] + w));
                store(before + w, load(before + w) | load(kept[k * stride].drawn[i] + w));
                store(seen + w, load(far + w) & ~load(before + w) & load(sky + w));
            }
            First of_seen, of_above;
            first_moments(*world.raster, seen, sky, of_seen, of_above);
            const float weight = of_above.along(n);
            covered += weight > 0.0f ? limits.weight[k] * (of_seen.along(n) / weight) : 0.0f;
        }
        const float share = sum > 0.0f ? covered / sum : 0.0f;
        changes[i] *= share < 1.0f ? share : 1.0f;
    }
}

void solve_kept(const MaskWorld& world, const ReceiverGroup& group, const std::uint32_t* in,
                std::size_t in_count, const MaskKept* kept, std::size_t stride,
                const MaskReceivers& receivers, MaskAnswers& answers, MaskScratch& scratch)
{
    MaskShared shared{};
    open_rest(world, group, in, in_count, shared, scratch);
    Masks16 masks(world, shared, receivers, kept, stride);
    const Receivers16 all_receivers = receivers_of(receivers, masks);
    draw_lists(world, scratch, all_receivers, receivers.count, true, masks);
    masks.add_up(receivers.count);
    alignas(64) float others[kLanes];
    seen_changes(world, shared, kept, stride, masks, all_receivers, receivers.count, others);
    for (unsigned k = 0; k < masks.limits; ++k)
        std::memcpy(shared.mask[k], kept[k * stride].shared, sizeof shared.mask[k]);
    shared.flow = kept->flow;
    answer(world, group, shared, masks, all_receivers, receivers, others, answers);
}

}  // namespace
}  // namespace surfelao::SURFELAO_MASK_ISA
