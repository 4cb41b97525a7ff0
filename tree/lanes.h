/// lanes.h: four floats as one value, in what every processor of a 64-bit machine has.
///
/// For loops that compilers do not turn into vector instructions by themselves. The same results as
/// with single floats. Not for the mask kernels, which are compiled for wider sets
/// (tree/masks/simd.h).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace surfelao {

constexpr std::size_t kLaneCount = 4;

/// GCC's and Clang's own vectors: + - * / and comparisons lane by lane, a ? b : c chooses by lane.
using Lanes [[gnu::vector_size(16)]] = float;
using LaneMask [[gnu::vector_size(16)]] = std::int32_t;  ///< -1 = true, 0 = false

inline Lanes load_lanes(const float* values)
{
    Lanes lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    return lanes;
}

inline Lanes all_lanes(float value)
{
    return Lanes{value, value, value, value};
}

inline Lanes least(Lanes a, Lanes b)
{
    return a < b ? a : b;
}

inline Lanes most(Lanes a, Lanes b)
{
    return a > b ? a : b;
}

inline Lanes absolute(Lanes a)
{
    return most(a, -a);
}

/// `size` with the sign of `sign`, zeros' too.
inline Lanes with_sign(Lanes size, Lanes sign)
{
    const LaneMask bit = {INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN};
    return reinterpret_cast<Lanes>((reinterpret_cast<LaneMask>(size) & ~bit) |
                                   (reinterpret_cast<LaneMask>(sign) & bit));
}

inline Lanes root(Lanes a)
{
    for (std::size_t i = 0; i < kLaneCount; ++i)
        a[i] = std::sqrt(a[i]);
    return a;
}

/// Rows become columns.
inline void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d)
{
    const Lanes ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const Lanes ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const Lanes cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const Lanes cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
    b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
    c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
    d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

}  // namespace surfelao
