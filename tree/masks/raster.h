/// raster.h: the directions that the bits of a mask stand for, and what each bit weighs.
///
/// A mask has six faces of a cube around the receiver, +x -x +y -y +z -z, 16 rows of 32 bits each:
///
///     direction of bit (face, row y, column x)  ~  a + u(x, y) U + v(y) V
///     a = +-1 on the face's axis;  (axis, U, V) = (x, y, z), (y, z, x), (z, x, y)
///     u = (x + shift(y)) / 16 - 1,  v = tan of equal angles from -45 to 45 degrees
///
/// The coarse raster has eight rows a face; its masks' words lie as close: 48 instead of 96.
///
/// Each row is shifted by its own part of a column (multiples of the golden ratio), so that upright
/// edges are sampled at 512 places and not at 32.
///
/// Sums over bits count them by twos and fours in a row and multiply by integers of 7 bits: every
/// kernel gets the same ones.
#pragma once

#include <cstdint>

namespace surfelao {

constexpr int kMaskFaces = 6;
constexpr int kMaskRows = 16;              ///< of a face
constexpr int kMaskCoarseRows = 8;         ///< of a face of the coarse raster
constexpr int kMaskFaceWords = kMaskRows;  ///< one 32-bit word a row; at most
constexpr int kMaskWords = 128;            ///< six faces, and two unused: offsets add by `or`
/// What is drawn is a pair of masks: all that is set, and what of it sheets set, whose rims are
/// not where the surface ends.
constexpr int kMaskPairWords = 2 * kMaskWords;
constexpr int kMaskFaceBytes = 4 * kMaskRows;

struct alignas(64) MaskRaster {
    int rows;   ///< of a face: kMaskRows or kMaskCoarseRows
    int words;  ///< of the six faces, one a row

    // sixteen rows: those of a face, or of both of an axis, + before -
    alignas(64) float side[2][kMaskRows];  ///< of even and odd sixteen rows: the face's a
    float row_v[kMaskRows];
    float row_shift[kMaskRows];               ///< in columns, [0, 1)
    std::uint32_t has_below[kMaskRows];       ///< ~0 where row y-1 is of the same face
    std::uint32_t has_above[kMaskRows];       ///< ~0 where row y+1 is
    std::uint32_t below_is_right[kMaskRows];  ///< ~0 where row y-1 is shifted further than row y
    std::uint32_t above_is_right[kMaskRows];  ///< ~0 where row y+1 is shifted further than row y

    /// What a bit is worth, times 127, as the mean over its neighbours in a row: two of them for
    /// the first moments, integrals of (n.w), and four for the second, integrals of w (n.w), of
    /// which only a direction is made. [moment][part][byte]: byte i of a face's 64 stands at bits
    /// 8 (i mod 4) .. + 7 of row i / 4, and part 0 is its lowest two or four bits.
    ///
    /// First: solid angle / length times 1, u, v; length is that of the direction as written above.
    /// Second: solid angle / length^2 times 1, u, v, uu, uv, vv.
    ///
    /// Of eight rows a face's 32 bytes come first; behind them stand those of the face opposite,
    /// which what changes its sign with the axis has negative: 1 of the first moments, u and v of
    /// the second.
    alignas(64) std::int8_t first[3][4][kMaskFaceBytes];
    alignas(64) std::int8_t second[6][2][kMaskFaceBytes];

    /// Sums over all parts and bytes of one face.
    std::int32_t first_sum[3];
    std::int32_t second_sum[6];
};

/// rows: kMaskRows or kMaskCoarseRows. Made at the first call; any thread.
const MaskRaster& mask_raster(int rows = kMaskRows);

}  // namespace surfelao
