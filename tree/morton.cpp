#include "tree/morton.h"

#include "surfels/for_all.h"

#include <glm/common.hpp>

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

constexpr double kCells = 2097152.0;  // 2^21 cells along each axis

/// Puts two zero bits after each of the lowest 21 bits.
std::uint64_t spread(std::uint64_t x)
{
    x = (x | x << 32) & 0x001F00000000FFFFull;
    x = (x | x << 16) & 0x001F0000FF0000FFull;
    x = (x | x << 8) & 0x100F00F00F00F00Full;
    x = (x | x << 4) & 0x10C30C30C30C30C3ull;
    return (x | x << 2) & 0x1249249249249249ull;
}

/// Beyond twice the unit frame lengths count by their logarithm: a terrain a million times as large
/// as the scene would leave it a single cell.
double drawn_in(float x)
{
    const double far = std::abs(static_cast<double>(x));
    return far <= 1.0 ? x : std::copysign(1.0 + std::log(far), x);
}

glm::dvec3 drawn_in(glm::vec3 point)
{
    return {drawn_in(point.x), drawn_in(point.y), drawn_in(point.z)};
}

std::uint64_t cell(double offset, double cells_per_length)
{
    return static_cast<std::uint64_t>(std::clamp(offset * cells_per_length, 0.0, kCells - 1.0));
}

}  // namespace

std::vector<MortonKey> morton_order(std::span<const glm::vec3> points)
{
    if (points.empty())
        return {};
    glm::vec3 low = points[0];
    glm::vec3 high = points[0];
    for (const glm::vec3& point : points) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    const glm::dvec3 begin = drawn_in(low), size = drawn_in(high) - begin;
    const double side = std::max({size.x, size.y, size.z});
    const double cells_per_length = side > 0.0 ? kCells / side : 0.0;

    std::vector<MortonKey> keys(points.size());
    for_all(points.size(), [&](std::size_t i) {
        const glm::dvec3 offset = drawn_in(points[i]) - begin;
        keys[i].code = spread(cell(offset.x, cells_per_length)) |
                       spread(cell(offset.y, cells_per_length)) << 1 |
                       spread(cell(offset.z, cells_per_length)) << 2;
        keys[i].index = static_cast<std::uint32_t>(i);
    });
    tbb::parallel_sort(keys, [](const MortonKey& a, const MortonKey& b) {
        return a.code != b.code ? a.code < b.code : a.index < b.index;
    });
    return keys;
}

}  // namespace surfelao
