#include "pixels/projected.h"

#include "surfels/for_all.h"

#include <glm/common.hpp>

#include <cmath>
#include <limits>

namespace surfelao {
namespace {

/// In pixels: four times what a float leaves of a place at the end of the largest picture.
constexpr float kRounding = 1.0f / 128.0f;

/// Far beyond every picture, and an int.
constexpr float kBeyond = 1e6f;

glm::ivec2 pixel_of(const glm::vec2& place)
{
    return glm::ivec2(glm::floor(glm::clamp(place, -kBeyond, kBeyond)));
}

}  // namespace

Projected::Projected(const Geometry& geometry, const View& view, int width, int height)
    : geometry_(geometry),
      view_(view),
      size_(width, height),
      places_(geometry.positions.size()),
      pixels_(geometry.positions.size())
{
    for_all(places_.size(), [&](std::size_t v) {
        places_[v] = to_view(view_, geometry_.positions[v]);
        if (!is_before_eye(places_[v]))
            pixels_[v] = in_picture(places_[v]);
    });
}

glm::vec3 Projected::cut(const glm::vec3& before, const glm::vec3& behind)
{
    const glm::vec3 at = glm::mix(before, behind, (kBeforeEye - before.z) / (behind.z - before.z));
    return {at.x, at.y, kBeforeEye};
}

glm::vec2 Projected::in_picture(const glm::vec3& place) const
{
    const glm::vec2 q = view_.lens.orthographic ? glm::vec2(place) : glm::vec2(place) / place.z;
    return (q - view_.lens.low) / (view_.lens.high - view_.lens.low) * glm::vec2(size_);
}

PixelBox Projected::box_around(const glm::vec2& low, const glm::vec2& high, float reach) const
{
    return {glm::max(pixel_of(low - reach), 0), glm::min(pixel_of(high + reach), size_ - 1)};
}

PixelBox Projected::box_of(const glm::uvec3& triangle) const
{
    glm::vec2 low(std::numeric_limits<float>::infinity()), high = -low;
    const auto hold = [&](const glm::vec2& at) {
        low = glm::min(low, at);
        high = glm::max(high, at);
    };
    for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t vertex = triangle[corner];
        if (!is_before_eye(places_[vertex])) {
            hold(pixels_[vertex]);
            continue;
        }
        for (int other = 0; other < 3; ++other) {
            const glm::vec3& behind = places_[triangle[other]];
            if (!is_before_eye(behind))
                hold(in_picture(cut(places_[vertex], behind)));
        }
    }
    return low.x <= high.x ? box_around(low, high, kRounding) : PixelBox{};
}

}  // namespace surfelao
