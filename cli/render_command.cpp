#include "bake/bake.h"
#include "bake/moving_solver.h"
#include "bake/texel_layout.h"
#include "cli/commands.h"
#include "cli/grid_bake_options.h"
#include "cli/output.h"
#include "cli/preset.h"
#include "cli/progress_bar.h"
#include "cli/render_options.h"
#include "cli/value_checks.h"
#include "engines/threads.h"
#include "image/image_file.h"
#include "surfels/extension.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"
#include "viewer/atlas_picture.h"
#include "viewer/render.h"
#include "viewer/solve_map.h"
#include "viewer/solve_model.h"

#include <CLI/CLI.hpp>

#include <array>
#include <filesystem>
#include <iostream>
#include <memory>

namespace surfelao {
namespace {

constexpr int kMostPixels = 32768;  // each way; the device may draw less
constexpr int kMostSamples = 4096;

/// The frames of an animation.
std::vector<FrameFile> frames_of(const RenderCommandOptions& options)
{
    return frames_of(options.frames, {&options.input, 1}, options.output, options.reading);
}

/// The pictures: one for each frame, or a single one.
std::vector<std::filesystem::path> outputs_of(const RenderCommandOptions& options)
{
    std::vector<std::filesystem::path> outputs;
    for (const FrameFile& frame : frames_of(options))
        outputs.push_back(frame.output);
    if (!options.frames.frames)
        outputs.emplace_back(options.output);
    return outputs;
}

/// Throws UsageError where a picture would replace what is read.
void check_files(const RenderCommandOptions& options)
{
    FilePlan plan;
    plan.reads(options.input);
    for (const std::string& other : options.parts.occluders)
        plan.reads(other);
    for (const GridFile& grid : grid_files_of(options.grids))
        plan.reads(grid.path.string());
    if (options.show.environment)
        plan.reads(*options.show.environment);
    for (const std::filesystem::path& output : outputs_of(options))
        plan.writes(output, "the picture");
}

/// Throws UsageError for a background that the file or the picture has not.
void check_background(const RenderCommandOptions& options, const ViewOptions& view)
{
    if (options.atlas && (view.background || fits_scale(options.show)))
        throw UsageError("--background and --difference-scale auto are not for --atlas.");
    const std::string extension = lower_extension(options.output);
    if (view.background && view.background->a == 0.0f &&
        (extension == ".jpg" || extension == ".jpeg"))
        throw UsageError("--background transparent is for .png and .exr: .jpg has no alpha.");
}

/// Throws UsageError for an engine that does not answer there, or not that.
void check_engine(const RenderCommandOptions& options)
{
    if (is_at_grid(options.texels))
        throw UsageError("--at grid is for bake, compare and view.");
    const std::string name = options.engine.engine.value_or("masks");
    check_pixel_options({&name, 1}, options.pixels, options.texels, options.measure);
    check_cube_options(options.cubes, is_at_cube_maps(options.texels));
    check_grid_options(options.grids, {&name, 1}, options.texels);
    const PixelEngine engine = engine_at_pixels(options);
    static_cast<void>(guard_of(options.pixels, {options.width, options.height}));
    if (const auto* of_scene = std::get_if<EngineSettings>(&engine))
        check_kernel(of_scene->engine, kernel_of(options.measure));
    else if (std::holds_alternative<GridPixels>(engine))
        check_kernel(Engine::masks, kernel_of(options.measure));
    if (!std::holds_alternative<EngineSettings>(engine) &&
        view_options_of(options.show).colors == Colors::bent_normals)
        throw UsageError("--mode bent-normals is for --engine masks, disks or rays: " + name +
                         " knows none.");
}

/// What a picture shows on the model.
struct Shown {
    std::vector<Occlusion> occlusion, reference;  ///< render()'s
    std::optional<ModelLayout> layout;            ///< with a map
    ModelMap map;
    std::optional<ModelMap> map_reference;
    std::optional<BasePaint> paint;
    double solve_s = 0.0, reference_s = 0.0;
    bool reference_from_cache = false;

    [[nodiscard]] SurfaceData data() const
    {
        return {layout ? &*layout : nullptr, layout ? &map : nullptr,
                map_reference ? &*map_reference : nullptr, paint ? &*paint : nullptr};
    }
};

bool needs_answer(Colors colors)
{
    return colors != Colors::rays && colors != Colors::normals && colors != Colors::levels &&
           colors != Colors::density;
}

/// Frames whose values at vertices come of a scene that is kept from one to the next.
class FrameSequence {
public:
    FrameSequence(const RenderCommandOptions& options, std::span<const double> seconds)
        : world_(options.input, seconds, target_settings_of(options.surface, options.show.up),
                 part_choice_of(options.parts), options.reading),
          solver_(world_, engine_for(options))
    {
    }

    void pose(double seconds)
    {
        world_.pose(seconds);
        solver_.place();
    }
    [[nodiscard]] const Scene& scene() const { return world_.scene(); }
    [[nodiscard]] const Box& box() const { return world_.box(); }

    /// Of the scene's vertices, then of further receivers.
    [[nodiscard]] std::vector<Occlusion> solve(std::span<const Receiver> more,
                                               const Progress& progress)
    {
        solver_.solve(progress);
        std::vector<Occlusion> values = solver_.values_of(solver_.answers());
        const std::vector<Occlusion> found = solver_.solve_others(more);
        values.insert(values.end(), found.begin(), found.end());
        return values;
    }

private:
    EngineSettings engine_for(const RenderCommandOptions& options) const
    {
        EngineSettings engine = settings_of(options.engine);
        engine.definition = definition_of(distance_limit_of(options.measure),
                                          kernel_of(options.measure), world_.frame());
        return engine;
    }

    MovingWorld world_;
    MovingSolver solver_;
};

using MakeProgress = std::function<Progress(const char*)>;

/// sequence: null, or where it stands in the model's pose.
void solve_for(const Model& model, FrameSequence* sequence, const EngineSettings& engine,
               const ViewOptions& view, std::uint32_t rays, const MakeProgress& stage, Shown& shown)
{
    Stopwatch watch;
    shown.occlusion.resize(model.answer_count());
    if (needs_answer(view.colors) && sequence != nullptr)
        shown.occlusion = sequence->solve(model.ground_receivers, stage("solve"));
    else if (needs_answer(view.colors))
        shown.occlusion = solve_model(prepare(model, engine), model, engine,
                                      {.ground = shows_ground(view)}, stage("solve"))
                              .values;
    shown.solve_s = watch.lap();
    if (!needs_reference(view))
        return;
    ModelReference reference = reference_of(model, engine.definition, rays, stage("reference"));
    shown.reference = std::move(reference.values);
    shown.reference_from_cache = reference.from_cache;
    shown.reference_s = watch.lap();
}

/// The same at the texels of a map.
void solve_map_for(const Model& model, const TexelSettings& texels, const EngineSettings& engine,
                   const ViewOptions& view, std::uint32_t rays, const MakeProgress& stage,
                   Shown& shown)
{
    Stopwatch watch;
    shown.layout = layout_of(model, texels, stage("charts"));
    const MapLayout& places = shown.layout->layout;
    shown.map = needs_answer(view.colors)
                    ? solve_map(model, places, engine, texels.padding, 0, stage("solve")).map
                    : open_map(places);
    shown.occlusion.resize(model.answer_count());
    if (shows_ground(view))
        shown.occlusion = solve_model(prepare(model.occluding(), engine), model, engine,
                                      {.vertices = false}, stage("ground"))
                              .values;
    shown.solve_s = watch.lap();
    if (!needs_reference(view))
        return;
    shown.map_reference =
        reference_map(model, places, engine.definition, rays, texels.padding, stage("reference"));
    shown.reference_s = watch.lap();
}

/// What was drawn, and how long it took: read_s, draw_s, write_s.
void tell(const RenderCommandOptions& options, const Model& model, const EngineSettings& engine,
          const Shown& shown, const std::array<double, 3>& seconds)
{
    const auto time = [](double s) { return fixed(s, 3) + " s"; };
    std::cout << options.input << " -> " << options.output << ", " << options.width << " x "
              << options.height << "\n  " << model.geometry().positions.size()
              << (model.cloud ? " points, "
                              : " vertices, " + std::to_string(model.geometry().triangles.size()) +
                                    " triangles, ")
              << name_of(engine.engine) << ", " << setting_of(engine);
    if (engine.definition.ground)
        std::cout << ", over a ground at "
                  << text_of(*engine.definition.ground, model.geometry().frame);
    std::cout << '\n';
    if (shown.layout)
        std::cout << "  " << text_of(*shown.layout) << '\n';
    std::cout << "  read " << time(seconds[0]) << ", solve " << time(shown.solve_s)
              << ", reference "
              << (shown.reference_from_cache ? "from the cache" : time(shown.reference_s))
              << ", draw " << time(seconds[1]) << ", write " << time(seconds[2]) << '\n';
    if (shown.paint)
        for (const std::string& note : shown.paint->notes)
            std::cout << "  note: " << note << '\n';
    const std::filesystem::path written[] = {options.output};
    print_written(written, false);
}

/// sequence: null, or of the frame that the options ask for.
int run(const RenderCommandOptions& options, FrameSequence* sequence)
{
    ProgressBar bar;
    const auto stage = [&](const char* name) -> Progress {
        return [&bar, name](double done) { return bar.update(name, done); };
    };

    // what can be refused comes first
    RenderOptions picture;
    picture.width = options.width;
    picture.height = options.height;
    picture.samples = options.samples;
    picture.backend = backend_of(options.backend);
    picture.view = view_options_of(options.show);
    picture.fit_scale = fits_scale(options.show);
    picture.view.ground &= !options.atlas;
    if (options.show.environment)
        picture.environment = read_image(*options.show.environment);

    Stopwatch watch;
    const TargetSettings target = target_settings_of(options.surface, options.show.up);
    const UpAxis up = up_axis_of(options.show);
    Scene scene = sequence != nullptr ? sequence->scene() : scene_of(options);
    const Model model = model_of(std::move(scene), up, target,
                                 {.parts = part_choice_of(options.parts),
                                  .ground = ground_plane_of(options.measure, options.show.up),
                                  .others = options.once.others,
                                  .frame = common_frame_of(options)});
    const Frame& frame = model.geometry().frame;
    EngineSettings engine = settings_of(options.engine);
    engine.definition =
        definition_of(distance_limit_of(options.measure), kernel_of(options.measure), frame);
    engine.definition.ground = model.occluding_ground;
    const auto texels = shown_texels_of(options.texels);
    if (texels && model.cloud)
        throw UsageError(options.input + ": has points only, no faces: --at points");
    if (model.cloud && (picture.view.wireframe || picture.view.cull))
        throw UsageError(options.input +
                         ": has points only, no faces: --wireframe and --cull are for faces.");
    const Camera camera = camera_of(options, model.seen, frame);
    Shown shown;
    if (picture.view.colors == Colors::textured && !model.cloud)
        shown.paint = base_paint_of(*model.mesh);
    const double read_s = options.once.seconds + watch.lap();
    open_images_early();

    const std::uint32_t rays = options.show.reference_rays;
    if (texels)
        solve_map_for(model, *texels, engine, picture.view, rays, stage, shown);
    else
        solve_for(model, sequence, engine, picture.view, rays, stage, shown);
    watch.lap();
    picture.data = shown.data();
    const Image image =
        options.atlas
            ? atlas_picture(*model.mesh, picture.data, picture.view, picture.width, picture.height)
            : render(model, shown.occlusion, shown.reference, camera, picture, stage("draw"));
    const double draw_s = watch.lap();
    write_image(options.output, image);

    tell(options, model, engine, shown, {read_s, draw_s, watch.lap()});
    return kDone;
}

/// Read or baked once for all frames.
std::shared_ptr<const GridSources> grid_sources_for(const RenderCommandOptions& options,
                                                    const std::vector<FrameFile>& frames)
{
    ProgressBar bar;
    ReadOptions reading = options.reading;
    if (!frames.empty())
        reading.moment = frames.front().moment;
    return std::make_shared<const GridSources>(grid_sources_of(
        options.grids, options.input, reading,
        [&](std::string_view stage, double done) { return bar.update(stage, done); }));
}

/// One picture, or one for each frame, at pixels or not.
int run_frames(const RenderCommandOptions& options, bool asks_pixels)
{
    const std::vector<FrameFile> frames = frames_of(options);
    OutputFolders folders;
    for (const std::filesystem::path& output : outputs_of(options)) {
        folders.make_for(output);
        check_image_output(output);
    }
    std::optional<ThreadLimit> limit;
    if (options.threads)
        limit.emplace(*options.threads);
    std::optional<FrameSequence> sequence;
    const auto run_one = [&](const RenderCommandOptions& one) {
        return asks_pixels ? render_pixels(one) : run(one, sequence ? &*sequence : nullptr);
    };
    RenderCommandOptions one = options;
    const PartChoice parts = part_choice_of(options.parts);
    Stopwatch watch;
    one.once.others = read_others(parts, options.reading);
    one.once.seconds = watch.lap();
    if (options.engine.engine == "grid")
        one.grid_sources = grid_sources_for(options, frames);
    if (frames.empty())
        return run_one(one);
    const std::vector<double> seconds = seconds_of(options.frames, {&options.input, 1});
    watch.lap();
    // what moves is kept from frame to frame where values at vertices are shown
    if (!asks_pixels && !shown_texels_of(options.texels) &&
        needs_answer(view_options_of(options.show).colors) &&
        settings_of(options.engine).device == Device::cpu &&
        !ground_plane_of(options.measure, options.show.up))
        sequence.emplace(options, seconds);
    else
        one.once.played = std::make_shared<PlayedScene>(options.input, options.reading);
    one.once.box =
        sequence ? sequence->box() : one.once.played->box_at(seconds, parts, one.once.others);
    one.once.seconds += watch.lap();
    for (const FrameFile& frame : frames) {
        one.reading.moment = frame.moment;
        if (sequence)
            sequence->pose(frame.moment.seconds);
        one.output = frame.output.string();
        if (const int code = run_one(one); code != kDone)
            return code;
        one.once.seconds = 0.0;
    }
    return kDone;
}

}  // namespace

void add_render_command(CLI::App& app, Work& work)
{
    const auto options = std::make_shared<RenderCommandOptions>();
    CLI::App* command =
        app.add_subcommand("render", "A picture of a mesh with its occlusion, without a window");
    command->add_option("IN", options->input, kMeshOrCloud)->required()->type_name("");
    command
        ->add_option(
            "-o,--output", options->output,
            "Picture: .png .jpg .exr (linear, alpha premultiplied); at pixels what sees nothing is "
            "transparent (.jpg: stands before the background)")
        ->required()
        ->type_name("OUT");
    add_read_options(*command, options->reading);
    add_frame_options(*command, options->frames);
    command->add_option("--width", options->width, "Pixels")
        ->check(whole_from(1, kMostPixels))
        ->type_name("N")
        ->capture_default_str();
    command->add_option("--height", options->height, "Pixels")
        ->check(whole_from(1, kMostPixels))
        ->type_name("N")
        ->capture_default_str();
    command
        ->add_option(
            "--samples", options->samples,
            "Samples per pixel: smoother edges; at pixels, what further samples see too is "
            "asked (1: middles alone)")
        ->check(whole_from(1, kMostSamples))
        ->type_name("N")
        ->capture_default_str();
    command
        ->add_option("--camera", options->camera,
                     "azimuth=30,elevation=18,distance=1,fov=35 or eye=X:Y:Z,target=X:Y:Z,fov=35, "
                     "any part of it; angles in degrees, distance relative to the framed view, "
                     "points in the file's units")
        ->type_name("WHERE");
    command
        ->add_option("--context", options->backend,
                     "What draws: egl (a GPU where there is one), osmesa (software), auto")
        ->check(one_of({"auto", "egl", "osmesa"}))
        ->type_name("auto|egl|osmesa")
        ->capture_default_str();
    add_model_options(*command, *options);
    add_cube_options(*command, options->cubes);
    add_grid_options(*command, options->grids);
    command->callback([options, command, &work] {
        apply_preset(*command);
        check_engine(*options);
        static_cast<void>(distance_limit_of(options->measure));
        static_cast<void>(ground_plane_of(options->measure, options->show.up));
        static_cast<void>(target_settings_of(options->surface, options->show.up));
        const ViewOptions view = view_options_of(options->show);
        const bool has_map = shown_texels_of(options->texels).has_value();
        const bool has_cube_maps = is_at_cube_maps(options->texels);
        const bool asks_pixels = has_cube_maps || is_at_pixels(options->texels);
        if (asks_pixels && (view.wireframe || view.cull))
            throw UsageError("--wireframe and --cull are for --at vertices and texels.");
        if (asks_pixels)
            check_shown_pixels(view, options->atlas, has_cube_maps);
        else
            check_shown_map(view, has_map, options->atlas);
        check_background(*options, view);
        check_files(*options);
        work = [options, asks_pixels] { return run_frames(*options, asks_pixels); };
    });
}

}  // namespace surfelao
