/// compare_options.h: what `compare` was asked, and its part for values at pixels.
#pragma once

#include "bake/grid_compare.h"
#include "cli/engine_options.h"
#include "cli/frame_options.h"
#include "cli/grid_bake_options.h"
#include "cli/grid_options.h"
#include "cli/part_options.h"
#include "cli/pixel_options.h"
#include "cli/read_options.h"
#include "cli/texel_options.h"
#include "pixels/pixel_compare.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace surfelao {

/// At pixels only: empty where an option was not given.
struct PixelTableOptions {
    PixelOptions methods;
    GridOptions grids;
    std::vector<std::string> cameras;
    std::optional<int> views, width, height;
    std::vector<std::uint32_t> rays;
    std::optional<std::string> tune;
};

/// Runs of every engine, where --rounds says nothing.
inline constexpr int kRounds = 3;

struct CompareOptions {
    std::vector<std::string> inputs;
    std::optional<std::string> output;
    ReadOptions reading;
    FrameOptions frames;
    bool overwrite = false;
    bool frontier = false;
    std::vector<std::string> engines;  ///< empty: what --at has by default
    std::vector<std::string> devices = {"cpu"};
    std::optional<std::vector<std::string>> qualities;
    MeasureOptions measure;
    std::optional<std::string> up;
    SurfaceOptions surface;
    std::optional<double> subdivide;
    TexelOptions texels;
    GridBakeOptions grid;
    PartOptions parts;
    PixelTableOptions pixels;
    std::optional<std::uint32_t> reference_rays;
    std::optional<std::uint64_t> sample;
    std::optional<int> rounds;
    bool no_cache = false;
    bool avx2 = false;
    std::optional<std::string> json, csv;
    std::optional<int> threads;
};

/// --camera, --views, --width, --height, --rays, --tune and those of add_pixel_options().
void add_pixel_table_options(CLI::App& command, PixelTableOptions& options);

/// Throws UsageError for what does not go with --at pixels, and for options of pixels without it.
void check_pixel_table(const CompareOptions& options);

/// Throws UsageError for what does not go with --at grid, and for options of grids without it.
void check_grid_table(const CompareOptions& options);

[[nodiscard]] GridCompareSettings grid_compare_settings(const CompareOptions& options);

/// Of --at pixels. Throws UsageError.
[[nodiscard]] PixelCompareSettings pixel_compare_settings(const CompareOptions& options);

/// As --qualities says, or all three.
[[nodiscard]] std::vector<std::string> qualities_of(const CompareOptions& options);

}  // namespace surfelao
