/// render.h: a picture of a model as a function, without a window.
#pragma once

#include "gpu/context.h"
#include "image/image.h"
#include "image/legend.h"
#include "pixels/camera.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "viewer/model.h"
#include "viewer/model_map.h"
#include "viewer/view_options.h"

#include <optional>
#include <span>

namespace surfelao {

struct RenderOptions {
    int width = 1280, height = 720;  ///< pixels, >= 1 and at most what the device draws at once
    int samples = 16;                ///< >= 1 per pixel, evenly spread; time grows with them
    ViewOptions view;
    GlBackend backend = GlBackend::automatic;
    std::optional<Image> environment;  ///< a panorama (environment.h); none = builtin_sky()
    bool fit_scale = false;            ///< the difference's scale is that of shown_error.h
    SurfaceData data = {};             ///< with a map, only the ground's values count
};

/// occlusion and reference: one per receiver of the model; the reference may be empty where
/// needs_reference(options.view) is false. The result is display-referred linear light, opaque but
/// for a transparent background; a colour map carries its legend, of differences with RMSE and bias
/// over what is seen. Throws InputError for a size that the device cannot draw,
/// std::runtime_error when there is no device, Cancelled. progress: of the samples.
[[nodiscard]] Image render(const Model& model, std::span<const Occlusion> occlusion,
                           std::span<const Occlusion> reference, const Camera& camera,
                           const RenderOptions& options, const Progress& progress = {});

/// Nothing for colours that are no numbers. layout: of the map that is shown, or null.
[[nodiscard]] std::optional<Legend> legend_of(const Model& model, const ModelLayout* layout,
                                              const ViewOptions& options);

}  // namespace surfelao
