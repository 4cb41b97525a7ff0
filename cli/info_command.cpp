#include "bake/info.h"
#include "cli/commands.h"
#include "cli/output.h"
#include "cli/progress_bar.h"
#include "cli/read_options.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <memory>

namespace surfelao {
namespace {

struct InfoOptions {
    std::string input;
    ReadOptions reading;
    std::optional<std::string> json;
};

int run(const InfoOptions& options)
{
    OutputFolders folders;
    folders.make_for_report(options.json);
    const Info info = [&options] {
        ProgressBar bar;
        return inspect(
            options.input, [&bar](double done) { return bar.update("looking", done); },
            options.reading);
    }();
    if (options.json != "-")
        std::cout << text_of(info);
    if (options.json)
        write_report(*options.json, json_of(info));
    if (options.json && options.json != "-") {
        const std::filesystem::path written[] = {*options.json};
        print_written(written, false);
    }
    return kDone;
}

}  // namespace

void add_info_command(CLI::App& app, Work& work)
{
    const auto options = std::make_shared<InfoOptions>();
    CLI::App* command =
        app.add_subcommand("info",
                           "What a mesh file holds, what is odd about it, and where a bake of it "
                           "will disappoint");
    command->add_option("IN", options->input, kMeshOrCloud)->required()->type_name("");
    add_read_options(*command, options->reading);
    command->add_option("--json", options->json, "Write it as JSON; - = standard output")
        ->type_name("FILE");
    command->callback([options, &work] {
        FilePlan files;
        files.reads(options->input);
        files.writes_report(options->json, "--json");
        work = [options] { return run(*options); };
    });
}

}  // namespace surfelao
