#include "cli/read_options.h"

#include "surfels/errors.h"

#include <CLI/CLI.hpp>

namespace surfelao {

void add_read_options(CLI::App& command, ReadOptions& options)
{
    command
        .add_option(
            "--columns", options.columns,
            "What the columns of a .xyz .pts .txt .asc are, as in \"x y z intensity r g b\" "
            "(also nx ny nz; - and other words: kept, not used); without it they are found")
        ->check([](const std::string& columns) {
            try {
                check_columns(columns);
            } catch (const SettingsError& error) {
                return std::string(error.what());
            }
            return std::string();
        })
        ->type_name("NAMES");
}

}  // namespace surfelao
