#include "cli/commands.h"

#include "bake/build_facts.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string>

namespace surfelao {
namespace {

constexpr const char* kAbout =
    "Ambient occlusion and bent normals for meshes: fast, without noise, with a known error.\n"
    "Occlusion is the cosine-weighted share of the hemisphere over a vertex that other surfaces\n"
    "close: 0 = open, 1 = closed. `surfelao help COMMAND` lists a command's options.";

constexpr const char* kExitCodes =
    "Exit code: 0 done, 1 failed, 2 wrong usage, 128 + signal when interrupted.";

/// "a|b:{a,b}" as "a|b": what an option takes is said once.
void say_choices_once(CLI::Option& option)
{
    const std::string said = option.get_type_name();
    const std::size_t colon = said.find(":{");
    if (colon == std::string::npos || said.back() != '}')
        return;
    std::string words = said.substr(colon + 2, said.size() - colon - 3);
    std::ranges::replace(words, ',', '|');
    if (words == said.substr(0, colon))
        option.get_validator()->description("");
}

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
    for (CLI::App* command : app.get_subcommands({}))
        for (CLI::Option* option : command->get_options()) {
            say_choices_once(*option);
            option->disable_flag_override();
        }
}

}  // namespace surfelao
