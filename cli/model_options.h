/// model_options.h: the options of a model that is shown, for `render` and `view`.
#pragma once

#include "cli/engine_options.h"
#include "cli/part_options.h"
#include "cli/pixel_options.h"
#include "cli/read_options.h"
#include "cli/texel_options.h"
#include "cli/view_options.h"

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace surfelao {

struct ModelOptions {
    ReadOptions reading;
    std::string camera;
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

/// All but --camera and those of reading; --preset too.
void add_model_options(CLI::App& command, ModelOptions& options);

}  // namespace surfelao
