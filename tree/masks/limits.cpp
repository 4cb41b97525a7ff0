#include "tree/masks/limits.h"

#include "surfels/for_all.h"
#include "tree/ground.h"
#include "tree/masks/constants.h"

namespace surfelao {

/// A falloff is a mean over hits within several limits: the weight of the distance t is the sum of
/// the weights of the limits beyond t.
MaskLimits distance_limits(const Definition& definition)
{
    if (definition.falloff == Falloff::none)
        return {1, {definition.max_distance}, {1.0f}, 0.0f};
    MaskLimits limits{};
    limits.uncut = kMaskUncut * definition.max_distance;
    for (const MaskFalloffStep& step : kMaskFalloffSteps) {
        limits.distance[limits.count] = step.distance * definition.max_distance;
        limits.weight[limits.count++] = step.weight;
    }
    return limits;
}

MaskSkies::MaskSkies(const Definition& definition, std::span<const Receiver> receivers)
    : ground_(definition.ground), receivers_(receivers)
{
    if (!ground_ || definition.falloff == Falloff::none)
        return;
    const MaskLimits limits = distance_limits(definition);
    scales_.resize(receivers.size());
    for_tasks(receivers.size(), [&](std::size_t i) {
        float mean = 0.0f;
        for (unsigned k = 0; k < limits.count; ++k)
            mean += limits.weight[k] *
                    (1.0f - ground_share(*ground_, receivers[i], limits.distance[k]));
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
