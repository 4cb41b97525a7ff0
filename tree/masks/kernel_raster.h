/// kernel_raster.h: the bits of polygons, sixteen at a time (part of kernel_body.h).
///
/// A face's bits on one side of an edge's plane n.d >= 0 are, row by row, those from a column up or
/// those below it; a polygon is what all of its edges have in common. No clipping is needed: where
/// a plane misses a face the column lies outside of it.
#pragma once

#include "tree/masks/constants.h"
#include "tree/masks/kernel.h"
#include "tree/masks/raster.h"
#include "tree/masks/simd.h"

namespace surfelao::SURFELAO_MASK_ISA {
namespace {

/// The bits of one face whose rays meet a plane within the limit: those inside of the circular cone
/// n.d >= k |d| about the plane's normal n, where k = plane's distance / limit, 0 <= k < 1.
/// With n.d = p + nu u and |d|^2 = q + u^2 in a row, u lies between or beyond the roots of
/// (nu^2 - k^2) u^2 + 2 p nu u + p^2 - k^2 q = 0.
SURFELAO_MASK_INLINE Int16 cone_bits(const MaskRaster& raster, Float16 na, float nu, float nv,
                                     float k)
{
    const Float16 v = load(raster.row_v);
    const Float16 shift = load(raster.row_shift);
    const Float16 zero = all(0.0f);
    float a = nu * nu - k * k;
    if (a > -kMaskConeFlat && a < kMaskConeFlat)
        a = a < 0.0f ? -kMaskConeFlat : kMaskConeFlat;
    const Float16 p = fma(all(nv), v, na);
    const Float16 root2 = fma(p, p, fma(v, v, all(1.0f)) * all(a));
    const Float16 root = sqrt(max(root2, zero)) * all(k);
    const Float16 b = p * all(nu);
    const Float16 scale = all(kMaskHalfColumns / a);
    const Float16 first = fma(root - b, scale, all(kMaskHalfColumns));
    const Float16 second = fma(zero - root - b, scale, all(kMaskHalfColumns));
    if (a < 0.0f) {
        const Int16 between = bits_from(first, shift) & ~bits_from(second, shift);
        return select((root2 > zero) & (p > zero), between, all(0u));
    }
    return nu > 0.0f ? bits_from(first, shift) : ~bits_from(second, shift);
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

/// The planes through the receiver and each edge, turned inward. Made of a corner and the edge, not
/// of pairs of corners, whose product is mere rounding where they are next to each other.
template <int kCorners>
struct EdgePlanes {
    Vector16 normal[kCorners];
    Float16 volume;  ///< 0: seen edge-on, or without area
};

template <int kCorners>
SURFELAO_MASK_INLINE EdgePlanes<kCorners> planes_of(const Vector16* c)
{
    EdgePlanes<kCorners> planes;
    Vector16* const n = planes.normal;
    for (int i = 0; i < kCorners; ++i)
        n[i] = cross(c[i], c[(i + 1) % kCorners] - c[i]);
    planes.volume = dot(n[0], c[2] - c[1]);
    const Int16 turn = sign_of(planes.volume);
    for (int i = 0; i < kCorners; ++i)
        n[i] = {flip(n[i].x, turn), flip(n[i].y, turn), flip(n[i].z, turn)};
    return planes;
}

/// Which of `drawn` touch each face. One is missed where all corners lie beyond one of the four
/// diagonal planes that bound it.
template <int kCorners>
SURFELAO_MASK_INLINE void find_faces(const Vector16* c, Bool16 drawn, Bool16* in)
{
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
    in[0] = without(drawn, negative(all_dxy | all_sxy | ~any_dzx | all_szx));
    in[1] = without(drawn, negative(~any_sxy | ~any_dxy | all_dzx | ~any_szx));
    in[2] = without(drawn, negative(~any_dxy | all_sxy | all_dyz | all_syz));
    in[3] = without(drawn, negative(all_dxy | ~any_sxy | ~any_dyz | ~any_syz));
    in[4] = without(drawn, negative(all_dzx | all_szx | ~any_dyz | all_syz));
    in[5] = without(drawn, negative(~any_dzx | ~any_szx | all_dyz | ~any_syz));
}

/// Polygons that are not wholly within the nearest limit. Within each limit that they cross they
/// are cut to a cone about their plane's normal.
struct Cuts {
    unsigned lanes = 0;
    unsigned within[kMaskMostLimits];    ///< lanes whose plane is nearer than the limit
    unsigned beyond[kMaskMostLimits];    ///< lanes of which a corner is not
    alignas(64) float plane[4][kLanes];  ///< normal; distance
};

/// Takes those whose plane lies beyond all limits out of `drawn`.
template <int kCorners>
SURFELAO_MASK_INLINE void find_cuts(const Vector16* c, const MaskLimits& limits, Bool16& drawn,
                                    Cuts& cuts)
{
    Vector16 normal = cross(c[1] - c[0], c[2] - c[0]);
    const Float16 length2 = max(dot(normal, normal), all(kMaskTiny));
    const Float16 inverse = inverse_sqrt(length2);
    Float16 height = dot(normal, c[0]) * inverse;
    const Int16 behind = sign_of(height);
    height = flip(height, behind);
    const Vector16 middle =
        kCorners == 3 ? (c[0] + c[1] + c[2]) * all(1.0f / 3.0f) : (c[0] + c[2]) * all(0.5f);
    Float16 radius2 = all(0.0f), farthest2 = all(0.0f);
    for (int i = 0; i < kCorners; ++i) {
        radius2 = max(radius2, dot(c[i] - middle, c[i] - middle));
        farthest2 = max(farthest2, dot(c[i], c[i]));
    }
    const Float16 distance2 = dot(middle, middle);
    const Float16 distance = sqrt(distance2);
    Float16 nearest = max(height, distance - sqrt(radius2));
    const Bool16 small = radius2 < all(limits.uncut * limits.uncut);
    nearest = select(small, distance, nearest);
    farthest2 = select(small, distance2, farthest2);
    for (unsigned k = 0; k < limits.count; ++k) {
        const Float16 limit = all(limits.distance[k]);
        cuts.within[k] = bits(nearest < limit);
        cuts.beyond[k] = bits(limit * limit < farthest2);
    }
    drawn = drawn & lanes_of(cuts.within[limits.count - 1]);
    cuts.lanes = cuts.beyond[0];
    store(cuts.plane[0], flip(normal.x * inverse, behind));
    store(cuts.plane[1], flip(normal.y * inverse, behind));
    store(cuts.plane[2], flip(normal.z * inverse, behind));
    store(cuts.plane[3], height);
}

/// The edges of 16 polygons as each face sees them: from bit ceil(slope v + start - shift) up, or
/// the bits below. The two faces of an axis see the same slopes.
template <int kCorners>
struct EdgeLines {
    alignas(64) float slope[3][kCorners][kLanes];
    alignas(64) float start[kMaskFaces][kCorners][kLanes];
    alignas(64) std::uint32_t below[3][kCorners][kLanes];  ///< ~0 where the bits below are meant
    std::uint64_t faces[2] = {};  ///< a bit for each face and lane that are touched
};

template <int kAxis, int kCorners>
SURFELAO_MASK_INLINE void set_axis(const Vector16* n, const Bool16* in, EdgeLines<kCorners>& lines)
{
    constexpr int kU = (kAxis + 1) % 3, kV = (kAxis + 2) % 3;
    const std::uint64_t both = bits(in[2 * kAxis]) | bits(in[2 * kAxis + 1]) << kLanes;
    if (both == 0)
        return;
    lines.faces[kAxis / 2] |= both << (kAxis % 2 * 2 * kLanes);
    for (int i = 0; i < kCorners; ++i) {
        const Float16 normal[3] = {n[i].x, n[i].y, n[i].z};
        const Int16 sign = sign_of(normal[kU]);
        const Float16 size = max(flip(normal[kU], sign), all(kMaskTiny));
        const Float16 scale = flip(reciprocal(size) * all(-kMaskHalfColumns), sign);
        store(lines.slope[kAxis][i], normal[kV] * scale);
        store(lines.start[2 * kAxis][i], fma(normal[kAxis], scale, all(kMaskHalfColumns)));
        store(lines.start[2 * kAxis + 1][i], all(kMaskHalfColumns) - normal[kAxis] * scale);
        store(lines.below[kAxis][i], select(nonzero(sign), all(~0u), all(0u)));
    }
}

/// Sets bits of one face in its mask, and among the sheets' bits too.
template <bool kSheet, class Ints>
SURFELAO_MASK_INLINE void set_bits(std::uint32_t* mask, Ints bits)
{
    Ints before;
    load_rows(mask, before);
    store(mask, before | bits);
    if constexpr (kSheet) {
        load_rows(mask + kMaskWords, before);
        store(mask + kMaskWords, before | bits);
    }
}

/// The rows of a face within all edges of the polygon in a lane.
template <int kCorners, class Floats, class Ints>
SURFELAO_MASK_INLINE void rows_within(const EdgeLines<kCorners>& lines, unsigned face,
                                      unsigned lane, Floats row_v, Floats row_shift, Ints& inside)
{
    fill_rows(~0u, inside);
    for (int i = 0; i < kCorners; ++i) {
        Floats slope, start;
        fill_rows(lines.slope[face / 2][i][lane], slope);
        fill_rows(lines.start[face][i][lane], start);
        Ints below;
        fill_rows(lines.below[face / 2][i][lane], below);
        inside = and_xor(inside, bits_from(fma(slope, row_v, start), row_shift), below);
    }
}

/// Of what stands for the rows of both faces of an axis, or of one, those of a face.
SURFELAO_MASK_INLINE void rows_of_face(Int16 rows, unsigned, Int16& of_face)
{
    of_face = rows;
}
SURFELAO_MASK_INLINE void rows_of_face(Int16 rows, unsigned face, Int8& of_face)
{
    of_face = half_of(rows, face % 2 == 1);
}

/// Sixteen polygons at once up to the edges, then each by itself, all rows of a face at a time.
/// corner: 3 kCorners rows of `kStride` floats, relative to the receiver; target: word offset of
/// the receiver's masks in `masks`, a pair for each limit. A polygon is set within the nearest
/// limit that it does not cross, and cut within those that it does. kCut: there are limits;
/// kCoarse: eight rows.
template <int kCorners, int kStride, bool kSheet, bool kCut, bool kCoarse>
void draw_polygons(const MaskRaster& raster, const MaskLimits& limits, const float* corner,
                   const std::uint32_t* target, unsigned count, std::uint32_t* masks)
{
    Vector16 c[kCorners];
    load_corners<kCorners, kStride>(corner, c);
    const auto planes = planes_of<kCorners>(c);
    Bool16 drawn = first_lanes(count) & (nonzero(as_int(planes.volume) & all(0x7fffffffu)));
    Cuts cuts;
    if constexpr (kCut)
        find_cuts<kCorners>(c, limits, drawn, cuts);
    Bool16 in[kMaskFaces];
    find_faces<kCorners>(c, drawn, in);
    EdgeLines<kCorners> lines;
    set_axis<0, kCorners>(planes.normal, in, lines);
    set_axis<1, kCorners>(planes.normal, in, lines);
    set_axis<2, kCorners>(planes.normal, in, lines);

    using Floats = typename RowTypes<kCoarse>::Floats;
    using Ints = typename RowTypes<kCoarse>::Ints;
    constexpr unsigned kRows = kCoarse ? kMaskCoarseRows : kMaskRows;
    Floats row_v, row_shift;
    load_rows(raster.row_v, row_v);
    load_rows(raster.row_shift, row_shift);
    for (unsigned half = 0; half < 2; ++half) {
        for (std::uint64_t left = lines.faces[half]; left != 0; left &= left - 1) {
            const auto place = static_cast<unsigned>(__builtin_ctzll(left));
            const unsigned lane = place % kLanes;
            const unsigned face = 4 * half + place / kLanes;
            const unsigned axis = face / 2;
            Ints inside;
            rows_within(lines, face, lane, row_v, row_shift, inside);
            std::uint32_t* mask = masks + target[lane] + kRows * face;
            if (!kCut || (cuts.lanes >> lane & 1u) == 0) {
                set_bits<kSheet>(mask, inside);
                continue;
            }
            for (unsigned k = 0; k < limits.count; ++k, mask += kMaskPairWords) {
                if ((cuts.beyond[k] >> lane & 1u) == 0) {
                    set_bits<kSheet>(mask, inside);
                    break;
                }
                if ((cuts.within[k] >> lane & 1u) == 0)
                    continue;
                const float na = cuts.plane[axis][lane];
                Ints near;
                rows_of_face(
                    cone_bits(raster, all(na) * load(raster.side[face % 2]),
                              cuts.plane[(axis + 1) % 3][lane], cuts.plane[(axis + 2) % 3][lane],
                              cuts.plane[3][lane] / limits.distance[k]),
                    face, near);
                set_bits<kSheet>(mask, inside & near);
            }
        }
    }
}

template <int kCorners, int kStride, bool kSheet>
void draw(const MaskRaster& raster, const MaskLimits& limits, const float* corner,
          const std::uint32_t* target, unsigned count, std::uint32_t* masks)
{
    const bool cut = limits.distance[0] < __builtin_inff();
    const auto draw_them = raster.rows == kMaskRows
                               ? (cut ? draw_polygons<kCorners, kStride, kSheet, true, false>
                                      : draw_polygons<kCorners, kStride, kSheet, false, false>)
                               : (cut ? draw_polygons<kCorners, kStride, kSheet, true, true>
                                      : draw_polygons<kCorners, kStride, kSheet, false, true>);
    draw_them(raster, limits, corner, target, count, masks);
}

/// The bits above the plane through the receiver with normal n.
inline void horizon(const MaskRaster& raster, const float* n, std::uint32_t* above)
{
    for (int block = 0; kLanes * block < raster.words; ++block) {
        const int a = block * kLanes / (2 * raster.rows), u = (a + 1) % 3, v = (a + 2) % 3;
        const bool turned = n[u] < 0.0f;
        float size = turned ? -n[u] : n[u];
        size = size > kMaskTiny ? size : kMaskTiny;
        const float scale = (turned ? kMaskHalfColumns : -kMaskHalfColumns) / size;
        const Float16 start =
            fma(load(raster.side[block % 2]), all(n[a] * scale), all(kMaskHalfColumns));
        const Int16 from =
            bits_from(fma(all(n[v] * scale), load(raster.row_v), start), load(raster.row_shift));
        store(above + kLanes * block, turned ? ~from : from);
    }
}

/// Takes what the ground covers within a limit, as seen from a signed height over it, out of
/// `above`: what lies below a second horizon without a limit, and inside of a cone with one.
inline void take_ground(const MaskRaster& raster, const MaskSettings& settings, float limit,
                        float height, std::uint32_t* above)
{
    const float turn = height < 0.0f ? 1.0f : -1.0f;
    const float edge = -turn * height / limit;
    if (!(settings.has_ground && edge < 1.0f))
        return;
    const float* up = settings.ground_up;
    const float towards[3] = {turn * up[0], turn * up[1], turn * up[2]};
    // so flat a cone is a half-space, and as such has no roots that vanish
    const bool flat = edge < kMaskConeFlat;
    alignas(64) std::uint32_t covered[kMaskWords];
    if (flat)
        horizon(raster, towards, covered);
    for (int block = 0; kLanes * block < raster.words; ++block) {
        const int a = block * kLanes / (2 * raster.rows), u = (a + 1) % 3, v = (a + 2) % 3;
        const int w = kLanes * block;
        const Int16 bits = flat ? load(covered + w)
                                : cone_bits(raster, load(raster.side[block % 2]) * all(towards[a]),
                                            towards[u], towards[v], edge);
        store(above + w, load(above + w) & ~bits);
    }
}

}  // namespace
}  // namespace surfelao::SURFELAO_MASK_ISA
