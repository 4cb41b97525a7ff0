/// point_job.h: the part of bake() that is for clouds of points. Internal to bake/.
#pragma once

#include "bake/bake.h"
#include "surfels/scene.h"

namespace surfelao {

/// Throws SettingsError where the settings are for points and the file has faces, or the other way
/// round.
void check_points(const BakeSettings& settings, const Scene& scene);

/// Solves, writes the output if there is one, and fills in the report what is of points. scene:
/// without triangles. One value per point.
[[nodiscard]] std::vector<Occlusion> bake_at_points(const Scene& scene, BakeReport& report,
                                                    const StageProgress& progress);

}  // namespace surfelao
