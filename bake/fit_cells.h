/// fit_cells.h: the cells and samples of a fit (vertex_fit.h). Internal to it.
#pragma once

#include "bake/vertex_fit.h"

#include <cstdint>
#include <span>

namespace surfelao {

/// unknowns: per vertex. Quads are looked for among triangles of several samples: in finer ones the
/// cut is not seen. Two triangles make a quad when they lie in one plane, meet at an edge, make a
/// convex shape, and each is for the other the neighbour with which that shape is nearest to a
/// rectangle. O(triangles + samples).
[[nodiscard]] SurfaceSamples samples_of(const Geometry& geometry,
                                        std::span<const std::uint32_t> unknowns);

/// In the unit frame, squared.
[[nodiscard]] double area_of(const Geometry& geometry, std::size_t triangle);

}  // namespace surfelao
