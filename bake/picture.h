/// picture.h: a small picture of a mesh with a colour at every vertex, for reports. No GL.
#pragma once

#include "image/color_map.h"
#include "surfels/geometry.h"

#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// Rows from the top, three bytes a pixel.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Rgb> pixels;
};

/// The whole scene in parallel projection, obliquely from above with y upwards, white behind it,
/// faintly shaded so that its shape shows. Faces that look at the viewer hide those that look away,
/// even where these are nearer: rooms are seen from inside. O(triangles + pixels).
/// colors: one per scene vertex.
[[nodiscard]] Picture draw_vertices(const Geometry& geometry, std::span<const Rgb> colors,
                                    int width, int height);

/// The bytes of a PNG file.
[[nodiscard]] std::string png_of(const Picture& picture);

}  // namespace surfelao
