#include "image/map.h"

#include "surfels/errors.h"
#include "surfels/for_all.h"

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

std::uint32_t repeated(double texel, std::uint32_t side)
{
    const double rest = std::fmod(texel, side);
    const auto place = static_cast<std::uint32_t>(rest < 0.0 ? rest + side : rest);
    return place < side ? place : 0;
}

/// Of a texel for fill_around().
enum : std::uint8_t { kWithout, kKnown, kNext };

/// Known texels beside one without a value, and the mean of all known ones; none: empty.
struct Rim {
    std::vector<std::size_t> texels;
    std::vector<float> mean;
};

Rim rim_of(const Map& map, const std::vector<std::uint8_t>& known)
{
    struct Row {
        std::vector<std::size_t> rim;
        std::vector<double> sums;
        std::size_t count = 0;
    };
    std::vector<Row> rows(map.height);
    constexpr std::size_t kRowGrain = 4;
    for_all(rows.size(), kRowGrain, [&](std::size_t y) {
        Row& row = rows[y];
        row.sums.assign(map.channels, 0.0);
        for (std::size_t texel = y * map.width; texel < (y + 1) * map.width; ++texel) {
            if (known[texel] == kWithout)
                continue;
            ++row.count;
            for (std::uint32_t c = 0; c < map.channels; ++c)
                row.sums[c] += map.values[texel * map.channels + c];
            bool is_rim = false;
            for_each_around(map, texel,
                            [&](std::size_t other) { is_rim |= known[other] == kWithout; });
            if (is_rim)
                row.rim.push_back(texel);
        }
    });
    Rim rim;
    std::vector<double> sums(map.channels, 0.0);
    std::size_t count = 0;
    for (const Row& row : rows) {
        rim.texels.insert(rim.texels.end(), row.rim.begin(), row.rim.end());
        count += row.count;
        for (std::uint32_t c = 0; c < map.channels; ++c)
            sums[c] += row.sums[c];
    }
    for (const double sum : sums)
        if (count > 0)
            rim.mean.push_back(static_cast<float>(sum / static_cast<double>(count)));
    return rim;
}

}  // namespace

Footprint footprint(std::uint32_t width, std::uint32_t height, glm::dvec2 uv)
{
    const double x = uv.x * width - 0.5, y = uv.y * height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const std::uint32_t columns[2] = {repeated(left, width), repeated(left + 1.0, width)};
    const std::uint32_t rows[2] = {repeated(top, height), repeated(top + 1.0, height)};
    Footprint print;
    for (int k = 0; k < 4; ++k) {
        const int i = k % 2, j = k / 2;
        print.texels[k] = std::size_t{rows[j]} * width + columns[i];
        print.weights[k] =
            (i == 1 ? x - left : 1.0 - x + left) * (j == 1 ? y - top : 1.0 - y + top);
    }
    return print;
}

float fetch(const Map& map, std::uint32_t channel, glm::dvec2 uv)
{
    const Footprint print = footprint(map.width, map.height, uv);
    double sum = 0.0;
    for (int k = 0; k < 4; ++k)
        sum += print.weights[k] * map.values[print.texels[k] * map.channels + channel];
    return static_cast<float>(sum);
}

void round_to_depth(Map& map, MapDepth depth, bool half_is_whole)
{
    if (depth == MapDepth::whole || (depth == MapDepth::half && !half_is_whole))
        return;
    const float steps = depth == MapDepth::byte ? 255.0f : 65535.0f;
    for (float& value : map.values)
        value = std::round(std::clamp(value, 0.0f, 1.0f) * steps) / steps;
}

void fill_around(Map& map, std::vector<std::uint8_t>& known, std::uint32_t rings)
{
    SURFELAO_CHECK(known.size() == map.texels());
    const Rim rim = rim_of(map, known);
    if (rim.mean.empty())
        return;
    std::vector<std::size_t> front = rim.texels;
    for (std::uint32_t ring = 0; ring < rings && !front.empty(); ++ring) {
        std::vector<std::size_t> next;
        for (const std::size_t texel : front)
            for_each_around(map, texel, [&](std::size_t other) {
                if (known[other] != kWithout)
                    return;
                known[other] = kNext;
                next.push_back(other);
            });
        for_all(next.size(), [&](std::size_t i) {
            for (std::uint32_t c = 0; c < map.channels; ++c) {
                double sum = 0.0, count = 0.0;
                for_each_around(map, next[i], [&](std::size_t other) {
                    if (known[other] != kKnown)
                        return;
                    ++count;
                    sum += map.values[other * map.channels + c];
                });
                map.values[next[i] * map.channels + c] = static_cast<float>(sum / count);
            }
        });
        for (const std::size_t texel : next)
            known[texel] = kKnown;
        front = std::move(next);
    }
    for_all(known.size(), [&](std::size_t texel) {
        if (known[texel] != kWithout)
            return;
        std::ranges::copy(rim.mean,
                          map.values.begin() + static_cast<std::ptrdiff_t>(texel * map.channels));
        known[texel] = kKnown;
    });
}

}  // namespace surfelao
