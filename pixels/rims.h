/// rims.h: which of two triangles is seen where a surface folds away from the eye.
///
/// The device rounds corners to 1/256 of a pixel. Where the nearer triangle of a fold ends a little
/// too early, a sample sees the one behind it, from inside of the body: closed, and so a black
/// pixel on a bright rim.
///
///      eye     nearer     rim
///       o      ----------.
///                       /         a sample as near to the rim as that belongs to the nearer
///              behind  /          triangle, at the nearest place of the edge that both have
///
#pragma once

#include "pixels/projected.h"
#include "surfels/edges.h"
#include "surfels/geometry.h"
#include "surfels/surface.h"

#include <cstdint>

namespace surfelao {

/// In pixels: twice the rounding of a corner, once for each of the two that an edge has.
inline constexpr float kRimWidth = 1.0f / 64.0f;

/// Any number of threads at once.
class Rims {
public:
    /// geometry must outlive it. O(triangles).
    explicit Rims(const Geometry& geometry)
        : geometry_(geometry), corners_(corners_around(geometry.triangles, geometry.welded))
    {
    }

    /// The point, or that of the nearer triangle. projected: of the geometry.
    [[nodiscard]] SurfacePoint nearer(const Projected& projected, const SurfacePoint& point) const;

private:
    [[nodiscard]] std::uint32_t welded(std::uint32_t triangle, int corner) const
    {
        return geometry_.welded[geometry_.triangles[triangle][corner]];
    }
    /// A point on a triangle in front of this one, or the point itself.
    [[nodiscard]] SurfacePoint step(const Projected& projected, const SurfacePoint& point) const;
    /// Of two that meet: whether the other one hides this one where both are seen.
    [[nodiscard]] bool is_in_front(const View& view, std::uint32_t other,
                                   std::uint32_t triangle) const;

    const Geometry& geometry_;
    Buckets<std::uint32_t> corners_;
};

}  // namespace surfelao
