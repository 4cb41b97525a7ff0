#include "surfels/folded_mesh.h"

#include "surfels/for_all.h"

#include <algorithm>
#include <atomic>

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
    std::vector<glm::uvec3>& corners = mesh.surface.split_corners;
    const std::vector<glm::uvec3>& triangles = mesh.geometry.triangles;
    std::size_t count = 0;
    for (std::size_t t = 0; t < corners.size(); ++t)
        count += corners[t] != triangles[t] ? 1 : 0;
    if (count * sizeof(Split) >= corners.size() * sizeof(corners[0]))
        return;
    splits_.reserve(count);
    for (std::uint32_t t = 0; t < corners.size(); ++t) {
        if (corners[t] != triangles[t])
            splits_.push_back({t, corners[t]});
    }
    corners = std::vector<glm::uvec3>();
}

void FoldedCorners::unfold()
{
    if (splits_.empty())
        return;
    mesh_.surface.split_corners = mesh_.geometry.triangles;
    for (const auto& [triangle, wedges] : splits_)
        mesh_.surface.split_corners[triangle] = wedges;
    splits_ = std::vector<Split>();
}

}  // namespace surfelao
