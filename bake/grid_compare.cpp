#include "bake/grid_compare.h"

#include "bake/table.h"
#include "engines/threads.h"
#include "grid/grid_file.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

/// Of the places; those of a bake's own statement are others.
constexpr std::uint64_t kPlaceSeed = 20051201;

/// What rays tell at the places: two independent halves.
struct GridTruth {
    std::vector<Receiver> places;
    std::vector<Occlusion> reference;
    double noise = 0.0;
    double rms = 0.0;
};

GridTruth truth_about(const Geometry& object, const AoGrid& box, const Definition& definition,
                      const GridCompareSettings& settings, const Progress& progress)
{
    const RayScene scene(object, RayScene::Build::robust);
    GridTruth truth;
    truth.places = places_about(object, box, scene, settings.places, kPlaceSeed);
    RayOptions options{.definition = definition, .rays = settings.reference_rays / 2};
    std::vector<Occlusion> halves[2];
    for (std::uint32_t half = 0; half < 2; ++half) {
        options.seed = half;
        halves[half] = trace_occlusion(scene, truth.places, options, [&](double done) {
            return !progress || progress(0.5 * (half + done));
        });
    }
    double noise = 0.0, square = 0.0;
    for (std::size_t i = 0; i < truth.places.size(); ++i) {
        const float first = halves[0][i].occlusion, second = halves[1][i].occlusion;
        truth.reference.push_back({0.5f * (first + second), {}});
        noise += 0.25 * std::pow(double{first} - double{second}, 2.0);
        square += double{first} * double{second};
    }
    const double count = static_cast<double>(std::max<std::size_t>(1, truth.places.size()));
    truth.noise = std::sqrt(noise / count);
    truth.rms = std::sqrt(square / count);
    return truth;
}

GridRow row_of(const Geometry& object, const GridTruth& truth, const EngineSettings& engine,
               const GridSettings& grid, int rounds, const StageProgress& progress)
{
    GridRow row;
    row.engine = engine;
    row.grid = grid;
    std::vector<double> build, solve, repair;
    for (int round = 0; round < rounds; ++round) {
        const GridBake bake = bake_grid(object, grid, engine, 0, progress);
        build.push_back(bake.seconds.surfels + bake.seconds.tree);
        solve.push_back(bake.seconds.solve);
        repair.push_back(bake.seconds.repair);
        if (round > 0)
            continue;
        row.inside = bake.inside;
        row.receivers = bake.receivers;
        row.bytes = bytes_of(bake.grid, grid.depth);
        std::vector<Occlusion> answers;
        for (const Receiver& place : truth.places)
            answers.push_back({occlusion_at(bake.grid, object.frame, place), {}});
        row.error = error_statistics(answers, truth.reference, truth.noise);
    }
    row.build_s = quantile(build, 0.5);
    row.solve_s = quantile(solve, 0.5);
    row.repair_s = quantile(repair, 0.5);
    return row;
}

/// "cone, eps 0.1, uniform, rescale"
std::string text_of_row(const GridRow& row)
{
    return name_of(row.grid.store) + ", eps " + exact(row.grid.extent) +
           (row.grid.uniform ? ", uniform, " : ", ") + name_of(row.grid.border) +
           (row.is_origin ? " (origin)" : "");
}

/// Of Malmer et al.: even cells in a box of eps .1, cones, rescaled at the border.
GridSettings origin_settings(int resolution)
{
    return {.resolution = resolution,
            .extent = 0.1,
            .uniform = true,
            .store = GridStore::cone,
            .border = GridBorder::rescale};
}

}  // namespace

GridComparison compare_grids(const Geometry& object, const GridCompareSettings& settings,
                             const StageProgress& progress)
{
    check_grid(settings.grid);
    require(settings.rounds >= 1, "rounds must be at least 1");
    require(settings.places >= 1 && !settings.candidates.empty(), "nothing is compared");
    require(settings.reference_rays >= 2 && settings.reference_rays % 2 == 0,
            "the rays of the reference must be an even number");
    GridComparison comparison;
    comparison.input = settings.input;
    comparison.triangles = object.triangles.size();
    comparison.reference_rays = settings.reference_rays;
    comparison.threads = thread_count();
    comparison.rounds = settings.rounds;
    const AoGrid box = empty_grid(box_of(object), settings.grid);
    comparison.box = {box.low, box.high};
    const Definition definition =
        definition_of(settings.max_distance, Kernel::cosine, object.frame);
    const auto in_reference = [&](double done) { return progress("reference", done); };
    const GridTruth truth = truth_about(object, box, definition, settings,
                                        progress ? Progress(in_reference) : Progress());
    comparison.places = truth.places.size();
    comparison.reference_noise = truth.noise;
    comparison.rms_occlusion = truth.rms;
    for (EngineSettings engine : settings.candidates) {
        engine.definition = definition;
        for (const GridStore store : {GridStore::cone, GridStore::sh}) {
            GridSettings grid = settings.grid;
            grid.store = store;
            comparison.rows.push_back(
                row_of(object, truth, engine, grid, settings.rounds, progress));
        }
    }
    EngineSettings engine = settings.candidates.front();
    engine.definition = definition;
    comparison.rows.push_back(row_of(object, truth, engine,
                                     origin_settings(settings.grid.resolution), settings.rounds,
                                     progress));
    comparison.rows.back().is_origin = true;
    return comparison;
}

GridComparison compare_grids(const GridCompareSettings& settings, const StageProgress& progress)
{
    if (progress && !progress("read", 0.0))
        throw Cancelled();
    PartChoice parts = settings.parts;
    parts.alone = true;
    const Mesh mesh = read_mesh(settings.input, {}, parts, settings.reading);
    return compare_grids(mesh.occluding(), settings, progress);
}

std::string csv_of(const GridComparison& comparison)
{
    std::string text =
        "input,triangles,places,engine,setting,store,extent,uniform,border,origin,build_s,solve_s,"
        "repair_s,inside,receivers,bytes,rmse,bias,p95,max\n";
    for (const GridRow& row : comparison.rows) {
        text += csv_field(comparison.input.string()) + ',' + std::to_string(comparison.triangles) +
                ',' + std::to_string(comparison.places) + ',' + name_of(row.engine.engine) + ',' +
                csv_field(setting_of(row.engine)) + ',' + name_of(row.grid.store) + ',' +
                exact(row.grid.extent) + (row.grid.uniform ? ",1," : ",0,") +
                name_of(row.grid.border) + (row.is_origin ? ",1" : ",0");
        for (const double value : {row.build_s, row.solve_s, row.repair_s})
            text += ',' + exact(value);
        for (const std::uint64_t value : {row.inside, row.receivers, row.bytes})
            text += ',' + std::to_string(value);
        for (const double value : {row.error.rmse, row.error.bias, row.error.p95, row.error.max})
            text += ',' + exact(value);
        text += '\n';
    }
    return text;
}

std::string table_of(const GridComparison& comparison)
{
    Table table({"engine", "grid", "build s", "solve s", "repair s", "inside", "KiB", "RMSE",
                 "bias", "p95", "max"});
    for (const GridRow& row : comparison.rows)
        table.add({name_of(row.engine.engine) + " " + setting_of(row.engine), text_of_row(row),
                   fixed(row.build_s, 3), fixed(row.solve_s, 3), fixed(row.repair_s, 3),
                   std::to_string(row.inside), std::to_string(row.bytes / 1024),
                   fixed(row.error.rmse, 4), signed_fixed(row.error.bias, 4),
                   fixed(row.error.p95, 4), fixed(row.error.max, 3)});
    const int cells = comparison.rows.empty() ? 0 : comparison.rows.front().grid.resolution;
    return comparison.input.string() + ": " + std::to_string(comparison.triangles) +
           " triangles, grids of " + std::to_string(cells) + "^3 cells; " +
           std::to_string(comparison.places) + " places about it, RMS occlusion " +
           fixed(comparison.rms_occlusion, 3) + ", against " +
           std::to_string(comparison.reference_rays) + " rays (noise " +
           fixed(comparison.reference_noise, 4) + "); " + std::to_string(comparison.threads) +
           " threads, median of " + std::to_string(comparison.rounds) + "\n\n" + table.text();
}

}  // namespace surfelao
