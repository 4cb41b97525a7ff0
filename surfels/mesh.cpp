#include "surfels/errors.h"
#include "surfels/surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace surfelao {

Scene split_at_creases(const Scene& scene, const Geometry& geometry, const Surface& surface,
                       const NormalSettings& settings)
{
    // per wedge: the vertex that it gets
    std::vector<std::uint32_t> vertices(surface.normals.size());
    std::vector<std::vector<std::uint32_t>> kinds(
        surface.extra_vertices.empty() ? 0 : surface.vertex_count());
    const std::vector<glm::uvec3>& corners = surface.corners(geometry);
    Scene split = scene;
    for (std::uint32_t wedge = 0; wedge < vertices.size(); ++wedge) {
        const std::uint32_t vertex = surface.vertex_of(wedge);
        vertices[wedge] = vertex;
        if (kinds.empty())
            continue;
        std::vector<std::uint32_t>& own = kinds[vertex];  // wedges with a vertex of their own
        const auto alike = std::ranges::find_if(own, [&](std::uint32_t other) {
            return are_smooth(surface.normals[other], surface.normals[wedge], settings);
        });
        if (alike != own.end()) {
            vertices[wedge] = vertices[*alike];
            continue;
        }
        if (!own.empty()) {
            vertices[wedge] = static_cast<std::uint32_t>(split.positions.size());
            split.positions.push_back(scene.positions[vertex]);
        }
        own.push_back(wedge);
    }
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner)
            split.triangles[geometry.scene_triangle(t)][corner] = vertices[corners[t][corner]];
    }
    split.parts.back().vertex_count +=
        static_cast<std::uint32_t>(split.positions.size() - scene.positions.size());
    return split;
}

Mesh make_mesh(Scene scene, const NormalSettings& settings, const GeometryScope& scope)
{
    if (scene.triangles.empty())
        throw InputError(scene.name + ": has points only, no faces");
    Mesh mesh{std::move(scene), {}, {}};
    const auto look = [&] {
        mesh.geometry = make_geometry(mesh.scene, scope);
        mesh.surface = make_surface(mesh.scene, mesh.geometry, settings);
    };
    look();
    if (mesh.scene.free_vertices && !mesh.surface.extra_vertices.empty()) {
        mesh.scene = split_at_creases(mesh.scene, mesh.geometry, mesh.surface, settings);
        look();
    }
    return mesh;
}

void keep_triangles(Mesh& mesh, const std::function<bool(std::size_t triangle)>& wanted)
{
    Geometry& geometry = mesh.geometry;
    std::vector<glm::uvec3>& split_corners = mesh.surface.split_corners;
    std::vector<std::uint32_t> kept;
    std::vector<bool> in_use(mesh.surface.normals.size(), false);
    std::vector<bool> has_kept(mesh.surface.vertex_count(), false);
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        const std::size_t in_scene = geometry.scene_triangle(t);
        if (!wanted(in_scene))
            continue;
        geometry.triangles[kept.size()] = geometry.triangles[t];
        if (!split_corners.empty())
            split_corners[kept.size()] = split_corners[t];
        kept.push_back(static_cast<std::uint32_t>(in_scene));
        for (int corner = 0; corner < 3; ++corner) {
            in_use[mesh.surface.corners(geometry)[t][corner]] = true;
            has_kept[mesh.scene.triangles[in_scene][corner]] = true;
        }
    }
    mesh.unbaked.assign(mesh.scene.triangles.size(), true);
    for (std::size_t t = 0; t < mesh.scene.triangles.size(); ++t) {
        if (!wanted(t))
            continue;
        mesh.unbaked[t] = false;
        for (int corner = 0; corner < 3; ++corner) {  // of triangles without area: the vertex' own
            const std::uint32_t vertex = mesh.scene.triangles[t][corner];
            in_use[vertex] = in_use[vertex] || !has_kept[vertex];
        }
    }
    for (std::size_t wedge = 0; wedge < in_use.size(); ++wedge) {
        if (!in_use[wedge])
            mesh.surface.normals[wedge] = glm::vec3(0.0f);
    }
    geometry.triangles.resize(kept.size());
    if (!split_corners.empty())
        split_corners.resize(kept.size());
    geometry.kept = std::move(kept);
}

}  // namespace surfelao
