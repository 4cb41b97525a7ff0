#include "bake/subdivide_job.h"

#include "bake/subdivide.h"
#include "files/refined_scene.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace surfelao {

Mesh refined_mesh(const Mesh& mesh, const Refinement& refinement, Scene scene)
{
    SURFELAO_CHECK(scene.triangles.size() == refinement.pieces.size());
    const std::size_t count = mesh.scene.triangles.size();
    constexpr std::uint32_t kLeftOut = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> in_geometry(count, kLeftOut);
    for (std::uint32_t t = 0; t < mesh.geometry.triangles.size(); ++t)
        in_geometry[mesh.geometry.scene_triangle(t)] = t;
    scene.normals = {};
    scene.normals.corners.assign(scene.triangles.size(), glm::uvec3(CornerNormals::kNone));
    std::vector<bool> is_there(scene.triangles.size(), false);
    for (std::size_t t = 0; t < count; ++t) {
        if (in_geometry[t] == kLeftOut)
            continue;
        std::array<glm::vec3, 3> normals;
        for (int k = 0; k < 3; ++k)
            normals[static_cast<std::size_t>(k)] =
                mesh.surface.normals[mesh.surface.corners(mesh.geometry)[in_geometry[t]][k]];
        const PieceValues<glm::vec3> values(
            refinement, t, mesh.scene.triangles[t], normals,
            [](glm::vec3 a, glm::vec3 b) { return 0.5f * (a + b); });
        for (std::uint32_t p = refinement.first[t]; p < refinement.first[t + 1]; ++p) {
            is_there[p] = true;
            for (int k = 0; k < 3; ++k) {
                scene.normals.corners[p][k] =
                    static_cast<std::uint32_t>(scene.normals.values.size());
                scene.normals.values.push_back(values[refinement.pieces[p][k]]);
            }
        }
    }
    NormalSettings settings;
    settings.source = NormalSource::file;
    Mesh refined = make_mesh(std::move(scene), settings, {mesh.geometry.frame, {}});
    if (!mesh.geometry.kept.empty())
        keep_triangles(refined, [&](std::size_t triangle) { return is_there[triangle]; });
    refined.occluders =
        mesh.occluders ? mesh.occluders : std::make_shared<const Geometry>(mesh.geometry);
    refined.surface.corners_from_file = mesh.surface.corners_from_file;
    refined.surface.replaced_corners = mesh.surface.replaced_corners;
    return refined;
}

Mesh subdivided(const Mesh& mesh, double tolerance, const TargetSettings& target,
                const EngineSettings& engine, Occluders& occluders, const StageProgress& progress,
                SubdivisionReport& report)
{
    check_refinable(mesh.scene);
    const Progress told =
        progress ? Progress([&](double done) { return progress("subdivide", done); }) : Progress();
    if (told && !told(0.0))
        throw Cancelled();
    Stopwatch watch;
    EngineSettings asked = engine;
    if (knows_kernel(Engine::masks, engine.definition.kernel)) {
        asked.engine = Engine::masks;
        asked.quality = kAskedQuality;
    }
    const Prepared& prepared = occluders.prepared_for(asked);
    const Subdivision found = subdivide(
        mesh, tolerance, offset_of(target, mesh.geometry.frame).value_or(kAskedOffset),
        [&](std::span<const Receiver> receivers, const Progress& done) {
            return solve(prepared, receivers, asked, done).occlusion;
        },
        told);
    report = {mesh.scene.positions.size(), mesh.scene.triangles.size(), found.asked, found.rounds,
              0.0};
    Mesh refined =
        refined_mesh(mesh, found.refinement, refined_scene(mesh.scene, found.refinement));
    report.seconds = watch.lap();
    return refined;
}

}  // namespace surfelao
