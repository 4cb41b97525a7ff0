#include "grid/ao_grid.h"

#include "grid/cone.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

/// From the middle of the box, in half its size.
glm::dvec3 in_half_boxes(const AoGrid& grid, glm::dvec3 place)
{
    return (place - 0.5 * (grid.low + grid.high)) / (0.5 * (grid.high - grid.low));
}

double farthest_out(glm::dvec3 x)
{
    return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
}

}  // namespace

std::string name_of(GridStore store)
{
    return store == GridStore::cone ? "cone" : "sh";
}

std::string name_of(GridBorder border)
{
    return border == GridBorder::fade ? "fade" : "rescale";
}

float warped(float x, float a, float s)
{
    const float size = std::abs(x);
    const float u = size < a ? s * size / a : s + (1.0f - s) * (size - a) / (1.0f - a);
    return std::copysign(u, x);
}

float unwarped(float u, float a, float s)
{
    const float size = std::abs(u);
    const float x = size < s ? a * size / s : a + (1.0f - a) * (size - s) / (1.0f - s);
    return std::copysign(x, u);
}

glm::dvec3 place_of(const AoGrid& grid, glm::vec3 cell)
{
    const glm::dvec3 middle = 0.5 * (grid.low + grid.high), half = 0.5 * (grid.high - grid.low);
    glm::dvec3 place;
    for (int axis = 0; axis < 3; ++axis) {
        const float u = 2.0f * cell[axis] / static_cast<float>(grid.cells[axis] - 1) - 1.0f;
        place[axis] = middle[axis] + half[axis] * static_cast<double>(unwarped(u, grid.inner[axis],
                                                                               grid.inner_share));
    }
    return place;
}

CellBlend blend_at(const AoGrid& grid, glm::dvec3 place)
{
    const glm::dvec3 x = in_half_boxes(grid, place);
    glm::ivec3 first;
    glm::vec3 share;
    for (int axis = 0; axis < 3; ++axis) {
        const float u = warped(static_cast<float>(x[axis]), grid.inner[axis], grid.inner_share);
        const int last = grid.cells[axis] - 1;
        const float at = std::clamp(0.5f * (u + 1.0f), 0.0f, 1.0f) * static_cast<float>(last);
        first[axis] = std::min(static_cast<int>(at), last - 1);
        share[axis] = at - static_cast<float>(first[axis]);
    }
    CellBlend blend;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::vec3 part = glm::mix(1.0f - share, share, glm::vec3(step));
        blend.cells[corner] = grid.index_of(first + step);
        blend.weights[corner] = part.x * part.y * part.z;
    }
    return blend;
}

void read_values(const AoGrid& grid, glm::dvec3 place, float* values)
{
    const std::size_t channels = channels_of(grid.store);
    std::fill_n(values, channels, 0.0f);
    if (!(farthest_out(in_half_boxes(grid, place)) <= 1.0))
        return;
    const CellBlend blend = blend_at(grid, place);
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const float* cell = grid.values.data() + blend.cells[corner] * channels;
        for (std::size_t c = 0; c < channels; ++c)
            values[c] += blend.weights[corner] * cell[c];
    }
}

float border_weight(const AoGrid& grid, glm::dvec3 place, float alpha)
{
    const double out = farthest_out(in_half_boxes(grid, place));
    if (!(out <= 1.0))
        return 0.0f;
    if (grid.border == GridBorder::fade)
        return glm::smoothstep(0.0f, kGridFade, static_cast<float>(1.0 - out));
    if (alpha <= grid.border_value)
        return 0.0f;
    return (alpha - grid.border_value) / ((1.0f - grid.border_value) * alpha);
}

float occlusion_of(GridStore store, const float* values, glm::vec3 normal)
{
    if (store == GridStore::cone)
        return occlusion_by(cone_of(moments_of(store, values)), normal);
    const Harmonics harmonics = harmonics_along(normal);
    float sum = 0.0f;
    for (std::size_t k = 0; k < kHarmonics; ++k)
        sum += cosine_weight(k) * values[k] * harmonics[k];
    return std::clamp(sum, 0.0f, 1.0f);
}

void read_values_in_border(const AoGrid& grid, glm::dvec3 place, float* values)
{
    read_values(grid, place, values);
    const float weight = border_weight(grid, place, moments_of(grid.store, values).w);
    for (std::size_t c = 0; c < channels_of(grid.store); ++c)
        values[c] *= weight;
}

float occlusion_at(const AoGrid& grid, glm::dvec3 place, glm::vec3 normal)
{
    Harmonics values;
    static_assert(channels_of(GridStore::cone) <= kHarmonics);
    read_values_in_border(grid, place, values.data());
    return occlusion_of(grid.store, values.data(), normal);
}

}  // namespace surfelao
