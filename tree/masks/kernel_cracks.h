/// kernel_cracks.h: clear bits between sheets that are no openings (part of kernel_body.h).
///
/// Sixteen rows of one face at a time; nothing is set outside of the face.
#pragma once

#include "tree/masks/constants.h"
#include "tree/masks/raster.h"
#include "tree/masks/simd.h"

namespace surfelao::SURFELAO_MASK_ISA {
namespace {

/// Of each bit's neighbours left and right, and of those above and below, of which each is the two
/// nearest in direction.
struct Beside {
    Int16 sides, stacked;
};

/// Rows below and above within the face, and what of them is the second nearest.
struct Stacked {
    Int16 low, low_side, high, high_side;
};

SURFELAO_MASK_INLINE Stacked stacked(const MaskRaster& raster, Int16 m)
{
    const Int16 low = from_below(m) & load(raster.has_below);
    const Int16 high = from_above(m) & load(raster.has_above);
    const Bool16 low_right = nonzero(load(raster.below_is_right));
    const Bool16 high_right = nonzero(load(raster.above_is_right));
    return {low, select(low_right, shift_left<1>(low), shift_right<1>(low)), high,
            select(high_right, shift_left<1>(high), shift_right<1>(high))};
}

SURFELAO_MASK_INLINE Beside all_beside(const MaskRaster& raster, Int16 m)
{
    const Stacked near = stacked(raster, m);
    return {shift_left<1>(m) & shift_right<1>(m),
            near.low & near.low_side & near.high & near.high_side};
}

SURFELAO_MASK_INLINE Beside any_beside(const MaskRaster& raster, Int16 m)
{
    const Stacked near = stacked(raster, m);
    return {shift_left<1>(m) | shift_right<1>(m),
            near.low | near.low_side | near.high | near.high_side};
}

/// A clear bit is a crack between two patches where its neighbours left and right are set, or those
/// above and below, and a sheet set one of them. No half-plane, nor any convex shape, is changed by
/// that. m: set bits; sheets: what of it sheets set.
SURFELAO_MASK_INLINE Int16 fill(const MaskRaster& raster, Int16 m, Int16 sheets)
{
    const Beside set = all_beside(raster, m), by_sheets = any_beside(raster, sheets);
    return m | (set.sides & by_sheets.sides) | (set.stacked & by_sheets.stacked);
}

/// The bits that are a crack, if clear, wherever they are: all of their neighbours are set.
SURFELAO_MASK_INLINE Int16 pinholes(const MaskRaster& raster, Int16 m, Int16 sheets)
{
    const Beside set = all_beside(raster, m), by_sheets = any_beside(raster, sheets);
    return set.sides & set.stacked & (by_sheets.sides | by_sheets.stacked);
}

/// Of the open bits those that are no cracks: what filling has left open and what touches it. A
/// notch in the rim of an opening is most likely part of it.
SURFELAO_MASK_INLINE Int16 openings(const MaskRaster& raster, Int16 open, Int16 filled)
{
    const Int16 left = ~filled;
    return open & (left | shift_left<1>(left) | shift_right<1>(left) |
                   (from_below(left) & load(raster.has_below)) |
                   (from_above(left) & load(raster.has_above)));
}

/// Closes cracks of two bits too, for places where nearly all is covered: what is set is grown by
/// one bit along the rows, then across them, and shrunk again. Only beside bits that sheets set.
SURFELAO_MASK_INLINE Int16 close(const MaskRaster& raster, Int16 m, Int16 sheets)
{
    const auto grown_across = [&](Int16 x) {
        const Stacked near = stacked(raster, x);
        return x | near.low | near.low_side | near.high | near.high_side;
    };
    const auto shrunk_across = [&](Int16 x) {
        const Stacked near = stacked(raster, x);
        return x & near.low & near.low_side & near.high & near.high_side;
    };
    const Int16 wide = m | shift_left<1>(m) | shift_right<1>(m);
    const Int16 rows = wide & shift_left<1>(wide) & shift_right<1>(wide);
    const Int16 columns = shrunk_across(grown_across(m));
    const Int16 near = grown_across(sheets | shift_left<1>(sheets) | shift_right<1>(sheets));
    return m | ((rows | columns) & near);
}

/// Whether next to nothing is open, once cracks are filled and closed. closed: what lies below the
/// horizon is set.
inline bool is_closed(const MaskRaster& raster, const std::uint32_t* closed, const float* n)
{
    // the face right ahead tells most others apart
    const float x = n[0] < 0.0f ? -n[0] : n[0];
    const float y = n[1] < 0.0f ? -n[1] : n[1];
    const float z = n[2] < 0.0f ? -n[2] : n[2];
    const int axis = x > y && x > z ? 0 : y > z ? 1 : 2;
    const int ahead = 2 * axis + (n[axis] < 0.0f ? 1 : 0);
    const Int16 holes = ~load(closed + raster.rows * ahead / kLanes * kLanes);
    const int most = kMaskOpenBits * raster.rows / kMaskRows;
    if (__builtin_popcount(bits(nonzero(holes))) > most)
        return false;
    int open = 0;
    for (int w = 0; w < raster.words; w += kLanes) {
        const Int16 sheets = load(closed + kMaskWords + w);
        const Int16 filled = fill(raster, load(closed + w), sheets);
        alignas(64) std::uint32_t rows[kLanes];
        store(rows, ~close(raster, filled, sheets));
        for (const std::uint32_t row : rows)
            open += __builtin_popcount(row);
        if (open > most)
            return false;
    }
    return true;
}

}  // namespace
}  // namespace surfelao::SURFELAO_MASK_ISA
