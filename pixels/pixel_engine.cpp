#include "pixels/pixel_engine.h"

#include "surfels/errors.h"
#include "surfels/stopwatch.h"

namespace surfelao {
View widened(View view, PictureSize size, int guard)
{
    view.lens = part_of(view.lens, size.width, size.height,
                        {-guard, -guard, size.width + 2 * guard, size.height + 2 * guard});
    return view;
}

std::string name_of(const PixelEngine& engine)
{
    if (const auto* screen = std::get_if<ScreenSettings>(&engine))
        return name_of(screen->method);
    if (std::holds_alternative<GridPixels>(engine))
        return "grid";
    return name_of(std::get<EngineSettings>(engine).engine);
}

std::string setting_of(const PixelEngine& engine)
{
    if (const auto* grids = std::get_if<GridPixels>(&engine))
        return name_of(grids->merge) + ", rest " + setting_of(grids->rest);
    if (const auto* screen = std::get_if<ScreenSettings>(&engine))
        return setting_of(*screen);
    return setting_of(std::get<EngineSettings>(engine));
}

PixelView::PixelView(const GlContext& context, const Mesh& mesh, const DrawnMesh& drawn,
                     const View& view, PictureSize size, const Offset& offset, int guard)
    : g_buffer_(context, size.width + 2 * guard, size.height + 2 * guard), guard_(guard)
{
    g_buffer_.draw(drawn, widened(view, size, guard));
    seen_ = seen_pixels(mesh, view, size.width, size.height,
                        inner(g_buffer_.read_triangles(), size, guard), offset);
}

std::vector<float> PixelView::at_seen(const std::vector<float>& picture) const
{
    std::vector<float> values;
    values.reserve(seen_.pixels.size());
    const auto columns = static_cast<std::uint32_t>(seen_.width);
    const auto guard = static_cast<std::uint32_t>(guard_);
    for (const std::uint32_t pixel : seen_.pixels)
        values.push_back(
            picture[(pixel / columns + guard) * (columns + 2 * guard) + pixel % columns + guard]);
    return values;
}

PixelAnswer answer(const PixelView& view, Occluders& occluders, ScreenSpace& screen,
                   const PixelEngine& engine, const Definition& definition,
                   const Progress& progress)
{
    Stopwatch watch;
    PixelAnswer result;
    if (const auto* settings = std::get_if<EngineSettings>(&engine)) {
        const Prepared& prepared = occluders.prepared_for(*settings);
        watch.lap();
        SolveSettings solving = *settings;
        solving.definition = definition;
        result.values = solve(prepared, view.seen().receivers, solving, progress).occlusion;
    } else {
        SURFELAO_CHECK(std::holds_alternative<ScreenSettings>(engine));
        const Framebuffer target = screen.make_target(view.g_buffer());
        screen.draw(view.g_buffer(), std::get<ScreenSettings>(engine), definition, target);
        for (const float occlusion : view.at_seen(target.read_red(target.rect())))
            result.values.push_back({occlusion, glm::vec3(0.0f)});
    }
    result.seconds = watch.lap();
    return result;
}

PixelAnswer answer(const PixelView& view, GridPass& pass, const GridPixels& settings,
                   const Definition& definition, const Progress& progress)
{
    settings.world->prepare(settings.rest);
    Stopwatch watch;
    GridPixels asked = settings;
    asked.rest.definition = definition;
    std::vector<std::uint32_t> pixels;
    const auto columns = static_cast<std::uint32_t>(view.seen().width);
    const auto guard = static_cast<std::uint32_t>(view.guard());
    for (const std::uint32_t pixel : view.seen().pixels)
        pixels.push_back((pixel / columns + guard) * (columns + 2 * guard) + pixel % columns +
                         guard);
    PixelAnswer result;
    result.values =
        solve_with_grids(pass, view.g_buffer(), asked, view.seen().receivers,
                         settings.world->surfaces_at(view.seen().points), pixels, progress);
    result.seconds = watch.lap();
    return result;
}

}  // namespace surfelao
