#include "image/map.h"

#include "surfels/errors.h"

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

/// Texels without a value beside one of `front`, each once, rising.
std::vector<std::size_t> ring_around(const Map& map, const std::vector<std::uint8_t>& known,
                                     const std::vector<std::size_t>& front)
{
    std::vector<std::size_t> ring;
    for (const std::size_t texel : front)
        for_each_around(map, texel, [&](std::size_t neighbour) {
            if (known[neighbour] == 0)
                ring.push_back(neighbour);
        });
    std::ranges::sort(ring);
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    return ring;
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
    std::vector<std::size_t> front;
    std::vector<double> mean(map.channels, 0.0);
    double count = 0.0;
    for (std::size_t texel = 0; texel < known.size(); ++texel) {
        if (known[texel] == 0)
            continue;
        ++count;
        for (std::uint32_t c = 0; c < map.channels; ++c)
            mean[c] += map.values[texel * map.channels + c];
        bool is_rim = false;
        for_each_around(map, texel, [&](std::size_t other) { is_rim |= known[other] == 0; });
        if (is_rim)
            front.push_back(texel);
    }
    if (count == 0.0)
        return;
    for (std::uint32_t ring = 0; ring < rings && !front.empty(); ++ring) {
        front = ring_around(map, known, front);
        for (const std::size_t texel : front) {
            double neighbours = 0.0;
            std::vector<double> sums(map.channels, 0.0);
            for_each_around(map, texel, [&](std::size_t other) {
                if (known[other] == 0)
                    return;
                ++neighbours;
                for (std::uint32_t c = 0; c < map.channels; ++c)
                    sums[c] += map.values[other * map.channels + c];
            });
            for (std::uint32_t c = 0; c < map.channels; ++c)
                map.values[texel * map.channels + c] = static_cast<float>(sums[c] / neighbours);
        }
        for (const std::size_t texel : front)
            known[texel] = 1;
    }
    for (std::size_t texel = 0; texel < known.size(); ++texel) {
        if (known[texel] != 0)
            continue;
        for (std::uint32_t c = 0; c < map.channels; ++c)
            map.values[texel * map.channels + c] = static_cast<float>(mean[c] / count);
        known[texel] = 1;
    }
}

}  // namespace surfelao
