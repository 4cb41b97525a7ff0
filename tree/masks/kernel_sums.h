/// kernel_sums.h: what the bits of a mask are worth (part of kernel_body.h).
///
/// Set bits are counted by twos (first moments) and fours (second) in a row and multiplied by the
/// integers of MaskRaster: every kernel gets the same sums.
#pragma once

#include "tree/masks/raster.h"
#include "tree/masks/simd.h"

namespace surfelao::SURFELAO_MASK_ISA {
namespace {

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

/// Set bits among the kPart-th kBits of each byte.
template <int kBits, int kPart>
SURFELAO_MASK_INLINE Bytes counts(Bytes rows)
{
    constexpr std::uint32_t chosen = kBits == 2 ? 0x03030303u : 0x0f0f0f0fu;
    return nibble_counts(shift_right<kBits * kPart>(rows) & all_bytes(chosen));
}

/// Some rows of the two faces of an axis: set bits.
struct FacePair {
    Bytes both;  ///< the sum
    Bytes more;  ///< what the front has more than the back, plus all that a face can have

    template <int kBits, int kPart>
    SURFELAO_MASK_INLINE static FacePair of(Bytes front, Bytes back)
    {
        constexpr std::uint32_t full = 0x01010101u * kBits;
        const Bytes ahead = counts<kBits, kPart>(front), behind = counts<kBits, kPart>(back);
        return {ahead + behind, ahead + (all_bytes(full) - behind)};
    }
};

/// From the byte `at` of each face on.
template <int kAxis, int kPart>
SURFELAO_MASK_INLINE void add_first(const MaskRaster& raster, int at, Bytes front, Bytes back,
                                    ByteSum* sum)
{
    const auto faces = FacePair::of<2, kPart>(front, back);
    sum[kAxis].add(faces.more, raster.first[0][kPart] + at);
    sum[(kAxis + 1) % 3].add(faces.both, raster.first[1][kPart] + at);
    sum[(kAxis + 2) % 3].add(faces.both, raster.first[2][kPart] + at);
}

template <int kAxis, int kRows>
SURFELAO_MASK_INLINE void add_first(const MaskRaster& raster, const std::uint32_t* mask, int row,
                                    ByteSum* sum)
{
    const Bytes front = load_bytes(mask + 2 * kAxis * kRows + row);
    const Bytes back = load_bytes(mask + (2 * kAxis + 1) * kRows + row);
    add_first<kAxis, 0>(raster, 4 * row, front, back, sum);
    add_first<kAxis, 1>(raster, 4 * row, front, back, sum);
    add_first<kAxis, 2>(raster, 4 * row, front, back, sum);
    add_first<kAxis, 3>(raster, 4 * row, front, back, sum);
}

/// Whether a register holds both faces of an axis: then the table knows the sign of each.
template <int kRows>
constexpr bool kHoldsPair = kByteRows == 2 * kRows;

template <int kAxis, int kPart>
SURFELAO_MASK_INLINE void add_first_of_pair(const MaskRaster& raster, Bytes pair, ByteSum* sum)
{
    const Bytes set = counts<2, kPart>(pair);
    sum[kAxis].add(set, raster.first[0][kPart]);
    sum[(kAxis + 1) % 3].add(set, raster.first[1][kPart]);
    sum[(kAxis + 2) % 3].add(set, raster.first[2][kPart]);
}

template <int kAxis>
SURFELAO_MASK_INLINE void add_first_of_pair(const MaskRaster& raster, const std::uint32_t* mask,
                                            ByteSum* sum)
{
    const Bytes pair = load_bytes(mask + kAxis * kByteRows);
    add_first_of_pair<kAxis, 0>(raster, pair, sum);
    add_first_of_pair<kAxis, 1>(raster, pair, sum);
    add_first_of_pair<kAxis, 2>(raster, pair, sum);
    add_first_of_pair<kAxis, 3>(raster, pair, sum);
}

/// As many rows at a time as a register holds: their sums stay in registers.
template <int kRows>
SURFELAO_MASK_INLINE void add_first(const MaskRaster& raster, const std::uint32_t* mask,
                                    ByteSum* sum)
{
    ByteSum part[3] = {};
    if constexpr (kHoldsPair<kRows>) {
        add_first_of_pair<0>(raster, mask, part);
        add_first_of_pair<1>(raster, mask, part);
        add_first_of_pair<2>(raster, mask, part);
    } else {
#pragma GCC unroll 1
        for (int row = 0; row < kRows; row += kByteRows) {
            add_first<0, kRows>(raster, mask, row, part);
            add_first<1, kRows>(raster, mask, row, part);
            add_first<2, kRows>(raster, mask, row, part);
        }
    }
    for (int k = 0; k < 3; ++k)
        sum[k] = part[k];
}

SURFELAO_MASK_INLINE void add_first(const MaskRaster& raster, const std::uint32_t* mask,
                                    ByteSum* sum)
{
    if (raster.rows == kMaskRows)
        add_first<kMaskRows>(raster, mask, sum);
    else
        add_first<kMaskCoarseRows>(raster, mask, sum);
}

/// Whether FacePair::more of a face's own rows was summed up.
SURFELAO_MASK_INLINE bool has_more(const MaskRaster& raster)
{
    return raster.rows == kMaskRows ? !kHoldsPair<kMaskRows> : !kHoldsPair<kMaskCoarseRows>;
}

SURFELAO_MASK_INLINE First first_of(const MaskRaster& raster, const std::int32_t* totals)
{
    First first;
    const std::int32_t more = has_more(raster) ? 2 * raster.first_sum[0] : 0;
    for (int k = 0; k < 3; ++k)
        first.at[k] = totals[k] - more;
    return first;
}

inline First first_moments(const MaskRaster& raster, const std::uint32_t* mask)
{
    ByteSum sum[6] = {};
    add_first(raster, mask, sum);
    std::int32_t totals[6];
    total(sum, totals);
    return first_of(raster, totals);
}

/// Of two masks.
inline void first_moments(const MaskRaster& raster, const std::uint32_t* a, const std::uint32_t* b,
                          First& of_a, First& of_b)
{
    ByteSum sum[6];
    add_first(raster, a, sum);
    add_first(raster, b, sum + 3);
    std::int32_t totals[6];
    total(sum, totals);
    of_a = first_of(raster, totals);
    of_b = first_of(raster, totals + 3);
}

/// Products of axes i and i + 1 stand at 3 + i.
template <int kAxis, int kPart>
SURFELAO_MASK_INLINE void add_second(const MaskRaster& raster, int at, Bytes front, Bytes back,
                                     ByteSum* sum)
{
    constexpr int u = (kAxis + 1) % 3, v = (kAxis + 2) % 3;
    const auto faces = FacePair::of<4, kPart>(front, back);
    sum[kAxis].add(faces.both, raster.second[0][kPart] + at);
    sum[3 + kAxis].add(faces.more, raster.second[1][kPart] + at);
    sum[3 + v].add(faces.more, raster.second[2][kPart] + at);
    sum[u].add(faces.both, raster.second[3][kPart] + at);
    sum[3 + u].add(faces.both, raster.second[4][kPart] + at);
    sum[v].add(faces.both, raster.second[5][kPart] + at);
}

template <int kAxis, int kRows>
SURFELAO_MASK_INLINE void add_second(const MaskRaster& raster, const std::uint32_t* mask, int row,
                                     ByteSum* sum)
{
    const Bytes front = load_bytes(mask + 2 * kAxis * kRows + row);
    const Bytes back = load_bytes(mask + (2 * kAxis + 1) * kRows + row);
    add_second<kAxis, 0>(raster, 4 * row, front, back, sum);
    add_second<kAxis, 1>(raster, 4 * row, front, back, sum);
}

template <int kAxis, int kPart>
SURFELAO_MASK_INLINE void add_second_of_pair(const MaskRaster& raster, Bytes pair, ByteSum* sum)
{
    constexpr int u = (kAxis + 1) % 3, v = (kAxis + 2) % 3;
    const Bytes set = counts<4, kPart>(pair);
    sum[kAxis].add(set, raster.second[0][kPart]);
    sum[3 + kAxis].add(set, raster.second[1][kPart]);
    sum[3 + v].add(set, raster.second[2][kPart]);
    sum[u].add(set, raster.second[3][kPart]);
    sum[3 + u].add(set, raster.second[4][kPart]);
    sum[v].add(set, raster.second[5][kPart]);
}

template <int kAxis>
SURFELAO_MASK_INLINE void add_second_of_pair(const MaskRaster& raster, const std::uint32_t* mask,
                                             ByteSum* sum)
{
    const Bytes pair = load_bytes(mask + kAxis * kByteRows);
    add_second_of_pair<kAxis, 0>(raster, pair, sum);
    add_second_of_pair<kAxis, 1>(raster, pair, sum);
}

template <int kRows>
SURFELAO_MASK_INLINE void add_second(const MaskRaster& raster, const std::uint32_t* mask,
                                     ByteSum* sum)
{
    if constexpr (kHoldsPair<kRows>) {
        add_second_of_pair<0>(raster, mask, sum);
        add_second_of_pair<1>(raster, mask, sum);
        add_second_of_pair<2>(raster, mask, sum);
    } else {
#pragma GCC unroll 1
        for (int row = 0; row < kRows; row += kByteRows) {
            add_second<0, kRows>(raster, mask, row, sum);
            add_second<1, kRows>(raster, mask, row, sum);
            add_second<2, kRows>(raster, mask, row, sum);
        }
    }
}

inline Second second_moments(const MaskRaster& raster, const std::uint32_t* mask)
{
    ByteSum sum[6] = {};
    if (raster.rows == kMaskRows)
        add_second<kMaskRows>(raster, mask, sum);
    else
        add_second<kMaskCoarseRows>(raster, mask, sum);
    Second second;
    total(sum, second.at);
    const std::int32_t more =
        has_more(raster) ? 4 * (raster.second_sum[1] + raster.second_sum[2]) : 0;
    for (int k = 0; k < 3; ++k)
        second.at[3 + k] -= more;
    return second;
}

/// Above the horizon and not covered.
SURFELAO_MASK_INLINE void open_bits(const MaskRaster& raster, const std::uint32_t* above,
                                    const std::uint32_t* mask, std::uint32_t* open)
{
    for (int w = 0; w < raster.words; w += kLanes)
        store(open + w, load(above + w) & ~load(mask + w));
}

}  // namespace
}  // namespace surfelao::SURFELAO_MASK_ISA
