#include "surfels/folded_mesh.h"

#include "surfels/buckets.h"
#include "surfels/for_all.h"

#include <algorithm>
#include <atomic>
#include <limits>

namespace surfelao {
namespace {

bool are_floats(const std::vector<glm::dvec3>& positions)
{
    std::atomic<bool> are{true};
    for_all(positions.size(), [&](std::size_t v) {
        if (glm::dvec3(glm::vec3(positions[v])) != positions[v])
            are.store(false, std::memory_order_relaxed);
    });
    return are;
}

}  // namespace

FoldedScene::FoldedScene(Mesh& mesh)
    : mesh_(mesh), is_in_geometry_(mesh.scene.triangles == mesh.geometry.triangles)
{
    Scene& scene = mesh.scene;
    if (is_in_geometry_)
        scene.triangles = std::vector<glm::uvec3>();  // {} would keep the room
    if (!are_floats(scene.positions))
        return;
    positions_.resize(scene.positions.size());
    for_all(positions_.size(), [&](std::size_t v) { positions_[v] = scene.positions[v]; });
    scene.positions = std::vector<glm::dvec3>();
}

void FoldedScene::unfold()
{
    Scene& scene = mesh_.scene;
    if (is_in_geometry_)
        scene.triangles = mesh_.geometry.triangles;
    if (positions_.empty())
        return;
    scene.positions.resize(positions_.size());
    for_all(positions_.size(), [&](std::size_t v) { scene.positions[v] = positions_[v]; });
    positions_ = std::vector<glm::vec3>();
}

FoldedCorners::FoldedCorners(Mesh& mesh) : mesh_(mesh)
{
    const Surface& surface = mesh.surface;
    const std::size_t vertices = surface.vertex_count();
    std::vector<std::uint8_t> count(vertices, 0), rank(surface.extra_vertices.size());
    for (std::size_t extra = 0; extra < rank.size(); ++extra) {
        std::uint8_t& before = count[surface.extra_vertices[extra]];
        if (before == std::numeric_limits<std::uint8_t>::max())
            return;
        rank[extra] = ++before;
    }
    ranks_.resize(surface.split_corners.size());
    for_all(ranks_.size(), [&](std::size_t t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t wedge = surface.split_corners[t][static_cast<int>(k)];
            ranks_[t][k] = wedge < vertices ? std::uint8_t{0} : rank[wedge - vertices];
        }
    });
    mesh.surface.split_corners = std::vector<glm::uvec3>();
}

void FoldedCorners::unfold()
{
    if (ranks_.empty())
        return;
    Surface& surface = mesh_.surface;
    const auto vertices = static_cast<std::uint32_t>(surface.vertex_count());
    const std::vector<std::uint32_t>& owners = surface.extra_vertices;
    const Buckets<std::uint32_t> extras(vertices, [&](const auto& put) {
        for (std::uint32_t extra = 0; extra < owners.size(); ++extra)
            put(owners[extra], vertices + extra);
    });
    surface.split_corners = mesh_.geometry.triangles;
    for_all(ranks_.size(), [&](std::size_t t) {
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& corner = surface.split_corners[t][static_cast<int>(k)];
            if (ranks_[t][k] > 0)
                corner = extras[corner][ranks_[t][k] - std::size_t{1}];
        }
    });
    ranks_ = std::vector<std::array<std::uint8_t, 3>>();
}

}  // namespace surfelao
