/// simd_rows8.h: eight rows as one vector of AVX2, with FMA; of simd_avx2.h and simd_avx512.h.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace surfelao::SURFELAO_MASK_ISA {

struct Float8 {
    __m256 v;
};
struct Int8 {
    __m256i v;
};

SURFELAO_MASK_INLINE __m256i bits_from8(__m256 at, __m256 shift)
{
    // the nearest to half a column more is what rounding up gives, but next to whole columns, and
    // the half is taken off the shift, which is the same for many; the second operand is what comes
    // out for NaN; what no integer holds becomes 2^31, and by so much, as by all above 31,
    // everything is shifted out
    const __m256 half = _mm256_set1_ps(0.49999f);
    const __m256 from = _mm256_sub_ps(at, _mm256_sub_ps(shift, half));
    return _mm256_sllv_epi32(_mm256_set1_epi32(-1),
                             _mm256_cvtps_epi32(_mm256_max_ps(from, _mm256_setzero_ps())));
}
SURFELAO_MASK_INLINE Int8 bits_from(Float8 at, Float8 shift)
{
    return {bits_from8(at.v, shift.v)};
}
SURFELAO_MASK_INLINE Float8 fma(Float8 x, Float8 y, Float8 z)
{
    return {_mm256_fmadd_ps(x.v, y.v, z.v)};
}
SURFELAO_MASK_INLINE Int8 and_xor(Int8 x, Int8 y, Int8 z)
{
    return {_mm256_and_si256(x.v, _mm256_xor_si256(y.v, z.v))};
}
SURFELAO_MASK_INLINE Int8 operator&(Int8 x, Int8 y)
{
    return {_mm256_and_si256(x.v, y.v)};
}
SURFELAO_MASK_INLINE Int8 operator|(Int8 x, Int8 y)
{
    return {_mm256_or_si256(x.v, y.v)};
}
SURFELAO_MASK_INLINE void store(std::uint32_t* p, Int8 x)
{
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), x.v);
}
SURFELAO_MASK_INLINE void load_rows(const float* p, Float8& x)
{
    x = {_mm256_loadu_ps(p)};
}
SURFELAO_MASK_INLINE void load_rows(const std::uint32_t* p, Int8& x)
{
    x = {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))};
}
SURFELAO_MASK_INLINE void fill_rows(float a, Float8& x)
{
    x = {_mm256_set1_ps(a)};
}
SURFELAO_MASK_INLINE void fill_rows(std::uint32_t a, Int8& x)
{
    x = {_mm256_set1_epi32(static_cast<int>(a))};
}

}  // namespace surfelao::SURFELAO_MASK_ISA
