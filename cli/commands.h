/// commands.h: the commands of the program, one file each. A new command is a file and two lines:
/// one here, one in commands.cpp.
#pragma once

#include <functional>
#include <stdexcept>

namespace CLI {
class App;
}

namespace surfelao {

/// What the command that was given does once everything is parsed: returns the exit code.
using Work = std::function<int()>;

/// The whole program: its own description, and all commands. The one table of options: what prints
/// help, and what writes manuals, reads it from `app`.
void add_commands(CLI::App& app, Work& work);

/// Each adds its subcommand to `app` and, when that one is given, refuses contradictions by
/// UsageError and sets `work`. Nothing is worked on while parsing.
void add_bake_command(CLI::App& app, Work& work);
void add_compare_command(CLI::App& app, Work& work);
void add_help_command(CLI::App& app, Work& work);
void add_info_command(CLI::App& app, Work& work);
void add_merge_command(CLI::App& app, Work& work);
void add_render_command(CLI::App& app, Work& work);
void add_view_command(CLI::App& app, Work& work);

/// Options that do not go together, or a value out of range. what() is one complete sentence.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The program's answers to its caller.
inline constexpr int kDone = 0, kFailed = 1, kWrongUsage = 2, kKilledBy = 128;  ///< + signal

}  // namespace surfelao
