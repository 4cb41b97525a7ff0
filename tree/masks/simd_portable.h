/// simd_portable.h: sixteen lanes as four times four floats, which every processor has
/// (tree/lanes.h). simd.h tells all.
#pragma once

#include "tree/lanes.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace surfelao::SURFELAO_MASK_ISA {

using Word4 [[gnu::vector_size(16)]] = std::uint32_t;
using Byte16 [[gnu::vector_size(16)]] = std::uint8_t;

struct Float16 {
    Float4 v[4];
};
struct Int16 {
    Word4 v[4];
};
/// All bits of a lane are set or none.
struct Bool16 {
    Bool4 v[4];
};

/// Out of the four quarters.
template <typename Out, typename Function>
SURFELAO_MASK_INLINE Out each(Function function)
{
    return {{function(0), function(1), function(2), function(3)}};
}
SURFELAO_MASK_INLINE Word4 word4(Bool4 x)
{
    return reinterpret_cast<Word4>(x);
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
    const Float4 v = {x, x, x, x};
    return {{v, v, v, v}};
}
SURFELAO_MASK_INLINE Int16 all(std::uint32_t x)
{
    const Word4 v = {x, x, x, x};
    return {{v, v, v, v}};
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
SURFELAO_MASK_INLINE Float4 sqrt4(Float4 x)
{
    return Float4{__builtin_sqrtf(x[0]), __builtin_sqrtf(x[1]), __builtin_sqrtf(x[2]),
                  __builtin_sqrtf(x[3])};
}
SURFELAO_MASK_INLINE Float16 sqrt(const Float16& x)
{
    return each<Float16>([&](int i) { return sqrt4(x.v[i]); });
}
SURFELAO_MASK_INLINE Float16 reciprocal(const Float16& x)
{
    return each<Float16>([&](int i) { return 1.0f / x.v[i]; });
}
SURFELAO_MASK_INLINE Float16 inverse_sqrt(const Float16& x)
{
    return each<Float16>([&](int i) { return 1.0f / sqrt4(x.v[i]); });
}

SURFELAO_MASK_INLINE Bool16 operator<(const Float16& x, const Float16& y)
{
    return each<Bool16>([&](int i) { return x.v[i] < y.v[i]; });
}
SURFELAO_MASK_INLINE Bool16 operator>(const Float16& x, const Float16& y)
{
    return y < x;
}
SURFELAO_MASK_INLINE Bool16 operator&(const Bool16& x, const Bool16& y)
{
    return each<Bool16>([&](int i) { return x.v[i] & y.v[i]; });
}
SURFELAO_MASK_INLINE Bool16 operator|(const Bool16& x, const Bool16& y)
{
    return each<Bool16>([&](int i) { return x.v[i] | y.v[i]; });
}
SURFELAO_MASK_INLINE Bool16 without(const Bool16& x, const Bool16& y)
{
    return each<Bool16>([&](int i) { return x.v[i] & ~y.v[i]; });
}
SURFELAO_MASK_INLINE Bool16 lanes_of(unsigned bits)
{
    const Bool4 lane = {1, 2, 4, 8};
    return each<Bool16>([&](int i) {
        const auto quarter = static_cast<std::int32_t>(bits >> 4 * i);
        return (lane & quarter) != 0;
    });
}
SURFELAO_MASK_INLINE unsigned bits(const Bool16& x)
{
    const Bool4 lane = {1, 2, 4, 8};
    const Bool4 set =
        (x.v[0] & lane) | (x.v[1] & (lane << 4)) | (x.v[2] & (lane << 8)) | (x.v[3] & (lane << 12));
    return static_cast<unsigned>(set[0] | set[1] | set[2] | set[3]);
}
SURFELAO_MASK_INLINE Float16 select(const Bool16& m, const Float16& yes, const Float16& no)
{
    return each<Float16>([&](int i) { return m.v[i] ? yes.v[i] : no.v[i]; });
}
SURFELAO_MASK_INLINE Int16 select(const Bool16& m, const Int16& yes, const Int16& no)
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
    return each<Int16>([&](int i) {
        const Word4 before = i > 0 ? x.v[i - 1] : Word4{};
        return __builtin_shufflevector(before, x.v[i], 3, 4, 5, 6);
    });
}
SURFELAO_MASK_INLINE Int16 from_above(const Int16& x)
{
    return each<Int16>([&](int i) {
        const Word4 behind = i < 3 ? x.v[i + 1] : Word4{};
        return __builtin_shufflevector(x.v[i], behind, 1, 2, 3, 4);
    });
}
SURFELAO_MASK_INLINE Bool16 nonzero(const Int16& x)
{
    return each<Bool16>([&](int i) { return x.v[i] != 0; });
}
SURFELAO_MASK_INLINE Int16 as_int(const Float16& x)
{
    return each<Int16>([&](int i) { return reinterpret_cast<Word4>(x.v[i]); });
}
SURFELAO_MASK_INLINE Float16 as_float(const Int16& x)
{
    return each<Float16>([&](int i) { return reinterpret_cast<Float4>(x.v[i]); });
}
SURFELAO_MASK_INLINE Word4 bits_from4(Float4 at, Float4 shift)
{
    // NaN is not above 0
    const Float4 x = at - shift;
    const Float4 zero = {}, most = zero + 32.0f;
    Float4 from = x > 0.0f ? x : zero;
    from = from < 32.0f ? from : most;
    Bool4 first = __builtin_convertvector(from, Bool4);
    first -= __builtin_convertvector(first, Float4) < from;
    // all bits from bit k up are the number -2^k, which has a float
    const Word4 power = (word4(first) + (256u + 127u)) << 23;
    const Bool4 up =
        __builtin_convertvector(reinterpret_cast<Float4>(first < 32 ? power : Word4{}), Bool4);
    return reinterpret_cast<Word4>(up);
}
SURFELAO_MASK_INLINE Int16 bits_from(const Float16& at, const Float16& shift)
{
    return each<Int16>([&](int i) { return bits_from4(at.v[i], shift.v[i]); });
}

/// Eight rows.
struct Float8 {
    Float4 v[2];
};
struct Int8 {
    Word4 v[2];
};
SURFELAO_MASK_INLINE Int8 half_of(const Int16& x, bool upper)
{
    return {{x.v[upper ? 2 : 0], x.v[upper ? 3 : 1]}};
}
SURFELAO_MASK_INLINE Int8 bits_from(const Float8& at, const Float8& shift)
{
    return {{bits_from4(at.v[0], shift.v[0]), bits_from4(at.v[1], shift.v[1])}};
}
SURFELAO_MASK_INLINE Float8 fma(const Float8& x, const Float8& y, const Float8& z)
{
    return {{x.v[0] * y.v[0] + z.v[0], x.v[1] * y.v[1] + z.v[1]}};
}
SURFELAO_MASK_INLINE Int8 and_xor(const Int8& x, const Int8& y, const Int8& z)
{
    return {{x.v[0] & (y.v[0] ^ z.v[0]), x.v[1] & (y.v[1] ^ z.v[1])}};
}
SURFELAO_MASK_INLINE Int8 operator&(const Int8& x, const Int8& y)
{
    return {{x.v[0] & y.v[0], x.v[1] & y.v[1]}};
}
SURFELAO_MASK_INLINE Int8 operator|(const Int8& x, const Int8& y)
{
    return {{x.v[0] | y.v[0], x.v[1] | y.v[1]}};
}
SURFELAO_MASK_INLINE void store(std::uint32_t* p, const Int8& x)
{
    std::memcpy(p, x.v, sizeof x.v);
}
SURFELAO_MASK_INLINE void load_rows(const float* p, Float8& x)
{
    std::memcpy(x.v, p, sizeof x.v);
}
SURFELAO_MASK_INLINE void load_rows(const std::uint32_t* p, Int8& x)
{
    std::memcpy(x.v, p, sizeof x.v);
}
SURFELAO_MASK_INLINE void fill_rows(float a, Float8& x)
{
    x.v[0] = x.v[1] = Float4{a, a, a, a};
}
SURFELAO_MASK_INLINE void fill_rows(std::uint32_t a, Int8& x)
{
    x.v[0] = x.v[1] = Word4{a, a, a, a};
}
SURFELAO_MASK_INLINE Float16 pack(const Float16& x, const Bool16& m)
{
    alignas(64) float in[16], out[16];
    store(in, x);
    store(out, x);
    int count = 0;
    for (unsigned left = bits(m); left != 0; left &= left - 1)
        out[count++] = in[__builtin_ctz(left)];
    return load(out);
}
SURFELAO_MASK_INLINE Int16 pack(const Int16& x, const Bool16& m)
{
    return as_int(pack(as_float(x), m));
}
SURFELAO_MASK_INLINE void load_transposed(const float* base, const std::uint32_t* index,
                                          Float16* field)
{
    for (int i = 0; i < 4; ++i) {
        const float* record[4];
        for (int k = 0; k < 4; ++k)
            record[k] = base + 16 * static_cast<std::size_t>(index[4 * i + k]);
        for (int f = 0; f < 16; f += 4) {
            Float4 a = load_lanes(record[0] + f), b = load_lanes(record[1] + f),
                   c = load_lanes(record[2] + f), d = load_lanes(record[3] + f);
            transpose(a, b, c, d);
            field[f].v[i] = a;
            field[f + 1].v[i] = b;
            field[f + 2].v[i] = c;
            field[f + 3].v[i] = d;
        }
    }
}

constexpr int kByteRows = 16;
struct Bytes {
    Byte16 v[4];
};
SURFELAO_MASK_INLINE Bytes operator+(const Bytes& x, const Bytes& y)
{
    return each<Bytes>([&](int i) { return x.v[i] + y.v[i]; });
}
SURFELAO_MASK_INLINE Bytes operator-(const Bytes& x, const Bytes& y)
{
    return each<Bytes>([&](int i) { return x.v[i] - y.v[i]; });
}
SURFELAO_MASK_INLINE Bytes operator&(const Bytes& x, const Bytes& y)
{
    return each<Bytes>([&](int i) { return x.v[i] & y.v[i]; });
}
SURFELAO_MASK_INLINE Bytes all_bytes(std::uint32_t four)
{
    const Word4 words = Word4{} + four;
    return each<Bytes>([&](int) { return reinterpret_cast<Byte16>(words); });
}
SURFELAO_MASK_INLINE Bytes load_bytes(const std::uint32_t* rows)
{
    static_assert(std::endian::native == std::endian::little);
    Bytes bytes;
    std::memcpy(bytes.v, rows, sizeof bytes.v);
    return bytes;
}
template <int kBy>
SURFELAO_MASK_INLINE Bytes shift_right(const Bytes& x)
{
    return each<Bytes>(
        [&](int i) { return reinterpret_cast<Byte16>(reinterpret_cast<Word4>(x.v[i]) >> kBy); });
}
SURFELAO_MASK_INLINE Bytes nibble_counts(const Bytes& x)
{
    return each<Bytes>([&](int i) {
        const Word4 words = reinterpret_cast<Word4>(x.v[i]);
        const Word4 pairs = words - (words >> 1 & 0x05050505u);
        return reinterpret_cast<Byte16>((pairs & 0x03030303u) + (pairs >> 2 & 0x03030303u));
    });
}
struct ByteSum {
    std::int32_t v;

    [[gnu::noinline]] void add(const Bytes& x, const std::int8_t* table)
    {
        std::uint8_t bytes[sizeof x.v];
        std::memcpy(bytes, x.v, sizeof bytes);
        for (std::size_t i = 0; i < sizeof bytes; ++i)
            v += bytes[i] * table[i];
    }
};
SURFELAO_MASK_INLINE void total(const ByteSum (&sum)[6], std::int32_t (&out)[6])
{
    for (int i = 0; i < 6; ++i)
        out[i] = sum[i].v;
}

}  // namespace surfelao::SURFELAO_MASK_ISA
