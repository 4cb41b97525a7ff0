#include "grid/cone.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surfelao {
namespace {

using std::numbers::pi;

/// Y_l0 and its fellows, before their polynomials.
constexpr float kBand0 = 0.28209479f;   // sqrt(1 / (4 pi))
constexpr float kBand1 = 0.48860251f;   // sqrt(3 / (4 pi))
constexpr float kBand2 = 1.09254843f;   // sqrt(15 / (4 pi))
constexpr float kPole2 = 0.31539157f;   // sqrt(5 / (16 pi)), of 3 z^2 - 1
constexpr float kPlane2 = 0.54627422f;  // sqrt(15 / (16 pi)), of x^2 - y^2

double clipped_narrow_cap(double cos_half, double cos_between)
{
    const double sine_square = 1.0 - cos_half * cos_half;
    const double sine_between = std::sqrt(std::max(0.0, 1.0 - cos_between * cos_between));
    if (sine_square <= 0.0)
        return 0.0;
    if (cos_between * cos_between >= sine_square || sine_between == 0.0)
        return sine_square * std::max(0.0, cos_between);
    const double x = cos_half / std::sqrt(sine_square);
    const double y = std::clamp(-x * cos_between / sine_between, -1.0, 1.0);
    const double q = sine_between * std::sqrt(1.0 - y * y);
    return ((cos_between * std::acos(y) - x * q) * sine_square + std::atan2(q, x)) / pi;
}

/// acos of what rounding may have put beyond 1.
double angle_of(double cosine)
{
    return std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// The solid angle that two caps of half angles r1, r2 share, d between their axes.
double shared_by_caps(double cos_first, double cos_second, double cos_between)
{
    const double first = angle_of(cos_first), second = angle_of(cos_second);
    const double between = angle_of(cos_between);
    if (between >= first + second)
        return 0.0;
    if (between <= std::abs(first - second))
        return 2.0 * pi * (1.0 - std::max(cos_first, cos_second));
    if (between + first + second >= 2.0 * pi)  // together they hide everything
        return 2.0 * pi * (1.0 - cos_first) + 2.0 * pi * (1.0 - cos_second) - 4.0 * pi;
    const double sine1 = std::sin(first), sine2 = std::sin(second), sine = std::sin(between);
    return 2.0 * pi - 2.0 * angle_of((cos_between - cos_first * cos_second) / (sine1 * sine2)) -
           2.0 * cos_first * angle_of((cos_second - cos_between * cos_first) / (sine * sine1)) -
           2.0 * cos_second * angle_of((cos_first - cos_between * cos_second) / (sine * sine2));
}

}  // namespace

Cone cone_of(glm::vec4 moments)
{
    const float alpha = std::clamp(moments.w, 0.0f, 1.0f);
    if (alpha < kNothingHidden)
        return {};
    const glm::vec3 mean(moments);
    const float length = glm::length(mean);
    const glm::vec3 axis = length > kNothingHidden ? mean / length : glm::vec3(0.0f);
    const float spread = std::min(1.0f, length / alpha);
    const float cos_half = 2.0f * spread - 1.0f, cap = 1.0f - spread;
    if (cap <= alpha)
        return {axis, 1.0f - 2.0f * alpha, 1.0f};
    return {axis, cos_half, alpha / cap};
}

double clipped_cap(double cos_half, double cos_between)
{
    const double between = std::clamp(cos_between, -1.0, 1.0);
    if (cos_half < 0.0)
        return 1.0 - clipped_narrow_cap(std::min(1.0, -cos_half), -between);
    return clipped_narrow_cap(std::min(1.0, cos_half), between);
}

float occlusion_by(const Cone& cone, glm::vec3 normal)
{
    const double shadow = clipped_cap(cone.cos_half, glm::dot(cone.axis, normal));
    return std::clamp(cone.cover * static_cast<float>(shadow), 0.0f, 1.0f);
}

double merged_caps(double alpha_first, double alpha_second, double cos_between)
{
    const double shared =
        shared_by_caps(1.0 - 2.0 * alpha_first, 1.0 - 2.0 * alpha_second, cos_between);
    return std::clamp(alpha_first + alpha_second - shared / (4.0 * pi), 0.0, 1.0);
}

Harmonics harmonics_along(glm::vec3 d)
{
    return {kBand0,
            kBand1 * d.y,
            kBand1 * d.z,
            kBand1 * d.x,
            kBand2 * d.x * d.y,
            kBand2 * d.y * d.z,
            kPole2 * (3.0f * d.z * d.z - 1.0f),
            kBand2 * d.x * d.z,
            kPlane2 * (d.x * d.x - d.y * d.y)};
}

float cosine_weight(std::size_t coefficient)
{
    return coefficient == 0 ? 1.0f : coefficient < 4 ? 2.0f / 3.0f : 0.25f;
}

glm::vec4 moments_of(GridStore store, const float* values)
{
    if (store == GridStore::cone)
        return {values[0], values[1], values[2], values[3]};
    constexpr float kSphere = 4.0f * std::numbers::pi_v<float>;
    const glm::vec3 mean = glm::vec3(values[3], values[1], values[2]) / (kBand1 * kSphere);
    return {mean, values[0] / (kBand0 * kSphere)};
}

}  // namespace surfelao
