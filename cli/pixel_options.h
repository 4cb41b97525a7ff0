/// pixel_options.h: the options of values at pixels, and who answers them, for `render`, `compare`
/// and `view`.
#pragma once

#include "cli/engine_options.h"
#include "cli/texel_options.h"
#include "pixels/pixel_engine.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace surfelao {

/// What was asked for: empty where an option was not given.
struct PixelOptions {
    std::vector<int> taps;
    std::vector<std::string> set;  ///< NAME=VALUE or METHOD.NAME=VALUE
    std::optional<std::string> guard;
};

/// Names for --engine and --engines where pixels can be asked: those of the scene, grids, then
/// those of the picture.
[[nodiscard]] std::vector<std::string> pixel_engine_names();

/// --taps, --set and --guard. many_taps: of a list each number is a row of its own.
void add_pixel_options(CLI::App& command, PixelOptions& options, bool many_taps = false);

[[nodiscard]] bool is_at_pixels(const TexelOptions& options);
[[nodiscard]] bool is_at_cube_maps(const TexelOptions& options);

/// One for each of --taps, with what --set says of this method. Throws UsageError for what no such
/// setting can be.
[[nodiscard]] std::vector<ScreenSettings> screen_settings_of(ScreenMethod method,
                                                             const PixelOptions& options);

/// Who answers: --engine with its settings; not of the engine grid (cli/grid_options.h). Throws
/// UsageError for what does not go together.
[[nodiscard]] PixelEngine pixel_engine_of(const EngineOptions& engine, const PixelOptions& options);

/// Throws UsageError for engines and options of pixels without --at pixels, for --set of a method
/// that none of the engines is, and for what the picture alone cannot tell: a ground, the kernel of
/// disks. engines: by name.
void check_pixel_options(std::span<const std::string> engines, const PixelOptions& options,
                         const TexelOptions& texels, const MeasureOptions& measure);

/// --guard as a share of the picture's height; 0 without it. Throws UsageError.
[[nodiscard]] double guard_share_of(const PixelOptions& options);
/// The same in pixels beyond each edge of a picture.
[[nodiscard]] int guard_of(const PixelOptions& options, PictureSize size);

}  // namespace surfelao
