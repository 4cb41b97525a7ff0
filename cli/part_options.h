/// part_options.h: the options that say who occludes and who is baked.
#pragma once

#include "bake/world.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace surfelao {

struct PartOptions {
    std::vector<std::string> exclude;
    std::vector<std::string> receivers;
    std::vector<std::string> occluders;
    std::string transparent = "solid";
};

void add_part_options(CLI::App& command, PartOptions& options);

[[nodiscard]] PartChoice part_choice_of(const PartOptions& options);

}  // namespace surfelao
