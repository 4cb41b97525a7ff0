/// projected.h: the vertices of a mesh as they lie in a picture.
#pragma once

#include "gpu/g_buffer.h"
#include "surfels/geometry.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace surfelao {

/// Nearer to the eye's plane, in diagonals, nothing is in the picture.
inline constexpr float kBeforeEye = 1e-6f;

/// Pixels from `first` to `last`, both in it; empty where last is below first.
struct PixelBox {
    glm::ivec2 first{0}, last{-1};
    [[nodiscard]] bool is_empty() const { return last.x < first.x || last.y < first.y; }
};

/// A picture of width x height pixels has row 0 at the bottom, a pixel's middle at + 1/2.
class Projected {
public:
    /// geometry must outlive it. O(vertices): 20 bytes each.
    Projected(const Geometry& geometry, const View& view, int width, int height);

    [[nodiscard]] const Geometry& geometry() const { return geometry_; }
    [[nodiscard]] const View& view() const { return view_; }
    [[nodiscard]] glm::ivec2 size() const { return size_; }

    /// In view space.
    [[nodiscard]] const glm::vec3& place(std::uint32_t vertex) const { return places_[vertex]; }
    /// In pixels, of a vertex that is not before the eye.
    [[nodiscard]] const glm::vec2& pixel(std::uint32_t vertex) const { return pixels_[vertex]; }
    /// Whether a place of view space is too near to the eye's plane, or behind it.
    [[nodiscard]] static bool is_before_eye(const glm::vec3& place) { return place.z < kBeforeEye; }
    /// Where a line comes into what lies behind kBeforeEye, from a place before it.
    [[nodiscard]] static glm::vec3 cut(const glm::vec3& before, const glm::vec3& behind);

    /// In pixels. place: of view space, not before the eye.
    [[nodiscard]] glm::vec2 in_picture(const glm::vec3& place) const;
    /// What grows with the distance forward and is linear in the picture.
    [[nodiscard]] float depth_of(float forward) const
    {
        return view_.lens.orthographic ? forward : -1.0f / forward;
    }

    /// The pixels around places, in pixels, that are as near as reach.
    [[nodiscard]] PixelBox box_around(const glm::vec2& low, const glm::vec2& high,
                                      float reach) const;
    /// The pixels that hold a triangle of the geometry.
    [[nodiscard]] PixelBox box_of(const glm::uvec3& triangle) const;

private:
    const Geometry& geometry_;
    View view_;
    glm::ivec2 size_;
    std::vector<glm::vec3> places_;
    std::vector<glm::vec2> pixels_;  // of what is not before the eye
};

}  // namespace surfelao
