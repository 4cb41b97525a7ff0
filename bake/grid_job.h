/// grid_job.h: the part of bake() that makes AO grids. Internal to bake/.
#pragma once

#include "bake/bake.h"
#include "surfels/surface.h"

#include <string>

namespace surfelao {

/// Throws InputError where the output is no grid that could be written, SettingsError for settings
/// that do not go with grids.
void check_grid_job(const BakeSettings& settings);

/// Solves, writes the output, and fills in the report what is of the grid. settings.grid is there;
/// report.settings.engine has its definition. What occludes is the mesh's occluders.
void bake_at_grid(const Mesh& mesh, BakeReport& report, const StageProgress& progress);

/// What the file tells of its making, a JSON object: the engine with its settings, the source and
/// its parts, extent, cells inside, the error.
[[nodiscard]] std::string grid_notes_of(const BakeReport& report);

}  // namespace surfelao
