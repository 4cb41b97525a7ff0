/// grid_options.h: the options of pixels that are answered by AO grids, for `render` and `compare`.
#pragma once

#include "cli/engine_options.h"
#include "cli/texel_options.h"
#include "files/scene_io.h"
#include "pixels/grid_sources.h"
#include "surfels/progress.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace surfelao {

/// What was asked for: empty where an option was not given.
struct GridOptions {
    std::vector<std::string> grids;  ///< FILE or NODE=FILE
    std::optional<std::string> merge;
};

/// --grid and --merge
void add_grid_options(CLI::App& command, GridOptions& options);

/// Throws UsageError for the engine grid elsewhere than at pixels, and for options of grids without
/// it. engines: by name.
void check_grid_options(const GridOptions& options, std::span<const std::string> engines,
                        const TexelOptions& texels);

/// Who answers; its world is made of the scene (grid_world_of). engine: of the rest: masks. Throws
/// UsageError for what is not for it.
[[nodiscard]] GridPixels grid_pixels_of(const GridOptions& options, const EngineOptions& engine);

/// The files of --grid, by name.
[[nodiscard]] std::vector<GridFile> grid_files_of(const GridOptions& options);

/// The grids of --grid, or one baked for each part that moves. Throws as read_grids() and
/// bake_moving_grids().
[[nodiscard]] GridSources grid_sources_of(const GridOptions& options, const std::string& input,
                                          const ReadOptions& reading,
                                          const StageProgress& progress = {});

}  // namespace surfelao
