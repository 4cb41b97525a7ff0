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

constexpr std::size_t kFloat4Lanes = 4;

/// GCC's and Clang's own vectors: + - * / and comparisons lane by lane, a ? b : c chooses by lane.
using Float4 [[gnu::vector_size(16)]] = float;
using Bool4 [[gnu::vector_size(16)]] = std::int32_t;  ///< -1 = true, 0 = false

inline Float4 load_lanes(const float* values)
{
    Float4 lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    return lanes;
}

inline Float4 all_lanes(float value)
{
    return Float4{value, value, value, value};
}

inline Float4 least(Float4 a, Float4 b)
{
    return a < b ? a : b;
}

inline Float4 most(Float4 a, Float4 b)
{
    return a > b ? a : b;
}

inline Float4 absolute(Float4 a)
{
    return most(a, -a);
}

/// `size` with the sign of `sign`, zeros' too.
inline Float4 with_sign(Float4 size, Float4 sign)
{
    const Bool4 bit = {INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN};
    return reinterpret_cast<Float4>((reinterpret_cast<Bool4>(size) & ~bit) |
                                    (reinterpret_cast<Bool4>(sign) & bit));
}

inline Float4 root(Float4 a)
{
    for (std::size_t i = 0; i < kFloat4Lanes; ++i)
        a[i] = std::sqrt(a[i]);
    return a;
}

/// Rows become columns.
inline void transpose(Float4& a, Float4& b, Float4& c, Float4& d)
{
    const Float4 ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
    const Float4 ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const Float4 cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const Float4 cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
    b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
    c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
    d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

}  // namespace surfelao
