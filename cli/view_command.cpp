#include "cli/commands.h"
#include "cli/grid_bake_options.h"
#include "cli/interrupt.h"
#include "cli/model_options.h"
#include "cli/output.h"
#include "cli/preset.h"
#include "engines/threads.h"
#include "image/image_file.h"
#include "surfels/errors.h"
#include "viewer/recent_files.h"
#include "viewer/window.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace surfelao {
namespace {

struct ViewCommandOptions : ModelOptions {
    std::vector<std::string> inputs;
    GridBakeOptions grid;
};

/// Of the picture; the engine of the scene where it is that one.
std::optional<ScreenSettings> screen_of(const ViewCommandOptions& options)
{
    const PixelEngine engine = pixel_engine_of(options.engine, options.pixels);
    const auto* screen = std::get_if<ScreenSettings>(&engine);
    return screen ? std::optional(*screen) : std::nullopt;
}

/// What the window begins with. Throws UsageError.
Cell cell_of(const ViewCommandOptions& options)
{
    Cell cell;
    cell.from_maps = is_at_cube_maps(options.texels);
    cell.grid = grid_settings_of(options.grid, options.texels);
    cell.at_pixels = is_at_pixels(options.texels) || cell.from_maps || cell.grid;
    if (is_at_pixels(options.texels))
        cell.screen = screen_of(options);
    cell.guard = static_cast<float>(guard_share_of(options.pixels));
    if (!cell.screen)
        cell.settings.engine = settings_of(options.engine);
    cell.settings.max_distance = distance_limit_of(options.measure);
    cell.settings.target = target_settings_of(options.surface, options.show.up);
    cell.settings.texels = shown_texels_of(options.texels);
    cell.settings.parts = part_choice_of(options.parts);
    cell.settings.ground = ground_plane_of(options.measure, options.show.up);
    return cell;
}

void check_view(const ViewCommandOptions& options)
{
    const std::string engine = options.engine.engine.value_or("masks");
    check_pixel_options(std::span(&engine, 1), options.pixels, options.texels, options.measure);
    if (is_at_cube_maps(options.texels) && screen_of(options))
        throw UsageError("--engine " + engine +
                         " is for --at pixels: the window's cube maps have masks, disks or rays.");
    const Cell cell = cell_of(options);
    if (fits_scale(options.show))
        throw UsageError("--difference-scale auto is for render.");
    const ViewOptions view = view_options_of(options.show);
    if (cell.at_pixels)
        check_shown_pixels(view, options.atlas, cell.from_maps);
    else
        check_shown_map(view, cell.settings.texels.has_value(), options.atlas);
    const DistanceLimit& distance = cell.settings.max_distance;
    if (std::isfinite(distance.value) && !distance.percent)
        throw UsageError("--max-distance of a window is in % of the diagonal (10%).");
    if (kernel_of(options.measure) != Kernel::cosine)
        throw UsageError("--kernel bunnell is not for a window: compare and bake know it.");
}

int run(const ViewCommandOptions& options)
{
    std::optional<ThreadLimit> limit;
    if (options.threads)
        limit.emplace(*options.threads);
    WindowOptions window;
    window.recent_list = recent_list_path();
    if (!options.inputs.empty()) {
        window.input = options.inputs.front();
        window.more_inputs.assign(options.inputs.begin() + 1, options.inputs.end());
    }
    window.reading = options.reading;
    window.up = up_axis_of(options.show);
    window.camera = options.camera;
    window.panel.view = view_options_of(options.show);
    window.panel.reference_rays = static_cast<int>(options.show.reference_rays);
    if (options.show.environment) {
        window.environment = read_image(*options.show.environment);
        window.other_inputs.push_back(*options.show.environment);
    }
    for (const std::string& input : options.inputs) {
        if (!std::filesystem::exists(input))
            throw InputError(input + ": no such file");
    }

    window.panel.left = cell_of(options);
    window.other_inputs.insert(window.other_inputs.end(), options.parts.occluders.begin(),
                               options.parts.occluders.end());
    window.panel.shows_atlas = options.atlas;
    window.keep_open = [] { return caught_signal() == 0; };
    print_written(show_window(window), false);
    if (caught_signal() != 0)
        return kKilledBy + caught_signal();
    return kDone;
}

}  // namespace

void add_view_command(CLI::App& app, Work& work)
{
    const auto options = std::make_shared<ViewCommandOptions>();
    CLI::App* command = app.add_subcommand(
        "view",
        "A window: orbit, engines, settings, display modes, comparison with rays, parts that move");
    command
        ->add_option("IN", options->inputs,
                     std::string(kMeshOrCloud) +
                         "; the first is shown, several are a list in the window; without one, "
                         "open files there")
        ->type_name("");
    command
        ->add_option("--camera", options->camera,
                     "Where from, as for render: azimuth=30,elevation=18,distance=1,fov=35")
        ->type_name("WHERE");
    add_read_options(*command, options->reading);
    add_model_options(*command, *options);
    add_grid_bake_options(*command, options->grid, true);
    command->callback([options, command, &work] {
        apply_preset(*command);
        check_view(*options);
        work = [options] { return run(*options); };
    });
}

}  // namespace surfelao
