/// vertex_fit.h: values at vertices whose interpolation over the surface is nearest to the truth.
///
/// People see the interpolated surface. The values that look best are not those at the vertices
/// but the least-squares fit of the piecewise linear function to samples of the surface (Kavan,
/// Bargteil, Sloan. Least Squares Vertex Baking. EGSR 2011): the x that make least
///
///     sum over samples s of  w_s (sum over corners i of b_si x_i - a_s)^2
///         + sum over triangles t of  k_t A_t / 3 * sum over its edges of (x_i - x_j)^2
///
/// a_s: the answer at the sample; b_si: its barycentric weights; w_s: the area that it stands for;
/// A_t: the triangle's; k_t: kFitSmoothness, small beside the first sum: it decides where one
/// sample a triangle does not.
///
/// Unknowns are vertices: a file can hold one value for each. Vertices at one place whose normals
/// make one smooth surface there are one unknown: no seam of the file shows. At hard edges that the
/// file splits, each side has an unknown of its own.
#pragma once

#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/surface.h"

#include <glm/vec4.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace surfelao {

/// Unitless. Tried from .001 to .1 on five models: the seen error is least at .03 on all of them,
/// and up to a sixth higher at .001, where a triangle's single sample leaves its corners free.
inline constexpr double kFitSmoothness = 0.03;

/// The same in triangles at a hard edge whose faces share their vertices. The values there stand
/// for both sides at once and fit neither; what the fit makes up for beside them shows as bands
/// (stars on a roof, light lines along an edge). Seen error at .03, .06, .1: gazebo .1925, .1926,
/// .1938, blob .0111, .0117, .0127, wingnut .0089, .0087, .0087, pandora .0413, .0411, .0416.
inline constexpr double kFitSmoothnessAtEdges = 0.06;

/// Samples of a surface: at least one a triangle, and by area as many as there are triangles; of
/// coarse meshes kFewestSamples, or kMostSamplesEach a triangle where that is less. So a scan has
/// about one a triangle, and a floor of two triangles a dozen. Seen error with samples by area for
/// a half, one and four times the number of triangles: pandora .0420, .0411, .0399; bunny .0066,
/// .0066, .0064; at twice the time for four times as many.
inline constexpr std::uint64_t kFewestSamples = 2048;
inline constexpr std::uint64_t kMostSamplesEach = 8;
/// The same holds for each connected piece by itself, so that nothing that is put beside it changes
/// its samples: all pieces together may have kMoreByPiece more than one a triangle by that. Where
/// they want more, as scenes of many small pieces do, each has its share of it.
inline constexpr std::uint64_t kMoreByPiece = 2048;
inline constexpr std::uint32_t kMostSampleRows = 32;  ///< of a triangle or quad: 32^2 samples

/// Samples by cell, over which their sum runs: a triangle, or a planar quad of two. A
/// file, or whoever draws it, cuts a quad either way; so its samples see the mean of both
/// interpolations, and neither the values nor the samples depend on the cut at hand.
///
/// A triangle is cut into m^2 equal ones, a quad into m^2 cells of its bilinear map, with a sample
/// near the middle of each: evenly spread, and the same from whichever corner one looks but for
/// kSampleShift. A quad with m = 1 has one for each of its triangles instead.
struct SurfaceSamples {
    std::vector<SurfacePoint> points;
    std::vector<float> areas;                 ///< that each stands for; unit frame
    std::vector<glm::vec4> quad_weights;      ///< of the samples in quads, which come first
    std::vector<glm::uvec4> quads;            ///< the first cells: unknowns at their corners
    std::vector<std::uint32_t> first_sample;  ///< of each cell; and one more, where they end
    std::vector<std::uint8_t> rows;           ///< m of each triangle; 0: it is in a quad
};

/// In sides of the small triangles, away from their middles. Built things are symmetric: in a ship
/// of panels a fifth of a percent of all middles lay exactly in the plane of another panel.
inline constexpr float kSampleShift[2] = {0.013f, 0.007f};

/// A bent vector shorter than this has no direction: the normal stands in.
inline constexpr float kLeastBent = 1e-4f;

/// Of solve_locally(). Its values then differ from solve()'s by less than .001 RMS where answers
/// wave and have noise of .05, and nowhere by .01 (tests/bake/vertex_fit_test.cpp holds them to
/// it).
inline constexpr int kLocalSteps = 16;
/// Least eigenvalue that the steps are made for, as a share of the largest: what lies below are
/// patterns that the samples hardly see, and that their answers hardly hold.
inline constexpr double kLocalSpectrum = 1.0 / 15.0;

/// The normal equations of a mesh, solved for any answers at its samples.
class VertexFit {
public:
    /// geometry and surface must outlive it. O(n) time and memory.
    VertexFit(const Geometry& geometry, const Surface& surface, const NormalSettings& normals);
    ~VertexFit();
    VertexFit(VertexFit&&) noexcept;
    VertexFit& operator=(VertexFit&&) noexcept;

    [[nodiscard]] const SurfaceSamples& samples() const;

    /// Samples are gone until unfolded, which is quick: engines that answer meanwhile have the
    /// memory. Range behind range: the place of a sample is there until its range comes, and
    /// nothing else is. Unfolding: O(triangles), all threads.
    void fold(std::size_t first, std::size_t end);
    void unfold();

    /// One per scene vertex: occlusion, cut to [0, 1], and the bent normal: the direction of the
    /// fitted visibility times bent normal. answers: one per sample. Unused vertices: occlusion 0,
    /// their normal. O(n): some ten steps of conjugate gradients. Same bytes for any number of
    /// threads.
    [[nodiscard]] std::vector<Occlusion> solve(std::span<const Occlusion> answers) const;

    /// The same by kLocalSteps steps of the Chebyshev iteration, whose coefficients are known
    /// before (Golub, Varga. Chebyshev Semi-Iterative Methods. Numer. Math. 3. 1961): the value of
    /// a vertex depends on the samples within kLocalSteps + 1 edges, and on nothing else to the
    /// last bit. For frames of an animation: where no answer changes no value does.
    [[nodiscard]] std::vector<Occlusion> solve_locally(std::span<const Occlusion> answers) const;

    /// Vertices that no triangle with an area uses, rising.
    [[nodiscard]] std::vector<std::uint32_t> unused_vertices() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace surfelao
