/// g_buffer.h: which point of the surface each pixel of a picture sees.
///
/// Two passes. The first draws the triangles' numbers alone, the nearest wins by its distance
/// forward, kept as a float that is linear in it: the near plane costs no digits. The second finds,
/// once a pixel, where the ray through the pixel's middle meets that triangle:
///
///     picture plane, z = 1            pixel (x, y) of a lens from `low` to `high`, w x h pixels:
///        low ┌────────┐
///            │    · q │               q = low + (high - low) (x + 1/2, y + 1/2) / (w, h)
///            └────────┘ high          ray: eye + t (q.x right + q.y up + forward)
///
/// View space: x to the right, y upwards, z forward from the eye; lengths in diagonals.
///
/// Based on:
///   Burns, Hunt. The Visibility Buffer. JCGT 2(2). 2013
#pragma once

#include "gpu/context.h"
#include "gpu/draw.h"
#include "gpu/objects.h"
#include "surfels/geometry.h"
#include "surfels/surface.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// The rectangle that a picture shows: of the plane z = 1 through a pinhole; orthographic: of every
/// plane, in diagonals. low < high; row 0 of the picture lies at low.y.
struct Lens {
    glm::vec2 low{-1.0f};
    glm::vec2 high{1.0f};
    bool orthographic = false;
    bool operator==(const Lens&) const = default;
};

/// What a part of the picture of width x height pixels shows.
[[nodiscard]] Lens part_of(const Lens& lens, int width, int height, const Rect& part);
/// The samples lie `shift` of a pixel to the right and upwards of the pixels' middles.
[[nodiscard]] Lens shifted(const Lens& lens, int width, int height, glm::vec2 shift);

/// From where, and in which direction.
struct View {
    glm::vec3 eye{0.0f};
    glm::vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< unit length, at right angles
    Lens lens;
};

/// In view space. pixel: of a picture of that size, from its lower left corner; its middle is at
/// + 1/2. The ray is origin + t direction, t the distance forward.
struct PixelRay {
    glm::vec3 origin{0.0f}, direction{0.0f};
};
[[nodiscard]] PixelRay pixel_ray(const Lens& lens, int width, int height, glm::vec2 pixel);
[[nodiscard]] glm::vec3 to_view(const View& view, glm::vec3 point);
[[nodiscard]] glm::vec3 to_world(const View& view, glm::vec3 point);

/// A mesh on the device. O(n) memory; throws where it is beyond the device's buffers.
class DrawnMesh {
public:
    DrawnMesh(const GlContext& context, const Geometry& geometry, const Surface& surface);

    /// The same triangles elsewhere. positions: one per vertex; normals: one per wedge.
    void move(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals);

private:
    friend class GBuffer;
    TextureBuffer positions_, triangles_, corners_, normals_;
    VertexArray vertices_;
    std::size_t index_count_;
    float radius_ = 0.0f;  ///< of a ball about the origin that holds it
};

/// In front of all that is there; the texels of the background are (0, 0, 0, kNothingThere).
inline constexpr float kNothingThere = 1e30f;

class GBuffer {
public:
    GBuffer(const GlContext& context, int width, int height);

    /// Both passes. Earlier pictures are forgotten. cull: those triangles are not there.
    void draw(const DrawnMesh& mesh, const View& view, Cull cull = Cull::none);

    /// Values of triangles at the pixels that see them. values: RGBA32F, one texel per triangle, at
    /// its three corners and one of its own. target: RG32F, as large: interpolated, and the
    /// triangle's own; background: where nothing is seen. mesh: of the last draw().
    void draw_values(const DrawnMesh& mesh, const TextureBuffer& values, glm::vec2 background,
                     const Framebuffer& target) const;

    int width() const { return triangles_.width(); }
    int height() const { return triangles_.height(); }
    const View& view() const { return view_; }  ///< of the last drawing

    /// RGBA32F: shading normal in view space, turned to the side of the triangle that is seen, the
    /// triangle's own where the interpolated one faces away from the eye; distance forward.
    const Texture2D& surface() const { return surface_.color(); }
    /// R32F: the distance alone, which is less to fetch.
    const Texture2D& distance() const { return surface_.color(1); }

    /// 1 + triangle of the geometry, 0 where there is none; row by row from the bottom. Waits.
    [[nodiscard]] std::vector<std::uint32_t> read_triangles() const;
    /// surface(), likewise.
    [[nodiscard]] std::vector<glm::vec4> read_surface() const;

private:
    void draw_triangles(const DrawnMesh& mesh, Cull cull);
    void find_surface(const DrawnMesh& mesh);
    /// The program, with what g_point.glsl reads.
    Program& program_at_points(const DrawnMesh& mesh, const char* fragment_file) const;

    const GlContext& context_;
    Framebuffer triangles_, surface_;
    VertexArray nothing_;
    View view_;
};

}  // namespace surfelao
