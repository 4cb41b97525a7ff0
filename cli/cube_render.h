/// cube_render.h: the cube maps of a picture, as `render` is told to place them.
#pragma once

#include "cli/cube_options.h"
#include "pixels/cube_placement.h"
#include "pixels/pixel_picture.h"

#include <string>

namespace surfelao {

struct PlacedMaps {
    CubeProjector projector;
    double placement_s = 0.0;
    CubeSeconds seconds = {};
};

/// settings: of the picture; its engine answers the texels. Throws UsageError for a place that is
/// none for a map.
[[nodiscard]] PlacedMaps place_maps(const GlContext& context, const Mesh& mesh,
                                    const DrawnMesh& drawn, Occluders& occluders, const View& view,
                                    const PixelPictureSettings& settings,
                                    const CubeOptions& options, const StageProgress& progress);

/// How many, their memory, what they cover, and what they took.
[[nodiscard]] std::string text_of(const PlacedMaps& maps, const PixelPicture& picture);

}  // namespace surfelao
