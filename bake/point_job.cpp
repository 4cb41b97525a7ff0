#include "bake/point_job.h"

#include "bake/point_target.h"
#include "files/scene_io.h"
#include "surfels/errors.h"
#include "surfels/progress.h"
#include "surfels/stopwatch.h"

#include <algorithm>
#include <utility>

namespace surfelao {

void check_points(const BakeSettings& settings, const Scene& scene)
{
    const bool is_cloud = scene.triangles.empty();
    const bool wants_points = settings.at_points.value_or(is_cloud);
    require(is_cloud || !wants_points,
            scene.name + ": has faces, --at points is for files without");
    require(!is_cloud || !settings.texels, scene.name + ": has no faces for a map to lie on");
    require(!is_cloud || !settings.grid, scene.name + ": has no faces, a grid is round a mesh");
    require(!is_cloud || !settings.subdivide, scene.name + ": has no faces to subdivide");
    require(!is_cloud || wants_points, scene.name + ": has points only, no faces: --at points");
    check_target(scene, settings.target, settings.parts);
}

std::vector<Occlusion> bake_at_points(const Scene& scene, BakeReport& report,
                                      const StageProgress& progress)
{
    const BakeSettings& settings = report.settings;
    std::optional<Prepared> masks;
    const PointTarget target = make_point_target(scene, settings.target, progress, &masks);
    const Prepared* ready = masks ? &*masks : nullptr;
    report.settings.engine.definition =
        definition_of(settings.max_distance, settings.kernel, target.cloud.frame);
    report.settings.engine.definition.ground = ground_below(target, settings.ground);
    if (const auto& ground = report.settings.engine.definition.ground)
        report.ground = text_of(*ground, target.cloud.frame);
    report.points = report_of(target);
    report.receivers = scene.positions.size();
    report.vertices_without_normal = target.cloud.counts.without_normal;
    VertexBake baked = settings.error
                           ? bake_points_to_error(target, settings.engine, *settings.error,
                                                  settings.check, progress, ready)
                           : bake_points(target, settings.engine, settings.check, progress, ready);
    take(baked, report);
    report.seconds.points = target.seconds;

    if (progress && !progress("write", 0.0))
        throw Cancelled();
    Stopwatch stage;
    report.notes = scene.notes;
    std::vector<std::string> written;
    if (!settings.output.empty())
        written = write_scene(settings.output, scene, baked.values,
                              {settings.colors, settings.encoding, mark_of(settings)});
    for (const auto& notes : {point_notes(target), written})
        report.notes.insert(report.notes.end(), notes.begin(), notes.end());
    double sum = 0.0;
    for (const Occlusion& value : baked.values)
        sum += value.occlusion;
    report.mean_occlusion = sum / static_cast<double>(std::max<std::uint64_t>(
                                      1, scene.positions.size() - report.vertices_without_normal));
    report.seconds.write = stage.lap();
    return std::move(baked.values);
}

}  // namespace surfelao
