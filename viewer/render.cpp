#include "viewer/render.h"

#include "surfels/errors.h"
#include "viewer/renderer.h"
#include "viewer/sample_sum.h"
#include "viewer/shown_error.h"

#include <algorithm>
#include <string>
#include <utility>

namespace surfelao {

Image render(const Model& model, std::span<const Occlusion> occlusion,
             std::span<const Occlusion> reference, const Camera& camera,
             const RenderOptions& options, const Progress& progress)
{
    SURFELAO_CHECK(options.samples >= 1);
    SURFELAO_CHECK(!reference.empty() || options.data.reference || !needs_reference(options.view));
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
    if (options.data.layout)
        renderer.set_layout(*model.mesh, *options.data.layout);
    if (options.data.map)
        renderer.set_map(*options.data.map);
    if (options.data.reference)
        renderer.set_map_reference(*options.data.reference);
    if (options.data.paint)
        renderer.set_paint(*options.data.paint);

    const Framebuffer target = renderer.make_target(options.width, options.height);
    ViewOptions view = options.view;
    std::string note;
    if (view.colors == Colors::difference) {
        renderer.draw_values(target, camera, view);
        const ErrorStatistics error = shown_error(target.read_color(target.rect()));
        if (options.fit_scale)
            view.difference_scale = fitting_scale(error);
        note = note_of(error);
    }
    SampleSum sum(context, options.width, options.height);
    ProgressMeter meter(progress, static_cast<std::uint64_t>(options.samples));
    for (int i = 0; i < options.samples; ++i) {
        renderer.draw_frame(target, camera, view, sample_shift(i));
        sum.add(target);
        meter.add(1);
    }
    context.finish("drawing the picture");
    Image image = sum.mean();
    if (auto legend = legend_of(model, options.data.layout, view)) {
        legend->note = std::move(note);
        draw_legend(image, *legend);
    }
    return image;
}

std::optional<Legend> legend_of(const Model& model, const ModelLayout* layout,
                                const ViewOptions& options)
{
    const ColorMap map = map_of(options);
    if (options.colors == Colors::difference)
        return difference_legend(options);
    if (options.colors == Colors::levels) {
        const glm::vec2 range = level_range(model);
        return Legend{"octree level", range.x, range.y, map};
    }
    if (options.colors == Colors::radius)
        return Legend{"radius over the distance", 0.0f, 1.0f, map};
    if (options.colors == Colors::density && layout)
        return Legend{"texels per unit, median in the middle", 0.0f, most_density(layout->facts),
                      map};
    return {};
}

}  // namespace surfelao
