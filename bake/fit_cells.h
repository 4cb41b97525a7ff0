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

/// Appends the cells and samples of the triangles to those of the quads. areas: triangle_areas().
void add_triangles(std::span<const double> areas, SurfaceSamples& samples);

/// Leaves those of the quads, but the places of samples before `first` and from `end` on: range
/// behind range, each place is there until its range comes, the areas and cells until the first.
void drop_triangles(SurfaceSamples& samples, std::size_t first, std::size_t end);

inline constexpr std::size_t kQuadsEverywhere = 1u << 16;

}  // namespace surfelao
