#include "cli/render_options.h"

#include "cli/commands.h"

#include <glm/common.hpp>

#include <array>

namespace surfelao {

GlBackend backend_of(const std::string& name)
{
    if (name == "egl")
        return GlBackend::egl;
    return name == "osmesa" ? GlBackend::osmesa : GlBackend::automatic;
}

Camera camera_of(const RenderCommandOptions& options, std::span<const glm::vec3> seen,
                 const Frame& frame)
{
    std::array<glm::vec3, 8> corners;
    if (options.once.box) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const glm::dvec3 share(i & 1, i >> 1 & 1, i >> 2);
            const glm::dvec3 corner =
                glm::mix(options.once.box->low, options.once.box->high, share);
            corners[i] = (corner - frame.centre) / frame.diagonal;
        }
        seen = corners;
    }
    return parse_camera(options.camera, {.points = seen,
                                         .frame_centre = frame.centre,
                                         .frame_diagonal = frame.diagonal,
                                         .up = up_axis_of(options.show),
                                         .aspect = static_cast<float>(options.width) /
                                                   static_cast<float>(options.height)});
}

std::optional<Frame> common_frame_of(const RenderCommandOptions& options)
{
    return options.once.box ? std::optional(frame_of(*options.once.box)) : std::nullopt;
}

Scene scene_of(const RenderCommandOptions& options)
{
    return options.once.played ? options.once.played->at(options.reading.moment->seconds)
                               : read_scene(options.input, options.reading);
}

PixelEngine engine_at_pixels(const RenderCommandOptions& options)
{
    if (options.engine.engine == "grid") {
        if (!options.pixels.taps.empty() || !options.pixels.set.empty() || options.pixels.guard)
            throw UsageError(
                "--taps, --set and --guard are for methods that know the picture alone, not for "
                "--engine grid.");
        return grid_pixels_of(options.grids, options.engine);
    }
    return pixel_engine_of(options.engine, options.pixels);
}

}  // namespace surfelao
