#include "reference/well_defined.h"

#include "reference/sobol.h"

#include <algorithm>

namespace surfelao {

std::vector<float> placement_change(const RayScene& scene, std::span<const Receiver> receivers,
                                    const Definition& definition, const Progress& progress,
                                    std::uint32_t rays)
{
    // in the receiver's own frame: sideways, in diagonals, and along the normal, in its offset
    constexpr float kSin120 = 0.8660254f;
    struct Step {
        float x, y, offsets;
    };
    constexpr Step kSteps[] = {
        {0.0f, 0.0f, -0.5f},
        {0.0f, 0.0f, 1.0f},
        {kSidestep, 0.0f, 0.0f},
        {-0.5f * kSidestep, kSin120 * kSidestep, 0.0f},
        {-0.5f * kSidestep, -kSin120 * kSidestep, 0.0f},
    };
    RayOptions options;
    options.definition = definition;
    options.rays = rays;

    std::vector<float> low(receivers.size(), 1.0f), high(receivers.size(), 0.0f);
    std::vector<Receiver> moved(receivers.size());
    double done = 0.0;
    for (const Step& step : kSteps) {
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            moved[i] = receivers[i];
            if (receivers[i].normal == glm::vec3(0.0f))
                continue;
            const Hemisphere around = hemisphere_over(receivers[i].normal, 0, 0);
            moved[i].position += step.x * around.x + step.y * around.y +
                                 step.offsets * receivers[i].offset * around.z;
        }
        const Progress part = [&](double share) { return !progress || progress(done + share / 5); };
        const std::vector<Occlusion> answers = trace_occlusion(scene, moved, options, part);
        for (std::size_t i = 0; i < answers.size(); ++i) {
            low[i] = std::min(low[i], answers[i].occlusion);
            high[i] = std::max(high[i], answers[i].occlusion);
        }
        done += 0.2;
    }
    options.definition.max_distance = kSidestep;
    options.definition.falloff = Falloff::none;
    const std::vector<Occlusion> touched = trace_occlusion(scene, receivers, options);
    std::vector<float> change(receivers.size());
    for (std::size_t i = 0; i < change.size(); ++i)
        change[i] = std::max(touched[i].occlusion, high[i] - low[i]);
    return change;
}

}  // namespace surfelao
