#include "bake/point_target.h"
#include "bake/vertex_target.h"
#include "cli/commands.h"
#include "cli/cube_render.h"
#include "cli/output.h"
#include "cli/progress_bar.h"
#include "cli/render_options.h"
#include "engines/threads.h"
#include "image/image_file.h"
#include "pixels/pixel_picture.h"
#include "surfels/errors.h"
#include "surfels/extension.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"
#include "viewer/pixel_paint.h"
#include "viewer/render.h"

#include <filesystem>
#include <iostream>

namespace surfelao {
namespace {

/// A mesh, and how it is looked at and asked.
struct PixelJob {
    Mesh mesh;
    View view = {};
    Camera camera = {};
    ViewOptions shown = {};
    PixelPictureSettings settings = {};
    std::optional<Image> panorama = {};
    std::optional<BasePaint> paint = {};

    [[nodiscard]] const Image* sky() const { return panorama ? &*panorama : nullptr; }
};

/// What colours do not tell is not asked.
void choose_engine(const RenderCommandOptions& options, PixelJob& job)
{
    const Colors colors = job.shown.colors;
    const std::uint32_t rays = options.show.reference_rays;
    if (colors == Colors::rays) {
        job.settings.engine = EngineSettings{{.engine = Engine::rays}, {.rays = rays}};
        return;
    }
    if (colors != Colors::normals)
        job.settings.engine = engine_at_pixels(options);
    if (auto* grids =
            job.settings.engine ? std::get_if<GridPixels>(&*job.settings.engine) : nullptr)
        grids->world = grid_world_of(job.mesh, options.once.others, part_choice_of(options.parts),
                                     *options.grid_sources, options.reading.moment);
    if (colors == Colors::difference)
        job.settings.reference_rays = rays;
}

PixelJob read_job(const RenderCommandOptions& options)
{
    const TargetSettings target = target_settings_of(options.surface, options.show.up);
    const PartChoice parts = part_choice_of(options.parts);
    Scene scene = scene_of(options);
    if (scene.triangles.empty())
        throw UsageError(options.input + ": has points only, no faces: --at points.");
    check_target(scene, target, parts);

    PixelJob job{mesh_of(std::move(scene), options.once.others, target.normals, parts,
                         common_frame_of(options))};
    const Geometry& geometry = job.mesh.geometry;
    const Frame& frame = geometry.frame;
    const PictureSize size{options.width, options.height};
    job.camera = camera_of(options, framed_points(geometry), frame);
    job.view = view_of(job.camera, size.width, size.height);
    job.shown = view_options_of(options.show);
    if (options.show.environment)
        job.panorama = read_image(*options.show.environment);
    if (job.shown.colors == Colors::textured)
        job.paint = base_paint_of(job.mesh);

    job.settings.size = size;
    job.settings.samples = options.samples;
    job.settings.offset = offset_of(target, frame);
    job.settings.guard = guard_of(options.pixels, size);
    job.settings.definition =
        definition_of(distance_limit_of(options.measure), kernel_of(options.measure), frame);
    job.settings.definition.ground =
        ground_of(ground_plane_of(options.measure, options.show.up),
                  {geometry, job.mesh.occluding()}, largest_offset_of(target, frame));
    choose_engine(options, job);
    return job;
}

/// As the file wants them: numbers of .exr are the values themselves, the other formats hold what a
/// screen shows, and .jpg has no alpha.
void finish(const GlContext& context, const RenderCommandOptions& options, const PixelJob& job,
            Image& image)
{
    const std::string extension = lower_extension(options.output);
    if (shows_numbers(job.shown.colors) && extension != ".exr")
        show_numbers(image);
    if (job.shown.colors == Colors::difference)
        show_difference(image, job.shown, fits_scale(options.show));
    const bool is_opaque = job.shown.background ? job.shown.background->a == 1.0f
                                                : extension == ".jpg" || extension == ".jpeg";
    if (is_opaque)
        put_on_background(context, image, job.camera, job.shown, job.sky());
}

/// What was drawn, and how long it took. maps: a line about cube maps, or nothing.
void tell(const RenderCommandOptions& options, const PixelJob& job, const PixelPicture& picture,
          const std::string& maps, double read_s, double write_s)
{
    const auto time = [](double s) { return fixed(s, 3) + " s"; };
    std::cout << options.input << " -> " << options.output << ", " << options.width << " x "
              << options.height << "\n  " << job.mesh.geometry.triangles.size() << " triangles";
    if (job.settings.engine)
        std::cout << ", " << name_of(*job.settings.engine) << ", "
                  << setting_of(*job.settings.engine);
    if (job.settings.definition.ground)
        std::cout << ", over a ground at "
                  << text_of(*job.settings.definition.ground, job.mesh.geometry.frame);
    std::cout << "\n  " << picture.middles << " receivers at pixels, " << picture.extras
              << " more at " << picture.edge_pixels << " edges";
    if (picture.bands > 1)
        std::cout << ", in " << picture.bands << " bands";
    std::cout << maps << "\n  read " << time(read_s) << ", prepare " << time(picture.prepare_s)
              << ", see " << time(picture.see_s);
    if (job.settings.cube_maps != nullptr)
        std::cout << ", project " << time(picture.project_s);
    std::cout << (job.settings.cube_maps != nullptr ? ", holes " : ", solve ")
              << time(picture.solve_s) << ", edges " << time(picture.edges_s);
    if (job.settings.reference_rays)
        std::cout << ", reference " << time(picture.reference_s);
    std::cout << ", draw " << time(picture.paint_s) << ", write " << time(write_s) << '\n';
    if (job.paint)
        for (const std::string& note : job.paint->notes)
            std::cout << "  note: " << note << '\n';
    const std::filesystem::path written[] = {options.output};
    print_written(written, false);
}

}  // namespace

int render_pixels(const RenderCommandOptions& options)
{
    ProgressBar bar;
    Stopwatch watch;
    PixelJob job = read_job(options);
    const double read_s = options.once.seconds + watch.lap();

    const GlContext context = GlContext::create(backend_of(options.backend));
    open_images_early();
    const DrawnMesh drawn(context, job.mesh.geometry, job.mesh.surface);
    Occluders occluders(job.mesh.occluding());
    std::optional<PlacedMaps> maps;
    const auto update = [&](std::string_view stage, double done) {
        return bar.update(stage, done);
    };
    if (is_at_cube_maps(options.texels)) {
        maps.emplace(place_maps(context, job.mesh, drawn, occluders, job.view, job.settings,
                                options.cubes, update));
        job.settings.cube_maps = &maps->projector;
        job.settings.white_holes = options.cubes.holes == "white";
    }
    const double upload_s = maps ? 0.0 : watch.lap();
    PixelPicture picture = pixel_picture(
        context, job.mesh, drawn, occluders, job.view, job.settings,
        pixel_paint(job.shown, job.camera, job.sky(), job.paint ? &*job.paint : nullptr), update);
    picture.prepare_s += upload_s;
    watch.lap();
    finish(context, options, job, picture.image);
    write_image(options.output, picture.image);
    tell(options, job, picture, maps ? text_of(*maps, picture) : "", read_s, watch.lap());
    return kDone;
}

}  // namespace surfelao
