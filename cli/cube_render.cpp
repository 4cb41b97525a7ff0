#include "cli/cube_render.h"

#include "pixels/cube_answer.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"

namespace surfelao {
namespace {

constexpr int kCoverageWidth = 320;  // of the picture that tells whether the camera needs a map

/// Of the picture's seen pixels, told by a smaller one.
double coverage_of(const CubeWorld& world, CubeProjector& projector, const View& view,
                   PictureSize size)
{
    const PictureSize small{
        std::min(size.width, kCoverageWidth),
        std::max(1, size.height * std::min(size.width, kCoverageWidth) / size.width)};
    const PixelView pixels(world.context, world.mesh, world.drawn, view, small);
    return answer_from_maps(pixels, projector).coverage();
}

}  // namespace

PlacedMaps place_maps(const GlContext& context, const Mesh& mesh, const DrawnMesh& drawn,
                      Occluders& occluders, const View& view, const PixelPictureSettings& settings,
                      const CubeOptions& options, const StageProgress& progress)
{
    const auto stage = [&](const char* name) -> Progress {
        return [&progress, name](double done) { return progress(name, done); };
    };
    CubePlan plan = cube_plan_of(options, mesh.geometry.frame);
    PlacedMaps maps{CubeProjector(context)};
    Stopwatch watch;
    if (plan.automatic) {
        for (const glm::vec3 centre :
             place_cube_maps(mesh, *plan.automatic, stage("placement")).centres)
            plan.centres.push_back(centre);
    }
    maps.placement_s = watch.lap();

    ScreenSpace screen(context);
    const CubeWorld world{context, mesh, drawn, occluders, screen};
    CubeSettings cube{settings.engine.value_or(EngineSettings{}), settings.definition,
                      options.size.value_or(kCubeSize), settings.offset};
    for (const glm::vec3 centre : plan.centres)
        maps.projector.add(make_cube_map(world, centre, cube, maps.seconds, stage("cube maps")));
    if (plan.covered > 0.0 &&
        coverage_of(world, maps.projector, view, settings.size) < plan.covered)
        maps.projector.add(make_cube_map(world, view.eye, cube, maps.seconds, stage("cube maps")));
    return maps;
}

std::string text_of(const PlacedMaps& maps, const PixelPicture& picture)
{
    const auto time = [](double s) { return fixed(s, 3) + " s"; };
    const std::vector<CubeMap>& all = maps.projector.maps();
    std::string text = "\n  " + std::to_string(all.size()) + " cube maps";
    if (!all.empty())
        text += " of 6 x " + std::to_string(all.front().size) + "^2";
    text += ", " + fixed(static_cast<double>(maps.projector.bytes()) / 1e6, 1) + " MB; ";
    const double covered = picture.middles == 0 ? 1.0
                                                : 1.0 - static_cast<double>(picture.holes) /
                                                            static_cast<double>(picture.middles);
    return text + fixed(100.0 * covered, 2) + " % of the pixels covered, " +
           std::to_string(picture.holes) + " holes, " + std::to_string(picture.faded) +
           " seen by fading maps alone\n  placement " + time(maps.placement_s) +
           ", maps' G-buffers " + time(maps.seconds.draw) + ", maps' texels " +
           time(maps.seconds.solve);
}

}  // namespace surfelao
