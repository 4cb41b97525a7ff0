/// seen.h: what the pixels of a picture see of a mesh, as receivers.
///
/// A receiver of a pixel is that of its surface point (surfels/surface.h), on the side of the
/// triangle from which it is seen: no other turn of the normal, so that two cameras ask the same of
/// the same point.
#pragma once

#include "gpu/g_buffer.h"
#include "pixels/camera.h"
#include "pixels/projected.h"
#include "pixels/rims.h"
#include "surfels/receiver.h"
#include "surfels/surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// width, height: of the picture, in pixels.
[[nodiscard]] View view_of(const Camera& camera, int width, int height);

/// Positions that triangles use, all where there are no triangles: what a camera frames.
[[nodiscard]] std::vector<glm::vec3> framed_points(const Geometry& geometry);

/// Where a ray of view space meets a triangle's plane, moved into the triangle where rounding, or a
/// pixel at its very edge, puts it beside it.
[[nodiscard]] SurfacePoint point_on_ray(const Geometry& geometry, const View& view,
                                        const PixelRay& ray, std::uint32_t triangle);

/// Those of the pixels that see something, rising: column + width * row, row 0 at the bottom.
struct SeenPixels {
    int width = 0, height = 0;
    std::vector<std::uint32_t> pixels;
    std::vector<SurfacePoint> points;  ///< one per pixel
    std::vector<Receiver> receivers;   ///< likewise
};

/// What the middles of a picture see, found on the CPU. projected: of mesh.geometry. O(triangles),
/// and the pixels that they cover.
[[nodiscard]] SeenPixels seen_pixels(const Mesh& mesh, const Projected& projected,
                                     const Offset& offset = {});

/// What a device has drawn. triangles: GBuffer::read_triangles() of the mesh's geometry. O(pixels).
/// At rims the nearer triangle counts (rims.h).
[[nodiscard]] SeenPixels seen_pixels(const Mesh& mesh, const View& view, int width, int height,
                                     std::span<const std::uint32_t> triangles,
                                     const Offset& offset = {});

/// The same, for several views. rims and projected: of mesh.geometry.
[[nodiscard]] SeenPixels seen_pixels(const Mesh& mesh, const Rims& rims, const Projected& projected,
                                     std::span<const std::uint32_t> triangles,
                                     const Offset& offset = {});

/// receivers_at(), and those of which the eye sees the other side turned over.
[[nodiscard]] std::vector<Receiver> receivers_facing(const Mesh& mesh, const View& view,
                                                     std::span<const SurfacePoint> points,
                                                     const Offset& offset = {});

/// The part of the scene that each triangle of the geometry belongs to.
[[nodiscard]] std::vector<std::uint32_t> parts_of(const Mesh& mesh);

}  // namespace surfelao
