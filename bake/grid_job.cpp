#include "bake/grid_job.h"

#include "grid/cone.h"
#include "grid/grid_file.h"
#include "surfels/errors.h"
#include "surfels/progress.h"
#include "surfels/stopwatch.h"

#include <utility>

namespace surfelao {
namespace {

/// Cells stand closest about the middle.
glm::dvec3 closest_cells(const AoGrid& grid)
{
    const glm::ivec3 middle = grid.cells / 2;
    return place_of(grid, middle) - place_of(grid, middle - 1);
}

double mean_alpha(const AoGrid& grid)
{
    double sum = 0.0;
    const std::size_t channels = channels_of(grid.store);
    for (std::size_t at = 0; at < grid.values.size(); at += channels)
        sum += double{moments_of(grid.store, &grid.values[at]).w};
    return sum / static_cast<double>(grid.cell_count());
}

}  // namespace

void check_grid_job(const BakeSettings& settings)
{
    check_grid(*settings.grid);
    require(!settings.texels && !settings.subdivide && !settings.error && !settings.share &&
                !settings.ground && settings.parts.occluders.empty() && settings.beside.empty(),
            "a grid is of one object alone, by a known engine, without a ground");
    check_grid_output(settings.output, settings.grid->depth);
}

void bake_at_grid(const Mesh& mesh, BakeReport& report, const StageProgress& progress)
{
    const BakeSettings& settings = report.settings;
    GridBake bake =
        bake_grid(mesh.occluding(), *settings.grid, settings.engine, settings.check, progress);
    report.surfels = bake.surfels;
    report.residual = bake.residual;
    report.error = bake.error;
    report.receivers = bake.receivers;
    report.seconds.surfels = bake.seconds.surfels;
    report.seconds.tree = bake.seconds.tree;
    report.seconds.solve = bake.seconds.solve;
    report.seconds.repair = bake.seconds.repair;
    report.seconds.check = bake.seconds.check;
    report.mean_occlusion = mean_alpha(bake.grid);
    GridReport& told = report.grid.emplace();
    told.inside = bake.inside;
    told.closest = closest_cells(bake.grid);
    told.bytes = bytes_of(bake.grid, settings.grid->depth);
    std::vector<float> values = std::exchange(bake.grid.values, {});
    told.grid = bake.grid;
    bake.grid.values = std::move(values);

    if (progress && !progress("write", 0.0))
        throw Cancelled();
    Stopwatch watch;
    write_grid(settings.output, bake.grid, settings.grid->depth,
               {mark_of(settings), grid_notes_of(report)});
    report.seconds.write = watch.lap();
    report.notes = mesh.scene.notes;
}

}  // namespace surfelao
