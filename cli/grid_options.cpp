#include "cli/grid_options.h"

#include "cli/commands.h"
#include "cli/pixel_options.h"
#include "cli/value_checks.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>

namespace surfelao {
namespace {

constexpr const char* kGrid = "grid";

bool has_grid(std::span<const std::string> engines)
{
    return std::ranges::find(engines, kGrid) != engines.end();
}

/// "NODE=FILE", or a file whose name has that sign.
GridFile grid_file_of(const std::string& text)
{
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || std::filesystem::exists(text))
        return {"", text};
    if (equals == 0 || equals + 1 == text.size())
        throw UsageError("--grid: \"" + text + "\" is not FILE or NODE=FILE.");
    return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

void add_grid_options(CLI::App& command, GridOptions& options)
{
    constexpr const char* kGroup = "AO grids (--engine grid)";
    command
        .add_option("--grid", options.grids,
                    "The .aogrid.json of a part that it names, or of the parts that NODE means (* "
                    "and ? stand for anything); may be given again. Without it each part that an "
                    "animation moves gets a grid here")
        ->allow_extra_args(false)
        ->type_name("[NODE=]FILE")
        ->group(kGroup);
    command
        .add_option("--merge", options.merge,
                    "Several objects: product = of what each leaves of the light; union = their "
                    "cones are joined, where they hide the same")
        ->check(one_of({"product", "union"}))
        ->type_name("product|union")
        ->default_str("product")
        ->group(kGroup);
}

void check_grid_options(const GridOptions& options, std::span<const std::string> engines,
                        const TexelOptions& texels)
{
    if (has_grid(engines) && !is_at_pixels(texels))
        throw UsageError("--engine grid is for --at pixels.");
    if (!has_grid(engines) && (!options.grids.empty() || options.merge))
        throw UsageError("--grid and --merge are for --engine grid.");
    static_cast<void>(grid_files_of(options));
}

GridPixels grid_pixels_of(const GridOptions& options, const EngineOptions& engine)
{
    if (engine.rays || engine.passes || engine.strength || engine.device)
        throw UsageError(
            "--device, --rays, --passes and --strength are not for --engine grid: masks on the "
            "CPU answer for what has no grid.");
    EngineOptions rest = engine;
    rest.engine = "masks";
    GridPixels pixels;
    pixels.rest = settings_of(rest);
    pixels.merge = *grid_merge_of(options.merge.value_or("product"));
    return pixels;
}

std::vector<GridFile> grid_files_of(const GridOptions& options)
{
    std::vector<GridFile> files;
    for (const std::string& text : options.grids)
        files.push_back(grid_file_of(text));
    return files;
}

GridSources grid_sources_of(const GridOptions& options, const std::string& input,
                            const ReadOptions& reading, const StageProgress& progress)
{
    if (!options.grids.empty())
        return read_grids(input, reading, grid_files_of(options));
    return bake_moving_grids(input, reading, {}, {}, progress);
}

}  // namespace surfelao
