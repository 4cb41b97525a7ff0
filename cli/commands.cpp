#include "cli/commands.h"

#include "bake/build_facts.h"

#include <CLI/CLI.hpp>

namespace surfelao {
namespace {

constexpr const char* kAbout =
    "Ambient occlusion and bent normals for meshes: fast, without noise, with a known error.\n"
    "Occlusion is the cosine-weighted share of the hemisphere over a vertex that other surfaces\n"
    "close: 0 = open, 1 = closed. `surfelao help COMMAND` lists a command's options.";

constexpr const char* kExitCodes =
    "Exit code: 0 done, 1 failed, 2 wrong usage, 128 + signal when interrupted.";

}  // namespace

void add_commands(CLI::App& app, Work& work)
{
    app.name("surfelao");
    app.description(kAbout);
    app.footer(kExitCodes);
    app.set_version_flag("--version", version_text, "What this program is made of, and exit");
    app.require_subcommand(1);
    for (const auto& add :
         {add_bake_command, add_compare_command, add_info_command, add_merge_command,
          add_render_command, add_view_command, add_help_command})
        add(app, work);
}

}  // namespace surfelao
