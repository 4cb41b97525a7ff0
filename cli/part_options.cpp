#include "cli/part_options.h"

#include "cli/value_checks.h"

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
    command
        .add_option("--transparent", options.transparent,
                    "What light goes through (alphaMode BLEND, transmission, d below 1 in .mtl) "
                    "occludes as solid, not at all, or where its alpha is at least half (leaves on "
                    "BLEND cards); holes by alpha (MASK, map_d) never occlude")
        ->check(one_of({"solid", "open", "cut"}))
        ->type_name("solid|open|cut")
        ->capture_default_str()
        ->group(kGroup);
}

PartChoice part_choice_of(const PartOptions& options)
{
    PartChoice choice;
    choice.exclude = options.exclude;
    choice.receivers = options.receivers;
    choice.occluders.assign(options.occluders.begin(), options.occluders.end());
    for (const ClearSurfaces clear : {ClearSurfaces::open, ClearSurfaces::cut})
        if (options.transparent == name_of(clear))
            choice.clear = clear;
    return choice;
}

}  // namespace surfelao
