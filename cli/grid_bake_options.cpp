#include "cli/grid_bake_options.h"

#include "cli/commands.h"
#include "cli/value_checks.h"

#include <CLI/CLI.hpp>

namespace surfelao {
namespace {

constexpr const char* kGridBakeGroup = "AO grids (--at grid)";

}  // namespace

void add_grid_bake_options(CLI::App& command, GridBakeOptions& options, bool with_store)
{
    command.add_option("--resolution", options.resolution, "Cells along each axis of the grid")
        ->check(whole_from(kLeastGrid, kMostGrid))
        ->type_name("N")
        ->default_str("32")
        ->group(kGridBakeGroup);
    command
        .add_option("--extent", options.extent,
                    "The grid's box reaches to where the object hides this share of all directions")
        ->check(number_from(1e-4, kMostExtent))
        ->type_name("EPS")
        ->default_str("0.03")
        ->group(kGridBakeGroup);
    if (with_store)
        command
            .add_option("--store", options.store,
                        "What a cell holds. cone: how much is hidden and where, four numbers; sh: "
                        "nine spherical harmonics, more exact")
            ->check(one_of({"cone", "sh"}))
            ->type_name("cone|sh")
            ->default_str("cone")
            ->group(kGridBakeGroup);
    command
        .add_option("--border", options.border,
                    "Where the box ends. fade: what is read falls to nothing over the last of it; "
                    "rescale: everywhere less, by the border's largest value")
        ->check(one_of({"fade", "rescale"}))
        ->type_name("fade|rescale")
        ->default_str("fade")
        ->group(kGridBakeGroup);
    command
        .add_flag("--uniform", options.uniform,
                  "Cells everywhere as close, in place of closer about the object")
        ->group(kGridBakeGroup);
}

void check_about_an_object(const MeasureOptions& measure, const SurfaceOptions& surface)
{
    if (measure.ground || kernel_of(measure) != Kernel::cosine)
        throw UsageError("--at grid knows --kernel cosine only, and no --ground.");
    if (has_any(surface))
        throw UsageError(
            "--normals, --crease, --values, --offset, --viewpoint and --occluder-spacing are not "
            "for --at grid: it asks about the object, not on it.");
}

bool is_at_grid(const TexelOptions& options)
{
    return options.at == "grid";
}

std::optional<GridSettings> grid_settings_of(const GridBakeOptions& options,
                                             const TexelOptions& texels)
{
    if (!is_at_grid(texels)) {
        if (options.resolution || options.extent || options.store || options.border ||
            options.uniform)
            throw UsageError(
                "--resolution, --extent, --store, --border and --uniform are for --at grid.");
        return {};
    }
    GridSettings settings;
    settings.resolution = options.resolution.value_or(settings.resolution);
    settings.extent = options.extent.value_or(settings.extent);
    settings.store = options.store == "sh" ? GridStore::sh : GridStore::cone;
    settings.border = options.border == "rescale" ? GridBorder::rescale : GridBorder::fade;
    settings.uniform = options.uniform;
    if (texels.depth == 32)
        throw UsageError("--at grid: --depth is 8 or 16.");
    settings.depth = texels.depth == 8 ? MapDepth::byte : MapDepth::half;
    return settings;
}

}  // namespace surfelao
