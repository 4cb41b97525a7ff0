/// stated_error.h: how wrong a bake is, by its own measure: few points, few rays, an interval.
///
/// compare (surface_error.h) knows the seen error of a scene to a hundredth, and takes minutes. A
/// bake has a tenth of its own time. So the points lie where they tell most: a mean square is known
/// best when each point is drawn in proportion to the error that one expects there (importance
/// sampling), and a fit knows that from its own misfits (vertex_target.h) and from how much the
/// values differ in a triangle. Each point counts for the inverse of its density, so that the
/// estimate is right whatever was expected.
///
/// The truth at a point has the noise of its rays. Two independent halves t1, t2 of them give
/// (d - t1)(d - t2), of which the mean is the square of the error without noise.
///
/// Judged on generated scenes (tests/family.h) by `./run tables stated`: docs/measurements.md.
#pragma once

#include "bake/vertex_target.h"
#include "reference/rays.h"
#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"
#include "surfels/surface.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// With so many, half of all intervals are narrower than a fifth of the error.
inline constexpr std::uint32_t kCheckPoints = 400;
/// The ends of an interval are rounded away from its middle to multiples of this: nobody sees less,
/// and the rays' noise is known no better.
inline constexpr double kStatedStep = 1e-4;
inline constexpr std::uint32_t kMostCheckPoints = 1'000'000;
/// Of each point; four times as many, up to the most, where their noise is above the error that is
/// to be known. It is .004 with 512 rays on scans, .0006 with 8192.
inline constexpr std::uint32_t kCheckRays = 512, kMostCheckRays = 8192;
/// For one in so many points rays are traced at one of the fit's samples too, for the floor: what
/// is asked there, error^2 - floor^2, needs few.
inline constexpr std::uint32_t kFloorStride = 4;

/// Points that err by more are asked whether they are well-defined: fewer would change no figure.
inline constexpr float kSuspicious = 0.1f;

/// A triangle's points are its area times (misfit^2 + (kCheckRange r)^2 + kCheckLeast^2)^(3/4), r:
/// largest less smallest value at its corners. Chosen on the family's first half: by area alone the
/// intervals are two and a half times as wide and hold in 90 instead of 97 of 100 bakes; without r
/// in 94; with the power 1 or 1/2 instead of 3/4 they are as good but a little wider.
inline constexpr float kCheckRange = 1.0f;
inline constexpr float kCheckLeast = 0.005f;

/// Errors of occlusion as displayed (seen errors, surface_error.h).
struct StatedError {
    double rmse = 0.0;
    double low = 0.0;  ///< of `rmse`: in 95 of 100 bakes it lies between these
    double high = 0.0;
    double bias = 0.0;            ///< positive: too dark
    double p95 = 0.0;             ///< 95 % of the surface err by at most this, noise included
    std::optional<double> floor;  ///< of fitted values: what more exact answers would leave
    double least_floor = 0.0;     ///< in 95 of 100 bakes the floor is not below
    std::uint32_t points = 0;
    std::uint32_t rays = 0;         ///< per point
    std::uint32_t ill_defined = 0;  ///< points that were left out
};

/// What is displayed at a point of the surface: occlusion, whatever holds it.
using Shown = std::function<float(const SurfacePoint&)>;

/// Where points tell most of values at vertices that were fitted to answers: the density of points
/// over the area, one per triangle, without a unit. O(n).
[[nodiscard]] std::vector<double> density_for(const Geometry& geometry, const VertexTarget& target,
                                              std::span<const Occlusion> answers,
                                              std::span<const Occlusion> values);

/// Where occlusion is asked for points of a surface.
using ReceiversOf = std::function<std::vector<Receiver>(std::span<const SurfacePoint>)>;

/// Points of a mesh and what is true there; measures whatever is displayed on it.
class ErrorCheck {
public:
    /// Chooses the points. mesh must outlive it. density: one per triangle; where it is 0, as where
    /// nothing is displayed, the surface does not count. offset: that of
    /// the job. count: 1 to kMostCheckPoints. O(n).
    ErrorCheck(const Mesh& mesh, std::span<const double> density, const Offset& offset,
               std::uint32_t count);

    /// The same where something else than the mesh itself is asked: receivers in the unit frame of
    /// `occluders`, which must outlive this.
    ErrorCheck(const Geometry& geometry, std::span<const double> density,
               const ReceiversOf& receivers_of, const Geometry& occluders, std::uint32_t count);

    /// The same of places that are no triangles, as points of a cloud: SurfacePoint::triangle is
    /// their number. measure: what each counts, one per place.
    ErrorCheck(std::vector<double> measure, std::span<const double> density,
               const ReceiversOf& receivers_of, const Geometry& occluders, std::uint32_t count);

    /// Of values that are fitted: asks at samples of the target too, for the floor; before trace().
    void add_floor(const VertexTarget& target, std::span<const double> density,
                   const ReceiversOf& receivers_of);

    /// Before trace(): points inside of bodies (hidden_texels.h) that err by more than kSuspicious
    /// count no more either. Nobody sees them, and maps show there what is beside them.
    void leave_out_hidden() { leaves_out_hidden_ = true; }

    /// Traces rays at the points: before error_of(). Points that are ill-defined
    /// (reference/well_defined.h) and err by more than kSuspicious count no more. O(n) for the ray
    /// tracer's hierarchy, with a small factor. least: what is to be known even where the values
    /// err more, for the sake of others. Throws Cancelled.
    void trace(const Definition& definition, const Shown& shown, const Progress& progress = {},
               std::optional<double> least = {});

    /// answers: an engine's, at the receivers of the target of add_floor(), of which the values
    /// were made; without add_floor() none.
    ///
    /// The floor: least squares makes of the engine's errors e at the samples a part P e of what is
    /// displayed, and P is a projection: the mean of (displayed - truth) e over the samples is that
    /// of (P e)^2, for the floor's own error does not depend on e. It is error^2 - floor^2.
    /// Equal input gives equal bytes, whatever the number of threads.
    [[nodiscard]] StatedError error_of(const Shown& shown,
                                       std::span<const Occlusion> answers = {}) const;

    /// RMS noise of the answer of `rays` rays over the surface: what the rays of the truth tell of
    /// it.
    [[nodiscard]] double noise_of_rays(std::uint32_t rays) const;

private:
    struct Point {
        SurfacePoint at;
        double weight = 0.0;                ///< inverse of the density, about 1 in sum; 0: left out
        float first = 0.0f, second = 0.0f;  ///< occlusion by either half of the rays
        std::uint32_t sample = 0;           ///< of the target; samples_ only
    };

    void trace_points(const RayScene& scene, RayOptions options, const Progress& progress);
    double mean_square(const Shown& shown) const;
    void leave_out(std::span<const std::size_t> points);

    const Geometry& occluders_;
    std::vector<Point> points_, samples_;
    std::vector<Receiver> receivers_;  ///< at points_, then at samples_
    std::uint32_t rays_ = 0;           ///< per point
    std::uint32_t ill_defined_ = 0;
    bool leaves_out_hidden_ = false;
};

}  // namespace surfelao
