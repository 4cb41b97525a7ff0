#include "cli/commands.h"
#include "cli/compare_options.h"
#include "cli/value_checks.h"
#include "reference/rays.h"
#include "surfels/errors.h"

#include <CLI/CLI.hpp>

#include <algorithm>

namespace surfelao {
namespace {

constexpr int kMostSide = 32768;  // pixels each way; the device may draw less
constexpr int kMostViews = 1000;
constexpr std::uint32_t kPixelRays = 256;  // the origin's

/// Masks, and all that know the picture alone.
std::vector<std::string> engines_at_pixels(const CompareOptions& options)
{
    if (!options.engines.empty())
        return options.engines;
    std::vector<std::string> names = {"masks"};
    for (const ScreenMethod method : screen_methods())
        names.push_back(name_of(method));
    return names;
}

PixelOptions methods_with_taps(const CompareOptions& options)
{
    PixelOptions methods = options.pixels.methods;
    if (methods.taps.empty())
        methods.taps = {8, 16, 24};
    return methods;
}

/// The rows of an engine of the scene.
void add_scene_engine(const CompareOptions& options, Engine engine,
                      std::vector<PixelEngine>& engines)
{
    EngineSettings settings;
    settings.engine = engine;
    settings.instructions = options.avx2 ? Instructions::avx2 : Instructions::all;
    for (const std::string& device : options.devices) {
        settings.device = device_of(device);
        if (!runs_on(engine, settings.device))
            continue;
        if (engine == Engine::rays) {
            const std::vector<std::uint32_t> counts = options.pixels.rays.empty()
                                                          ? std::vector<std::uint32_t>{16, 64, 256}
                                                          : options.pixels.rays;
            for (const std::uint32_t rays : counts) {
                settings.rays = rays;
                engines.emplace_back(settings);
            }
            continue;
        }
        for (const std::string& quality : qualities_of(options)) {
            settings.quality = quality_of(quality, engine);
            engines.emplace_back(settings);
        }
    }
}

/// One for each quality of the rest that is named, else good.
void add_grid_rows(const CompareOptions& options, std::vector<PixelEngine>& engines)
{
    for (const std::string& quality :
         options.qualities.value_or(std::vector<std::string>{"good"})) {
        EngineOptions rest;
        rest.quality = quality;
        engines.emplace_back(grid_pixels_of(options.pixels.grids, rest));
    }
}

std::vector<PixelEngine> engines_of_table(const CompareOptions& options)
{
    const PixelOptions methods = methods_with_taps(options);
    std::vector<PixelEngine> engines;
    for (const std::string& name : engines_at_pixels(options)) {
        const auto method = screen_method_of(name);
        if (name == "grid") {
            add_grid_rows(options, engines);
            continue;
        }
        if (!method) {
            add_scene_engine(options, engine_of(name), engines);
            continue;
        }
        for (const ScreenSettings& settings : screen_settings_of(*method, methods))
            engines.emplace_back(settings);
    }
    return engines;
}

/// The engines of --tune, and what is swept.
void tune_into(const CompareOptions& options, PixelCompareSettings& settings)
{
    try {
        settings.sweep = parse_sweep(*options.pixels.tune);
        settings.engines =
            engines_of(*settings.sweep,
                       screen_settings_of(settings.sweep->method, options.pixels.methods).front());
    } catch (const SettingsError& error) {
        throw UsageError(std::string("--tune: ") + error.what() + '.');
    }
}

bool has_pixel_table_option(const PixelTableOptions& options)
{
    return !options.cameras.empty() || options.views || options.width || options.height ||
           options.tune;
}

}  // namespace

void add_pixel_table_options(CLI::App& command, PixelTableOptions& options)
{
    constexpr const char* kGroup = "Pixels (--at pixels)";
    add_pixel_options(command, options.methods, true);
    add_grid_options(command, options.grids);
    command
        .add_option("--camera", options.cameras,
                    "From where to look, as of `render`; may be given again")
        ->allow_extra_args(false)
        ->type_name("WHERE")
        ->group(kGroup);
    command
        .add_option("--views", options.views,
                    "Without --camera: look from so many directions, evenly spread all round")
        ->check(whole_from(1, kMostViews))
        ->type_name("N")
        ->default_str("4")
        ->group(kGroup);
    command.add_option("--width", options.width, "Pixels of each picture")
        ->check(whole_from(1, kMostSide))
        ->type_name("N")
        ->default_str("1280")
        ->group(kGroup);
    command.add_option("--height", options.height, "Pixels of each picture")
        ->check(whole_from(1, kMostSide))
        ->type_name("N")
        ->default_str("720")
        ->group(kGroup);
    command
        .add_option("--rays", options.rays,
                    "Rays a pixel of the engine rays, a row for each number")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(whole_from(1, kMostRays))
        ->type_name("N,...")
        ->default_str("16,64,256")
        ->group(kGroup);
    command
        .add_option("--tune", options.tune,
                    "Try one setting of a method that knows the picture alone, and mark the value "
                    "with the least error: hbao.bias=0:40:5")
        ->type_name("METHOD.NAME=FROM:TO:STEP")
        ->group(kGroup);
}

void check_pixel_table(const CompareOptions& options)
{
    const PixelTableOptions& pixels = options.pixels;
    const std::vector<std::string> engines =
        is_at_pixels(options.texels) ? engines_at_pixels(options) : options.engines;
    const bool tunes = pixels.tune.has_value();
    check_grid_options(pixels.grids, engines, options.texels);
    if (is_at_cube_maps(options.texels))
        throw UsageError("compare is at vertices, texels, points, pixels or grid.");
    if (!is_at_pixels(options.texels)) {
        check_pixel_options(engines, pixels.methods, options.texels, options.measure);
        if (std::ranges::find(engines, "rays") != engines.end() || !pixels.rays.empty())
            throw UsageError(
                "The engine rays, and --rays, are for --at pixels: else rays are "
                "what all are compared with.");
        if (has_pixel_table_option(pixels))
            throw UsageError(
                "--camera, --views, --width, --height and --tune are for --at pixels.");
        return;
    }
    if (options.frontier)
        throw UsageError(
            "--frontier is for vertices and texels: at pixels --qualities and --taps "
            "list all rows.");
    if (options.subdivide || options.sample || options.surface.values ||
        options.surface.viewpoint || options.surface.occluder_spacing)
        throw UsageError(
            "--subdivide, --sample, --values, --viewpoint and --occluder-spacing are "
            "not for --at pixels.");
    if (!pixels.cameras.empty() && pixels.views)
        throw UsageError("--camera and --views both say from where to look.");
    if (tunes && (!options.engines.empty() || options.qualities || !pixels.rays.empty()))
        throw UsageError(
            "--tune names its method: --engines, --qualities and --rays do not go "
            "with it.");
    if (tunes && pixels.methods.taps.size() > 1)
        throw UsageError("--tune goes with one number of --taps.");
    if (!pixels.rays.empty() && std::ranges::find(engines, "rays") == engines.end())
        throw UsageError("--rays is for --engines rays.");
    const PixelCompareSettings settings = pixel_compare_settings(options);
    std::vector<std::string> asked;
    for (const PixelEngine& engine : settings.engines)
        asked.push_back(name_of(engine));
    check_pixel_options(asked, pixels.methods, options.texels, options.measure);
    for (const PixelEngine& engine : settings.engines) {
        if (const auto* scene = std::get_if<EngineSettings>(&engine))
            check_kernel(scene->engine, settings.kernel);
    }
}

PixelCompareSettings pixel_compare_settings(const CompareOptions& options)
{
    const PixelTableOptions& pixels = options.pixels;
    PixelCompareSettings settings;
    settings.input = options.inputs.front();
    if (pixels.tune)
        tune_into(options, settings);
    else
        settings.engines = engines_of_table(options);
    if (settings.engines.empty())
        throw UsageError("--engines rays does not run on --devices gpu.");
    settings.cameras = pixels.cameras;
    settings.views = pixels.views.value_or(settings.views);
    settings.up = options.up == "z" ? UpAxis::z : UpAxis::y;
    settings.size = {pixels.width.value_or(settings.size.width),
                     pixels.height.value_or(settings.size.height)};
    settings.guard = guard_of(pixels.methods, settings.size);
    settings.max_distance = distance_limit_of(options.measure);
    settings.kernel = kernel_of(options.measure);
    settings.ground = ground_plane_of(options.measure, options.up);
    settings.target = target_settings_of(options.surface, options.up);
    settings.parts = part_choice_of(options.parts);
    settings.reading = options.reading;
    settings.reference_rays = options.reference_rays.value_or(kPixelRays);
    settings.rounds = options.rounds.value_or(kRounds);
    settings.use_cache = !options.no_cache;
    settings.pictures = options.output.has_value();
    return settings;
}

}  // namespace surfelao
