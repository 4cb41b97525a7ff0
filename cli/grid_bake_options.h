/// grid_bake_options.h: the options of AO grids that are made.
#pragma once

#include "bake/grid_target.h"
#include "cli/engine_options.h"
#include "cli/texel_options.h"

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace surfelao {

/// What was asked for: empty where an option was not given.
struct GridBakeOptions {
    std::optional<int> resolution;
    std::optional<double> extent;
    std::optional<std::string> store;
    std::optional<std::string> border;
    bool uniform = false;
};

/// --resolution, --extent, --border, --uniform; --store where a single grid is made.
void add_grid_bake_options(CLI::App& command, GridBakeOptions& options, bool with_store);

/// Throws UsageError for what is of no use where no surface is asked.
void check_about_an_object(const MeasureOptions& measure, const SurfaceOptions& surface);

[[nodiscard]] bool is_at_grid(const TexelOptions& options);

/// Nothing without --at grid. Throws UsageError for options of grids without it, and for a depth
/// that no grid has.
[[nodiscard]] std::optional<GridSettings> grid_settings_of(const GridBakeOptions& options,
                                                           const TexelOptions& texels);

}  // namespace surfelao
