#include "tree/ground.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surfelao {

float height_over(const Ground& ground, glm::vec3 position)
{
    return glm::dot(ground.up, position) - ground.height;
}

GroundSight sight_of(const Ground& ground, glm::vec3 position)
{
    const float above = height_over(ground, position);
    return above >= 0.0f ? GroundSight{-ground.up, above} : GroundSight{ground.up, -above};
}

double cone_share(double cosine, double edge)
{
    const double radius2 = 1.0 - edge * edge;
    const double radius = std::sqrt(std::max(0.0, radius2));
    if (cosine >= radius)
        return cosine * radius2;
    if (cosine <= -radius)
        return 0.0;
    const double sine = std::sqrt(1.0 - cosine * cosine);
    const double t = std::sqrt(radius2 - cosine * cosine);
    const double turn = std::acos(std::clamp(-cosine * edge / (radius * sine), -1.0, 1.0));
    return (radius2 * cosine * turn - edge * t + std::atan2(t, edge)) / std::numbers::pi;
}

float ground_share(const Ground& ground, const Receiver& receiver, float limit)
{
    const GroundSight sight = sight_of(ground, receiver.position);
    if (!(sight.distance < limit))
        return 0.0f;
    const double cosine = std::clamp(glm::dot(sight.towards, receiver.normal), -1.0f, 1.0f);
    return static_cast<float>(cone_share(cosine, sight.distance / limit));
}

float ground_share(const Definition& definition, const Receiver& receiver)
{
    const float limit = definition.max_distance;
    if (definition.falloff == Falloff::none)
        return ground_share(*definition.ground, receiver, limit);
    // by parts: the weight that hits lose from distance to distance, times what lies within it
    constexpr int kSteps = 32;  // half as many: four times the error
    const float nearest = sight_of(*definition.ground, receiver.position).distance;
    const float step = (limit - nearest) / kSteps;
    double share = 0.0;
    for (int i = 0; i < kSteps && step > 0.0f; ++i) {
        const float from = nearest + static_cast<float>(i) * step;
        const float lost = hit_weight(definition, from) - hit_weight(definition, from + step);
        share += lost * ground_share(*definition.ground, receiver, from + 0.5f * step);
    }
    return static_cast<float>(share);
}

glm::vec3 ground_direction(const Definition& definition, const Receiver& receiver)
{
    // by rings around the direction straight to the ground, at equal angles: along each the
    // integrals over what is above the horizon are elementary
    constexpr int kRings = 16;
    const GroundSight sight = sight_of(*definition.ground, receiver.position);
    const double edge = sight.distance / definition.max_distance;
    if (!(edge < 1.0))
        return glm::vec3(0.0f);
    const double cosine = std::clamp(glm::dot(sight.towards, receiver.normal), -1.0f, 1.0f);
    const double sine = std::sqrt(1.0 - cosine * cosine);
    const double step = std::acos(edge) / kRings;
    double towards = 0.0, upwards = 0.0;  // the integral along the axis, along the normal
    for (int i = 0; i < kRings; ++i) {
        const double angle = (i + 0.5) * step;
        // n.w = even + odd cos(turn)
        const double even = cosine * std::cos(angle), odd = sine * std::sin(angle);
        const double half = even >= odd    ? std::numbers::pi
                            : even <= -odd ? 0.0
                                           : std::acos(-even / odd);
        const double first = 2.0 * (even * half + odd * std::sin(half));
        const double second = 2.0 * even * even * half + 4.0 * even * odd * std::sin(half) +
                              odd * odd * (half + std::sin(half) * std::cos(half));
        double weight = std::sin(angle) * step / std::numbers::pi;
        if (definition.falloff != Falloff::none)
            weight *= hit_weight(definition, sight.distance / static_cast<float>(std::cos(angle)));
        towards += weight * std::cos(angle) * first;
        upwards += weight * second;
    }
    constexpr double kParallel = 1e-6;  // squared sine: the two directions are one
    const double sine2 = sine * sine;
    if (sine2 < kParallel)
        return static_cast<float>(upwards) * receiver.normal;
    return static_cast<float>((towards - cosine * upwards) / sine2) * sight.towards +
           static_cast<float>((upwards - cosine * towards) / sine2) * receiver.normal;
}

}  // namespace surfelao
