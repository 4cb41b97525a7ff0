/// texel_options.h: the options of maps.
#pragma once

#include "bake/bake.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace surfelao {

/// What was asked for: empty where an option was not given.
struct TexelOptions {
    std::optional<std::string> at;
    std::optional<std::uint32_t> size;
    std::optional<double> texels_per_unit;
    std::optional<std::string> uv;
    bool udim = false;
    std::optional<std::string> charts;
    std::optional<std::uint32_t> padding;
    std::optional<int> depth;
    std::optional<std::string> bent;
    std::optional<std::string> green;
    std::vector<std::string> high;
    std::optional<std::string> cage;
};

/// Where values are asked, and where the surface lies in a map; shown in the help under `group`.
void add_layout_options(CLI::App& command, TexelOptions& options, const std::string& group);

/// All of them: what a map holds and how it stands in a file too.
void add_texel_options(CLI::App& command, TexelOptions& options);

/// For commands that show a map.
inline constexpr const char* kShownMaps = "Maps (--at texels)";
void add_atlas_option(CLI::App& command, bool& atlas);

/// Nothing where values at vertices are asked: by --at, or by an output that is no picture. Throws
/// UsageError for what contradicts itself.
[[nodiscard]] std::optional<TexelSettings> texel_settings_of(const TexelOptions& options,
                                                             const std::filesystem::path& output);

/// The same for a command that shows the map: nothing unless --at says texels.
[[nodiscard]] std::optional<TexelSettings> shown_texels_of(const TexelOptions& options);

}  // namespace surfelao
