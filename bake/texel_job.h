/// texel_job.h: the part of bake() that makes maps. Internal to bake/.
#pragma once

#include "bake/bake.h"
#include "bake/occluders.h"
#include "surfels/surface.h"

namespace surfelao {

/// Throws InputError where the output is no map that could be written.
void check_texel_output(const BakeSettings& settings);

/// Solves, and writes the output, or leaves layout and map in `baked` where there is none. Fills in
/// the report what is of the map; its settings.texels is there, settings.engine has its definition.
/// occluders: engines of what occludes the mesh; null: they are prepared for it alone.
void bake_texels(const Mesh& mesh, Occluders* occluders, SceneBake& baked,
                 const StageProgress& progress);

}  // namespace surfelao
