#include "bake/bake.h"
#include "cli/bake_text.h"
#include "cli/commands.h"
#include "cli/engine_options.h"
#include "cli/output.h"
#include "cli/progress_bar.h"
#include "cli/texel_options.h"
#include "engines/threads.h"
#include "files/file_type.h"
#include "files/scene_io.h"
#include "surfels/progress.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <memory>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

struct BakeOptions {
    std::vector<std::string> inputs;
    std::string output;
    EngineOptions engine;
    MeasureOptions measure;
    SurfaceOptions surface;
    ColorOptions colors;
    TexelOptions texels;
    std::optional<double> subdivide;
    std::uint32_t check = kCheckPoints;
    std::optional<double> error;
    bool resume = false;
    bool overwrite = false;
    std::optional<std::string> json;
    std::optional<int> threads;
};

/// One file of the batch.
struct Job {
    fs::path input, output;
};

/// Whether -o names a folder: then the names of the files in it are ours, not the user's.
bool is_folder(const BakeOptions& options)
{
    std::error_code error;
    return options.inputs.size() > 1 || options.output.ends_with('/') ||
           fs::is_directory(options.output, error);
}

/// Where every result goes. Two results under one name, or one in the place of an input, are
/// refused before anything is overwritten.
std::vector<Job> jobs_of(const BakeOptions& options)
{
    std::error_code error;
    if (options.inputs.size() > 1 && fs::is_regular_file(options.output, error))
        throw UsageError(options.output + " is no folder, but several files are to be written.");
    FilePlan files;
    for (const std::string& input : options.inputs)
        files.reads(input);
    for (const std::string& high : options.texels.high)
        files.reads(high);
    const bool into_folder = is_folder(options);
    std::vector<Job> jobs;
    for (const std::string& input : options.inputs) {
        jobs.push_back({input, into_folder ? output_in_folder(input, options.output)
                                           : fs::path(options.output)});
        files.writes(jobs.back().output, input);
        if (texel_settings_of(options.texels, jobs.back().output)) {
            if (options.subdivide)
                throw UsageError("--subdivide is for values at vertices: it goes with no map.");
            for (const auto& beside :
                 {map_file_of(jobs.back().output), map_materials_of(jobs.back().output)}) {
                if (beside)
                    files.writes(*beside, input);
            }
        }
        if (options.texels.bent.value_or("none") != "none")
            files.writes(bent_path(jobs.back().output), input);
    }
    files.writes_report(options.json, "--json");
    return jobs;
}

BakeSettings settings_for(const BakeOptions& options, const Job& job)
{
    BakeSettings settings;
    settings.input = job.input;
    settings.output = job.output;
    settings.engine = settings_of(options.engine);
    settings.max_distance = distance_limit_of(options.measure);
    settings.kernel = kernel_of(options.measure);
    settings.target = target_settings_of(options.surface);
    settings.check = options.check;
    settings.error = options.error;
    settings.texels = texel_settings_of(options.texels, job.output);
    settings.subdivide = options.subdivide;
    settings.colors = colors_of(options.colors);
    settings.encoding = encoding_of(options.colors);
    return settings;
}

/// One job; `label` stands in front of its progress. False when it failed: the others can still be
/// done.
bool run_job(const BakeSettings& settings, bool ask_before_replacing, const std::string& label,
             BatchEntry& entry)
{
    try {
        if (ask_before_replacing)
            refuse_foreign(settings.output, "bake");
        ProgressBar bar(label);
        entry.report = bake(
            settings, [&](std::string_view stage, double done) { return bar.update(stage, done); });
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        std::cerr << "surfelao: " << error.what() << '\n';
        entry.error = error.what();
    }
    return entry.report.has_value();
}

int run(const BakeOptions& options, const std::vector<Job>& jobs)
{
    check_report(options.json);
    std::optional<OutputFolder> folder;
    if (is_folder(options))
        folder.emplace(options.output);
    std::optional<ThreadLimit> limit;
    if (options.threads)
        limit.emplace(*options.threads);
    const bool batch = jobs.size() > 1;
    const bool quiet = options.json == "-";
    const bool ask = is_folder(options) && !options.overwrite;
    std::size_t failed = 0;
    std::vector<BatchEntry> entries;
    std::vector<fs::path> written;
    for (const Job& job : jobs) {
        BatchEntry& entry = entries.emplace_back();
        entry.input = job.input;
        entry.output = job.output;
        const BakeSettings settings = settings_for(options, job);
        if (options.resume && is_finished(settings)) {
            if (!quiet)
                std::cout << job.input.string() << ": finished before, skipped\n";
            continue;
        }
        const std::string label = std::to_string(entries.size()) + "/" +
                                  std::to_string(jobs.size()) + " " +
                                  job.input.filename().string() + " ";
        if (!run_job(settings, ask, batch ? label : "", entry)) {
            ++failed;
            continue;
        }
        if (!entry.report->texels || type_of(job.output) != FileType::unknown)
            written.push_back(job.output);
        if (entry.report->texels)
            written.insert(written.end(), entry.report->texels->written.begin(),
                           entry.report->texels->written.end());
        if (!quiet)
            print_report(*entry.report);
    }
    if (options.json)
        write_report(*options.json, json_of(entries));
    if (options.json && !quiet)
        written.emplace_back(*options.json);
    print_written(written, quiet);
    if (failed > 0 && batch)
        std::cerr << "surfelao: " << failed << " of " << jobs.size() << " files failed\n";
    return failed > 0 ? kFailed : kDone;
}

/// Throws UsageError for what contradicts itself.
void check_options(const BakeOptions& options)
{
    const EngineSettings engine = settings_of(options.engine);
    static_cast<void>(distance_limit_of(options.measure));
    static_cast<void>(target_settings_of(options.surface));
    check_kernel(engine.engine, kernel_of(options.measure));
    if (options.error && options.check == 0)
        throw UsageError("--error needs the points of --check.");
    if (options.error && kernel_of(options.measure) != Kernel::cosine)
        throw UsageError("--error tries masks, which know --kernel cosine only.");
    if (options.resume && options.texels.udim)
        throw UsageError("--resume knows no tiles: leave it or --udim out.");
}

}  // namespace

void add_bake_command(CLI::App& app, Work& work)
{
    const auto options = std::make_shared<BakeOptions>();
    CLI::App* command = app.add_subcommand("bake",
                                           "Occlusion and bent normals at every vertex, or as a "
                                           "map: a mesh file in, the same mesh or a "
                                           "picture out");
    command->add_option("IN", options->inputs, "Mesh files: .obj .ply .off .stl .gltf .glb")
        ->required()
        ->type_name("");
    command
        ->add_option(
            "-o,--output", options->output,
            "Mesh file (.ply .obj .off, .gltf/.glb from glTF), a map over the file's texture "
            "coordinates (.png .tif .exr), or a folder (made where it is "
            "missing, for several files and behind a /): there every "
            "result has its input's name, .ply for .stl, and only files that bake made are "
            "replaced")
        ->required()
        ->type_name("OUT|DIR");
    add_engine_options(*command, options->engine);
    add_measure_options(*command, options->measure);
    add_surface_options(*command, options->surface);
    add_subdivide_option(*command, options->subdivide);
    add_color_options(*command, options->colors);
    add_texel_options(*command, options->texels);
    command
        ->add_option("--check", options->check,
                     "Points of the surface at which the result is measured against rays; 0: none")
        ->check(CLI::Range(0u, kMostCheckPoints))
        ->type_name("N")
        ->default_str(std::to_string(kCheckPoints))
        ->group("Error");
    CLI::Option* error =
        command
            ->add_option(
                "--error", options->error,
                "Take the cheapest setting of masks or rays whose error, as seen, is below "
                "this with its whole interval (0.01); instead of --engine and --quality")
            ->check(CLI::Range(1e-6, 1.0))
            ->type_name("E")
            ->group("Error");
    for (const char* other : {"--engine", "--quality", "--rays", "--passes", "--strength"})
        error->excludes(command->get_option(other));
    command->add_flag(
        "--resume", options->resume,
        "Skip files whose result is not older than they are and says that it was "
        "made with these settings (a comment in .ply .obj .off, asset.extras in glTF)");
    add_overwrite_option(*command, options->overwrite);
    command
        ->add_option("--json", options->json,
                     "Write what was done and how long it took; - = "
                     "standard output; a list for several files")
        ->type_name("FILE");
    add_thread_option(*command, options->threads);
    command->callback([options, &work] {
        check_options(*options);
        work = [options, jobs = jobs_of(*options)] { return run(*options, jobs); };
    });
}

}  // namespace surfelao
