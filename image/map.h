/// map.h: numbers per texel, as a texture holds them: data, no colours.
#pragma once

#include <glm/vec2.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace surfelao {

/// Row 0 is the top. Invariant: values.size() == width * height * channels.
struct Map {
    Map() = default;
    Map(std::uint32_t columns, std::uint32_t rows, std::uint32_t numbers, float fill = 0.0f)
        : width(columns),
          height(rows),
          channels(numbers),
          values(std::size_t{columns} * rows * numbers, fill)
    {
    }

    std::uint32_t width = 0, height = 0;
    std::uint32_t channels = 1;
    std::vector<float> values;

    [[nodiscard]] std::size_t texels() const { return std::size_t{width} * height; }
    [[nodiscard]] std::size_t index(std::uint32_t x, std::uint32_t y) const
    {
        return (std::size_t{y} * width + x) * channels;
    }
};

/// Calls visit(texel) for the texels around one and for itself, by index over the channels, row by
/// row. Neighbours do not repeat beyond the rim.
template <class Visit>
void for_each_around(const Map& map, std::size_t texel, const Visit& visit)
{
    const auto x = static_cast<std::uint32_t>(texel % map.width);
    const auto y = static_cast<std::uint32_t>(texel / map.width);
    for (std::uint32_t row = y > 0 ? y - 1 : 0; row <= std::min(y + 1, map.height - 1); ++row)
        for (std::uint32_t column = x > 0 ? x - 1 : 0; column <= std::min(x + 1, map.width - 1);
             ++column)
            visit(std::size_t{row} * map.width + column);
}

/// How numbers from 0 to 1 stand in a file.
enum class MapDepth {
    byte,   ///< 8 bits, rounded: 1 is 255
    half,   ///< 16 bits: whole numbers in .png and .tif, a half float in .exr
    whole,  ///< 32-bit float, .tif and .exr
};

/// The four texels around a place of a map, rows of two, and their weights: they sum up to 1.
struct Footprint {
    std::size_t texels[4];  ///< row * width + column
    double weights[4];
};

/// What fetch() takes. uv must be finite.
[[nodiscard]] Footprint footprint(std::uint32_t width, std::uint32_t height, glm::dvec2 uv);

/// One channel as a viewer fetches it: linear between the four texels whose centres are around uv,
/// repeating beyond [0, 1]. uv must be finite.
[[nodiscard]] float fetch(const Map& map, std::uint32_t channel, glm::dvec2 uv);

/// Numbers as a file of this depth holds them: bytes and, where `half` means whole numbers, 16 bits
/// are rounded to the nearest step and cut to [0, 1].
void round_to_depth(Map& map, MapDepth depth, bool half_is_whole);

/// Gives texels without a value (known[i] == 0) what surrounds them, so that no filter fetches an
/// empty one: `rings` times the mean of those of the eight neighbours that have one, then the mean
/// over all that were known. Neighbours do not repeat beyond the rim. known is 1 everywhere
/// afterwards. Nothing happens where no texel has a value. O(texels); equal input gives equal
/// bytes.
void fill_around(Map& map, std::vector<std::uint8_t>& known, std::uint32_t rings);

}  // namespace surfelao
