#include "pixels/cube_answer.h"

#include "surfels/stopwatch.h"

#include <glm/common.hpp>

namespace surfelao {

double CubeAnswer::coverage() const
{
    if (occlusion.empty())
        return 1.0;
    return 1.0 - static_cast<double>(holes) / static_cast<double>(occlusion.size());
}

CubeAnswer answer_from_maps(const PixelView& view, CubeProjector& projector, int most)
{
    Stopwatch watch;
    const GBuffer& buffer = view.g_buffer();
    const Framebuffer target = projector.make_target(buffer.width(), buffer.height());
    projector.project(buffer, target, most);
    std::vector<float> occlusion, weight;
    for (const glm::vec4 texel : target.read_color(target.rect())) {
        occlusion.push_back(texel.x);
        weight.push_back(texel.y);
    }
    CubeAnswer answer;
    answer.occlusion = view.at_seen(occlusion);
    for (const float share : view.at_seen(weight)) {
        answer.share.push_back(share);
        answer.hole.push_back(share > 0.0f ? 0 : 1);
        answer.holes += answer.hole.back();
    }
    answer.project_s = watch.lap();
    return answer;
}

void solve_holes(CubeAnswer& answer, const PixelView& view, const CubeWorld& world,
                 const CubeSettings& settings, const Progress& progress)
{
    Stopwatch watch;
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < answer.share.size(); ++i) {
        if (answer.share[i] < 1.0f)
            open.push_back(i);
    }
    if (open.empty())
        return;
    std::vector<Occlusion> values;
    if (const auto* engine = std::get_if<EngineSettings>(&settings.engine)) {
        std::vector<Receiver> receivers;
        for (const std::size_t i : open)
            receivers.push_back(view.seen().receivers[i]);
        const EngineSettings here = engine_of(world, *engine, settings.definition);
        values = solve(world.occluders.prepared_for(here), receivers, here, progress).occlusion;
    } else {
        const PixelAnswer pixels = surfelao::answer(view, world.occluders, world.screen,
                                                    settings.engine, settings.definition, progress);
        for (const std::size_t i : open)
            values.push_back(pixels.values[i]);
    }
    for (std::size_t k = 0; k < open.size(); ++k) {
        float& occlusion = answer.occlusion[open[k]];
        occlusion = glm::mix(values[k].occlusion, occlusion, answer.share[open[k]]);
    }
    answer.holes_s = watch.lap();
}

}  // namespace surfelao
