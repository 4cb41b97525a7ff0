#include "reference/sobol.h"

#include "surfels/clones.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surfelao {
namespace {

std::uint32_t reverse_bits(std::uint32_t x)
{
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0F0F0F0Fu) | (x & 0x0F0F0F0Fu) << 4;
    x = (x >> 8 & 0x00FF00FFu) | (x & 0x00FF00FFu) << 8;
    return x >> 16 | x << 16;
}

/// Owen's nested scramble on reversed bits (Burley 2020, section 3.3): every step carries upwards
/// only, so that bit k is flipped by a hash of the bits above it in the original order.
inline std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed)
{
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

/// Second Sobol dimension: the generator matrix of the polynomial x + 1 (Pascal's triangle mod 2).
std::uint32_t sobol_v(std::uint32_t index)
{
    std::uint32_t result = 0;
    for (std::uint32_t column = 1u << 31; index != 0; index >>= 1, column ^= column >> 1) {
        if (index & 1)
            result ^= column;
    }
    return result;
}

std::uint64_t spread_bits(std::uint64_t x)
{
    x = (x | x << 16) & 0x0000FFFF0000FFFFu;
    x = (x | x << 8) & 0x00FF00FF00FF00FFu;
    x = (x | x << 4) & 0x0F0F0F0F0F0F0F0Fu;
    x = (x | x << 2) & 0x3333333333333333u;
    return (x | x << 1) & 0x5555555555555555u;
}

/// A 64-bit finaliser (Stafford's variant 13 of MurmurHash3's).
std::uint64_t mix(std::uint64_t x)
{
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
    x = (x ^ x >> 27) * 0x94D049BB133111EBu;
    return x ^ x >> 31;
}

/// A point of the scrambled unit square, on the disk by Shirley and Chiu's concentric map, lifted
/// to the hemisphere: cosine-weighted. sine and cosine of at most pi/4 by Taylor series: error
/// 4e-8.
inline void direction(std::uint32_t reversed_u, std::uint32_t reversed_v, const Hemisphere& h,
                      float& out_x, float& out_y, float& out_z, float& out_cosine)
{
    // centres of 2^24 cells: never 0, never 1
    const float u = static_cast<float>(
        static_cast<std::int32_t>(reverse_bits(scramble_reversed(reversed_u, h.scramble_u)) >> 8));
    const float v = static_cast<float>(
        static_cast<std::int32_t>(reverse_bits(scramble_reversed(reversed_v, h.scramble_v)) >> 8));
    const float a = (u + 0.5f) * 0x1p-23f - 1.0f;
    const float b = (v + 0.5f) * 0x1p-23f - 1.0f;

    const bool wide = std::fabs(a) > std::fabs(b);
    const float radius = wide ? a : b;
    const float t =
        (wide ? b : a) / (radius == 0.0f ? 1.0f : radius) * (std::numbers::pi_v<float> / 4.0f);
    const float t2 = t * t;
    const float sine = t * (1.0f + t2 * (-1.0f / 6 + t2 * (1.0f / 120 - t2 * (1.0f / 5040))));
    const float cosine =
        1.0f + t2 * (-0.5f + t2 * (1.0f / 24 + t2 * (-1.0f / 720 + t2 * (1.0f / 40320))));
    const float x = radius * (wide ? cosine : sine);
    const float y = radius * (wide ? sine : cosine);
    const float z = std::sqrt(std::max(0.0f, 1.0f - radius * radius));

    out_x = x * h.x.x + y * h.y.x + z * h.z.x;
    out_y = x * h.x.y + y * h.y.y + z * h.z.y;
    out_z = x * h.x.z + y * h.y.z + z * h.z.z;
    out_cosine = z;
}

}  // namespace

SobolPoints sobol_points_by_cell(std::uint32_t count)
{
    struct Point {
        std::uint64_t cell;
        std::uint32_t reversed_u, reversed_v;
    };
    std::vector<Point> points(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t u = reverse_bits(i), v = sobol_v(i);
        points[i] = {spread_bits(u) << 1 | spread_bits(v), i, reverse_bits(v)};
    }
    std::sort(points.begin(), points.end(),
              [](const Point& a, const Point& b) { return a.cell < b.cell; });

    // whole packets: the last one repeats the last point
    SobolPoints result;
    const std::uint32_t padded = (count + kPacket - 1) / kPacket * kPacket;
    for (std::uint32_t i = 0; i < padded; ++i) {
        result.reversed_u.push_back(points[std::min(i, count - 1)].reversed_u);
        result.reversed_v.push_back(points[std::min(i, count - 1)].reversed_v);
    }
    return result;
}

Hemisphere hemisphere_over(glm::vec3 n, std::uint32_t seed, std::uint32_t receiver)
{
    Hemisphere result;
    // Duff et al. 2017: no branch, no weak spot near any axis
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    result.x = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    result.y = {b, sign + n.y * n.y * a, -n.y};
    result.z = n;
    const std::uint64_t hash = mix(mix(seed + 0x9E3779B97F4A7C15u) ^ receiver);
    result.scramble_u = static_cast<std::uint32_t>(hash);
    result.scramble_v = static_cast<std::uint32_t>(hash >> 32);
    return result;
}

SURFELAO_CLONES
void fill_directions(const SobolPoints& points, std::uint32_t first, const Hemisphere& hemisphere,
                     DirectionPacket& packet)
{
    const std::uint32_t* u = points.reversed_u.data() + first;
    const std::uint32_t* v = points.reversed_v.data() + first;
    const Hemisphere h = hemisphere;
    for (int lane = 0; lane < kPacket; ++lane) {
        direction(u[lane], v[lane], h, packet.x[lane], packet.y[lane], packet.z[lane],
                  packet.cosine[lane]);
    }
}

void fill_directions_across(const SobolPoints& points, std::uint32_t index,
                            const Hemisphere (&hemispheres)[kPacket], DirectionPacket& packet)
{
    for (int lane = 0; lane < kPacket; ++lane) {
        direction(points.reversed_u[index], points.reversed_v[index], hemispheres[lane],
                  packet.x[lane], packet.y[lane], packet.z[lane], packet.cosine[lane]);
    }
}

}  // namespace surfelao
