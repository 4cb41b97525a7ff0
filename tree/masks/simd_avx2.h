/// simd_avx2.h: sixteen lanes as two vectors of AVX2, with FMA. simd.h tells all.
#pragma once

#include "tree/masks/simd_rows8.h"

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

namespace surfelao::SURFELAO_MASK_ISA {

struct Float16 {
    __m256 a, b;
};
struct Int16 {
    __m256i a, b;
};
/// All bits of a lane are set or none.
struct Bool16 {
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

SURFELAO_MASK_INLINE Bool16 operator<(Float16 x, Float16 y)
{
    return {_mm256_cmp_ps(x.a, y.a, _CMP_LT_OQ), _mm256_cmp_ps(x.b, y.b, _CMP_LT_OQ)};
}
SURFELAO_MASK_INLINE Bool16 operator>(Float16 x, Float16 y)
{
    return y < x;
}
SURFELAO_MASK_INLINE Bool16 operator&(Bool16 x, Bool16 y)
{
    return {_mm256_and_ps(x.a, y.a), _mm256_and_ps(x.b, y.b)};
}
SURFELAO_MASK_INLINE Bool16 operator|(Bool16 x, Bool16 y)
{
    return {_mm256_or_ps(x.a, y.a), _mm256_or_ps(x.b, y.b)};
}
SURFELAO_MASK_INLINE Bool16 without(Bool16 x, Bool16 y)
{
    return {_mm256_andnot_ps(y.a, x.a), _mm256_andnot_ps(y.b, x.b)};
}
SURFELAO_MASK_INLINE Bool16 lanes_of(unsigned bits)
{
    const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const auto half = [&](unsigned byte) {
        const __m256i chosen = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(byte)), lane);
        return _mm256_castsi256_ps(_mm256_cmpeq_epi32(chosen, lane));
    };
    return {half(bits & 255u), half(bits >> 8)};
}
SURFELAO_MASK_INLINE unsigned bits(Bool16 x)
{
    return static_cast<unsigned>(_mm256_movemask_ps(x.a)) |
           static_cast<unsigned>(_mm256_movemask_ps(x.b)) << 8;
}
SURFELAO_MASK_INLINE Float16 select(Bool16 m, Float16 yes, Float16 no)
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
SURFELAO_MASK_INLINE Int16 select(Bool16 m, Int16 yes, Int16 no)
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
SURFELAO_MASK_INLINE Bool16 nonzero(Int16 x)
{
    const __m256i zero = _mm256_setzero_si256();
    const __m256i ones = _mm256_set1_epi32(-1);
    return {_mm256_castsi256_ps(_mm256_xor_si256(_mm256_cmpeq_epi32(x.a, zero), ones)),
            _mm256_castsi256_ps(_mm256_xor_si256(_mm256_cmpeq_epi32(x.b, zero), ones))};
}
/// Eight of the rows.
SURFELAO_MASK_INLINE Int8 half_of(Int16 x, bool upper)
{
    return {upper ? x.b : x.a};
}
SURFELAO_MASK_INLINE Int16 bits_from(Float16 at, Float16 shift)
{
    return {bits_from8(at.a, shift.a), bits_from8(at.b, shift.b)};
}

/// For each of 256 masks the chosen lanes first.
struct PackTable {
    alignas(32) std::uint32_t lane[256][8];
    alignas(32) std::uint32_t turned[9][8];  ///< lanes, turned upward by so many
    alignas(32) std::uint32_t first[9][8];   ///< ~0 in so many

    constexpr PackTable() : lane(), turned(), first()
    {
        for (unsigned mask = 0; mask < 256; ++mask) {
            unsigned count = 0;
            for (unsigned i = 0; i < 8; ++i) {
                if (mask >> i & 1u)
                    lane[mask][count++] = i;
            }
        }
        for (unsigned count = 0; count <= 8; ++count) {
            for (unsigned i = 0; i < 8; ++i) {
                turned[count][i] = (i - count) & 7u;
                first[count][i] = i < count ? ~0u : 0u;
            }
        }
    }
};
constexpr PackTable kPackTable;

SURFELAO_MASK_INLINE __m256i load8(const std::uint32_t* p)
{
    return _mm256_load_si256(reinterpret_cast<const __m256i*>(p));
}

SURFELAO_MASK_INLINE Float16 pack(Float16 x, Bool16 m)
{
    const auto low = static_cast<unsigned>(_mm256_movemask_ps(m.a));
    const auto high = static_cast<unsigned>(_mm256_movemask_ps(m.b));
    const int count = __builtin_popcount(low);
    // the upper half goes on where the lower one ends
    const __m256i behind =
        _mm256_permutevar8x32_epi32(load8(kPackTable.lane[high]), load8(kPackTable.turned[count]));
    const __m256 a = _mm256_permutevar8x32_ps(x.a, load8(kPackTable.lane[low]));
    const __m256 b = _mm256_permutevar8x32_ps(x.b, behind);
    return {_mm256_blendv_ps(b, a, _mm256_castsi256_ps(load8(kPackTable.first[count]))), b};
}
SURFELAO_MASK_INLINE Int16 pack(Int16 x, Bool16 m)
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

constexpr int kByteRows = 8;
struct Bytes {
    __m256i v;
};
SURFELAO_MASK_INLINE Bytes operator+(Bytes x, Bytes y)
{
    return {_mm256_add_epi8(x.v, y.v)};
}
SURFELAO_MASK_INLINE Bytes operator-(Bytes x, Bytes y)
{
    return {_mm256_sub_epi8(x.v, y.v)};
}
SURFELAO_MASK_INLINE Bytes operator&(Bytes x, Bytes y)
{
    return {_mm256_and_si256(x.v, y.v)};
}
SURFELAO_MASK_INLINE Bytes all_bytes(std::uint32_t four)
{
    return {_mm256_set1_epi32(static_cast<int>(four))};
}
SURFELAO_MASK_INLINE Bytes load_bytes(const std::uint32_t* rows)
{
    return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(rows))};
}
template <int kBy>
SURFELAO_MASK_INLINE Bytes shift_right(Bytes x)
{
    return {_mm256_srli_epi32(x.v, kBy)};
}
SURFELAO_MASK_INLINE Bytes nibble_counts(Bytes x)
{
    const __m256i count =
        _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4));
    return {_mm256_shuffle_epi8(count, x.v)};
}
struct ByteSum {
    __m256i v;  ///< 16 bits each, at most 4 * 48 * 127

    SURFELAO_MASK_INLINE void add(Bytes x, const std::int8_t* table)
    {
        const auto* at = reinterpret_cast<const __m256i*>(table);
        v = _mm256_add_epi16(v, _mm256_maddubs_epi16(x.v, _mm256_load_si256(at)));
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

}  // namespace surfelao::SURFELAO_MASK_ISA
