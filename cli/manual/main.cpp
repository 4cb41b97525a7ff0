#include "cli/commands.h"
#include "cli/manual/completion.h"
#include "cli/manual/man_page.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace surfelao {
namespace {

void write(const std::filesystem::path& file, const std::string& text)
{
    std::filesystem::create_directories(file.parent_path());
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    if (!stream.flush())
        throw std::runtime_error(file.string() + ": cannot be written");
}

/// Below `folder` as they are to lie below share/.
void write_manuals(const std::filesystem::path& folder, const std::string& version,
                   const std::string& date)
{
    CLI::App app;
    Work unused;
    add_commands(app, unused);
    const std::vector<CommandFacts> commands = facts_of(app);
    for (std::size_t i = 0; i < commands.size(); ++i)
        write(folder / "man/man1" / (page_name(commands[i]) + ".1"),
              man_page(commands, i, version, date));
    write(folder / "bash-completion/completions/surfelao", bash_completion(commands));
    write(folder / "zsh/vendor-completions/_surfelao", zsh_completion(commands));
    write(folder / "fish/vendor_completions.d/surfelao.fish", fish_completion(commands));
}

}  // namespace
}  // namespace surfelao

/// Writes the manual pages and the completions of the shells. Run by the build.
int main(int argument_count, char** arguments)
{
    if (argument_count != 4) {
        std::fputs("usage: surfelao_manual FOLDER VERSION DATE\n", stderr);
        return 2;
    }
    try {
        surfelao::write_manuals(arguments[1], arguments[2], arguments[3]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "surfelao_manual: %s\n", error.what());
        return 1;
    }
    return 0;
}
