/// fit_cells.h: the cells and samples of a fit (vertex_fit.h). Internal to it.
#pragma once

#include "bake/vertex_fit.h"

#include <cstdint>
#include <span>

namespace surfelao {

/// unknowns: per vertex. In meshes of more than kQuadsEverywhere triangles quads are looked for
/// among those of several samples only: in finer ones the cut is not seen. Two triangles make a
/// quad when they lie in one plane, meet at an edge, make a convex shape, and each is for the other
/// the neighbour with which that shape is nearest to a rectangle. O(triangles + samples).
[[nodiscard]] SurfaceSamples samples_of(const Geometry& geometry,
                                        std::span<const std::uint32_t> unknowns);

inline constexpr std::size_t kQuadsEverywhere = 1u << 16;

}  // namespace surfelao
