#include "bake/stated_error.h"

#include "bake/hidden_texels.h"
#include "bake/surface_error.h"
#include "reference/rays.h"
#include "reference/well_defined.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

/// For whether a point is well-defined: the five places share their rays.
constexpr std::uint32_t kPlacementRays = 64;

/// The quantile of the normal distribution that leaves 2.5 % above.
constexpr double kTwoSided95 = 1.96;

/// Rays of n Owen-scrambled points err as n to this power (rays.h).
constexpr double kRayPower = -0.73;

double sum_of(std::span<const double> values)
{
    double sum = 0.0;
    for (const double value : values)
        sum += value;
    return sum;
}

struct Estimate {
    double mean = 0.0;
    double standard_error = 0.0;
};

/// The mean over the surface of what is known at points of unequal weights. The weights' own mean
/// is known, 1, and that of the points differs from it by chance: what it explains of the values is
/// taken out (regression estimator: Cochran. Sampling Techniques. 1977, chapter 7).
class Mean {
public:
    void add(double weight, double value)
    {
        weights_.push_back(weight);
        terms_.push_back(weight * value);
    }
    [[nodiscard]] Estimate estimate() const
    {
        const double count = static_cast<double>(weights_.size());
        if (count < 2.0)
            return {sum_of(terms_), sum_of(terms_)};
        const double weight = sum_of(weights_) / count, term = sum_of(terms_) / count;
        double both = 0.0, square = 0.0;
        for (std::size_t i = 0; i < weights_.size(); ++i) {
            both += (weights_[i] - weight) * (terms_[i] - term);
            square += (weights_[i] - weight) * (weights_[i] - weight);
        }
        const double slope = square > 0.0 ? both / square : term / weight;
        double rest = 0.0;
        for (std::size_t i = 0; i < weights_.size(); ++i)
            rest += std::pow(terms_[i] - term - slope * (weights_[i] - weight), 2.0);
        return {count * (term - slope * (weight - 1.0 / count)),
                std::sqrt(rest * count / (count - 1.0))};
    }

private:
    std::vector<double> weights_, terms_;
};

/// The ends of a mean square's 95 % interval: those of its logarithm where it is well above its
/// standard error. Where it is not, the exponentials are cut behind their squares.
std::pair<double, double> interval_of(double mean_square, double standard_error)
{
    const double error = kTwoSided95 * standard_error;
    if (!(mean_square > error))
        return {0.0, std::max(mean_square, 0.0) + 1.5 * error};
    const double share = error / mean_square;
    return {mean_square * std::exp(-share), mean_square * std::exp(share)};
}

}  // namespace

std::vector<double> density_for(const Geometry& geometry, const VertexTarget& target,
                                std::span<const Occlusion> answers,
                                std::span<const Occlusion> values)
{
    const std::vector<float> misfits = target.triangle_misfits(answers, values);
    std::vector<double> density;
    density.reserve(misfits.size());
    for (std::size_t t = 0; t < misfits.size(); ++t) {
        const glm::uvec3 v = geometry.triangles[t];
        const auto [least, most] =
            std::minmax({values[v.x].occlusion, values[v.y].occlusion, values[v.z].occlusion});
        const double range = kCheckRange * (most - least), misfit = misfits[t];
        const double expected =
            std::sqrt(misfit * misfit + range * range + kCheckLeast * kCheckLeast);
        density.push_back(expected * std::sqrt(expected));
    }
    return density;
}

ErrorCheck::ErrorCheck(const Mesh& mesh, std::span<const double> density, const Offset& offset,
                       std::uint32_t count)
    : ErrorCheck(
          mesh.geometry, density,
          [&](std::span<const SurfacePoint> points) {
              return receivers_at(mesh.geometry, mesh.surface, points, offset);
          },
          mesh.geometry, count)
{
}

ErrorCheck::ErrorCheck(const Geometry& geometry, std::span<const double> density,
                       const ReceiversOf& receivers_of, const Geometry& occluders,
                       std::uint32_t count)
    : ErrorCheck(triangle_areas(geometry), density, receivers_of, occluders, count)
{
}

ErrorCheck::ErrorCheck(std::vector<double> measure, std::span<const double> density,
                       const ReceiversOf& receivers_of, const Geometry& occluders,
                       std::uint32_t count)
    : occluders_(occluders)
{
    double whole = 0.0;
    for (std::size_t t = 0; t < measure.size(); ++t) {
        whole += density[t] > 0.0 ? measure[t] : 0.0;
        measure[t] *= density[t];
    }
    const double sum = sum_of(measure);
    const std::vector<SurfacePoint> places = surface_points(measure, count);
    receivers_ = receivers_of(places);
    for (const SurfacePoint& place : places)
        points_.push_back({place, sum / (whole * density[place.triangle] * count)});
}

void ErrorCheck::add_floor(const VertexTarget& target, std::span<const double> density,
                           const ReceiversOf& receivers_of)
{
    if (target.samples() == nullptr)
        return;
    const SurfaceSamples& samples = *target.samples();
    const std::size_t count = (points_.size() + kFloorStride - 1) / kFloorStride;
    std::vector<double> measure(samples.areas.begin(), samples.areas.end());
    const double whole = sum_of(measure);
    for (std::size_t i = 0; i < measure.size(); ++i)
        measure[i] *= density[samples.points[i].triangle];
    const double sum = sum_of(measure);
    std::vector<SurfacePoint> places;
    for (const std::uint32_t i : stratified(measure, count)) {
        const double share = whole * density[samples.points[i].triangle];
        samples_.push_back(
            {samples.points[i], sum / (share * static_cast<double>(count)), 0.0f, 0.0f, i});
        places.push_back(samples.points[i]);
    }
    const std::vector<Receiver> more = receivers_of(places);
    receivers_.insert(receivers_.end(), more.begin(), more.end());
}

void ErrorCheck::trace(const Definition& definition, const Shown& shown, const Progress& progress,
                       std::optional<double> least)
{
    const RayScene scene(occluders_, RayScene::Build::quick);
    const auto trace_with = [&](std::uint32_t rays) {
        trace_points(scene, {.definition = definition, .rays = rays / 2}, progress);
    };
    const auto is_hidden = [&] {
        const double noise = noise_of_rays(rays_), square = mean_square(shown);
        return noise * noise > (least ? std::min(square, *least * *least) : square);
    };
    for (trace_with(kCheckRays); rays_ < kMostCheckRays && is_hidden();)
        trace_with(4 * rays_);

    std::vector<std::size_t> suspects;
    std::vector<Receiver> suspicious;
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const float truth = 0.5f * (points_[i].first + points_[i].second);
        if (std::abs(shown(points_[i].at) - truth) > kSuspicious) {
            suspects.push_back(i);
            suspicious.push_back(receivers_[i]);
        }
    }
    const std::vector<float> changes =
        placement_change(scene, suspicious, definition, {}, kPlacementRays);
    const std::vector<std::uint8_t> inside =
        leaves_out_hidden_ ? inside_bodies(occluders_, scene, suspicious, definition.max_distance)
                           : std::vector<std::uint8_t>(suspects.size(), 0);
    std::size_t kept = 0;
    for (std::size_t s = 0; s < suspects.size(); ++s)
        if (changes[s] > kIllDefined || inside[s] != 0)
            suspects[kept++] = suspects[s];
    leave_out(std::span(suspects).first(kept));
}

/// options.rays: of either half.
void ErrorCheck::trace_points(const RayScene& scene, RayOptions options, const Progress& progress)
{
    rays_ = 2 * options.rays;
    const auto trace_half = [&](std::uint32_t seed) {
        options.seed = seed;
        return trace_occlusion(scene, receivers_, options, [&, seed](double done) {
            return !progress || progress(0.5 * (seed + done));
        });
    };
    const std::vector<Occlusion> first = trace_half(0), second = trace_half(1);
    const std::size_t count = points_.size();
    for (std::size_t i = 0; i < receivers_.size(); ++i) {
        Point& point = i < count ? points_[i] : samples_[i - count];
        point.first = first[i].occlusion;
        point.second = second[i].occlusion;
    }
}

double ErrorCheck::mean_square(const Shown& shown_at) const
{
    Mean square;
    for (const Point& point : points_) {
        const double shown = shown_at(point.at);
        square.add(point.weight, (shown - point.first) * (shown - point.second));
    }
    return square.estimate().mean;
}

/// The others then stand for less than the whole surface.
void ErrorCheck::leave_out(std::span<const std::size_t> points)
{
    double counted = 1.0;
    for (const std::size_t i : points)
        counted -= std::exchange(points_[i].weight, 0.0);
    for (Point& point : points_)
        point.weight /= std::max(counted, 0.5);
    ill_defined_ = static_cast<std::uint32_t>(points.size());
}

StatedError ErrorCheck::error_of(const Shown& shown_at, std::span<const Occlusion> answers) const
{
    StatedError stated;
    stated.points = static_cast<std::uint32_t>(points_.size()) - ill_defined_;
    stated.rays = rays_;
    stated.ill_defined = ill_defined_;
    if (stated.points == 0)
        return stated;
    Mean square, difference;
    std::vector<std::pair<double, double>> magnitudes;  // error, weight
    double weights = 0.0;
    for (const Point& point : points_) {
        if (point.weight == 0.0)
            continue;
        const double shown = shown_at(point.at);
        const double truth = 0.5 * (double{point.first} + double{point.second});
        square.add(point.weight, (shown - point.first) * (shown - point.second));
        difference.add(point.weight, shown - truth);
        magnitudes.emplace_back(std::abs(shown - truth), point.weight);
        weights += point.weight;
    }
    stated.bias = difference.estimate().mean;
    const auto [mean, standard_error] = square.estimate();
    const auto [low, high] = interval_of(mean, standard_error);
    stated.rmse = std::sqrt(std::max(0.0, mean));
    stated.low = kStatedStep * std::floor(std::sqrt(low) / kStatedStep);
    stated.high = kStatedStep * std::ceil(std::sqrt(high) / kStatedStep);
    if (!samples_.empty()) {
        Mean beyond;  // what the mean square would lose by exact answers
        for (const Point& sample : samples_) {
            const double shown = shown_at(sample.at);
            const double answer = answers[sample.sample].occlusion;
            beyond.add(sample.weight, 0.5 * ((shown - sample.first) * (answer - sample.second) +
                                             (shown - sample.second) * (answer - sample.first)));
        }
        const Estimate lost = beyond.estimate();
        const double floor = std::max(0.0, mean - std::max(0.0, lost.mean));
        stated.floor = std::sqrt(floor);
        stated.least_floor = std::sqrt(
            std::max(0.0, floor - kTwoSided95 * std::hypot(standard_error, lost.standard_error)));
    }
    std::ranges::sort(magnitudes);
    double below = 0.0;
    for (const auto& [error, weight] : magnitudes) {
        stated.p95 = error;
        if ((below += weight) >= 0.95 * weights)
            break;
    }
    return stated;
}

double ErrorCheck::noise_of_rays(std::uint32_t rays) const
{
    double squares = 0.0;
    for (const Point& point : points_)
        squares += point.weight * std::pow(double{point.first} - double{point.second}, 2.0) / 2.0;
    return std::sqrt(squares) * std::pow(rays / (rays_ / 2.0), kRayPower);
}

}  // namespace surfelao
