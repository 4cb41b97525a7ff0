/// surface_error.h: what people see of a mesh with values at its vertices, or with a map, against
/// the truth.
///
/// *Surface points* lie all over the surface, uniform by area; the *truth* is traced there with
/// many robust rays (reference/reference_cache.h). Points that have no well-defined answer
/// (reference/well_defined.h) are left out, and counted.
///
/// - **Solve error**: an engine's answers at the surface points against the truth.
/// - **Seen error**: what is displayed there, interpolated from the vertices or fetched between
///   texels, against the truth.
/// - **Floor**: the seen error of the best values that these vertices can hold: the fit
///   (vertex_fit.h) of the reference's answers. It belongs to the mesh, not to the engine. Of a
///   map: what it shows when every texel has the answer of many rays.
/// - **Beyond**: RMS over the surface points of what is displayed less what the floor's values
///   display: the engine's part. Least squares makes the floor's own error orthogonal to all that
///   vertices can hold, so that seen^2 = floor^2 + beyond^2 but for the fit's few samples, its
///   smoothness and its other cut of quads: to a few percent of beyond. (A map is no least square,
///   but what its texels cannot hold is between them, where no engine is asked.) Where the floor is
///   .2 the fourth digit of either error decides over that difference of squares; beyond has it
///   first.
///
/// All RMS figures are what they would be with exact references: the variances of the noise of
/// truth and floor, both known from two independent halves, are taken out of the squares.
#pragma once

#include "bake/statistics.h"
#include "bake/vertex_target.h"
#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"
#include "surfels/surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// With so many an RMSE is right to about a hundredth of itself.
inline constexpr std::uint64_t kSurfacePoints = 20'000;

/// `count` points, uniform by area: one in each of as many equal stretches of the area, triangle
/// after triangle, so that every triangle gets its share but for one point. None where there is no
/// triangle. Equal input gives equal bytes. O(triangles + count).
[[nodiscard]] std::vector<SurfacePoint> surface_points(const Geometry& geometry,
                                                       std::uint64_t count);

/// The same for another measure than the area, one per triangle, >= 0: in each triangle points are
/// as many as it has of it.
[[nodiscard]] std::vector<SurfacePoint> surface_points(std::span<const double> measure,
                                                       std::uint64_t count);

/// The indices, rising, on which `count` points fall when the measures lie one behind the other and
/// each of as many equal stretches has one. None where all are 0.
[[nodiscard]] std::vector<std::uint32_t> stratified(std::span<const double> measure,
                                                    std::uint64_t count);

struct TruthSettings {
    Definition definition = {};
    Offset offset;                          ///< of the points: that of the target (offset_of)
    std::uint64_t points = kSurfacePoints;  ///< >= 1
    std::uint32_t rays = 4096;              ///< per point, an even number
    bool use_cache = true;
    std::vector<double> measure = {};  ///< per triangle, >= 0: by it points lie; empty: by area
    bool leave_out_hidden = false;     ///< points inside of bodies, as maps do (hidden_texels.h)
};

/// The well-defined surface points and what is true there; one entry per point in each list.
struct SurfaceTruth {
    std::vector<SurfacePoint> points;
    std::vector<Receiver> receivers;
    std::vector<Occlusion> reference;
    double noise = 0.0;             ///< RMS error of the reference's occlusion by sampling
    std::uint64_t ill_defined = 0;  ///< points that were left out
    std::uint64_t hidden = 0;       ///< points that were left out for lying inside of bodies
    bool from_cache = false;
};

/// Costs rays + 1280 rays a point. Throws SettingsError as trace_reference does, Cancelled.
[[nodiscard]] SurfaceTruth trace_truth(const Mesh& mesh, const TruthSettings& settings,
                                       const Progress& progress = {});

/// What is seen at the points: occlusion interpolated, bent normals interpolated and normalised
/// (zero where they cancel). values: one per vertex.
[[nodiscard]] std::vector<Occlusion> displayed_at(const Geometry& geometry,
                                                  std::span<const Occlusion> values,
                                                  std::span<const SurfacePoint> points);

/// Of an engine's answers, or of what is displayed: one per point of the truth.
[[nodiscard]] ErrorStatistics error_against(const SurfaceTruth& truth,
                                            std::span<const Occlusion> answers);

/// error_against() what is displayed of values, one per vertex.
[[nodiscard]] ErrorStatistics seen_error(const Geometry& geometry,
                                         std::span<const Occlusion> values,
                                         const SurfaceTruth& truth);

/// The best values of a mesh, and what they show.
struct Floor {
    std::vector<Occlusion> values;     ///< per vertex: the fit of the reference; per texel: its
                                       ///< answer or what fills it, without bent normals
    std::vector<Occlusion> displayed;  ///< of these, one per point of the truth
    ErrorStatistics error;
    double noise = 0.0;      ///< RMS error of `displayed` by sampling
    std::uint32_t rays = 0;  ///< per receiver
    bool from_cache = false;
};

/// Rays a receiver of the fit: the fit averages over receivers, so that few of many will do.
/// Receivers times rays are about this, with a power of two between the ends.
inline constexpr double kFloorRays = 8e7;
inline constexpr std::uint32_t kFewestFloorRays = 256, kMostFloorRays = 4096;

/// As many as that, but no more than `truth_rays`.
[[nodiscard]] std::uint32_t floor_rays(std::size_t receivers, std::uint32_t truth_rays);

/// fitted: the mesh's target with VertexValues::fit. settings: those of the truth; no more rays are
/// traced than there. Throws as trace_truth().
[[nodiscard]] Floor find_floor(const VertexTarget& fitted, const Mesh& mesh,
                               const SurfaceTruth& truth, const TruthSettings& settings,
                               const Progress& progress = {});

/// RMS of displayed - floor, one per point of the truth, without the floor's noise.
[[nodiscard]] double error_beyond(std::span<const Occlusion> displayed, const Floor& floor);

}  // namespace surfelao
