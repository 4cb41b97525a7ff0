#include "tree/masks/limits.h"

#include "tree/ground.h"
#include "tree/masks/constants.h"

#include <tbb/parallel_for.h>

namespace surfelao {

/// A falloff is a mean over hits within several limits: with H(w) the weight of the distance t,
/// H = integral over h in [0, 1] of (t < distance at which the weight is h). Midpoints of as many
/// steps; a hit's weight is off by half a step at most.
std::vector<float> distance_limits(const Definition& definition)
{
    if (definition.falloff == Falloff::none)
        return {definition.max_distance};
    std::vector<float> limits;
    for (int step = 0; step < kMaskFalloffSteps; ++step) {
        const float weight = (static_cast<float>(step) + 0.5f) / kMaskFalloffSteps;
        // hit_weight falls steadily: bisection keeps its formula in one place
        float near = 0.0f;
        float far = definition.max_distance;
        for (int i = 0; i < kMaskFalloffHalvings; ++i) {
            const float middle = 0.5f * (near + far);
            (hit_weight(definition, middle) > weight ? near : far) = middle;
        }
        limits.push_back(far);
    }
    return limits;
}

MaskSkies::MaskSkies(const Definition& definition, std::span<const Receiver> receivers)
    : ground_(definition.ground), receivers_(receivers)
{
    if (!ground_ || definition.falloff == Falloff::none)
        return;
    const std::vector<float> limits = distance_limits(definition);
    scales_.resize(receivers.size());
    tbb::parallel_for(std::size_t{0}, receivers.size(), [&](std::size_t i) {
        float sum = 0.0f;
        for (const float limit : limits)
            sum += 1.0f - ground_share(*ground_, receivers[i], limit);
        const float mean = sum / static_cast<float>(limits.size());
        const float whole = 1.0f - ground_share(definition, receivers[i]);
        scales_[i] = mean > 0.0f ? whole / mean : 1.0f;
    });
}

MaskSkies::Sky MaskSkies::at(float limit, std::size_t receiver) const
{
    if (!ground_)
        return {};
    const float sky = 1.0f - ground_share(*ground_, receivers_[receiver], limit);
    return {scales_.empty() ? sky : scales_[receiver] * sky,
            height_over(*ground_, receivers_[receiver].position)};
}

}  // namespace surfelao
