/// simd.h: vectors of 16 lanes for the mask kernels, in three instruction sets.
///
/// Only for mask_kernel_*.cpp: each is compiled with its own flags, and everything here lives in a
/// namespace of that instruction set (SURFELAO_MASK_ISA), so that no code of a wide set can be
/// linked into a narrow one. The same results in all three but for the rounding of fused products.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

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

#if defined(__AVX512F__)

struct Float16 {
    __m512 v;
};
struct Int16 {
    __m512i v;
};
/// One truth value a lane.
struct Lanes {
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

SURFELAO_MASK_INLINE Lanes operator<(Float16 a, Float16 b)
{
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)};
}
SURFELAO_MASK_INLINE Lanes operator>(Float16 a, Float16 b)
{
    return b < a;
}
SURFELAO_MASK_INLINE Lanes operator&(Lanes a, Lanes b)
{
    return {static_cast<__mmask16>(a.v & b.v)};
}
SURFELAO_MASK_INLINE Lanes operator|(Lanes a, Lanes b)
{
    return {static_cast<__mmask16>(a.v | b.v)};
}
/// a and not b
SURFELAO_MASK_INLINE Lanes without(Lanes a, Lanes b)
{
    return {static_cast<__mmask16>(a.v & ~b.v)};
}
/// The lanes whose bits are set.
SURFELAO_MASK_INLINE Lanes lanes_of(unsigned bits)
{
    return {static_cast<__mmask16>(bits)};
}
SURFELAO_MASK_INLINE unsigned bits(Lanes a)
{
    return a.v;
}
SURFELAO_MASK_INLINE Float16 select(Lanes m, Float16 yes, Float16 no)
{
    return {_mm512_mask_blend_ps(m.v, no.v, yes.v)};
}
SURFELAO_MASK_INLINE Int16 select(Lanes m, Int16 yes, Int16 no)
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
SURFELAO_MASK_INLINE Lanes nonzero(Int16 a)
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
/// All 32 bits from bit ceil(a) upward: all for a <= 0 or NaN, none for a > 31.
SURFELAO_MASK_INLINE Int16 bits_from(Float16 a)
{
    const __m512i from = _mm512_cvt_roundps_epu32(_mm512_max_ps(a.v, _mm512_setzero_ps()),
                                                  _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC);
    return {_mm512_sllv_epi32(_mm512_set1_epi32(-1), from)};
}
/// The chosen lanes, moved together to the front; what follows them is undefined.
SURFELAO_MASK_INLINE Float16 pack(Float16 a, Lanes m)
{
    return {_mm512_maskz_compress_ps(m.v, a.v)};
}
SURFELAO_MASK_INLINE Int16 pack(Int16 a, Lanes m)
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

/// A small number for each byte of 16 words.
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
/// Byte 4 i + k of the result stands at bits 8 k .. + 7 of lane i.
SURFELAO_MASK_INLINE Bytes bytes_of(Int16 a)
{
    return {a.v};
}
/// Set bits of each byte; all are below 16.
SURFELAO_MASK_INLINE Bytes nibble_counts(Int16 a)
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

#elif defined(__AVX2__)

struct Float16 {
    __m256 a, b;
};
struct Int16 {
    __m256i a, b;
};
/// All bits of a lane are set or none.
struct Lanes {
    __m256 a, b;
};

SURFELAO_MASK_INLINE Float16 load(const float* p)
{
    return {_mm256_loadu_ps(p), _mm256_loadu_ps(p + 8)};
}
SURFELAO_MASK_INLINE void store(float* p, Float16 x)
{
    _mm256_storeu_ps(p, x.a);
    _mm256_storeu_ps(p + 8, x.b);
}
SURFELAO_MASK_INLINE Int16 load(const std::uint32_t* p)
{
    return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)),
            _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p + 8))};
}
SURFELAO_MASK_INLINE void store(std::uint32_t* p, Int16 x)
{
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), x.a);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p + 8), x.b);
}
SURFELAO_MASK_INLINE Float16 all(float x)
{
    return {_mm256_set1_ps(x), _mm256_set1_ps(x)};
}
SURFELAO_MASK_INLINE Int16 all(std::uint32_t x)
{
    const __m256i v = _mm256_set1_epi32(static_cast<int>(x));
    return {v, v};
}

SURFELAO_MASK_INLINE Float16 operator+(Float16 x, Float16 y)
{
    return {_mm256_add_ps(x.a, y.a), _mm256_add_ps(x.b, y.b)};
}
SURFELAO_MASK_INLINE Float16 operator-(Float16 x, Float16 y)
{
    return {_mm256_sub_ps(x.a, y.a), _mm256_sub_ps(x.b, y.b)};
}
SURFELAO_MASK_INLINE Float16 operator*(Float16 x, Float16 y)
{
    return {_mm256_mul_ps(x.a, y.a), _mm256_mul_ps(x.b, y.b)};
}
SURFELAO_MASK_INLINE Float16 fma(Float16 x, Float16 y, Float16 z)
{
    return {_mm256_fmadd_ps(x.a, y.a, z.a), _mm256_fmadd_ps(x.b, y.b, z.b)};
}
SURFELAO_MASK_INLINE Float16 fms(Float16 x, Float16 y, Float16 z)
{
    return {_mm256_fmsub_ps(x.a, y.a, z.a), _mm256_fmsub_ps(x.b, y.b, z.b)};
}
SURFELAO_MASK_INLINE Float16 min(Float16 x, Float16 y)
{
    return {_mm256_min_ps(x.a, y.a), _mm256_min_ps(x.b, y.b)};
}
SURFELAO_MASK_INLINE Float16 max(Float16 x, Float16 y)
{
    return {_mm256_max_ps(x.a, y.a), _mm256_max_ps(x.b, y.b)};
}
SURFELAO_MASK_INLINE Float16 sqrt(Float16 x)
{
    return {_mm256_sqrt_ps(x.a), _mm256_sqrt_ps(x.b)};
}
SURFELAO_MASK_INLINE __m256 reciprocal8(__m256 x)
{
    // twelve bits, then 23
    const __m256 e = _mm256_rcp_ps(x);
    return _mm256_mul_ps(e, _mm256_fnmadd_ps(x, e, _mm256_set1_ps(2.0f)));
}
SURFELAO_MASK_INLINE Float16 reciprocal(Float16 x)
{
    return {reciprocal8(x.a), reciprocal8(x.b)};
}
SURFELAO_MASK_INLINE __m256 inverse_sqrt8(__m256 x)
{
    const __m256 e = _mm256_rsqrt_ps(x);
    const __m256 half = _mm256_mul_ps(_mm256_set1_ps(-0.5f), x);
    return _mm256_mul_ps(e, _mm256_fmadd_ps(_mm256_mul_ps(half, e), e, _mm256_set1_ps(1.5f)));
}
SURFELAO_MASK_INLINE Float16 inverse_sqrt(Float16 x)
{
    return {inverse_sqrt8(x.a), inverse_sqrt8(x.b)};
}

SURFELAO_MASK_INLINE Lanes operator<(Float16 x, Float16 y)
{
    return {_mm256_cmp_ps(x.a, y.a, _CMP_LT_OQ), _mm256_cmp_ps(x.b, y.b, _CMP_LT_OQ)};
}
SURFELAO_MASK_INLINE Lanes operator>(Float16 x, Float16 y)
{
    return y < x;
}
SURFELAO_MASK_INLINE Lanes operator&(Lanes x, Lanes y)
{
    return {_mm256_and_ps(x.a, y.a), _mm256_and_ps(x.b, y.b)};
}
SURFELAO_MASK_INLINE Lanes operator|(Lanes x, Lanes y)
{
    return {_mm256_or_ps(x.a, y.a), _mm256_or_ps(x.b, y.b)};
}
SURFELAO_MASK_INLINE Lanes without(Lanes x, Lanes y)
{
    return {_mm256_andnot_ps(y.a, x.a), _mm256_andnot_ps(y.b, x.b)};
}
SURFELAO_MASK_INLINE Lanes lanes_of(unsigned bits)
{
    const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const auto half = [&](unsigned byte) {
        const __m256i chosen = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(byte)), lane);
        return _mm256_castsi256_ps(_mm256_cmpeq_epi32(chosen, lane));
    };
    return {half(bits & 255u), half(bits >> 8)};
}
SURFELAO_MASK_INLINE unsigned bits(Lanes x)
{
    return static_cast<unsigned>(_mm256_movemask_ps(x.a)) |
           static_cast<unsigned>(_mm256_movemask_ps(x.b)) << 8;
}
SURFELAO_MASK_INLINE Float16 select(Lanes m, Float16 yes, Float16 no)
{
    return {_mm256_blendv_ps(no.a, yes.a, m.a), _mm256_blendv_ps(no.b, yes.b, m.b)};
}
SURFELAO_MASK_INLINE Int16 as_int(Float16 x)
{
    return {_mm256_castps_si256(x.a), _mm256_castps_si256(x.b)};
}
SURFELAO_MASK_INLINE Float16 as_float(Int16 x)
{
    return {_mm256_castsi256_ps(x.a), _mm256_castsi256_ps(x.b)};
}
SURFELAO_MASK_INLINE Int16 select(Lanes m, Int16 yes, Int16 no)
{
    return as_int(select(m, as_float(yes), as_float(no)));
}
SURFELAO_MASK_INLINE Int16 operator&(Int16 x, Int16 y)
{
    return {_mm256_and_si256(x.a, y.a), _mm256_and_si256(x.b, y.b)};
}
SURFELAO_MASK_INLINE Int16 operator|(Int16 x, Int16 y)
{
    return {_mm256_or_si256(x.a, y.a), _mm256_or_si256(x.b, y.b)};
}
SURFELAO_MASK_INLINE Int16 operator^(Int16 x, Int16 y)
{
    return {_mm256_xor_si256(x.a, y.a), _mm256_xor_si256(x.b, y.b)};
}
SURFELAO_MASK_INLINE Int16 operator~(Int16 x)
{
    return x ^ all(~0u);
}
SURFELAO_MASK_INLINE Int16 and_xor(Int16 x, Int16 y, Int16 z)
{
    return x & (y ^ z);
}
template <int kBy>
SURFELAO_MASK_INLINE Int16 shift_left(Int16 x)
{
    return {_mm256_slli_epi32(x.a, kBy), _mm256_slli_epi32(x.b, kBy)};
}
template <int kBy>
SURFELAO_MASK_INLINE Int16 shift_right(Int16 x)
{
    return {_mm256_srli_epi32(x.a, kBy), _mm256_srli_epi32(x.b, kBy)};
}
SURFELAO_MASK_INLINE Int16 from_below(Int16 x)
{
    const __m256i turn = _mm256_setr_epi32(7, 0, 1, 2, 3, 4, 5, 6);
    const __m256i a = _mm256_permutevar8x32_epi32(x.a, turn);
    const __m256i b = _mm256_permutevar8x32_epi32(x.b, turn);
    return {_mm256_blend_epi32(a, _mm256_setzero_si256(), 1), _mm256_blend_epi32(b, a, 1)};
}
SURFELAO_MASK_INLINE Int16 from_above(Int16 x)
{
    const __m256i turn = _mm256_setr_epi32(1, 2, 3, 4, 5, 6, 7, 0);
    const __m256i a = _mm256_permutevar8x32_epi32(x.a, turn);
    const __m256i b = _mm256_permutevar8x32_epi32(x.b, turn);
    return {_mm256_blend_epi32(a, b, 0x80), _mm256_blend_epi32(b, _mm256_setzero_si256(), 0x80)};
}
SURFELAO_MASK_INLINE Lanes nonzero(Int16 x)
{
    const __m256i zero = _mm256_setzero_si256();
    const __m256i ones = _mm256_set1_epi32(-1);
    return {_mm256_castsi256_ps(_mm256_xor_si256(_mm256_cmpeq_epi32(x.a, zero), ones)),
            _mm256_castsi256_ps(_mm256_xor_si256(_mm256_cmpeq_epi32(x.b, zero), ones))};
}
SURFELAO_MASK_INLINE __m256i bits_from8(__m256 x)
{
    // the second operand is what comes out for NaN
    const __m256 from = _mm256_min_ps(_mm256_max_ps(x, _mm256_setzero_ps()), _mm256_set1_ps(32.0f));
    return _mm256_sllv_epi32(_mm256_set1_epi32(-1), _mm256_cvttps_epi32(_mm256_ceil_ps(from)));
}
SURFELAO_MASK_INLINE Int16 bits_from(Float16 x)
{
    return {bits_from8(x.a), bits_from8(x.b)};
}

/// For each of 256 masks the chosen lanes first.
struct PackTable {
    alignas(32) std::uint32_t lane[256][8];

    constexpr PackTable() : lane()
    {
        for (unsigned mask = 0; mask < 256; ++mask) {
            unsigned count = 0;
            for (unsigned i = 0; i < 8; ++i) {
                if (mask >> i & 1u)
                    lane[mask][count++] = i;
            }
        }
    }
};
constexpr PackTable kPackTable;

SURFELAO_MASK_INLINE Float16 pack(Float16 x, Lanes m)
{
    const auto low = static_cast<unsigned>(_mm256_movemask_ps(m.a));
    const auto high = static_cast<unsigned>(_mm256_movemask_ps(m.b));
    const auto turn = [](unsigned mask) {
        return _mm256_load_si256(reinterpret_cast<const __m256i*>(kPackTable.lane[mask]));
    };
    alignas(32) float both[16];
    _mm256_store_ps(both, _mm256_permutevar8x32_ps(x.a, turn(low)));
    _mm256_storeu_ps(both + __builtin_popcount(low), _mm256_permutevar8x32_ps(x.b, turn(high)));
    return load(both);
}
SURFELAO_MASK_INLINE Int16 pack(Int16 x, Lanes m)
{
    return as_int(pack(as_float(x), m));
}

/// Eight records' eight floats from `at` to eight vectors.
SURFELAO_MASK_INLINE void transpose8(const float* base, const std::uint32_t* index, int at,
                                     __m256* out)
{
    __m256 r[8], t[8];
    for (int i = 0; i < 8; ++i)
        r[i] = _mm256_load_ps(base + 16 * static_cast<std::size_t>(index[i]) + at);
    for (int i = 0; i < 8; i += 2) {
        t[i] = _mm256_unpacklo_ps(r[i], r[i + 1]);
        t[i + 1] = _mm256_unpackhi_ps(r[i], r[i + 1]);
    }
    for (int i = 0; i < 8; i += 4) {
        r[i] = _mm256_shuffle_ps(t[i], t[i + 2], 0x44);
        r[i + 1] = _mm256_shuffle_ps(t[i], t[i + 2], 0xee);
        r[i + 2] = _mm256_shuffle_ps(t[i + 1], t[i + 3], 0x44);
        r[i + 3] = _mm256_shuffle_ps(t[i + 1], t[i + 3], 0xee);
    }
    for (int i = 0; i < 4; ++i) {
        out[i] = _mm256_permute2f128_ps(r[i], r[i + 4], 0x20);
        out[i + 4] = _mm256_permute2f128_ps(r[i], r[i + 4], 0x31);
    }
}
SURFELAO_MASK_INLINE void load_transposed(const float* base, const std::uint32_t* index,
                                          Float16* field)
{
    __m256 low[8], high[8];
    for (int at = 0; at < 16; at += 8) {
        transpose8(base, index, at, low);
        transpose8(base, index + 8, at, high);
        for (int i = 0; i < 8; ++i)
            field[at + i] = {low[i], high[i]};
    }
}

struct Bytes {
    __m256i a, b;
};
SURFELAO_MASK_INLINE Bytes operator+(Bytes x, Bytes y)
{
    return {_mm256_add_epi8(x.a, y.a), _mm256_add_epi8(x.b, y.b)};
}
SURFELAO_MASK_INLINE Bytes operator-(Bytes x, Bytes y)
{
    return {_mm256_sub_epi8(x.a, y.a), _mm256_sub_epi8(x.b, y.b)};
}
SURFELAO_MASK_INLINE Bytes bytes_of(Int16 x)
{
    return {x.a, x.b};
}
SURFELAO_MASK_INLINE Bytes nibble_counts(Int16 x)
{
    const __m256i count =
        _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4));
    return {_mm256_shuffle_epi8(count, x.a), _mm256_shuffle_epi8(count, x.b)};
}
struct ByteSum {
    __m256i v;  ///< 16 bits each, at most 4 * 48 * 127

    SURFELAO_MASK_INLINE void add(Bytes x, const std::int8_t* table)
    {
        const auto* at = reinterpret_cast<const __m256i*>(table);
        v = _mm256_add_epi16(v, _mm256_maddubs_epi16(x.a, _mm256_load_si256(at)));
        v = _mm256_add_epi16(v, _mm256_maddubs_epi16(x.b, _mm256_load_si256(at + 1)));
    }
};
SURFELAO_MASK_INLINE void total(const ByteSum (&sum)[6], std::int32_t (&out)[6])
{
    __m128i x[6];
    for (int i = 0; i < 6; ++i) {
        const __m256i wide = _mm256_madd_epi16(sum[i].v, _mm256_set1_epi16(1));
        x[i] = _mm_add_epi32(_mm256_castsi256_si128(wide), _mm256_extracti128_si256(wide, 1));
    }
    const __m128i last = _mm_hadd_epi32(x[4], x[5]);
    const __m128i first = _mm_hadd_epi32(_mm_hadd_epi32(x[0], x[1]), _mm_hadd_epi32(x[2], x[3]));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out), first);
    _mm_storel_epi64(reinterpret_cast<__m128i*>(out + 4), _mm_hadd_epi32(last, last));
}

#else

struct Float16 {
    float v[16];
};
struct Int16 {
    std::uint32_t v[16];
};
/// All bits of a lane are set or none.
struct Lanes {
    std::uint32_t v[16];
};

template <typename Out, typename Function>
SURFELAO_MASK_INLINE Out each(Function function)
{
    Out out;
    for (int i = 0; i < kLanes; ++i)
        out.v[i] = function(i);
    return out;
}

SURFELAO_MASK_INLINE Float16 load(const float* p)
{
    Float16 out;
    std::memcpy(out.v, p, sizeof out.v);
    return out;
}
SURFELAO_MASK_INLINE void store(float* p, const Float16& x)
{
    std::memcpy(p, x.v, sizeof x.v);
}
SURFELAO_MASK_INLINE Int16 load(const std::uint32_t* p)
{
    Int16 out;
    std::memcpy(out.v, p, sizeof out.v);
    return out;
}
SURFELAO_MASK_INLINE void store(std::uint32_t* p, const Int16& x)
{
    std::memcpy(p, x.v, sizeof x.v);
}
SURFELAO_MASK_INLINE Float16 all(float x)
{
    return each<Float16>([&](int) { return x; });
}
SURFELAO_MASK_INLINE Int16 all(std::uint32_t x)
{
    return each<Int16>([&](int) { return x; });
}

SURFELAO_MASK_INLINE Float16 operator+(const Float16& x, const Float16& y)
{
    return each<Float16>([&](int i) { return x.v[i] + y.v[i]; });
}
SURFELAO_MASK_INLINE Float16 operator-(const Float16& x, const Float16& y)
{
    return each<Float16>([&](int i) { return x.v[i] - y.v[i]; });
}
SURFELAO_MASK_INLINE Float16 operator*(const Float16& x, const Float16& y)
{
    return each<Float16>([&](int i) { return x.v[i] * y.v[i]; });
}
SURFELAO_MASK_INLINE Float16 fma(const Float16& x, const Float16& y, const Float16& z)
{
    return each<Float16>([&](int i) { return x.v[i] * y.v[i] + z.v[i]; });
}
SURFELAO_MASK_INLINE Float16 fms(const Float16& x, const Float16& y, const Float16& z)
{
    return each<Float16>([&](int i) { return x.v[i] * y.v[i] - z.v[i]; });
}
SURFELAO_MASK_INLINE Float16 min(const Float16& x, const Float16& y)
{
    return each<Float16>([&](int i) { return x.v[i] < y.v[i] ? x.v[i] : y.v[i]; });
}
SURFELAO_MASK_INLINE Float16 max(const Float16& x, const Float16& y)
{
    return each<Float16>([&](int i) { return x.v[i] > y.v[i] ? x.v[i] : y.v[i]; });
}
SURFELAO_MASK_INLINE Float16 sqrt(const Float16& x)
{
    return each<Float16>([&](int i) { return __builtin_sqrtf(x.v[i]); });
}
SURFELAO_MASK_INLINE Float16 reciprocal(const Float16& x)
{
    return each<Float16>([&](int i) { return 1.0f / x.v[i]; });
}
SURFELAO_MASK_INLINE Float16 inverse_sqrt(const Float16& x)
{
    return each<Float16>([&](int i) { return 1.0f / __builtin_sqrtf(x.v[i]); });
}

SURFELAO_MASK_INLINE Lanes operator<(const Float16& x, const Float16& y)
{
    return each<Lanes>([&](int i) { return x.v[i] < y.v[i] ? ~0u : 0u; });
}
SURFELAO_MASK_INLINE Lanes operator>(const Float16& x, const Float16& y)
{
    return y < x;
}
SURFELAO_MASK_INLINE Lanes operator&(const Lanes& x, const Lanes& y)
{
    return each<Lanes>([&](int i) { return x.v[i] & y.v[i]; });
}
SURFELAO_MASK_INLINE Lanes operator|(const Lanes& x, const Lanes& y)
{
    return each<Lanes>([&](int i) { return x.v[i] | y.v[i]; });
}
SURFELAO_MASK_INLINE Lanes without(const Lanes& x, const Lanes& y)
{
    return each<Lanes>([&](int i) { return x.v[i] & ~y.v[i]; });
}
SURFELAO_MASK_INLINE Lanes lanes_of(unsigned bits)
{
    return each<Lanes>([&](int i) { return (bits >> i & 1u) != 0 ? ~0u : 0u; });
}
SURFELAO_MASK_INLINE unsigned bits(const Lanes& x)
{
    unsigned out = 0;
    for (int i = 0; i < kLanes; ++i)
        out |= (x.v[i] & 1u) << i;
    return out;
}
SURFELAO_MASK_INLINE Float16 select(const Lanes& m, const Float16& yes, const Float16& no)
{
    return each<Float16>([&](int i) { return m.v[i] ? yes.v[i] : no.v[i]; });
}
SURFELAO_MASK_INLINE Int16 select(const Lanes& m, const Int16& yes, const Int16& no)
{
    return each<Int16>([&](int i) { return m.v[i] ? yes.v[i] : no.v[i]; });
}
SURFELAO_MASK_INLINE Int16 operator&(const Int16& x, const Int16& y)
{
    return each<Int16>([&](int i) { return x.v[i] & y.v[i]; });
}
SURFELAO_MASK_INLINE Int16 operator|(const Int16& x, const Int16& y)
{
    return each<Int16>([&](int i) { return x.v[i] | y.v[i]; });
}
SURFELAO_MASK_INLINE Int16 operator^(const Int16& x, const Int16& y)
{
    return each<Int16>([&](int i) { return x.v[i] ^ y.v[i]; });
}
SURFELAO_MASK_INLINE Int16 operator~(const Int16& x)
{
    return each<Int16>([&](int i) { return ~x.v[i]; });
}
SURFELAO_MASK_INLINE Int16 and_xor(const Int16& x, const Int16& y, const Int16& z)
{
    return each<Int16>([&](int i) { return x.v[i] & (y.v[i] ^ z.v[i]); });
}
template <int kBy>
SURFELAO_MASK_INLINE Int16 shift_left(const Int16& x)
{
    return each<Int16>([&](int i) { return x.v[i] << kBy; });
}
template <int kBy>
SURFELAO_MASK_INLINE Int16 shift_right(const Int16& x)
{
    return each<Int16>([&](int i) { return x.v[i] >> kBy; });
}
SURFELAO_MASK_INLINE Int16 from_below(const Int16& x)
{
    return each<Int16>([&](int i) { return i > 0 ? x.v[i - 1] : 0u; });
}
SURFELAO_MASK_INLINE Int16 from_above(const Int16& x)
{
    return each<Int16>([&](int i) { return i < kLanes - 1 ? x.v[i + 1] : 0u; });
}
SURFELAO_MASK_INLINE Lanes nonzero(const Int16& x)
{
    return each<Lanes>([&](int i) { return x.v[i] ? ~0u : 0u; });
}
SURFELAO_MASK_INLINE Int16 as_int(const Float16& x)
{
    Int16 out;
    std::memcpy(out.v, x.v, sizeof out.v);
    return out;
}
SURFELAO_MASK_INLINE Float16 as_float(const Int16& x)
{
    Float16 out;
    std::memcpy(out.v, x.v, sizeof out.v);
    return out;
}
SURFELAO_MASK_INLINE Int16 bits_from(const Float16& x)
{
    return each<Int16>([&](int i) {
        if (!(x.v[i] > 0.0f))
            return ~0u;
        if (x.v[i] > 31.0f)
            return 0u;
        const auto floor = static_cast<std::uint32_t>(x.v[i]);
        return ~0u << (floor + (static_cast<float>(floor) < x.v[i] ? 1u : 0u));
    });
}
SURFELAO_MASK_INLINE Float16 pack(const Float16& x, const Lanes& m)
{
    Float16 out{};
    int count = 0;
    for (int i = 0; i < kLanes; ++i) {
        if (m.v[i])
            out.v[count++] = x.v[i];
    }
    return out;
}
SURFELAO_MASK_INLINE Int16 pack(const Int16& x, const Lanes& m)
{
    return as_int(pack(as_float(x), m));
}
SURFELAO_MASK_INLINE void load_transposed(const float* base, const std::uint32_t* index,
                                          Float16* field)
{
    for (int i = 0; i < kLanes; ++i) {
        const float* record = base + 16 * static_cast<std::size_t>(index[i]);
        for (int f = 0; f < 16; ++f)
            field[f].v[i] = record[f];
    }
}

struct Bytes {
    std::uint8_t v[4 * kLanes];
};
SURFELAO_MASK_INLINE Bytes operator+(const Bytes& x, const Bytes& y)
{
    Bytes out;
    for (int i = 0; i < 4 * kLanes; ++i)
        out.v[i] = static_cast<std::uint8_t>(x.v[i] + y.v[i]);
    return out;
}
SURFELAO_MASK_INLINE Bytes operator-(const Bytes& x, const Bytes& y)
{
    Bytes out;
    for (int i = 0; i < 4 * kLanes; ++i)
        out.v[i] = static_cast<std::uint8_t>(x.v[i] - y.v[i]);
    return out;
}
SURFELAO_MASK_INLINE Bytes bytes_of(const Int16& x)
{
    Bytes out;
    for (int i = 0; i < 4 * kLanes; ++i)
        out.v[i] = static_cast<std::uint8_t>(x.v[i / 4] >> 8 * (i % 4));
    return out;
}
[[gnu::noinline]] inline Bytes nibble_counts(const Int16& x)
{
    Bytes out;
    for (int i = 0; i < 4 * kLanes; ++i) {
        const std::uint32_t nibble = x.v[i / 4] >> 8 * (i % 4) & 15u;
        const std::uint32_t pairs = nibble - (nibble >> 1 & 5u);
        out.v[i] = static_cast<std::uint8_t>((pairs & 3u) + (pairs >> 2));
    }
    return out;
}
struct ByteSum {
    std::int32_t v;

    [[gnu::noinline]] void add(const Bytes& x, const std::int8_t* table)
    {
        for (int i = 0; i < 4 * kLanes; ++i)
            v += x.v[i] * table[i];
    }
};
SURFELAO_MASK_INLINE void total(const ByteSum (&sum)[6], std::int32_t (&out)[6])
{
    for (int i = 0; i < 6; ++i)
        out[i] = sum[i].v;
}

#endif

}  // namespace surfelao::SURFELAO_MASK_ISA
