/// edge_pixels.h: which pixels may see more than one surface.
///
/// To look at every sample inside of every pixel costs more than all answers do, and says nothing
/// new nearly everywhere. A pixel sees one surface, unless
///
///     one of the eight pixels around it     another part, a normal or a plane unlike its own
///     sees another one                      (place.h), or nothing
///     an outline crosses it                 an edge where a surface ends, turns from the eye or
///                                           its normal jumps, nearer than something that the
///                                           pixel's middle or one of those around sees
///
/// The first finds bodies that stick in each other, whose common line is no edge of a mesh; the
/// second what is thinner than a pixel.
#pragma once

#include "pixels/projected.h"
#include "pixels/seen.h"

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Of a mesh, for any view. Any number of threads at once.
class EdgeFinder {
public:
    /// mesh and parts, parts_of(mesh), must outlive it. O(vertices + triangles).
    EdgeFinder(const Mesh& mesh, std::span<const std::uint32_t> parts);

    /// Rising: column + width * row, row 0 at the bottom. middles: what the pixels see at their
    /// middles. O(triangles + pixels), and the length of all outlines in pixels.
    [[nodiscard]] std::vector<std::uint32_t> find(const Projected& projected,
                                                  const SeenPixels& middles) const;

private:
    std::span<const std::uint32_t> parts_;
    /// Per position: whether a surface ends there or its normal jumps, from wherever it is seen.
    std::vector<std::uint8_t> ends_;
};

}  // namespace surfelao
