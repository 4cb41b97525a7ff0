/// simd.h: vectors of 16 lanes for the mask kernels, in three instruction sets.
///
/// Only for kernel_avx512.cpp, _avx2.cpp and _portable.cpp: each is compiled with its own flags,
/// and everything here lives in a namespace of that instruction set (SURFELAO_MASK_ISA), so that no
/// code of a wide set can be linked into a narrow one. The same results in all three but for the
/// rounding of fused products and of reciprocals.
///
/// Float16 and Int16 are sixteen numbers, Bool16 sixteen truth values, Bytes as many small numbers
/// as a register has bytes, ByteSum a sum of products of such; simd_avx512.h says what each
/// operation does.
#pragma once

// All in one function, and checked at each step, would take a compiler minutes.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SURFELAO_MASK_INLINE inline
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SURFELAO_MASK_INLINE inline
#endif
#if !defined(SURFELAO_MASK_INLINE)
#define SURFELAO_MASK_INLINE [[gnu::always_inline]] inline
#endif

namespace surfelao::SURFELAO_MASK_ISA {

constexpr int kLanes = 16;

}  // namespace surfelao::SURFELAO_MASK_ISA

#if defined(__AVX512F__)
#include "tree/masks/simd_avx512.h"
#elif defined(__AVX2__)
#include "tree/masks/simd_avx2.h"
#else
#include "tree/masks/simd_portable.h"
#endif

namespace surfelao::SURFELAO_MASK_ISA {

SURFELAO_MASK_INLINE void load_rows(const float* p, Float16& x)
{
    x = load(p);
}
SURFELAO_MASK_INLINE void load_rows(const std::uint32_t* p, Int16& x)
{
    x = load(p);
}
SURFELAO_MASK_INLINE void fill_rows(float a, Float16& x)
{
    x = all(a);
}
SURFELAO_MASK_INLINE void fill_rows(std::uint32_t a, Int16& x)
{
    x = all(a);
}

/// The rows of one face: sixteen, or eight.
template <bool kCoarse>
struct RowTypes {
    using Floats = Float16;
    using Ints = Int16;
};
template <>
struct RowTypes<true> {
    using Floats = Float8;
    using Ints = Int8;
};

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
SURFELAO_MASK_INLINE Vector16 pack(Vector16 a, Bool16 chosen)
{
    return {pack(a.x, chosen), pack(a.y, chosen), pack(a.z, chosen)};
}
SURFELAO_MASK_INLINE Bool16 first_lanes(unsigned count)
{
    return lanes_of((1u << count) - 1u);
}
SURFELAO_MASK_INLINE unsigned count_of(Bool16 a)
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
SURFELAO_MASK_INLINE Bool16 negative(Int16 a)
{
    return nonzero(a & all(0x80000000u));
}

}  // namespace surfelao::SURFELAO_MASK_ISA
