#include "cli/preset.h"

#include "bake/subdivide.h"
#include "cli/value_checks.h"
#include "surfels/number_text.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace surfelao {
namespace {

struct PresetValue {
    const char* option;
    std::string value;
};

struct Preset {
    const char* name;
    std::vector<PresetValue> values;
};

/// Why these values:
///   scan: normals of scans are often those of the raw points; colours are the scan's own, which
///     alone would hide what was baked.
///   cad: fillets of twelve facets a turn and finer are round, what is sharper is an edge; walls of
///     few triangles get the vertices that shades need.
///   game: lights do the large shadows, so only what is near counts; engines multiply by grey.
///   interior: walls close the hemisphere everywhere, so what is far does not count. The limit is
///     that of notes (bake/notes.h).
const std::vector<Preset>& presets()
{
    static const std::vector<Preset> table = {
        {"scan", {{"--normals", "smooth"}, {"--colors", "shaded"}}},
        {"cad",
         {{"--normals", "smooth"},
          {"--crease", "30"},
          {"--subdivide", exact(kSubdivideTolerance)}}},
        {"game", {{"--max-distance", "20%"}, {"--falloff", "smooth"}, {"--colors", "grey"}}},
        {"interior", {{"--max-distance", "10%"}, {"--falloff", "smooth"}}},
    };
    return table;
}

constexpr const char* kPreset = "--preset";

/// "cad: --normals smooth --crease 30"
std::string preset_text(const Preset& preset, const CLI::App& command)
{
    std::string text = std::string(preset.name) + ':';
    for (const PresetValue& value : preset.values)
        if (command.get_option_no_throw(value.option) != nullptr)
            text += std::string(" ") + value.option + ' ' + value.value;
    return text;
}

}  // namespace

void add_preset_option(CLI::App& command)
{
    std::vector<std::string> names;
    std::string help = "Values for options that are not given. ";
    for (const Preset& preset : presets()) {
        help += (names.empty() ? "" : "; ") + preset_text(preset, command);
        names.emplace_back(preset.name);
    }
    const std::string& described = help;  // CLI11 would store into what is not const
    command.add_option(kPreset, described)
        ->check(one_of(names))
        ->type_name(CLI::detail::join(names, "|"))
        ->group("What is measured");
}

void apply_preset(CLI::App& command, std::span<const std::string> moot)
{
    const CLI::Option* const asked = command.get_option(kPreset);
    if (asked->count() == 0)
        return;
    for (const Preset& preset : presets()) {
        if (asked->results().front() != preset.name)
            continue;
        for (const PresetValue& value : preset.values) {
            CLI::Option* const option = command.get_option_no_throw(value.option);
            if (option == nullptr || option->count() > 0 ||
                std::ranges::find(moot, value.option) != moot.end())
                continue;
            option->add_result(value.value);
            option->run_callback();
        }
    }
}

}  // namespace surfelao
