/// statistics.h: how wrong an answer is, and what time it would have cost to be equally wrong.
#pragma once

#include "surfels/occlusion.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// Errors of occlusion (dimensionless, 0 to 1) and of bent normals (degrees) over `count`
/// receivers.
struct ErrorStatistics {
    std::uint64_t count = 0;
    double rmse = 0.0;
    double bias = 0.0;  ///< mean of answer - reference: positive = too dark
    double p95 = 0.0;   ///< 95 % of the absolute errors are at most this (nearest rank)
    double max = 0.0;   ///< largest absolute error
    double bent_mean_deg = 0.0;
    double bent_p95_deg = 0.0;
};

/// answer and reference: same length. Bent normals count where both sides have one. All zero for
/// empty input. O(n).
[[nodiscard]] ErrorStatistics error_statistics(std::span<const Occlusion> answer,
                                               std::span<const Occlusion> reference);

/// One setting of a family that trades time for exactness.
struct CurvePoint {
    double rmse = 0.0;
    double seconds = 0.0;
};

struct CurveTime {
    double seconds = 0.0;
    bool extrapolated = false;  ///< the family has no point on one side of the error asked for
};

/// The seconds that a family needs for an RMSE: straight lines through its points in log-log,
/// beyond its ends along the last line. Points that another one beats in both time and error are
/// left out, and so are points without error or without time, which have no logarithm. Empty with
/// fewer than two points left, rmse <= 0, or a time a thousand times beyond the family's own.
[[nodiscard]] std::optional<CurveTime> time_at(std::vector<CurvePoint> family, double rmse);

/// The value that `share` of the values do not exceed, straight between ranks. Values: not empty.
[[nodiscard]] double quantile(std::vector<double> values, double share);

}  // namespace surfelao
