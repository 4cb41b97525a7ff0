#include "cli/part_options.h"

#include <CLI/CLI.hpp>

namespace surfelao {

void add_part_options(CLI::App& command, PartOptions& options)
{
    constexpr const char* kGroup = "Parts";
    command
        .add_option("--exclude", options.exclude,
                    "Parts that neither occlude nor are baked, as a sky dome or collision hulls: "
                    "names of nodes (with all below them), meshes, objects, groups or materials, "
                    "with * ? [...]; case counts; surfelao info lists them")
        ->type_name("NAME...")
        ->group(kGroup);
    command
        .add_option("--receivers", options.receivers,
                    "The only parts that are baked, by such names: the rest of the file occludes "
                    "them and stays as it is. What is excluded too is baked without occluding")
        ->type_name("NAME...")
        ->group(kGroup);
    command
        .add_option("--occluders", options.occluders,
                    "Other mesh files in the same coordinates that occlude, but are not baked, as "
                    "a terrain; any size")
        ->type_name("FILE...")
        ->group(kGroup);
}

PartChoice part_choice_of(const PartOptions& options)
{
    PartChoice choice;
    choice.exclude = options.exclude;
    choice.receivers = options.receivers;
    choice.occluders.assign(options.occluders.begin(), options.occluders.end());
    return choice;
}

}  // namespace surfelao
