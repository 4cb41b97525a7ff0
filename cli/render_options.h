/// render_options.h: what `render` was asked for, and its ways to make a picture.
#pragma once

#include "bake/played_scene.h"
#include "cli/cube_options.h"
#include "cli/frame_options.h"
#include "cli/grid_options.h"
#include "cli/model_options.h"
#include "gpu/context.h"
#include "pixels/camera.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// What is read before the first picture, for all of them.
struct ReadOnce {
    std::vector<Scene> others;            ///< PartChoice::occluders
    std::shared_ptr<PlayedScene> played;  ///< the input of frames that are whole scenes, else null
    std::optional<Box> box;               ///< of all frames, for each of them
    double seconds = 0.0;                 ///< that reading took; the first picture tells it
};

struct RenderCommandOptions : ModelOptions {
    std::string input;
    std::string output;
    FrameOptions frames;
    int width = 1280, height = 720;
    int samples = 16;
    std::string backend = "auto";
    CubeOptions cubes;
    GridOptions grids;
    std::shared_ptr<const GridSources> grid_sources = {};  ///< of all frames, once they are there
    ReadOnce once = {};
};

/// The input at the options' moment.
[[nodiscard]] Scene scene_of(const RenderCommandOptions& options);

/// "egl", "osmesa", "auto"
[[nodiscard]] GlBackend backend_of(const std::string& name);

/// seen: by default framed, in the unit frame; of frames of an animation their common box is.
[[nodiscard]] Camera camera_of(const RenderCommandOptions& options, std::span<const glm::vec3> seen,
                               const Frame& frame);

/// What is measured in, where it is not the scene's own.
[[nodiscard]] std::optional<Frame> common_frame_of(const RenderCommandOptions& options);

/// Who answers at pixels. Throws UsageError.
[[nodiscard]] PixelEngine engine_at_pixels(const RenderCommandOptions& options);

/// --at pixels and cubemaps. Returns the exit code.
int render_pixels(const RenderCommandOptions& options);

}  // namespace surfelao
