#include "bake/compare.h"
#include "bake/threads.h"
#include "cli/commands.h"
#include "cli/engine_options.h"
#include "cli/output.h"
#include "cli/progress_bar.h"
#include "reference/rays.h"
#include "surfels/atomic_file.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <memory>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
    std::vector<std::string> inputs;
    std::string output = ".";
    std::vector<std::string> engines;
    std::vector<std::string> qualities;
    MeasureOptions measure;
    std::uint32_t reference_rays = 4096;
    std::uint64_t sample = 0;
    int rounds = 3;
    bool no_cache = false;
    std::optional<std::string> json, csv;
    std::optional<int> threads;
};

CompareSettings settings_for(const CompareOptions& options, const std::string& input)
{
    CompareSettings settings;
    settings.input = input;
    settings.max_distance = distance_limit_of(options.measure);
    settings.kernel = kernel_of(options.measure);
    settings.reference_rays = options.reference_rays;
    settings.sample = options.sample;
    settings.rounds = options.rounds;
    settings.use_cache = !options.no_cache;
    for (const std::string& engine : options.engines) {
        for (const std::string& quality : options.qualities) {
            EngineSettings& candidate = settings.candidates.emplace_back();
            candidate.engine = engine_of(engine);
            candidate.quality = quality_of(quality, candidate.engine);
            check_kernel(candidate.engine, settings.kernel);
        }
    }
    return settings;
}

int run(const CompareOptions& options, const CompareSettings& settings)
{
    check_report(options.json);
    check_report(options.csv);
    const fs::path difference = fs::path(options.output) / "difference.ply";
    check_writable(difference);
    std::optional<ThreadLimit> limit;
    if (options.threads)
        limit.emplace(*options.threads);

    const Comparison comparison = [&] {
        ProgressBar bar;
        return compare(
            settings, [&](std::string_view stage, double done) { return bar.update(stage, done); });
    }();
    if (options.json != "-" && options.csv != "-")
        std::cout << table_of(comparison);
    if (options.json)
        write_report(*options.json, json_of(comparison));
    if (options.csv)
        write_report(*options.csv, csv_of(comparison));
    write_difference(difference, comparison, comparison.rows.front());
    return kDone;
}

}  // namespace

void add_compare_command(CLI::App& app, Work& work)
{
    const auto options = std::make_shared<CompareOptions>();
    options->engines = {"disks"};
    options->qualities = {"draft", "good", "best"};
    CLI::App* command = app.add_subcommand(
        "compare", "One scene by our engines and by ray tracing: how long, how wrong");
    command->add_option("IN", options->inputs, "Mesh file: .obj .ply .off .stl .gltf .glb")
        ->required()
        ->type_name("");
    command
        ->add_option("-o,--output", options->output,
                     "Folder for difference.ply, the scene with the error as colour")
        ->type_name("DIR")
        ->capture_default_str();
    command->add_option("--engines", options->engines, "Engines to compare with rays")
        ->delimiter(',')
        ->check(CLI::IsMember({"disks"}))
        ->type_name("E,...")
        ->capture_default_str();
    command
        ->add_option("--qualities", options->qualities,
                     "Settings of each engine: draft, good, best or numbers")
        ->delimiter(',')
        ->type_name("Q,...")
        ->capture_default_str();
    add_measure_options(*command, options->measure);
    command
        ->add_option("--reference-rays", options->reference_rays,
                     "Rays per vertex of the reference, an even number")
        ->check(CLI::Range(2u, kMostRays))
        ->type_name("N")
        ->capture_default_str();
    command
        ->add_option("--sample", options->sample,
                     "Take errors at N vertices only (times are of all)")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40))
        ->type_name("N");
    command
        ->add_option("--rounds", options->rounds, "Runs of every engine, in turns; medians count")
        ->check(CLI::Range(1, 99))
        ->type_name("N")
        ->capture_default_str();
    command->add_flag("--no-cache", options->no_cache,
                      "Trace the reference even if the same one was kept from before");
    command->add_option("--json", options->json, "Write all figures; - = standard output")
        ->type_name("FILE");
    command->add_option("--csv", options->csv, "Write the rows as CSV; - = standard output")
        ->type_name("FILE");
    add_thread_option(*command, options->threads);
    command->callback([options, &work] {
        if (options->inputs.size() > 1)
            throw UsageError("compare takes one file.");
        if (options->reference_rays % 2 != 0)
            throw UsageError("--reference-rays must be even: two halves tell the noise.");
        if (options->json == "-" && options->csv == "-")
            throw UsageError("--json and --csv cannot both go to standard output.");
        work = [options, settings = settings_for(*options, options->inputs.front())] {
            return run(*options, settings);
        };
    });
}

}  // namespace surfelao
