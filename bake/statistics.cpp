#include "bake/statistics.h"

#include "surfels/errors.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surfelao {
namespace {

/// Nearest rank; 0 for no values. Reorders.
double p95_of(std::vector<float>& values)
{
    if (values.empty())
        return 0.0;
    const std::size_t rank = (values.size() * 95 + 99) / 100 - 1;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                     values.end());
    return values[rank];
}

struct WeightedAngle {
    double degrees = 0.0;
    double weight = 0.0;  ///< > 0
};

/// The least angle that 95 % of the weight do not exceed; 0 for no angles. Reorders.
double p95_of(std::vector<WeightedAngle>& angles, double weight)
{
    std::ranges::sort(angles, {}, &WeightedAngle::degrees);
    double sum = 0.0;
    for (const WeightedAngle& angle : angles) {
        sum += angle.weight;
        if (sum >= 0.95 * weight)
            return angle.degrees;
    }
    return angles.empty() ? 0.0 : angles.back().degrees;
}

/// Angle by atan2: exact near 0, where an arc cosine has no digits left.
double angle_deg(glm::dvec3 a, glm::dvec3 b)
{
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
}

}  // namespace

double without_noise(double rms, double noise)
{
    return std::sqrt(std::max(0.0, rms * rms - noise * noise));
}

ErrorStatistics error_statistics(std::span<const Occlusion> answer,
                                 std::span<const Occlusion> reference, double noise)
{
    SURFELAO_CHECK(answer.size() == reference.size());
    ErrorStatistics result;
    result.count = answer.size();
    if (answer.empty())
        return result;

    std::vector<float> errors;
    std::vector<WeightedAngle> angles;
    double sum = 0.0, squares = 0.0, angle_sum = 0.0, weight_sum = 0.0;
    for (std::size_t i = 0; i < answer.size(); ++i) {
        const double error = static_cast<double>(answer[i].occlusion) - reference[i].occlusion;
        sum += error;
        squares += error * error;
        result.max = std::max(result.max, std::fabs(error));
        errors.push_back(static_cast<float>(std::fabs(error)));
        const double weight = 1.0 - reference[i].occlusion;
        if (weight > 0.0 && answer[i].bent_normal != glm::vec3(0.0f) &&
            reference[i].bent_normal != glm::vec3(0.0f)) {
            angles.push_back({angle_deg(answer[i].bent_normal, reference[i].bent_normal), weight});
            angle_sum += weight * angles.back().degrees;
            weight_sum += weight;
        }
    }
    const double count = static_cast<double>(answer.size());
    result.rmse = without_noise(std::sqrt(squares / count), noise);
    result.bias = sum / count;
    result.p95 = p95_of(errors);
    if (!angles.empty())
        result.bent_mean_deg = angle_sum / weight_sum;
    result.bent_p95_deg = p95_of(angles, weight_sum);
    return result;
}

std::optional<CurveTime> time_at(std::vector<CurvePoint> family, double error)
{
    // from coarse to fine; a finer point must cost more, else the coarser one is beaten
    std::erase_if(family, [](CurvePoint p) { return !(p.error > 0.0) || !(p.seconds > 0.0); });
    std::sort(family.begin(), family.end(), [](CurvePoint a, CurvePoint b) {
        return a.error != b.error ? a.error > b.error : a.seconds > b.seconds;
    });
    std::vector<CurvePoint> front;
    for (const CurvePoint point : family) {
        while (!front.empty() && front.back().seconds >= point.seconds)
            front.pop_back();
        front.push_back(point);
    }
    if (front.empty() || !(error > 0.0))
        return std::nullopt;
    if (front.front().error <= error)
        return CurveTime{front.front().seconds, false};
    if (front.size() < 2)
        return std::nullopt;

    // the segment that holds the error, or the most exact one
    std::size_t right = 1;
    while (right + 1 < front.size() && front[right].error > error)
        ++right;
    const CurvePoint a = front[right - 1], b = front[right];
    const double position =
        (std::log(error) - std::log(a.error)) / (std::log(b.error) - std::log(a.error));
    const double seconds =
        std::exp(std::log(a.seconds) + position * (std::log(b.seconds) - std::log(a.seconds)));
    constexpr double kFar = 1000.0;  // a line through two points close together leads anywhere
    if (!(seconds < front.back().seconds * kFar))
        return std::nullopt;
    return CurveTime{seconds, error < front.back().error};
}

double quantile(std::vector<double> values, double share)
{
    SURFELAO_CHECK(!values.empty());
    std::sort(values.begin(), values.end());
    const double rank = share * static_cast<double>(values.size() - 1);
    const std::size_t low = static_cast<std::size_t>(rank);
    const std::size_t high = std::min(low + 1, values.size() - 1);
    return values[low] + (rank - static_cast<double>(low)) * (values[high] - values[low]);
}

}  // namespace surfelao
