#include "cli/commands.h"
#include "cli/interrupt.h"
#include "surfels/progress.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <new>

namespace surfelao {
namespace {

constexpr const char* kAbout =
    "Ambient occlusion and bent normals for meshes: fast, without noise, with a known error.\n"
    "Occlusion is the cosine-weighted share of the hemisphere over a vertex that other surfaces\n"
    "close: 0 = open, 1 = closed. `surfelao COMMAND --help` lists a command's options.";

constexpr const char* kExitCodes =
    "Exit code: 0 done, 1 failed, 2 wrong usage, 128 + signal when interrupted.";

int run(int argument_count, char** arguments)
{
    CLI::App app(kAbout, "surfelao");
    app.footer(kExitCodes);
    app.set_version_flag("--version", SURFELAO_VERSION);
    app.require_subcommand(1);
    Work work;
    for (const auto& add : {add_bake_command, add_compare_command, add_info_command,
                            add_merge_command, add_render_command, add_view_command})
        add(app, work);

    try {
        app.parse(argument_count, arguments);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kDone : kWrongUsage;  // 0: --help, --version
    }
    interrupt_politely();
    const int code = work();
    std::cout.flush();
    if (!std::cout)
        throw std::runtime_error("the results could not be written to standard output");
    return code;
}

}  // namespace
}  // namespace surfelao

/// Exceptions end here and nowhere else.
int main(int argument_count, char** arguments)
{
    using namespace surfelao;
    const auto say = [](const char* what) { std::cerr << "surfelao: " << what << '\n'; };
    try {
        return run(argument_count, arguments);
    } catch (const UsageError& error) {
        say(error.what());
        return kWrongUsage;
    } catch (const Cancelled&) {
        say("interrupted; the unfinished result was not written");
        return kKilledBy + caught_signal();
    } catch (const std::bad_alloc&) {
        say("not enough memory");
    } catch (const std::exception& error) {
        say(error.what());
    }
    return kFailed;
}
