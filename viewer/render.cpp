#include "viewer/render.h"

#include "image/color_map.h"
#include "surfels/errors.h"
#include "viewer/renderer.h"

#include <algorithm>
#include <string>

namespace surfelao {

Image render(const Model& model, std::span<const Occlusion> occlusion,
             std::span<const Occlusion> reference, const Camera& camera,
             const RenderOptions& options, const Progress& progress)
{
    SURFELAO_CHECK(options.samples >= 1);
    SURFELAO_CHECK(!reference.empty() || !needs_reference(options.view));
    const GlContext context = GlContext::create(options.backend);
    const int largest = context.info().max_texture_size;
    if (options.width < 1 || options.height < 1 || options.width > largest ||
        options.height > largest)
        throw InputError("a picture of " + std::to_string(options.width) + " x " +
                         std::to_string(options.height) + " pixels was asked for, 1 to " +
                         std::to_string(largest) + " each way can be drawn here");

    Renderer renderer(context);
    if (options.environment)
        renderer.set_environment(*options.environment);
    renderer.set_model(model);
    renderer.set_occlusion(occlusion);
    if (!reference.empty())
        renderer.set_reference(reference);

    const Framebuffer target = renderer.make_target(options.width, options.height);
    SampleSum sum(context, options.width, options.height);
    ProgressMeter meter(progress, static_cast<std::uint64_t>(options.samples));
    for (int i = 0; i < options.samples; ++i) {
        renderer.draw_frame(target, camera, options.view, sample_shift(i));
        sum.add(target);
        meter.add(1);
    }
    context.finish("drawing the picture");
    Image image = sum.mean();
    draw_legend(image, model, options.view);
    return image;
}

void draw_legend(Image& image, const Model& model, const ViewOptions& options)
{
    if (options.colors == Colors::difference)
        draw_heat_legend(image, "occlusion difference to rays", 0.0f, options.difference_scale);
    if (options.colors == Colors::levels) {
        const glm::vec2 range = level_range(model);
        draw_heat_legend(image, "octree level", range.x, range.y);
    }
}

}  // namespace surfelao
