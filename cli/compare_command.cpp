#include "bake/compare.h"
#include "bake/frontier.h"
#include "bake/moving_compare.h"
#include "bake/surface_error.h"
#include "cli/commands.h"
#include "cli/compare_options.h"
#include "cli/output.h"
#include "cli/preset.h"
#include "cli/progress_bar.h"
#include "cli/value_checks.h"
#include "engines/threads.h"
#include "reference/rays.h"
#include "surfels/atomic_file.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <memory>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

/// Each takes some hundred bytes, and thousands of rays.
constexpr std::uint64_t kMostSample = 10'000'000;

constexpr std::uint32_t kSurfaceRays = 4096;  // a point of the surface

std::vector<std::string> engines_of_scene(const CompareOptions& options)
{
    return options.engines.empty() ? std::vector<std::string>{"masks", "disks"} : options.engines;
}

/// All but the input and the candidates.
CompareSettings common_settings(const CompareOptions& options)
{
    CompareSettings settings;
    settings.max_distance = distance_limit_of(options.measure);
    settings.kernel = kernel_of(options.measure);
    settings.ground = ground_plane_of(options.measure, options.up);
    settings.target = target_settings_of(options.surface, options.up);
    settings.parts = part_choice_of(options.parts);
    settings.texels = shown_texels_of(options.texels);
    settings.subdivide = options.subdivide;
    settings.reference_rays = options.reference_rays.value_or(kSurfaceRays);
    settings.sample = options.sample.value_or(kSurfacePoints);
    settings.rounds = options.rounds.value_or(kRounds);
    settings.use_cache = !options.no_cache;
    settings.reading = options.reading;
    settings.instructions = options.avx2 ? Instructions::avx2 : Instructions::all;
    return settings;
}

CompareSettings compare_settings(const CompareOptions& options)
{
    CompareSettings settings = common_settings(options);
    settings.input = options.inputs.front();
    for (const std::string& engine : engines_of_scene(options)) {
        for (const std::string& device : options.devices) {
            for (const std::string& quality : qualities_of(options)) {
                EngineSettings& candidate = settings.candidates.emplace_back();
                candidate.engine = engine_of(engine);
                candidate.device = device_of(device);
                candidate.quality = quality_of(quality, candidate.engine);
            }
        }
    }
    return settings;
}

FrontierSettings frontier_settings(const CompareOptions& options)
{
    FrontierSettings settings;
    settings.compare = common_settings(options);
    settings.inputs.assign(options.inputs.begin(), options.inputs.end());
    for (const std::string& engine : engines_of_scene(options))
        settings.engines.push_back(engine_of(engine));
    return settings;
}

MovingCompareSettings moving_settings(const CompareOptions& options)
{
    const CompareSettings common = compare_settings(options);
    MovingCompareSettings settings;
    settings.input = common.input;
    settings.seconds = seconds_of(options.frames, options.inputs);
    settings.candidates = common.candidates;
    settings.max_distance = common.max_distance;
    settings.kernel = common.kernel;
    settings.ground = common.ground;
    settings.target = common.target;
    settings.parts = common.parts;
    settings.reading = common.reading;
    settings.sample = options.sample.value_or(kMovingSample);
    settings.reference_rays = options.reference_rays.value_or(kMovingRays);
    return settings;
}

/// What goes into the folder of -o.
fs::path difference_of(const CompareOptions& options)
{
    return fs::path(*options.output) / "difference.ply";
}

fs::path report_of(const CompareOptions& options)
{
    return fs::path(*options.output) / "report.html";
}

/// The table, and the files that were asked for by name: these are added to `written`.
template <class Result>
void print_or_write(const CompareOptions& options, const Result& result,
                    std::vector<fs::path>& written)
{
    if (options.json != "-" && options.csv != "-")
        std::cout << table_of(result);
    const auto write = [&](const std::optional<std::string>& file, const std::string& text) {
        if (!file)
            return;
        write_report(*file, text);
        if (file != "-")
            written.emplace_back(*file);
    };
    write(options.json, json_of(result));
    write(options.csv, csv_of(result));
}

int run_compare(const CompareOptions& options, std::vector<fs::path>& written)
{
    Comparison comparison = [&] {
        ProgressBar bar;
        return compare(compare_settings(options), [&](std::string_view stage, double done) {
            return bar.update(stage, done);
        });
    }();
    print_or_write(options, comparison, written);
    if (!options.output)
        return kDone;
    if (!comparison.texels) {
        write_difference(difference_of(options), comparison, shown_row(comparison));
        written.push_back(difference_of(options));
    }
    Frontier frontier;
    for (const std::string& engine : engines_of_scene(options))
        frontier.engines.push_back(engine_of(engine));
    frontier.scenes.push_back(frontier_scene(std::move(comparison)));
    write_atomically(report_of(options), html_of(frontier));
    written.push_back(report_of(options));
    return kDone;
}

int run_frontier(const CompareOptions& options, std::vector<fs::path>& written)
{
    const Frontier result = [&] {
        ProgressBar bar;
        return frontier(frontier_settings(options), [&](std::string_view stage, double done) {
            return bar.update(stage, done);
        });
    }();
    print_or_write(options, result, written);
    if (options.output) {
        write_atomically(report_of(options), html_of(result));
        written.push_back(report_of(options));
    }
    int code = kDone;
    for (const FrontierScene& scene : result.scenes) {
        if (!scene.comparison) {
            std::cerr << "surfelao: " << scene.error << '\n';
            code = kFailed;
        }
    }
    return code;
}

int run_at_pixels(const CompareOptions& options, std::vector<fs::path>& written)
{
    const PixelComparison comparison = [&] {
        ProgressBar bar;
        const auto update = [&](std::string_view stage, double done) {
            return bar.update(stage, done);
        };
        PixelCompareSettings settings = pixel_compare_settings(options);
        if (std::ranges::find(options.engines, "grid") != options.engines.end())
            settings.grids = grid_sources_of(options.pixels.grids, options.inputs.front(),
                                             options.reading, update);
        return compare_pixels(settings, update);
    }();
    print_or_write(options, comparison, written);
    if (options.output) {
        write_atomically(report_of(options), html_of(comparison));
        written.push_back(report_of(options));
    }
    return kDone;
}

int run_frames(const CompareOptions& options, std::vector<fs::path>& written)
{
    const MovingComparison comparison = [&] {
        ProgressBar bar;
        return compare_frames(moving_settings(options), [&](std::string_view stage, double done) {
            return bar.update(stage, done);
        });
    }();
    print_or_write(options, comparison, written);
    return kDone;
}

int run_at_grid(const CompareOptions& options, std::vector<fs::path>& written)
{
    const GridComparison comparison = [&] {
        ProgressBar bar;
        return compare_grids(
            grid_compare_settings(options),
            [&](std::string_view stage, double done) { return bar.update(stage, done); });
    }();
    print_or_write(options, comparison, written);
    return kDone;
}

/// What goes into the folder of -o without having been named by the user.
std::vector<fs::path> own_names(const CompareOptions& options)
{
    if (!options.output)
        return {};
    if (options.frontier || options.texels.at == "texels" || is_at_pixels(options.texels))
        return {report_of(options)};
    return {difference_of(options), report_of(options)};
}

int run(const CompareOptions& options)
{
    OutputFolders folders;
    folders.make_for_report(options.json);
    folders.make_for_report(options.csv);
    if (options.output)
        folders.make(*options.output);
    for (const fs::path& file : own_names(options)) {
        if (!options.overwrite)
            refuse_foreign(file, "compare");
        check_writable(file);
    }
    std::optional<ThreadLimit> limit;
    if (options.threads)
        limit.emplace(*options.threads);
    std::vector<fs::path> written;
    const int code = options.frames.frames          ? run_frames(options, written)
                     : is_at_pixels(options.texels) ? run_at_pixels(options, written)
                     : is_at_grid(options.texels)   ? run_at_grid(options, written)
                     : options.frontier             ? run_frontier(options, written)
                                                    : run_compare(options, written);
    print_written(written, options.json == "-" || options.csv == "-");
    return code;
}

/// Throws UsageError for what does not go with --frames.
void check_frames(const CompareOptions& options)
{
    if (!options.frames.frames)
        return;
    if (seconds_of(options.frames, options.inputs).size() < 2)
        throw UsageError("compare --frames needs two frames at least.");
    if (options.texels.at.value_or("vertices") != "vertices" || options.frontier ||
        options.output || options.subdivide || options.devices != std::vector<std::string>{"cpu"})
        throw UsageError(
            "--frames compares values at vertices on the CPU, in a table: it goes with neither "
            "--at nor --frontier, -o, --subdivide or --devices.");
    if (options.rounds || options.no_cache)
        throw UsageError(
            "--rounds and --no-cache are not for --frames: each engine goes through them once, and "
            "nothing is kept.");
}

/// What a preset leaves alone.
std::vector<std::string> moot_of(const CompareOptions& options)
{
    if (is_at_grid(options.texels))
        return {"--normals", "--crease", "--subdivide"};
    if (options.frames.frames || options.texels.at.value_or("vertices") != "vertices")
        return {"--subdivide"};
    return {};
}

/// Contradictions, before any work.
void check(const CompareOptions& options)
{
    if (options.inputs.size() > 1 && is_at_pixels(options.texels))
        throw UsageError("--at pixels is for one file.");
    if (options.inputs.size() > 1 && !options.frontier)
        throw UsageError("several files need --frontier.");
    if (options.frontier && options.qualities)
        throw UsageError("--frontier runs all qualities: it does not go with --qualities.");
    if (options.frontier && options.devices != std::vector<std::string>{"cpu"})
        throw UsageError("--frontier runs on the CPU: it does not go with --devices.");
    if (options.frontier && options.rounds.value_or(kRounds) < 3)
        throw UsageError("--frontier needs at least 3 rounds.");
    if (options.reference_rays.value_or(kSurfaceRays) % 2 != 0)
        throw UsageError("--reference-rays must be even: two halves tell the noise.");
    if (options.subdivide && options.texels.at == "texels")
        throw UsageError("--subdivide is for values at vertices: it goes with no map.");
    if (options.json == "-" && options.csv == "-")
        throw UsageError("--json and --csv cannot both go to standard output.");
    check_pixel_table(options);
    check_frames(options);
    check_grid_table(options);
    if (!is_at_pixels(options.texels) && !is_at_grid(options.texels)) {
        const CompareSettings settings = compare_settings(options);
        for (const EngineSettings& candidate : settings.candidates)
            check_kernel(candidate.engine, settings.kernel);
    }
    FilePlan files;
    for (const auto* inputs : {&options.inputs, &options.parts.occluders})
        for (const std::string& input : *inputs)
            files.reads(input);
    for (const GridFile& grid : grid_files_of(options.pixels.grids))
        files.reads(grid.path.string());
    for (const fs::path& file : own_names(options))
        files.writes(file, file.filename().string());
    files.writes_report(options.json, "--json");
    files.writes_report(options.csv, "--csv");
}

/// What is right, and how often everything runs.
void add_run_options(CLI::App& command, CompareOptions& options)
{
    command
        .add_option(
            "--reference-rays", options.reference_rays,
            "Rays per place of the reference (a point of the surface, a pixel, a point about an "
            "object), an even number")
        ->check(whole_from(2, kMostRays))
        ->type_name("N")
        ->default_str(std::to_string(kSurfaceRays) + "; at pixels 256, with --frames " +
                      std::to_string(kMovingRays));
    command
        .add_option("--sample", options.sample,
                    "Take errors at N points of the surface, or about an object (times are of all "
                    "receivers)")
        ->check(whole_from(1, kMostSample))
        ->type_name("N")
        ->default_str(std::to_string(kSurfacePoints) + "; with --frames " +
                      std::to_string(kMovingSample) + ", at grid " +
                      std::to_string(GridCompareSettings().places));
    command.add_option("--rounds", options.rounds, "Runs of every engine, in turns; medians count")
        ->check(whole_from(1, 99))
        ->type_name("N")
        ->default_str(std::to_string(kRounds));
    command.add_flag("--no-cache", options.no_cache,
                     "Trace the reference even if the same one was kept from before");
    command.add_flag("--avx2", options.avx2,
                     "Limit masks and rays to AVX2 instructions, which most machines have");
}

}  // namespace

std::vector<std::string> qualities_of(const CompareOptions& options)
{
    return options.qualities.value_or(std::vector<std::string>{"draft", "good", "best"});
}

void add_compare_command(CLI::App& app, Work& work)
{
    const auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand(
        "compare",
        "One scene by our engines and by ray tracing, the same job: how long, how wrong");
    command
        ->add_option("IN", options->inputs, std::string(kMeshOrCloud) + "; several with --frontier")
        ->required()
        ->type_name("");
    command
        ->add_option("-o,--output", options->output,
                     "Folder for difference.ply, the scene with the error as colour (of values at "
                     "vertices, without --frontier), and report.html; without it no file is "
                     "written")
        ->type_name("DIR");
    add_read_options(*command, options->reading);
    add_frame_options(*command, options->frames,
                      "glTF: frames A to B of an animation, frame N at N / fps seconds: each "
                      "engine goes through them with bodies that move, beside rays");
    add_overwrite_option(*command, options->overwrite);
    command->add_flag(
        "--frontier", options->frontier,
        "Every engine's whole curve of speed against error, for any number of files, "
        "with the ratio to Embree at errors of 0.010 and 0.005 beyond the floor, and a summary");
    command
        ->add_option("--engines", options->engines,
                     "Engines to compare with rays: masks, disks; at pixels also rays, and what "
                     "knows the picture alone: ssao-disc, ssao-sphere, vo, hbao, gtao, bitmask")
        ->delimiter(',')
        ->allow_extra_args(false)  // the word behind the list may be IN
        ->check(one_of(pixel_engine_names()))
        ->type_name("E,...")
        ->default_str("masks,disks; at pixels all but disks and rays");
    command
        ->add_option("--devices", options->devices,
                     "Where the engines run: cpu, gpu or both, side by side")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(one_of({"cpu", "gpu"}))
        ->type_name("D,...")
        ->capture_default_str();
    command
        ->add_option("--qualities", options->qualities,
                     "Settings of each engine: draft, good, best or numbers")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("Q,...")
        ->default_str("draft,good,best");
    add_measure_options(*command, options->measure);
    add_up_option(*command, options->up, "What is measured");
    add_surface_options(*command, options->surface);
    add_subdivide_option(*command, options->subdivide);
    add_layout_options(*command, options->texels, kShownMaps);
    add_grid_bake_options(*command, options->grid, false);
    add_part_options(*command, options->parts);
    add_pixel_table_options(*command, options->pixels);
    add_run_options(*command, *options);
    command->add_option("--json", options->json, "Write all figures; - = standard output")
        ->type_name("FILE");
    command->add_option("--csv", options->csv, "Write the rows as CSV; - = standard output")
        ->type_name("FILE");
    add_thread_option(*command, options->threads);
    add_preset_option(*command);
    command->callback([options, command, &work] {
        apply_preset(*command, moot_of(*options));
        check(*options);
        work = [options] { return run(*options); };
    });
}

}  // namespace surfelao
