/// statistics.h: how wrong an answer is, and what time it would have cost to be equally wrong.
#pragma once

#include "surfels/occlusion.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// Errors of occlusion (dimensionless, 0 to 1) and of bent normals (degrees) over `count`
/// receivers. An angle weighs as much as the reference is open: the bent normal of a closed
/// receiver is next to nobody's.
struct ErrorStatistics {
    std::uint64_t count = 0;
    double rmse = 0.0;           ///< without the reference's noise
    double bias = 0.0;           ///< mean of answer - reference: positive = too dark
    double p95 = 0.0;            ///< 95 % of the absolute errors are at most this (nearest rank)
    double max = 0.0;            ///< largest absolute error
    double bent_mean_deg = 0.0;  ///< weighted
    double bent_p95_deg = 0.0;   ///< 95 % of the weight is at most this far off
};

/// answer and reference: same length. noise: RMS error of the reference's occlusion, whose square
/// is taken from that of the RMSE, not below 0; the other figures are as they are found. Bent
/// normals count where both sides have one. All zero for empty input. O(n log n).
[[nodiscard]] ErrorStatistics error_statistics(std::span<const Occlusion> answer,
                                               std::span<const Occlusion> reference,
                                               double noise = 0.0);

/// What is left of an RMS error without an independent one; 0 where that is larger.
[[nodiscard]] double without_noise(double rms, double noise);

/// One setting of a family that trades time for exactness.
struct CurvePoint {
    double error = 0.0;
    double seconds = 0.0;
};

struct CurveTime {
    double seconds = 0.0;
    bool extrapolated = false;  ///< the family has no point as exact as asked
};

/// The seconds that a family needs for an error: straight lines through its points in log-log,
/// beyond its exact end along the last line. Where its coarsest point is more exact than asked, the
/// cheapest one's time counts: that is no extrapolation, the family has nothing cheaper. Points
/// that another one beats in both time and error are left out, and so are points without error or
/// without time, which have no logarithm. Empty with error <= 0, without points, with one point
/// that is not exact enough, or with a time a thousand times beyond the family's own.
[[nodiscard]] std::optional<CurveTime> time_at(std::vector<CurvePoint> family, double error);

/// The value that `share` of the values do not exceed, straight between ranks. Values: not empty.
[[nodiscard]] double quantile(std::vector<double> values, double share);

}  // namespace surfelao
