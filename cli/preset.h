/// preset.h: values for several options at once, for a kind of scene.
#pragma once

#include <span>
#include <string>

namespace CLI {
class App;
}

namespace surfelao {

/// --preset; its help names what of each preset this command has. After the options that presets
/// are of.
void add_preset_option(CLI::App& command);

/// Gives the options of the preset that was asked for its values, where they were not given
/// themselves: whoever looks at options afterwards sees no difference. moot: options that are of no
/// use beside what else was given, and stay without one. Nothing without --preset.
void apply_preset(CLI::App& command, std::span<const std::string> moot = {});

}  // namespace surfelao
