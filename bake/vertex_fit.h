/// vertex_fit.h: values at vertices whose interpolation over the surface is nearest to the truth.
///
/// People see the interpolated surface. The values that look best are not those at the vertices
/// but the least-squares fit of the piecewise linear function to samples of the surface (Kavan,
/// Bargteil, Sloan. Least Squares Vertex Baking. EGSR 2011): the x that make least
///
///     sum over samples s of  w_s (sum over corners i of b_si x_i - a_s)^2
///         + kFitSmoothness * sum over triangles t of  A_t / 3 * sum over its edges of (x_i -
///         x_j)^2
///
/// a_s: the answer at the sample; b_si: its barycentric weights; w_s: the area that it stands for.
/// The second sum is small beside the first. It decides where one sample a triangle does not.
///
/// Unknowns are vertices: a file can hold one value for each. Vertices at one place whose normals
/// make one smooth surface there are one unknown: no seam of the file shows. At hard edges that the
/// file splits, each side has an unknown of its own.
#pragma once

#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/surface.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace surfelao {

/// Unitless. Tried from .001 to .1 on five models: the seen error is least at .03 on all of them,
/// and up to a sixth higher at .001, where a triangle's single sample leaves its corners free.
inline constexpr double kFitSmoothness = 0.03;

/// Samples of a surface: at least one a triangle, and as many by area as there are triangles, or
/// kFewestSamples where that is more. So a scan has about one a triangle, and a floor of two
/// triangles hundreds: twice as many cost twice the time and lower the seen error by a hundredth.
inline constexpr std::uint64_t kFewestSamples = 4096;
inline constexpr std::uint32_t kMostSampleRows = 32;  ///< per triangle: 32^2 samples

/// By triangle: those of triangle t are first[t] to first[t + 1].
struct SurfaceSamples {
    std::vector<SurfacePoint> points;
    std::vector<std::uint32_t> first;  ///< one more than triangles
};

/// Each triangle is cut into m^2 equal ones, with a sample near the middle of each: evenly spread,
/// the same from whichever corner one looks but for kSampleShift. O(triangles + samples).
[[nodiscard]] SurfaceSamples fit_samples(const Geometry& geometry);

/// In sides of the small triangles, away from their middles. Built things are symmetric: in a ship
/// of panels a fifth of a percent of all middles lay exactly in the plane of another panel.
inline constexpr float kSampleShift[2] = {0.013f, 0.007f};

/// A bent vector shorter than this has no direction: the normal stands in.
inline constexpr float kLeastBent = 1e-4f;

/// The normal equations of a mesh, solved for any answers at its samples.
class VertexFit {
public:
    /// geometry and surface must outlive it. O(n) time and memory.
    VertexFit(const Geometry& geometry, const Surface& surface, const NormalSettings& normals,
              SurfaceSamples samples);
    ~VertexFit();
    VertexFit(VertexFit&&) noexcept;
    VertexFit& operator=(VertexFit&&) noexcept;

    /// One per scene vertex: occlusion, cut to [0, 1], and the bent normal: the direction of the
    /// fitted visibility times bent normal. answers: one per sample. Unused vertices: occlusion 0,
    /// their normal. O(n): some ten steps of conjugate gradients. Same bytes for any number of
    /// threads.
    [[nodiscard]] std::vector<Occlusion> solve(std::span<const Occlusion> answers) const;

    [[nodiscard]] const SurfaceSamples& samples() const;

    /// Vertices that no triangle with an area uses, rising.
    [[nodiscard]] std::vector<std::uint32_t> unused_vertices() const;

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

}  // namespace surfelao
