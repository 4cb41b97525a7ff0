#include "cli/model_options.h"

#include "cli/preset.h"

#include <CLI/CLI.hpp>

namespace surfelao {

void add_model_options(CLI::App& command, ModelOptions& options)
{
    add_show_options(command, options.show);
    add_layout_options(command, options.texels, kShownMaps);
    add_part_options(command, options.parts);
    add_atlas_option(command, options.atlas);
    add_engine_options(command, options.engine, pixel_engine_names());
    add_pixel_options(command, options.pixels);
    add_measure_options(command, options.measure);
    add_surface_options(command, options.surface);
    add_thread_option(command, options.threads);
    add_preset_option(command);
}

}  // namespace surfelao
