/// material_pages.h: texture coordinates that each material uses for itself, a map for each.
#pragma once

#include "atlas/layout.h"
#include "surfels/base_colors.h"
#include "surfels/scene.h"

namespace surfelao {

/// The pages are those of the materials whose triangles have coordinates, in the order of the
/// materials; uvs and colors: of the scene. A triangle without coordinates lies on none. O(n).
[[nodiscard]] MapLayout material_layout(const Scene& scene, const UvSet& uvs,
                                        const BaseColors& colors, MapSize size);

}  // namespace surfelao
