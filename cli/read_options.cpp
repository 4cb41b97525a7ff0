#include "cli/read_options.h"

#include "cli/interrupt.h"
#include "cli/value_checks.h"
#include "surfels/errors.h"

#include <CLI/CLI.hpp>

namespace surfelao {

void add_read_options(CLI::App& command, ReadOptions& options)
{
    options.progress = [](double) { return caught_signal() == 0; };
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
    command
        .add_option_function<double>(
            "--time",
            [&options](double seconds) {
                options.moment = Moment{seconds, options.moment.value_or(Moment{}).animation};
            },
            "glTF: the pose at this second of an animation, skins and morph targets too; "
            "without it the default pose")
        ->check(number_from(0.0, 1e9))
        ->type_name("S");
    command
        .add_option_function<std::string>(
            "--animation",
            [&options](const std::string& name) {
                options.moment = Moment{options.moment.value_or(Moment{}).seconds, name};
            },
            "Which animation, by its name or its number from 0; alone its pose at 0 seconds")
        ->type_name("NAME")
        ->default_str("0");
}

}  // namespace surfelao
