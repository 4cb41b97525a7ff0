/// render_options.h: what `render` was asked for, and its ways to make a picture.
#pragma once

#include "cli/engine_options.h"
#include "cli/part_options.h"
#include "cli/pixel_options.h"
#include "cli/read_options.h"
#include "cli/texel_options.h"
#include "cli/view_options.h"
#include "gpu/context.h"

#include <optional>
#include <string>

namespace surfelao {

struct RenderCommandOptions {
    std::string input;
    std::string output;
    ReadOptions reading;
    int width = 1280, height = 720;
    int samples = 16;
    std::string camera;
    std::string backend = "auto";
    ShowOptions show;
    EngineOptions engine;
    MeasureOptions measure;
    SurfaceOptions surface;
    TexelOptions texels;
    PixelOptions pixels;
    PartOptions parts;
    bool atlas = false;
    std::optional<int> threads;
};

/// "egl", "osmesa", "auto"
[[nodiscard]] GlBackend backend_of(const std::string& name);

/// --at pixels. Returns the exit code.
int render_pixels(const RenderCommandOptions& options);

}  // namespace surfelao
