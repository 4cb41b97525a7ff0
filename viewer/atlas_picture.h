/// atlas_picture.h: a map as it lies flat, with the borders of its charts.
#pragma once

#include "image/image.h"
#include "viewer/model.h"
#include "viewer/model_map.h"
#include "viewer/view_options.h"

namespace surfelao {

/// All pages of the map, as large as they fit beside each other, v down, a line on each side of the
/// borders of charts; pages of several are named. Colours as on the model; levels and environment
/// are shown as visibility. What no chart covers shows the map where it is of visibility, else the
/// ground. data: with layout and map, and what the colours need. width, height >= 1. O(pixels,
/// texels and triangles).
[[nodiscard]] Image atlas_picture(const Mesh& mesh, const SurfaceData& data,
                                  const ViewOptions& view, int width, int height);

}  // namespace surfelao
