/// kernel_body.h: the text of the mask kernels, compiled once per instruction set.
///
/// Read in this order: bits of one polygon (draw), lists of polygons (Stream), which nodes (walk),
/// what a mask is worth (sums, fill), one group (solve).
#pragma once

#include "tree/masks/constants.h"
#include "tree/masks/kernel.h"
#include "tree/masks/raster.h"
#include "tree/masks/simd.h"

namespace surfelao::SURFELAO_MASK_ISA {
namespace {

static_assert(sizeof(MaskShared::mask) == kMaskPairWords * sizeof(std::uint32_t));

constexpr float kInversePi = 0.31830989f;
constexpr std::uint32_t kGrown = 0x80000000u;  ///< in a list: the polygon's rim is larger

struct Vector16 {
    Float16 x, y, z;
};

SURFELAO_MASK_INLINE Vector16 operator-(Vector16 a, Vector16 b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
SURFELAO_MASK_INLINE Vector16 operator+(Vector16 a, Vector16 b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
SURFELAO_MASK_INLINE Vector16 operator*(Vector16 a, Float16 b)
{
    return {a.x * b, a.y * b, a.z * b};
}
SURFELAO_MASK_INLINE Float16 dot(Vector16 a, Vector16 b)
{
    return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
SURFELAO_MASK_INLINE Vector16 cross(Vector16 a, Vector16 b)
{
    return {fms(a.y, b.z, a.z * b.y), fms(a.z, b.x, a.x * b.z), fms(a.x, b.y, a.y * b.x)};
}
SURFELAO_MASK_INLINE Vector16 broadcast(const float* v)
{
    return {all(v[0]), all(v[1]), all(v[2])};
}
SURFELAO_MASK_INLINE Vector16 pack(Vector16 a, Lanes chosen)
{
    return {pack(a.x, chosen), pack(a.y, chosen), pack(a.z, chosen)};
}
SURFELAO_MASK_INLINE Lanes first_lanes(unsigned count)
{
    return lanes_of((1u << count) - 1u);
}
SURFELAO_MASK_INLINE unsigned count_of(Lanes a)
{
    return static_cast<unsigned>(__builtin_popcount(bits(a)));
}
SURFELAO_MASK_INLINE Int16 sign_of(Float16 a)
{
    return as_int(a) & all(0x80000000u);
}
SURFELAO_MASK_INLINE Float16 flip(Float16 a, Int16 sign)
{
    return as_float(as_int(a) ^ sign);
}
SURFELAO_MASK_INLINE Lanes negative(Int16 a)
{
    return nonzero(a & all(0x80000000u));
}

// --- one polygon ---

/// The bits on one side of an edge, for the 16 rows of one face: those with n.d >= 0, where
/// n.d = na + nu u + nv v. From bit ceil(slope v + start - shift) up where nu > 0, else the others.
struct Edge {
    float slope, start;
    std::uint32_t below;  ///< ~0 where the bits below are meant
};

SURFELAO_MASK_INLINE Int16 row_bits(const MaskRaster& raster, float slope, float start)
{
    return bits_from(fma(all(slope), load(raster.row_v), all(start) - load(raster.row_shift)));
}

/// The bits of one face whose rays meet a plane within the limit: those inside of the circular cone
/// n.d >= k |d| about the plane's normal n, where k = plane's distance / limit, 0 <= k < 1.
/// With n.d = p + nu u and |d|^2 = q + u^2 in a row, u lies between or beyond the roots of
/// (nu^2 - k^2) u^2 + 2 p nu u + p^2 - k^2 q = 0.
SURFELAO_MASK_INLINE Int16 cone_bits(const MaskRaster& raster, float na, float nu, float nv,
                                     float k)
{
    const Float16 v = load(raster.row_v);
    const Float16 shift = load(raster.row_shift);
    const Float16 zero = all(0.0f);
    float a = nu * nu - k * k;
    if (a > -kMaskConeFlat && a < kMaskConeFlat)
        a = a < 0.0f ? -kMaskConeFlat : kMaskConeFlat;
    const Float16 p = fma(all(nv), v, all(na));
    const Float16 root2 = fma(p, p, fma(v, v, all(1.0f)) * all(a));
    const Float16 root = sqrt(max(root2, zero)) * all(k);
    const Float16 b = p * all(nu);
    const Float16 scale = all(kMaskHalfColumns / a);
    const Float16 first = fms(root - b, scale, shift) + all(kMaskHalfColumns);
    const Float16 second = fms(zero - root - b, scale, shift) + all(kMaskHalfColumns);
    if (a < 0.0f) {
        const Int16 between = bits_from(first) & ~bits_from(second);
        return select((root2 > zero) & (p > zero), between, all(0u));
    }
    return nu > 0.0f ? bits_from(first) : ~bits_from(second);
}

/// Of 16 polygons: corner i stands in rows 3 i to 3 i + 2 of `kStride` floats.
template <int kCorners, int kStride>
SURFELAO_MASK_INLINE void load_corners(const float* rows, Vector16* corner)
{
    for (int i = 0; i < kCorners; ++i) {
        corner[i] = {load(rows + (3 * i) * kStride), load(rows + (3 * i + 1) * kStride),
                     load(rows + (3 * i + 2) * kStride)};
    }
}

/// Sixteen polygons at once up to the edges, then each by itself, 16 rows at a time.
/// corner: 3 kCorners rows of `kStride` floats, relative to the receiver; target: word offset of
/// the receiver's mask in `masks`.
template <int kCorners, int kStride, bool kLoose>
void draw(const MaskRaster& raster, float max_distance, const float* corner,
          const std::uint32_t* target, unsigned count, std::uint32_t* masks)
{
    Vector16 c[kCorners];
    load_corners<kCorners, kStride>(corner, c);

    // planes through the receiver and each edge, turned inward; from the edges, not from pairs of
    // corners, whose product is mere rounding where they are next to each other
    Vector16 n[kCorners];
    for (int i = 0; i < kCorners; ++i)
        n[i] = cross(c[i], c[(i + 1) % kCorners] - c[i]);
    const Float16 volume = dot(n[0], c[2] - c[1]);
    const Int16 turn = sign_of(volume);
    for (int i = 0; i < kCorners; ++i)
        n[i] = {flip(n[i].x, turn), flip(n[i].y, turn), flip(n[i].z, turn)};

    // a face is missed where all corners lie beyond one of the four diagonal planes that bound it
    const auto beyond = [&](auto difference, Int16& all_negative, Int16& any_negative) {
        all_negative = any_negative = as_int(difference(c[0]));
        for (int i = 1; i < kCorners; ++i) {
            const Int16 d = as_int(difference(c[i]));
            all_negative = all_negative & d;
            any_negative = any_negative | d;
        }
    };
    Int16 all_dxy, any_dxy, all_sxy, any_sxy, all_dyz, any_dyz, all_syz, any_syz, all_dzx, any_dzx,
        all_szx, any_szx;
    beyond([](Vector16 p) { return p.x - p.y; }, all_dxy, any_dxy);
    beyond([](Vector16 p) { return p.x + p.y; }, all_sxy, any_sxy);
    beyond([](Vector16 p) { return p.y - p.z; }, all_dyz, any_dyz);
    beyond([](Vector16 p) { return p.y + p.z; }, all_syz, any_syz);
    beyond([](Vector16 p) { return p.z - p.x; }, all_dzx, any_dzx);
    beyond([](Vector16 p) { return p.z + p.x; }, all_szx, any_szx);
    Lanes drawn = first_lanes(count) & (nonzero(as_int(volume) & all(0x7fffffffu)));

    // with a distance limit: planes beyond it are dropped, polygons that cross it are cut to a cone
    unsigned cut = 0;
    alignas(64) float plane[4][kLanes];
    if (max_distance < __builtin_inff()) {
        const Float16 limit = all(max_distance);
        Vector16 normal = cross(c[1] - c[0], c[2] - c[0]);
        const Float16 length2 = max(dot(normal, normal), all(kMaskTiny));
        const Float16 inverse = inverse_sqrt(length2);
        Float16 height = dot(normal, c[0]) * inverse;
        const Int16 behind = sign_of(height);
        height = flip(height, behind);
        Float16 farthest2 = dot(c[0], c[0]);
        for (int i = 1; i < kCorners; ++i)
            farthest2 = max(farthest2, dot(c[i], c[i]));
        drawn = drawn & (height < limit);
        cut = bits(farthest2 > limit * limit);
        store(plane[0], flip(normal.x * inverse, behind));
        store(plane[1], flip(normal.y * inverse, behind));
        store(plane[2], flip(normal.z * inverse, behind));
        store(plane[3], height * all(1.0f / max_distance));
    }
    Lanes in[6] = {without(drawn, negative(all_dxy | all_sxy | ~any_dzx | all_szx)),
                   without(drawn, negative(~any_sxy | ~any_dxy | all_dzx | ~any_szx)),
                   without(drawn, negative(~any_dxy | all_sxy | all_dyz | all_syz)),
                   without(drawn, negative(all_dxy | ~any_sxy | ~any_dyz | ~any_syz)),
                   without(drawn, negative(all_dzx | all_szx | ~any_dyz | all_syz)),
                   without(drawn, negative(~any_dzx | ~any_szx | all_dyz | ~any_syz))};

    // the two faces of an axis see the same slopes
    alignas(64) float slope[3][kCorners][kLanes];
    alignas(64) float start[kMaskFaces][kCorners][kLanes];
    alignas(64) std::uint32_t below[3][kCorners][kLanes];
    std::uint64_t faces[2] = {};  // a bit for each face and lane
    const auto set_axis = [&]<int kAxis>() {
        constexpr int kU = (kAxis + 1) % 3, kV = (kAxis + 2) % 3;
        const std::uint64_t both = bits(in[2 * kAxis]) | bits(in[2 * kAxis + 1]) << kLanes;
        if (both == 0)
            return;
        faces[kAxis / 2] |= both << (kAxis % 2 * 2 * kLanes);
        for (int i = 0; i < kCorners; ++i) {
            const Float16 normal[3] = {n[i].x, n[i].y, n[i].z};
            const Int16 sign = sign_of(normal[kU]);
            const Float16 size = max(flip(normal[kU], sign), all(kMaskTiny));
            const Float16 scale = flip(reciprocal(size) * all(-kMaskHalfColumns), sign);
            store(slope[kAxis][i], normal[kV] * scale);
            store(start[2 * kAxis][i], fma(normal[kAxis], scale, all(kMaskHalfColumns)));
            store(start[2 * kAxis + 1][i], all(kMaskHalfColumns) - normal[kAxis] * scale);
            store(below[kAxis][i], select(nonzero(sign), all(~0u), all(0u)));
        }
    };
    set_axis.template operator()<0>();
    set_axis.template operator()<1>();
    set_axis.template operator()<2>();

    const Float16 row_v = load(raster.row_v);
    const Float16 row_shift = load(raster.row_shift);
    for (unsigned half = 0; half < 2; ++half) {
        for (std::uint64_t left = faces[half]; left != 0; left &= left - 1) {
            const auto place = static_cast<unsigned>(__builtin_ctzll(left));
            const unsigned lane = place % kLanes;
            const unsigned face = 4 * half + place / kLanes;
            const unsigned axis = face / 2;
            Int16 inside = all(~0u);
            for (int i = 0; i < kCorners; ++i) {
                const Int16 from = bits_from(
                    fma(all(slope[axis][i][lane]), row_v, all(start[face][i][lane])) - row_shift);
                inside = and_xor(inside, from, all(below[axis][i][lane]));
            }
            if (cut >> lane & 1u) {
                const float na = plane[axis][lane];
                inside = inside & cone_bits(raster, face % 2 == 0 ? na : -na,
                                            plane[(axis + 1) % 3][lane],
                                            plane[(axis + 2) % 3][lane], plane[3][lane]);
            }
            std::uint32_t* mask = masks + target[lane] + kMaskFaceWords * face;
            store(mask, load(mask) | inside);
            if constexpr (kLoose)
                store(mask + kMaskWords, load(mask + kMaskWords) | inside);
        }
    }
}

SURFELAO_MASK_INLINE float sum_of(Float16 a)
{
    alignas(64) float lanes[kLanes];
    store(lanes, a);
    float sum = 0.0f;
    for (const float lane : lanes)
        sum += lane;
    return sum;
}

/// How the vector irradiance of what is drawn for a group changes with the place. A small emitter
/// at r with area vector A, r.A > 0, sends f = r (A.r) / (pi r^4); with a receiver that moves by p,
/// r moves by -p: df/dp = (4 r r^T (A.r) / r^2 - (A.r) I - r A^T) / (pi r^4).
class Slope {
public:
    Slope(const MaskGroup& group, float max_distance)
        : axis_(broadcast(group.axis)), max_distance_(max_distance)
    {
    }

    /// The first `count` of 16 polygons; corners as draw takes them, from the group's centre.
    template <int kCorners, int kStride>
    void add(const float* corner, unsigned count)
    {
        Vector16 c[kCorners];
        load_corners<kCorners, kStride>(corner, c);
        const Float16 zero = all(0.0f);
        Vector16 r =
            kCorners == 3 ? (c[0] + c[1] + c[2]) * all(1.0f / 3.0f) : (c[0] + c[2]) * all(0.5f);
        Vector16 area =
            cross(c[2] - c[0], kCorners == 3 ? c[1] - c[0] : c[kCorners - 1] - c[1]) * all(0.5f);
        // beyond the count stands anything
        const Lanes counts = first_lanes(count) & (zero < dot(r, axis_)) &
                             (dot(r, r) < all(max_distance_ * max_distance_));
        const auto choose = [&](Vector16 v) {
            return Vector16{select(counts, v.x, zero), select(counts, v.y, zero),
                            select(counts, v.z, zero)};
        };
        r = choose(r);
        const Float16 inverse = inverse_sqrt(max(dot(r, r), all(kMaskTiny)));
        r = r * inverse;
        area = choose(area) * (inverse * inverse * all(kInversePi));
        const Int16 away = sign_of(dot(area, r));
        const Float16 along = flip(dot(area, r), away);
        const Float16 direction[3] = {r.x, r.y, r.z};
        const Float16 facing[3] = {flip(area.x, away), flip(area.y, away), flip(area.z, away)};
        for (int i = 0; i < 3; ++i) {
            irradiance_[i] = fma(along, direction[i], irradiance_[i]);
            const Float16 by_distance = direction[i] * inverse;
            for (int j = 0; j < 3; ++j) {
                slope_[i][j] =
                    fma(by_distance, fms(all(4.0f) * along, direction[j], facing[j]), slope_[i][j]);
            }
            slope_[i][i] = slope_[i][i] - along * inverse;
        }
        any_ = true;
    }

    void finish(MaskShared& shared) const
    {
        if (!any_)
            return;
        for (int i = 0; i < 3; ++i) {
            shared.irradiance[i] += sum_of(irradiance_[i]);
            for (int j = 0; j < 3; ++j)
                shared.slope[i][j] += sum_of(slope_[i][j]);
        }
    }

private:
    Vector16 axis_;
    float max_distance_;
    bool any_ = false;
    Float16 irradiance_[3] = {all(0.0f), all(0.0f), all(0.0f)};
    Float16 slope_[3][3] = {{all(0.0f), all(0.0f), all(0.0f)},
                            {all(0.0f), all(0.0f), all(0.0f)},
                            {all(0.0f), all(0.0f), all(0.0f)}};
};

/// Collects polygons of any receivers until 16 can be drawn at once.
template <int kCorners, bool kLoose>
class Stream {
public:
    /// slope: where all is drawn for a group.
    Stream(const MaskWorld& world, std::uint32_t* masks, Slope* slope = nullptr)
        : raster_(*world.raster),
          max_distance_(world.settings.max_distance),
          masks_(masks),
          slope_(slope)
    {
    }

    /// corner: relative to the receivers whose masks begin at masks[target].
    SURFELAO_MASK_INLINE void add(const Vector16* corner, Int16 target, unsigned count)
    {
        for (int i = 0; i < kCorners; ++i) {
            store(corner_[3 * i] + count_, corner[i].x);
            store(corner_[3 * i + 1] + count_, corner[i].y);
            store(corner_[3 * i + 2] + count_, corner[i].z);
        }
        store(target_ + count_, target);
        count_ += count;
        if (count_ >= kLanes) {
            draw_first(kLanes);
            for (int i = 0; i < 3 * kCorners; ++i)
                store(corner_[i], load(corner_[i] + kLanes));
            store(target_, load(target_ + kLanes));
            count_ -= kLanes;
        }
    }

    void finish()
    {
        if (count_ > 0)
            draw_first(count_);
        count_ = 0;
    }

private:
    void draw_first(unsigned count)
    {
        draw<kCorners, 2 * kLanes, kLoose>(raster_, max_distance_, corner_[0], target_, count,
                                           masks_);
        if (slope_ != nullptr)
            slope_->template add<kCorners, 2 * kLanes>(corner_[0], count);
    }

    const MaskRaster& raster_;
    float max_distance_;
    std::uint32_t* masks_;
    Slope* slope_;
    unsigned count_ = 0;
    alignas(64) float corner_[3 * kCorners][2 * kLanes] = {};
    alignas(64) std::uint32_t target_[2 * kLanes] = {};
};

// --- which nodes ---

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
SURFELAO_MASK_INLINE void append(MaskBuffer<std::uint32_t>& list, Int16 index, Lanes chosen)
{
    make_room(list, list.count + kLanes);
    store(list.data + list.count, pack(index, chosen));
    list.count += count_of(chosen);
}

void move_to(MaskShared& shared, const float* center)
{
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            shared.change[i] += shared.slope[i][j] * (center[j] - shared.center[j]);
    }
    for (int i = 0; i < 3; ++i)
        shared.center[i] = center[i];
}

/// Through scratch.frontier, which grows meanwhile, to its end: far nodes are drawn into the
/// group's mask; a leaf group lists the rest as polygons, an inner group hands it down.
template <bool kLeaf>
void walk(const MaskWorld& world, const MaskGroup& group, MaskBuffer<std::uint32_t>* out,
          MaskShared& shared_part, MaskScratch& scratch)
{
    const MaskSettings& settings = world.settings;
    move_to(shared_part, group.center);
    Slope slope(group, settings.max_distance);
    const Vector16 origin = broadcast(group.center);
    const Vector16 axis = broadcast(group.axis);
    const Float16 group_radius = all(group.radius);
    const Float16 cone_cos = all(group.cone_cos);
    const Float16 cone_sin = all(group.cone_sin);
    const Float16 zero = all(0.0f);
    const Float16 share = all(kLeaf ? settings.share_leaf : settings.share_inner);
    Stream<4, true> clusters(world, shared_part.mask, &slope);
    Stream<4, false> rectangles(world, shared_part.mask, &slope);
    Stream<3, false> triangles(world, shared_part.mask, &slope);
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
        const Lanes active = first_lanes(count);
        Node16 node;
        load_transposed(world.nodes, index, node.field);

        // how high above any of the group's horizons the node may reach, and so how much it may
        // weigh
        const Vector16 to_node = node.center() - origin;
        const Float16 distance2 = max(dot(to_node, to_node), all(kMaskTiny));
        const Float16 inverse = inverse_sqrt(distance2);
        const Float16 distance = distance2 * inverse;
        const Float16 height = dot(to_node, axis);
        const Float16 aside = sqrt(max(fms(distance, distance, height * height), zero));
        const Float16 raised = fma(height, cone_cos, aside * cone_sin);
        const Float16 base = select(height < cone_cos * distance, raised, distance);
        const Vector16 normal = node.normal();
        const Float16 facing = dot(normal, axis);
        const Float16 tilt = sqrt(max(all(1.0f) - facing * facing, zero)) + cone_sin;
        const Float16 slab = min(node.radius(), fma(node.radius(), tilt, node.thickness()));
        const Float16 top = base + slab + all(group.rise);
        const Float16 nearest = distance - node.radius();
        const Float16 away = dot(to_node, normal);
        const Lanes one_sided = nonzero(node.links() & solid);
        const Lanes alive = active &
                            (top > max(all(settings.graze) * (nearest - group_radius), zero)) &
                            (nearest - group_radius < all(settings.max_distance));
        const Float16 weight = min(max(top * inverse, all(kMaskImportanceFloor)), all(1.0f));
        const Float16 relax = inverse_sqrt(weight);

        const Float16 cluster = min(all(settings.cluster) * relax, all(settings.cluster_limit));
        const Lanes is_triangle = nonzero(node.links() & all(kMaskTriangle));
        const Lanes exact = node.open_radius() < exact_radius;
        const Lanes sheet = without(negative(node.links()), exact);
        // a front that is hollow goes on beyond its rim
        const Lanes hollow = nonzero(node.links() & all(kMaskHollow)) & (away < zero);
        const Float16 grow = select(sheet & hollow, all(kMaskHollowGrowth), all(1.0f));
        const Lanes small = exact | (node.open_radius() < cluster * distance);
        const Lanes far = group_radius < share * relax * nearest;
        const Lanes shared = alive & small & far;
        const Lanes rest = without(alive, shared | (one_sided & (away < zero - group_radius)));
        const Lanes drawn = without(shared, one_sided & (away < zero));
        if (bits(drawn) != 0) {
            Vector16 corner[4];
            corners_of<4>(node, origin, grow, corner);
            const auto add = [&]<int kCorners, bool kLoose>(Stream<kCorners, kLoose>& stream,
                                                            Lanes chosen) {
                Vector16 packed[kCorners];
                for (int i = 0; i < kCorners; ++i)
                    packed[i] = pack(corner[i], chosen);
                stream.add(packed, all(0u), count_of(chosen));
            };
            add(triangles, drawn & is_triangle);
            add(rectangles, without(drawn, sheet | is_triangle));
            add(clusters, drawn & sheet);
        }

        Lanes opened;
        if constexpr (kLeaf) {
            const Lanes listed =
                rest & (exact | (node.open_radius() < cluster * (distance - group_radius)));
            opened = without(rest, listed);
            if (bits(listed) != 0) {
                const Int16 found = load(index) | select(hollow, all(kGrown), all(0u));
                append(scratch.triangles, found, listed & is_triangle);
                append(scratch.rectangles, found, without(listed, sheet | is_triangle));
                append(scratch.clusters, found, listed & sheet);
            }
        } else {
            opened = without(rest, small) & (group_radius < node.radius());
            const Lanes handed = without(rest, opened);
            if (bits(handed) != 0)
                append(*out, load(index), handed);
        }
        if (bits(opened) != 0) {
            make_room(frontier, frontier.count + 2 * kLanes + kLanes);
            append(frontier, node.first_child(), opened);
            const unsigned added = count_of(opened);
            std::uint32_t* child = frontier.data + frontier.count - added;
            for (unsigned i = 0; i < added; ++i) {
                child[added + i] = child[i] + 1;
                __builtin_prefetch(world.nodes + kLanes * static_cast<std::size_t>(child[i]));
                __builtin_prefetch(world.nodes + kLanes * static_cast<std::size_t>(child[i] + 1));
            }
            frontier.count += added;
        }
    }
    clusters.finish();
    rectangles.finish();
    triangles.finish();
    slope.finish(shared_part);
}

void start_frontier(MaskScratch& scratch, const std::uint32_t* in, std::size_t in_count)
{
    MaskBuffer<std::uint32_t>& frontier = scratch.frontier;
    reserve(frontier, in_count + kLanes);
    if (in_count > 0)
        std::memcpy(frontier.data, in, in_count * sizeof(std::uint32_t));
    frontier.count = in_count;
}

// --- what a mask is worth ---

/// Sum of w over bits, cosine weights, in the unit of MaskRaster::first.
struct First {
    std::int32_t at[3] = {};

    /// Integral of (n.w) over the bits.
    SURFELAO_MASK_INLINE float along(const float* n) const
    {
        return static_cast<float>(at[0]) * n[0] + static_cast<float>(at[1]) * n[1] +
               static_cast<float>(at[2]) * n[2];
    }
};

/// Sum of w w^T over bits, cosine weights: xx yy zz xy yz zx.
struct Second {
    std::int32_t at[6] = {};
};

/// Set bits among the kPart-th kBits of each byte of a face.
template <int kBits, int kPart>
SURFELAO_MASK_INLINE Bytes counts(Int16 face)
{
    constexpr std::uint32_t chosen = kBits == 2 ? 0x03030303u : 0x0f0f0f0fu;
    return nibble_counts(shift_right<kBits * kPart>(face) & all(chosen));
}

/// Set bits of the two faces of an axis.
struct FacePair {
    Bytes both;  ///< the sum
    Bytes more;  ///< what the front has more than the back, plus all that a face can have

    template <int kBits, int kPart>
    SURFELAO_MASK_INLINE static FacePair of(Int16 front, Int16 back)
    {
        constexpr std::uint32_t full = 0x01010101u * kBits;
        const Bytes ahead = counts<kBits, kPart>(front), behind = counts<kBits, kPart>(back);
        return {ahead + behind, ahead + (bytes_of(all(full)) - behind)};
    }
};

template <int kAxis, int kPart>
SURFELAO_MASK_INLINE void add_first(const MaskRaster& raster, Int16 front, Int16 back, ByteSum* sum)
{
    const auto faces = FacePair::of<2, kPart>(front, back);
    sum[kAxis].add(faces.more, raster.first[0][kPart]);
    sum[(kAxis + 1) % 3].add(faces.both, raster.first[1][kPart]);
    sum[(kAxis + 2) % 3].add(faces.both, raster.first[2][kPart]);
}

template <int kAxis>
SURFELAO_MASK_INLINE void add_first(const MaskRaster& raster, const std::uint32_t* mask,
                                    ByteSum* sum)
{
    const Int16 front = load(mask + 2 * kAxis * kMaskFaceWords);
    const Int16 back = load(mask + (2 * kAxis + 1) * kMaskFaceWords);
    add_first<kAxis, 0>(raster, front, back, sum);
    add_first<kAxis, 1>(raster, front, back, sum);
    add_first<kAxis, 2>(raster, front, back, sum);
    add_first<kAxis, 3>(raster, front, back, sum);
}

SURFELAO_MASK_INLINE First first_of(const MaskRaster& raster, const std::int32_t* totals)
{
    First first;
    for (int k = 0; k < 3; ++k)
        first.at[k] = totals[k] - 2 * raster.first_sum[0];
    return first;
}

SURFELAO_MASK_INLINE First first_moments(const MaskRaster& raster, const std::uint32_t* mask)
{
    ByteSum sum[6] = {};
    add_first<0>(raster, mask, sum);
    add_first<1>(raster, mask, sum);
    add_first<2>(raster, mask, sum);
    std::int32_t totals[6];
    total(sum, totals);
    return first_of(raster, totals);
}

/// Of two masks.
SURFELAO_MASK_INLINE void first_moments(const MaskRaster& raster, const std::uint32_t* a,
                                        const std::uint32_t* b, First& of_a, First& of_b)
{
    ByteSum sum[6] = {};
    add_first<0>(raster, a, sum);
    add_first<0>(raster, b, sum + 3);
    add_first<1>(raster, a, sum);
    add_first<1>(raster, b, sum + 3);
    add_first<2>(raster, a, sum);
    add_first<2>(raster, b, sum + 3);
    std::int32_t totals[6];
    total(sum, totals);
    of_a = first_of(raster, totals);
    of_b = first_of(raster, totals + 3);
}

/// Products of axes i and i + 1 stand at 3 + i.
template <int kAxis, int kPart>
SURFELAO_MASK_INLINE void add_second(const MaskRaster& raster, Int16 front, Int16 back,
                                     ByteSum* sum)
{
    constexpr int u = (kAxis + 1) % 3, v = (kAxis + 2) % 3;
    const auto faces = FacePair::of<4, kPart>(front, back);
    sum[kAxis].add(faces.both, raster.second[0][kPart]);
    sum[3 + kAxis].add(faces.more, raster.second[1][kPart]);
    sum[3 + v].add(faces.more, raster.second[2][kPart]);
    sum[u].add(faces.both, raster.second[3][kPart]);
    sum[3 + u].add(faces.both, raster.second[4][kPart]);
    sum[v].add(faces.both, raster.second[5][kPart]);
}

template <int kAxis>
SURFELAO_MASK_INLINE void add_second(const MaskRaster& raster, const std::uint32_t* mask,
                                     ByteSum* sum)
{
    const Int16 front = load(mask + 2 * kAxis * kMaskFaceWords);
    const Int16 back = load(mask + (2 * kAxis + 1) * kMaskFaceWords);
    add_second<kAxis, 0>(raster, front, back, sum);
    add_second<kAxis, 1>(raster, front, back, sum);
}

SURFELAO_MASK_INLINE Second second_moments(const MaskRaster& raster, const std::uint32_t* mask)
{
    ByteSum sum[6] = {};
    add_second<0>(raster, mask, sum);
    add_second<1>(raster, mask, sum);
    add_second<2>(raster, mask, sum);
    Second second;
    total(sum, second.at);
    for (int k = 0; k < 3; ++k)
        second.at[3 + k] -= 4 * (raster.second_sum[1] + raster.second_sum[2]);
    return second;
}

/// Above the horizon and not covered.
SURFELAO_MASK_INLINE void open_bits(const std::uint32_t* above, const std::uint32_t* mask,
                                    std::uint32_t* open)
{
    for (int w = 0; w < kMaskFaces * kMaskFaceWords; w += kLanes)
        store(open + w, load(above + w) & ~load(mask + w));
}

/// A clear bit is a crack between two patches where its neighbours left and right are set, or those
/// above and below, both of the two nearest in direction, and a cluster set one of them. No
/// half-plane, nor any convex shape, is changed by that. Nothing is set outside of the face.
SURFELAO_MASK_INLINE Int16 fill(const MaskRaster& raster, Int16 m, Int16 loose)
{
    const Lanes low_right = nonzero(load(raster.below_is_right));
    const Lanes high_right = nonzero(load(raster.above_is_right));
    const auto pair = [](Int16 row, Lanes right, auto join) {
        return join(row, select(right, shift_left<1>(row), shift_right<1>(row)));
    };
    const auto both = [](Int16 a, Int16 b) { return a & b; };
    const auto either = [](Int16 a, Int16 b) { return a | b; };
    const Int16 sides = shift_left<1>(m) & shift_right<1>(m);
    const Int16 loose_sides = shift_left<1>(loose) | shift_right<1>(loose);
    const Int16 stacked =
        pair(from_below(m), low_right, both) & pair(from_above(m), high_right, both);
    const Int16 loose_stacked =
        pair(from_below(loose), low_right, either) | pair(from_above(loose), high_right, either);
    return m | (sides & loose_sides) | (stacked & loose_stacked);
}

/// Of the open bits those that are no cracks: what filling has left open and what touches it. A
/// notch in the rim of an opening is most likely part of it.
SURFELAO_MASK_INLINE Int16 openings(Int16 open, Int16 filled)
{
    const Int16 left = ~filled;
    return open & (left | shift_left<1>(left) | shift_right<1>(left) | from_below(left) |
                   from_above(left));
}

/// Closes cracks of two bits too, for places where nearly all is covered: what is set is grown by
/// one bit along the rows, then across them, and shrunk again. Only beside bits that clusters set.
SURFELAO_MASK_INLINE Int16 close(const MaskRaster& raster, Int16 m, Int16 loose)
{
    const Lanes low_right = nonzero(load(raster.below_is_right));
    const Lanes high_right = nonzero(load(raster.above_is_right));
    const auto beside = [](Int16 row, Lanes right) {
        return select(right, shift_left<1>(row), shift_right<1>(row));
    };
    const auto grown_across = [&](Int16 x) {
        const Int16 low = from_below(x);
        const Int16 high = from_above(x);
        return x | low | beside(low, low_right) | high | beside(high, high_right);
    };
    const auto shrunk_across = [&](Int16 x) {
        const Int16 low = from_below(x);
        const Int16 high = from_above(x);
        return x & low & beside(low, low_right) & high & beside(high, high_right);
    };
    const Int16 wide = m | shift_left<1>(m) | shift_right<1>(m);
    const Int16 rows = wide & shift_left<1>(wide) & shift_right<1>(wide);
    const Int16 columns = shrunk_across(grown_across(m));
    const Int16 near = grown_across(loose | shift_left<1>(loose) | shift_right<1>(loose));
    return m | ((rows | columns) & near);
}

/// The bits above the plane through the receiver with normal n.
void horizon(const MaskRaster& raster, const float* n, std::uint32_t* above)
{
    for (int face = 0; face < kMaskFaces; ++face) {
        const int a = face / 2, u = (a + 1) % 3, v = (a + 2) % 3;
        const float na = face % 2 == 0 ? n[a] : -n[a];
        const bool turned = n[u] < 0.0f;
        float size = turned ? -n[u] : n[u];
        size = size > kMaskTiny ? size : kMaskTiny;
        const float scale = (turned ? kMaskHalfColumns : -kMaskHalfColumns) / size;
        const Int16 from = row_bits(raster, n[v] * scale, kMaskHalfColumns + na * scale);
        store(above + kMaskFaceWords * face, turned ? ~from : from);
    }
}

/// Whether next to nothing is open, once cracks are filled and closed. closed: what lies below the
/// horizon is set.
bool is_closed(const MaskRaster& raster, const std::uint32_t* closed, const float* n)
{
    // the face right ahead tells most others apart
    const float x = n[0] < 0.0f ? -n[0] : n[0];
    const float y = n[1] < 0.0f ? -n[1] : n[1];
    const float z = n[2] < 0.0f ? -n[2] : n[2];
    const int axis = x > y && x > z ? 0 : y > z ? 1 : 2;
    const int ahead = 2 * axis + (n[axis] < 0.0f ? 1 : 0);
    const Int16 holes = ~load(closed + kMaskFaceWords * ahead);
    if (__builtin_popcount(bits(nonzero(holes))) > kMaskOpenBits)
        return false;
    int open = 0;
    for (int face = 0; face < kMaskFaces; ++face) {
        const int w = kMaskFaceWords * face;
        const Int16 loose = load(closed + kMaskWords + w);
        const Int16 filled = fill(raster, load(closed + w), loose);
        alignas(64) std::uint32_t rows[kLanes];
        store(rows, ~close(raster, filled, loose));
        for (const std::uint32_t row : rows)
            open += __builtin_popcount(row);
        if (open > kMaskOpenBits)
            return false;
    }
    return true;
}

// --- one group ---

/// The receivers of a group, and where their masks begin.
struct Receivers16 {
    Vector16 position, normal;
    Int16 target;
};

/// Of what a group shares.
struct Visible {
    float openness;  ///< of the sky above the group's axis
    float share;     ///< covered sky over the sum of what covers it: nodes hide behind each other
};

/// n.(change + slope (p - center))
SURFELAO_MASK_INLINE Float16 changes_at(const MaskShared& shared, const Receivers16& receivers)
{
    const Vector16 p = receivers.position - broadcast(shared.center);
    const Vector16 change = broadcast(shared.change) + Vector16{dot(broadcast(shared.slope[0]), p),
                                                                dot(broadcast(shared.slope[1]), p),
                                                                dot(broadcast(shared.slope[2]), p)};
    return dot(change, receivers.normal);
}

Visible visible_of(const MaskRaster& raster, const MaskShared& shared, const float* axis)
{
    const float sum = shared.irradiance[0] * axis[0] + shared.irradiance[1] * axis[1] +
                      shared.irradiance[2] * axis[2];
    if (!(sum > 0.0f))
        return {1.0f, 0.0f};
    alignas(64) std::uint32_t above[kMaskWords];
    alignas(64) std::uint32_t open[kMaskWords];
    horizon(raster, axis, above);
    open_bits(above, shared.mask, open);
    First of_open, of_above;
    first_moments(raster, open, above, of_open, of_above);
    const float openness = of_open.along(axis) / of_above.along(axis);
    const float share = (1.0f - openness) / sum;
    return {openness, share < 1.0f ? share : 1.0f};
}

/// Draws the listed polygons from `begin` to `end`, no more than kMaskDrawnBetweenChecks, for those
/// receivers in `active` above whose horizon they reach: where the highest corner, seen as far away
/// as the centre is, or a little nearer, stands higher than the grazing strip.
template <int kCorners, bool kLoose>
SURFELAO_MASK_INLINE void draw_near(const MaskWorld& world, const MaskBuffer<std::uint32_t>& list,
                                    std::size_t begin, std::size_t end,
                                    const Receivers16& receivers, Lanes active,
                                    Stream<kCorners, kLoose>& stream)
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
        const Float16 skew = kLoose ? zero : dot(node.skew(), normal);
        const Float16 a = dot(node.axis_a(), normal), b = dot(node.axis_b(), normal);
        const Float16 even = skew + max(a, zero - a);
        const Float16 odd = (kCorners == 3 ? b : max(b, zero - b)) - skew;
        const Float16 top = dot(center, normal) + max(even, odd);
        const Float16 least =
            fms(all(graze2), dot(center, center), all(graze2 * fields[3] * fields[3]));
        const Lanes above = active & (top > zero) & (top * top > least);
        found[count] = list.data[i];
        seen[count] = bits(above);
        count += bits(above) != 0 ? 1 : 0;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const float* const fields = fields_of(found[i]);
        const Node16 node = broadcast_node(fields);
        Lanes above = lanes_of(seen[i]);
        std::uint32_t links;
        std::memcpy(&links, fields + 15, sizeof links);
        if (!kLoose && world.settings.one_sided && (links & kMaskSolid) != 0)
            above = without(
                above, dot(cross(node.axis_a(), node.axis_b()), node.center() - position) < zero);
        Vector16 corner[kCorners];
        const float grow = kLoose && (found[i] & kGrown) != 0 ? kMaskHollowGrowth : 1.0f;
        corners_of<kCorners>(node, pack(position, above), all(grow), corner);
        stream.add(corner, pack(receivers.target, above), count_of(above));
    }
}

void descend(const MaskWorld& world, const MaskGroup& group, const std::uint32_t* in,
             std::size_t in_count, MaskBuffer<std::uint32_t>& out, MaskShared& shared,
             MaskScratch& scratch)
{
    out.count = 0;
    start_frontier(scratch, in, in_count);
    walk<false>(world, group, &out, shared, scratch);
}

/// Draws the lists into the masks of `count` receivers. Those in nearly closed places are finished
/// before all is drawn.
void draw_lists(const MaskWorld& world, const MaskScratch& scratch, const Receivers16& receivers,
                const float (*normals)[3], unsigned count, std::uint32_t* masks)
{
    Stream<4, true> clusters(world, masks);
    Stream<4, false> rectangles(world, masks);
    Stream<3, false> triangles(world, masks);
    alignas(64) std::uint32_t active[kLanes] = {};
    for (unsigned i = 0; i < count; ++i)
        active[i] = 1;
    const auto leave_out_closed = [&] {
        for (unsigned i = 0; i < count; ++i) {
            if (active[i] != 0 && is_closed(*world.raster, masks + i * kMaskPairWords, normals[i]))
                active[i] = 0;
        }
    };
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
    draw_list(scratch.rectangles, rectangles);
    draw_list(scratch.clusters, clusters);
    draw_list(scratch.triangles, triangles);
    clusters.finish();
    rectangles.finish();
    triangles.finish();
}

void solve(const MaskWorld& world, const MaskGroup& group, const std::uint32_t* in,
           std::size_t in_count, const MaskShared& from_above, const MaskReceivers& receivers,
           MaskAnswers& answers, MaskScratch& scratch)
{
    const MaskRaster& raster = *world.raster;
    MaskShared shared = from_above;
    scratch.clusters.count = 0;
    scratch.rectangles.count = 0;
    scratch.triangles.count = 0;
    start_frontier(scratch, in, in_count);
    walk<true>(world, group, nullptr, shared, scratch);

    alignas(64) std::uint32_t masks[kLanes * kMaskPairWords];
    alignas(64) std::uint32_t horizons[kLanes * kMaskWords];
    alignas(64) std::uint32_t target[kLanes];
    float normals[kLanes][3];
    for (unsigned i = 0; i < kLanes; ++i) {
        target[i] = i * kMaskPairWords;
        for (int k = 0; k < 3; ++k)
            normals[i][k] = receivers.normal[k][i];
    }
    for (unsigned i = 0; i < receivers.count; ++i) {
        std::uint32_t* above = horizons + i * kMaskWords;
        horizon(raster, normals[i], above);
        std::uint32_t* closed = masks + target[i];
        for (int w = 0; w < kMaskFaces * kMaskFaceWords; w += kLanes) {
            store(closed + w, load(shared.mask + w) | ~load(above + w));
            store(closed + kMaskWords + w, load(shared.mask + kMaskWords + w));
        }
    }
    const Receivers16 all_receivers = {
        {load(receivers.position[0]), load(receivers.position[1]), load(receivers.position[2])},
        {load(receivers.normal[0]), load(receivers.normal[1]), load(receivers.normal[2])},
        load(target)};
    draw_lists(world, scratch, all_receivers, normals, receivers.count, masks);

    const Visible visible = visible_of(raster, shared, group.axis);
    alignas(64) float changes[kLanes];
    store(changes, changes_at(shared, all_receivers));
    for (unsigned i = 0; i < receivers.count; ++i) {
        const float* n = normals[i];
        std::uint32_t* mask = masks + i * kMaskPairWords;
        const std::uint32_t* above = horizons + i * kMaskWords;
        alignas(64) std::uint32_t open[kMaskWords];
        open_bits(above, mask, open);
        First of_open, of_above;
        first_moments(raster, open, above, of_open, of_above);
        const float weight = of_above.along(n);
        float openness = of_open.along(n) / weight;
        const float fill_weight = (1.0f - openness - kMaskFillFrom) / kMaskFillRange;
        if (world.settings.fill && fill_weight > 0.0f && openness > 0.0f) {
            alignas(64) std::uint32_t filled[kMaskWords];
            for (int w = 0; w < kMaskFaces * kMaskFaceWords; w += kLanes) {
                // what lies below the horizon is no opening
                const Int16 closed = load(mask + w) | ~load(above + w);
                store(filled + w, fill(raster, closed, load(mask + kMaskWords + w)));
                store(open + w, openings(~closed, load(filled + w)));
            }
            const float cracks = openness - first_moments(raster, open).along(n) / weight;
            openness -= (fill_weight < 1.0f ? fill_weight : 1.0f) * kMaskFillShare * cracks;

            const float close_weight = (1.0f - openness - kMaskCloseFrom) / kMaskCloseRange;
            if (world.settings.close > 0.0f && close_weight > 0.0f && openness > 0.0f) {
                for (int w = 0; w < kMaskFaces * kMaskFaceWords; w += kLanes)
                    store(open + w, ~close(raster, load(filled + w), load(mask + kMaskWords + w)));
                const float sealed = first_moments(raster, open).along(n) / weight;
                if (sealed < openness)
                    openness += (close_weight < 1.0f ? close_weight : 1.0f) * world.settings.close *
                                (sealed - openness);
            }
        }
        // near polygons cover what is far as they cover the open sky
        const float bare = openness < visible.openness ? openness / visible.openness : 1.0f;
        const float change = bare * visible.share * changes[i];
        const float size = change < 0.0f ? -change : change;
        if (size < __builtin_inff())
            openness -= change / (1.0f + size / kMaskLargestMove);
        openness = openness < 0.0f ? 0.0f : openness > 1.0f ? 1.0f : openness;
        answers.occlusion[i] = 1.0f - openness;
        const Second second = second_moments(raster, open);
        float m[6];
        for (int k = 0; k < 6; ++k)
            m[k] = static_cast<float>(second.at[k]);
        answers.bent[0][i] = m[0] * n[0] + m[3] * n[1] + m[5] * n[2];
        answers.bent[1][i] = m[3] * n[0] + m[1] * n[1] + m[4] * n[2];
        answers.bent[2][i] = m[5] * n[0] + m[4] * n[1] + m[2] * n[2];
    }
}

}  // namespace

constexpr MaskKernel kKernel = {SURFELAO_MASK_ISA_NAME, descend, solve};

}  // namespace surfelao::SURFELAO_MASK_ISA
