#include "bake/bake.h"
#include "bake/part_file.h"
#include "cli/bake_command.h"
#include "cli/bake_text.h"
#include "cli/commands.h"
#include "cli/engine_options.h"
#include "cli/output.h"
#include "cli/progress_bar.h"
#include "engines/threads.h"
#include "surfels/errors.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <memory>

namespace surfelao {
namespace {

namespace fs = std::filesystem;

struct MergeOptions {
    std::vector<std::string> parts;
    std::optional<std::string> output;
    std::optional<std::string> json;
    std::optional<int> threads;
};

int run(const MergeOptions& options)
{
    OutputFolders folders;
    folders.make_for_report(options.json);
    std::optional<ThreadLimit> limit;
    if (options.threads)
        limit.emplace(*options.threads);
    const std::vector<fs::path> paths(options.parts.begin(), options.parts.end());
    std::vector<PartFile> parts;
    for (const fs::path& path : paths)
        parts.push_back(read_part(path));
    auto merged = std::make_shared<const MergedAnswers>(merge_parts(paths, parts));

    const PartFile& first = parts.front();
    const fs::path output = options.output ? fs::path(*options.output) : first.output;
    FilePlan files;
    files.reads(first.input);
    for (const fs::path& path : paths)
        files.reads(path);
    files.writes(output, "the result");
    files.writes_report(options.json, "--json");
    folders.make_for(output);
    BakeSettings settings = bake_settings_of(first.input, output, first.arguments);
    if (mark_of(settings) != first.mark)
        throw InputError(paths[0].string() +
                         ": another version of surfelao has made it: " + first.mark);
    settings.merged = std::move(merged);
    BatchEntry entry{first.input, output, {}, {}};
    parts.clear();
    {
        ProgressBar bar;
        entry.report = bake(
            settings, [&](std::string_view stage, double done) { return bar.update(stage, done); });
    }
    const bool quiet = options.json == "-";
    if (!quiet)
        print_report(*entry.report);
    std::vector<fs::path> written = {output};
    if (options.json)
        write_report(*options.json, json_of({&entry, 1}));
    if (options.json && !quiet)
        written.emplace_back(*options.json);
    print_written(written, quiet);
    return kDone;
}

}  // namespace

void add_merge_command(CLI::App& app, Work& work)
{
    const auto options = std::make_shared<MergeOptions>();
    CLI::App* command = app.add_subcommand(
        "merge", "The shares that several machines have baked (bake --part) as one result");
    command->add_option("PART", options->parts, "All parts of one bake, in any order")
        ->required()
        ->type_name("");
    command
        ->add_option("-o,--output", options->output,
                     "Mesh file (default: what the parts were baked for)")
        ->type_name("OUT");
    command
        ->add_option("--json", options->json,
                     "Write what was done and how long it took; - = standard output")
        ->type_name("FILE");
    add_thread_option(*command, options->threads);
    command->callback([options, &work] { work = [options] { return run(*options); }; });
}

}  // namespace surfelao
