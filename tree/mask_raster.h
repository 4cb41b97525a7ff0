/// mask_raster.h: the directions that the bits of a mask stand for, and what each bit weighs.
///
/// A mask has six faces of a cube around the receiver, +x -x +y -y +z -z, 16 rows of 32 bits each:
///
///     direction of bit (face, row y, column x)  ~  a + u(x, y) U + v(y) V
///     a = +-1 on the face's axis;  (axis, U, V) = (x, y, z), (y, z, x), (z, x, y)
///     u = (x + shift(y)) / 16 - 1,  v = tan of equal angles from -45 to 45 degrees
///
/// Each row is shifted by its own part of a column (multiples of the golden ratio), so that upright
/// edges are sampled at 512 places and not at 32.
///
/// Sums over bits are sums of small integers (weights of 8 bits times coordinates of 7), so every
/// kernel gets the same ones.
#pragma once

#include <cstdint>

namespace surfelao {

constexpr int kMaskFaces = 6;
constexpr int kMaskRows = 16;
constexpr int kMaskFaceWords = kMaskRows;  ///< one 32-bit word a row
constexpr int kMaskWords = 128;            ///< six faces, and two unused: offsets add by `or`
/// What is drawn is a pair of masks: all that is set, and what of it clusters set, whose rims are
/// not where the surface ends.
constexpr int kMaskPairWords = 2 * kMaskWords;
constexpr int kMaskFaceBits = 32 * kMaskRows;

struct alignas(64) MaskRaster {
    float row_v[kMaskRows];
    float row_shift[kMaskRows];               ///< in columns, [0, 1)
    std::uint32_t below_is_right[kMaskRows];  ///< ~0 where row y-1 is shifted further than row y
    std::uint32_t above_is_right[kMaskRows];  ///< ~0 where row y+1 is shifted further than row y

    /// Per bit of a face. First order: solid angle / length, for integrals of (n.w). Second order:
    /// solid angle / length^2, for integrals of w (n.w). Length of the direction as written above.
    std::uint8_t weight1[kMaskFaceBits];
    std::uint8_t weight2[kMaskFaceBits];
    /// Coordinates of the bit's direction and their products, times 127 (and negated).
    std::int8_t one[2][kMaskFaceBits];
    std::int8_t u[2][kMaskFaceBits];
    std::int8_t v[2][kMaskFaceBits];
    std::int8_t uu[kMaskFaceBits];
    std::int8_t uv[kMaskFaceBits];
    std::int8_t vv[kMaskFaceBits];

    /// The same for the kernels that look up four bits at a time: sums over the set bits of the
    /// nibble `value` at bits 4 k .. 4 k + 3 of row y, at [y][k][value].
    std::int32_t sum1[kMaskRows][8][16][4];  ///< weight1 times 127, u, v, 0
    std::int32_t sum2[kMaskRows][8][16][8];  ///< weight2 times 127, u, v, uu, uv, vv, 0, 0
};

/// Made at the first call; any thread.
const MaskRaster& mask_raster();

}  // namespace surfelao
