/// simd_avx512.h: sixteen lanes as one vector of AVX-512, with VNNI. simd.h tells all.
#pragma once

#include "tree/masks/simd_rows8.h"

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

namespace surfelao::SURFELAO_MASK_ISA {

struct Float16 {
    __m512 v;
};
struct Int16 {
    __m512i v;
};
/// One truth value a lane.
struct Bool16 {
    __mmask16 v;
};

SURFELAO_MASK_INLINE Float16 load(const float* p)
{
    return {_mm512_loadu_ps(p)};
}
SURFELAO_MASK_INLINE void store(float* p, Float16 a)
{
    _mm512_storeu_ps(p, a.v);
}
SURFELAO_MASK_INLINE Int16 load(const std::uint32_t* p)
{
    return {_mm512_loadu_si512(p)};
}
SURFELAO_MASK_INLINE void store(std::uint32_t* p, Int16 a)
{
    _mm512_storeu_si512(p, a.v);
}
SURFELAO_MASK_INLINE Float16 all(float a)
{
    return {_mm512_set1_ps(a)};
}
SURFELAO_MASK_INLINE Int16 all(std::uint32_t a)
{
    return {_mm512_set1_epi32(static_cast<int>(a))};
}

SURFELAO_MASK_INLINE Float16 operator+(Float16 a, Float16 b)
{
    return {_mm512_add_ps(a.v, b.v)};
}
SURFELAO_MASK_INLINE Float16 operator-(Float16 a, Float16 b)
{
    return {_mm512_sub_ps(a.v, b.v)};
}
SURFELAO_MASK_INLINE Float16 operator*(Float16 a, Float16 b)
{
    return {_mm512_mul_ps(a.v, b.v)};
}
/// a b + c
SURFELAO_MASK_INLINE Float16 fma(Float16 a, Float16 b, Float16 c)
{
    return {_mm512_fmadd_ps(a.v, b.v, c.v)};
}
/// a b - c
SURFELAO_MASK_INLINE Float16 fms(Float16 a, Float16 b, Float16 c)
{
    return {_mm512_fmsub_ps(a.v, b.v, c.v)};
}
SURFELAO_MASK_INLINE Float16 min(Float16 a, Float16 b)
{
    return {_mm512_min_ps(a.v, b.v)};
}
SURFELAO_MASK_INLINE Float16 max(Float16 a, Float16 b)
{
    return {_mm512_max_ps(a.v, b.v)};
}
SURFELAO_MASK_INLINE Float16 sqrt(Float16 a)
{
    return {_mm512_sqrt_ps(a.v)};
}
/// 1 / a to 1e-7: an estimate and one Newton step; a must be neither 0 nor denormal.
SURFELAO_MASK_INLINE Float16 reciprocal(Float16 a)
{
    const __m512 e = _mm512_rcp14_ps(a.v);
    return {_mm512_mul_ps(e, _mm512_fnmadd_ps(a.v, e, _mm512_set1_ps(2.0f)))};
}
/// 1 / sqrt(a) to 1e-7, a > 0.
SURFELAO_MASK_INLINE Float16 inverse_sqrt(Float16 a)
{
    const __m512 e = _mm512_rsqrt14_ps(a.v);
    const __m512 half = _mm512_mul_ps(_mm512_set1_ps(-0.5f), a.v);
    return {_mm512_mul_ps(e, _mm512_fmadd_ps(_mm512_mul_ps(half, e), e, _mm512_set1_ps(1.5f)))};
}

SURFELAO_MASK_INLINE Bool16 operator<(Float16 a, Float16 b)
{
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)};
}
SURFELAO_MASK_INLINE Bool16 operator>(Float16 a, Float16 b)
{
    return b < a;
}
SURFELAO_MASK_INLINE Bool16 operator&(Bool16 a, Bool16 b)
{
    return {static_cast<__mmask16>(a.v & b.v)};
}
SURFELAO_MASK_INLINE Bool16 operator|(Bool16 a, Bool16 b)
{
    return {static_cast<__mmask16>(a.v | b.v)};
}
/// a and not b
SURFELAO_MASK_INLINE Bool16 without(Bool16 a, Bool16 b)
{
    return {static_cast<__mmask16>(a.v & ~b.v)};
}
/// The lanes whose bits are set.
SURFELAO_MASK_INLINE Bool16 lanes_of(unsigned bits)
{
    return {static_cast<__mmask16>(bits)};
}
SURFELAO_MASK_INLINE unsigned bits(Bool16 a)
{
    return a.v;
}
SURFELAO_MASK_INLINE Float16 select(Bool16 m, Float16 yes, Float16 no)
{
    return {_mm512_mask_blend_ps(m.v, no.v, yes.v)};
}
SURFELAO_MASK_INLINE Int16 select(Bool16 m, Int16 yes, Int16 no)
{
    return {_mm512_mask_blend_epi32(m.v, no.v, yes.v)};
}

SURFELAO_MASK_INLINE Int16 operator&(Int16 a, Int16 b)
{
    return {_mm512_and_si512(a.v, b.v)};
}
SURFELAO_MASK_INLINE Int16 operator|(Int16 a, Int16 b)
{
    return {_mm512_or_si512(a.v, b.v)};
}
SURFELAO_MASK_INLINE Int16 operator^(Int16 a, Int16 b)
{
    return {_mm512_xor_si512(a.v, b.v)};
}
SURFELAO_MASK_INLINE Int16 operator~(Int16 a)
{
    return {_mm512_ternarylogic_epi32(a.v, a.v, a.v, 0x55)};
}
/// a and (b xor c)
SURFELAO_MASK_INLINE Int16 and_xor(Int16 a, Int16 b, Int16 c)
{
    return {_mm512_ternarylogic_epi32(a.v, b.v, c.v, 0x60)};
}
template <int kBy>
SURFELAO_MASK_INLINE Int16 shift_left(Int16 a)
{
    return {_mm512_slli_epi32(a.v, kBy)};
}
template <int kBy>
SURFELAO_MASK_INLINE Int16 shift_right(Int16 a)
{
    return {_mm512_srli_epi32(a.v, kBy)};
}
/// Lane i gets lane i-1 (i+1); lane 0 (15) gets zero.
SURFELAO_MASK_INLINE Int16 from_below(Int16 a)
{
    return {_mm512_alignr_epi32(a.v, _mm512_setzero_si512(), 15)};
}
SURFELAO_MASK_INLINE Int16 from_above(Int16 a)
{
    return {_mm512_alignr_epi32(_mm512_setzero_si512(), a.v, 1)};
}
/// All ones where the lane is not zero.
SURFELAO_MASK_INLINE Bool16 nonzero(Int16 a)
{
    return {_mm512_test_epi32_mask(a.v, a.v)};
}
SURFELAO_MASK_INLINE Int16 as_int(Float16 a)
{
    return {_mm512_castps_si512(a.v)};
}
SURFELAO_MASK_INLINE Float16 as_float(Int16 a)
{
    return {_mm512_castsi512_ps(a.v)};
}
/// All 32 bits from bit ceil(at - shift) upward, to within rounding: all for what is negative or
/// NaN, none for what is above 31.
SURFELAO_MASK_INLINE Int16 bits_from(Float16 at, Float16 shift)
{
    const __m512i from =
        _mm512_cvt_roundps_epu32(_mm512_max_ps((at - shift).v, _mm512_setzero_ps()),
                                 _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC);
    return {_mm512_sllv_epi32(_mm512_set1_epi32(-1), from)};
}
/// The first or the last eight rows.
SURFELAO_MASK_INLINE Int8 half_of(Int16 a, bool upper)
{
    return {upper ? _mm512_extracti64x4_epi64(a.v, 1) : _mm512_castsi512_si256(a.v)};
}
/// The chosen lanes, moved together to the front; what follows them is undefined.
SURFELAO_MASK_INLINE Float16 pack(Float16 a, Bool16 m)
{
    return {_mm512_maskz_compress_ps(m.v, a.v)};
}
SURFELAO_MASK_INLINE Int16 pack(Int16 a, Bool16 m)
{
    return {_mm512_maskz_compress_epi32(m.v, a.v)};
}

/// Sixteen records of sixteen floats to sixteen vectors, one per field.
SURFELAO_MASK_INLINE void load_transposed(const float* base, const std::uint32_t* index,
                                          Float16* field)
{
    __m512 a[16], b[16];
    for (int i = 0; i < 16; ++i)
        a[i] = _mm512_load_ps(base + 16 * static_cast<std::size_t>(index[i]));
    for (int i = 0; i < 16; i += 2) {
        b[i] = _mm512_unpacklo_ps(a[i], a[i + 1]);
        b[i + 1] = _mm512_unpackhi_ps(a[i], a[i + 1]);
    }
    for (int i = 0; i < 16; i += 4) {
        const auto lo = [](__m512 x, __m512 y) {
            return _mm512_castpd_ps(_mm512_unpacklo_pd(_mm512_castps_pd(x), _mm512_castps_pd(y)));
        };
        const auto hi = [](__m512 x, __m512 y) {
            return _mm512_castpd_ps(_mm512_unpackhi_pd(_mm512_castps_pd(x), _mm512_castps_pd(y)));
        };
        a[i] = lo(b[i], b[i + 2]);
        a[i + 1] = hi(b[i], b[i + 2]);
        a[i + 2] = lo(b[i + 1], b[i + 3]);
        a[i + 3] = hi(b[i + 1], b[i + 3]);
    }
    for (int i = 0; i < 4; ++i) {
        b[i] = _mm512_shuffle_f32x4(a[i], a[i + 4], 0x88);
        b[i + 4] = _mm512_shuffle_f32x4(a[i], a[i + 4], 0xdd);
        b[i + 8] = _mm512_shuffle_f32x4(a[i + 8], a[i + 12], 0x88);
        b[i + 12] = _mm512_shuffle_f32x4(a[i + 8], a[i + 12], 0xdd);
    }
    for (int i = 0; i < 4; ++i) {
        field[i] = {_mm512_shuffle_f32x4(b[i], b[i + 8], 0x88)};
        field[i + 8] = {_mm512_shuffle_f32x4(b[i], b[i + 8], 0xdd)};
        field[i + 4] = {_mm512_shuffle_f32x4(b[i + 4], b[i + 12], 0x88)};
        field[i + 12] = {_mm512_shuffle_f32x4(b[i + 4], b[i + 12], 0xdd)};
    }
}

/// As many rows of a face as a register holds, and a small number for each of their bytes.
constexpr int kByteRows = 16;
struct Bytes {
    __m512i v;
};
SURFELAO_MASK_INLINE Bytes operator+(Bytes a, Bytes b)
{
    return {_mm512_add_epi8(a.v, b.v)};
}
SURFELAO_MASK_INLINE Bytes operator-(Bytes a, Bytes b)
{
    return {_mm512_sub_epi8(a.v, b.v)};
}
SURFELAO_MASK_INLINE Bytes operator&(Bytes a, Bytes b)
{
    return {_mm512_and_si512(a.v, b.v)};
}
SURFELAO_MASK_INLINE Bytes all_bytes(std::uint32_t four)
{
    return {_mm512_set1_epi32(static_cast<int>(four))};
}
/// Byte 4 i + k stands at bits 8 k .. + 7 of row i.
SURFELAO_MASK_INLINE Bytes load_bytes(const std::uint32_t* rows)
{
    return {_mm512_loadu_si512(rows)};
}
/// Row by row.
template <int kBy>
SURFELAO_MASK_INLINE Bytes shift_right(Bytes a)
{
    return {_mm512_srli_epi32(a.v, kBy)};
}
/// Set bits of each byte; all are below 16.
SURFELAO_MASK_INLINE Bytes nibble_counts(Bytes a)
{
    const __m128i count = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
    return {_mm512_shuffle_epi8(_mm512_broadcast_i32x4(count), a.v)};
}
/// Sum of products of bytes with table entries of 7 bits and a sign.
struct ByteSum {
    __m512i v;

    /// All that is added must not exceed 48 a byte, so that no instruction set overflows.
    SURFELAO_MASK_INLINE void add(Bytes a, const std::int8_t* table)
    {
        v = _mm512_dpbusd_epi32(v, a.v, _mm512_load_si512(table));
    }
};
SURFELAO_MASK_INLINE void total(const ByteSum (&sum)[6], std::int32_t (&out)[6])
{
    __m128i x[6];
    for (int i = 0; i < 6; ++i) {
        const __m256i half = _mm256_add_epi32(_mm512_castsi512_si256(sum[i].v),
                                              _mm512_extracti64x4_epi64(sum[i].v, 1));
        x[i] = _mm_add_epi32(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
    }
    const __m128i last = _mm_hadd_epi32(x[4], x[5]);
    const __m128i first = _mm_hadd_epi32(_mm_hadd_epi32(x[0], x[1]), _mm_hadd_epi32(x[2], x[3]));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out), first);
    _mm_storel_epi64(reinterpret_cast<__m128i*>(out + 4), _mm_hadd_epi32(last, last));
}

}  // namespace surfelao::SURFELAO_MASK_ISA
