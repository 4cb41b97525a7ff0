#include "cli/commands.h"
#include "cli/usage_sentence.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>

namespace surfelao {

void add_help_command(CLI::App& app, Work& work)
{
    const auto name = std::make_shared<std::string>();
    CLI::App* const help = app.add_subcommand(
        "help", "The commands, or what a command does and its options: as COMMAND --help");
    help->add_option("COMMAND", *name, "Which; without one, the commands")->type_name("");
    help->callback([&app, &work, name] {
        const CLI::App* command = name->empty() ? &app : nullptr;
        for (const CLI::App* known : app.get_subcommands({}))
            if (known->get_name() == *name)
                command = known;
        if (command == nullptr)
            throw UsageError(no_command_sentence(app, *name));
        work = [&app, command] {
            const std::string line =
                command == &app ? app.get_name() : app.get_name() + ' ' + command->get_name();
            std::cout << app.get_formatter()->make_help(command, line, CLI::AppFormatMode::Normal);
            return kDone;
        };
    });
}

}  // namespace surfelao
