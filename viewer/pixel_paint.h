/// pixel_paint.h: the colours of a picture whose pixels are asked themselves
/// (pixels/pixel_picture.h): twins of shaders/shading.glsl.
#pragma once

#include "gpu/context.h"
#include "image/image.h"
#include "pixels/camera.h"
#include "pixels/pixel_picture.h"
#include "viewer/base_paint.h"
#include "viewer/view_options.h"

namespace surfelao {

/// Whether a picture of these colours is numbers, not light: visibility as it is, directions as (n
/// + 1) / 2.
[[nodiscard]] constexpr bool shows_numbers(Colors colors)
{
    return colors == Colors::visibility || colors == Colors::rays ||
           colors == Colors::bent_normals || colors == Colors::normals ||
           colors == Colors::coverage;
}

/// Numbers for shows_numbers(); of differences the occlusion in red and the reference in green;
/// else display-referred linear light: the lit picture times the visibility. camera: for
/// Colors::headlight, and whose up is the panorama's. panorama: for Colors::environment; null =
/// builtin_sky(). paint: for Colors::textured; what it returns refers to it. Colors that need a map
/// or levels are no choice.
[[nodiscard]] PixelPaint pixel_paint(const ViewOptions& options, const Camera& camera,
                                     const Image* panorama, const BasePaint* paint);

/// Numbers as light that a screen shows as these numbers.
void show_numbers(Image& image);

/// A picture of differences in their colours, with its legend; fit_scale: as RenderOptions'.
void show_difference(Image& image, ViewOptions options, bool fit_scale);

/// Puts the picture on render()'s background: opaque then, where that is.
void put_on_background(const GlContext& context, Image& image, const Camera& camera,
                       const ViewOptions& options, const Image* panorama);

}  // namespace surfelao
