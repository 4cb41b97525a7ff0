#include "bake/subdivide_job.h"

#include "bake/subdivide.h"
#include "files/refined_scene.h"
#include "surfels/errors.h"
#include "surfels/stopwatch.h"

#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

/// Copies of vertices, and the normals of all.
struct PartedVertices {
    Refinement refinement;           ///< that cuts nothing
    std::vector<glm::vec3> normals;  ///< as refined_scene() takes them
};

/// What the mesh's file needs so that it holds the surface that is asked: a vertex for each normal
/// and, where the file gives none, the normals. Nothing where it holds it already: files that give
/// each vertex one.
std::optional<PartedVertices> parted_at_normals(const Mesh& mesh)
{
    const CornerNormals& given = mesh.scene.normals;
    if (given.of_vertices())
        return std::nullopt;
    const Surface& surface = mesh.surface;
    const std::vector<glm::uvec3>& corners = surface.corners(mesh.geometry);
    std::vector<bool> is_used(surface.normals.size(), false);
    bool lacks_normals = false;
    for (std::size_t t = 0; t < mesh.geometry.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            is_used[corners[t][k]] = true;
            lacks_normals =
                lacks_normals || given.empty() ||
                given.corners[mesh.geometry.scene_triangle(t)][k] == CornerNormals::kNone;
        }
    }
    PartedVertices parted;
    Refinement& refinement = parted.refinement;
    refinement.old_vertices = static_cast<std::uint32_t>(surface.vertex_count());
    std::vector<std::uint32_t> vertices(surface.normals.size());
    for (std::uint32_t wedge = 0; wedge < vertices.size(); ++wedge) {
        const bool is_copy = wedge >= refinement.old_vertices;
        if (is_copy && !is_used[wedge])
            continue;
        vertices[wedge] = static_cast<std::uint32_t>(parted.normals.size());
        parted.normals.push_back(surface.normals[wedge]);
        if (is_copy)
            refinement.parents.emplace_back(surface.vertex_of(wedge));
    }
    if (refinement.parents.empty() && !lacks_normals)
        return std::nullopt;
    refinement.pieces = mesh.scene.triangles;
    for (std::size_t t = 0; t < mesh.geometry.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k)
            refinement.pieces[mesh.geometry.scene_triangle(t)][k] = vertices[corners[t][k]];
    }
    refinement.first.resize(refinement.pieces.size() + 1);
    std::iota(refinement.first.begin(), refinement.first.end(), 0u);
    return parted;
}

/// Normals of the corners as those of the vertices, where each vertex has one.
CornerNormals of_vertices_if_one(const CornerNormals& normals, const Scene& scene)
{
    CornerNormals of_vertices;
    of_vertices.values.resize(scene.positions.size(), glm::vec3(0.0f));
    for (std::size_t t = 0; t < normals.corners.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            if (normals.corners[t][k] == CornerNormals::kNone)
                continue;
            const glm::vec3& normal = normals.values[normals.corners[t][k]];
            glm::vec3& known = of_vertices.values[scene.triangles[t][k]];
            if (known != glm::vec3(0.0f) && known != normal)
                return normals;
            known = normal;
        }
    }
    return of_vertices;
}

}  // namespace

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
            [](glm::vec3 a, glm::vec3 b) { return glm::vec3(middle_direction(a, b)); });
        for (std::uint32_t p = refinement.first[t]; p < refinement.first[t + 1]; ++p) {
            is_there[p] = true;
            for (int k = 0; k < 3; ++k) {
                scene.normals.corners[p][k] =
                    static_cast<std::uint32_t>(scene.normals.values.size());
                scene.normals.values.push_back(values[refinement.pieces[p][k]]);
            }
        }
    }
    scene.normals = of_vertices_if_one(scene.normals, scene);
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
    report.old_vertices = mesh.scene.positions.size();
    report.old_triangles = mesh.scene.triangles.size();
    std::optional<Mesh> parted;
    if (const std::optional<PartedVertices> at_normals = parted_at_normals(mesh))
        parted =
            refined_mesh(mesh, at_normals->refinement,
                         refined_scene(mesh.scene, at_normals->refinement, at_normals->normals));
    const Mesh& whole = parted ? *parted : mesh;
    EngineSettings asked = engine;
    if (knows_kernel(Engine::masks, engine.definition.kernel)) {
        asked.engine = Engine::masks;
        asked.quality = kAskedQuality;
    }
    const Prepared& prepared = occluders.prepared_for(asked);
    const Subdivision found = subdivide(
        whole, tolerance, offset_of(target, mesh.geometry.frame).value_or(kAskedOffset),
        [&](std::span<const Receiver> receivers, const Progress& done) {
            return solve(prepared, receivers, asked, done).occlusion;
        },
        told);
    Mesh refined =
        refined_mesh(whole, found.refinement, refined_scene(whole.scene, found.refinement));
    report.asked = found.asked;
    report.rounds = found.rounds;
    report.seconds = watch.lap();
    return refined;
}

}  // namespace surfelao
