/// charts.h: a surface cut into pieces that lie flat without lying on themselves.
///
/// A chart is a connected piece of the surface and a direction, its axis: seen along it, from far
/// away, each triangle shows its front, and none is behind another. So charts grow over the edges
/// of a half-edge mesh, from the largest triangle that is left, as far as the surface keeps facing
/// the axis within a limit and the plane is free (occupancy.h), but never over a hard edge: there
/// values step, which no filter may smooth. Then charts with a common smooth border become one
/// wherever that is possible, longest border first; small ones are less particular.
#pragma once

#include "surfels/half_edges.h"
#include "surfels/progress.h"
#include "surfels/surface.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace surfelao {

/// The triangles of a mesh as charts are made of them. All per triangle of the geometry.
struct Facets {
    /// Vertices whose positions are meant, welded; of a triangle that would turn round by that, its
    /// own. Such a triangle has no neighbours.
    std::vector<glm::uvec3> corners;
    std::vector<glm::vec3> normals;  ///< of unit length
    std::vector<glm::vec3> shading;  ///< the mean of its corner normals, of unit length: what tells
                                     ///< which way a rough surface faces
    std::vector<double> areas;       ///< in the unit frame
    std::vector<Neighbours> neighbours;
    /// Of each side: whether the surface is shaded as one across it, at either end; else it is
    /// hard.
    std::vector<std::array<bool, 3>> is_smooth;
};

/// O(n).
[[nodiscard]] Facets make_facets(const Mesh& mesh);

/// Invariants: right, up and the axis are of unit length and at right angles, right x up = axis; of
/// all triangles normal . axis > 0; their projections do not overlap.
struct Chart {
    glm::dvec3 right{0.0}, up{0.0}, axis{0.0};
    std::vector<std::uint32_t> triangles;  ///< of the geometry, rising
    double area = 0.0;                     ///< of the surface, in the unit frame
    double scale = 1.0;  ///< so that what is flat has the area of the surface: sqrt(true / flat)

    /// Where a place of the unit frame lies in the chart, y up.
    [[nodiscard]] glm::dvec2 at(glm::dvec3 position) const;
};

/// Degrees between a chart's axis and the shading of what belongs to it.
inline constexpr double kChartLimit = 65.0;
/// The same for charts so small that nobody sees how they are stretched, and for the normal itself
/// of any triangle: beyond, a twentieth of its area would be left.
inline constexpr double kSteepest = 85.0;
/// So small are charts of fewer texels than this, which join over hard edges too, and charts of
/// fewer triangles, unless they have more texels than that.
inline constexpr double kSmallChartTexels = 16.0;
inline constexpr std::size_t kFewChartTriangles = 8;
inline constexpr double kFewChartTexels = 256.0;
/// Strips narrower than this (twice the area over the perimeter), as along a fluted column, join
/// over hard edges as well: on their own they would be half padding. Not those of few triangles:
/// posts and boards have flat sides, each with values of its own.
inline constexpr double kNarrowTexels = 32.0;
/// Degrees between corner normals at one place from which on an edge is hard.
inline constexpr double kHardEdge = 20.0;

/// Each triangle in one chart. texel: the side of a texel in the unit frame, for what is small.
/// About 2 us a triangle, one thread; equal input gives equal bytes. progress: a unit a triangle.
[[nodiscard]] std::vector<Chart> make_charts(const Mesh& mesh, const Facets& facets, double texel,
                                             ProgressMeter& progress);

/// The two sides of a chart as charts of their own, each of them in its connected pieces: the
/// triangles with is_beyond (one per triangle of the chart, in their order), and the others. O(n).
[[nodiscard]] std::vector<Chart> cut(const Mesh& mesh, const Facets& facets, const Chart& chart,
                                     const std::vector<std::uint8_t>& is_beyond);

/// The charts of one page of a blended map (layout.h): of the triangles that have a weight there,
/// by the sides of the axis (0 to 2 for x, y, z) that they face. Each triangle lies on at least one
/// of the three pages, in one chart of each.
[[nodiscard]] std::vector<Chart> make_axis_charts(const Mesh& mesh, const Facets& facets, int axis,
                                                  ProgressMeter& progress);

}  // namespace surfelao
