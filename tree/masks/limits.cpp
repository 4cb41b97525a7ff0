#include "tree/masks/limits.h"

#include "tree/masks/constants.h"

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

}  // namespace surfelao
