/// view_options.h: the options that say how a model is shown, for `render` and `view`.
#pragma once

#include "pixels/camera.h"
#include "viewer/view_options.h"

#include <cstdint>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace surfelao {

/// What was asked for: empty where an option was not given.
struct ShowOptions {
    std::optional<std::string> mode;
    std::string surface = "triangles";
    std::optional<std::string> up;
    std::optional<std::string> environment;  ///< a panorama's path
    float exposure = 0.0f;
    float radius_scale = 1.0f;
    std::string difference_scale = "0.1";  ///< or "auto"
    bool is_signed = false;
    std::string color_map = "heat";
    std::optional<std::string> background;
    std::uint32_t reference_rays = 1024;
    bool no_ground = false;
    bool wireframe = false;
    bool cull = false;
};

void add_show_options(CLI::App& command, ShowOptions& options);

/// Whether the difference's scale follows from what is shown.
[[nodiscard]] bool fits_scale(const ShowOptions& options);
/// Throws UsageError for what contradicts itself.
[[nodiscard]] ViewOptions view_options_of(const ShowOptions& options);
/// Throws UsageError for what cannot be shown with or without a map.
void check_shown_map(const ViewOptions& view, bool has_map, bool atlas);
/// Likewise at the pixels of the picture, asked themselves or of cube maps.
void check_shown_pixels(const ViewOptions& view, bool atlas, bool has_cube_maps = false);
[[nodiscard]] UpAxis up_axis_of(const ShowOptions& options);

}  // namespace surfelao
