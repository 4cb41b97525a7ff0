/// bent_space.h: the spaces in which maps hold bent normals.
#pragma once

#include "bake/map_bake.h"
#include "bake/texel_layout.h"

namespace surfelao {

/// From the world to a space. Object space is that of the part (Part::to_world), in which its
/// normals are; a bent normal is turned back into the world as they are, by the inverse transpose.
/// green_down: of tangent space, as TexelSettings has it. What it returns refers to the mesh and
/// the layout. Empty for BentSpace::none.
[[nodiscard]] BentEncoder bent_encoder(const Mesh& mesh, const MapLayout& layout, BentSpace space,
                                       bool green_down = false);

}  // namespace surfelao
