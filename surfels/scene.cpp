#include "surfels/scene.h"

#include "surfels/errors.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

namespace surfelao {
namespace {

void refuse(const Scene& scene, const std::string& fault)
{
    throw InputError(scene.name.empty() ? fault : scene.name + ": " + fault);
}

/// False for what is no number too.
bool in_reach(glm::dvec3 p)
{
    return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
}

/// Of CornerNormals or a UvSet, whose values a sentence calls `noun`.
template <class CornerValues>
void check_corners(const Scene& scene, const CornerValues& given, const std::string& noun)
{
    if (given.empty() && given.corners.empty())
        return;
    if (given.corners.empty()) {
        if (given.values.size() != scene.positions.size())
            refuse(scene, "there are " + std::to_string(given.values.size()) + ' ' + noun +
                              "s for " + std::to_string(scene.positions.size()) + " vertices");
        return;
    }
    if (given.corners.size() != scene.triangles.size())
        refuse(scene, "there are " + noun + "s of " + std::to_string(given.corners.size()) +
                          " triangles for " + std::to_string(scene.triangles.size()));
    const auto within = [&](std::uint32_t index) {
        return index < given.values.size() || index == CornerValues::kNone;
    };
    const auto wrong = std::ranges::find_if_not(given.corners, [&](glm::uvec3 corners) {
        return within(corners.x) && within(corners.y) && within(corners.z);
    });
    if (wrong != given.corners.end())
        refuse(scene, "triangle " + std::to_string(wrong - given.corners.begin()) + " uses a " +
                          noun + " that there is not: there are " +
                          std::to_string(given.values.size()));
}

}  // namespace

Scene make_scene(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles)
{
    Scene scene;
    scene.positions.assign(positions.begin(), positions.end());
    scene.triangles.assign(triangles.begin(), triangles.end());
    if (triangles.empty())
        refuse(scene, "there is no triangle");
    check_scene(scene);
    Part part;
    part.vertex_count = static_cast<std::uint32_t>(positions.size());
    part.triangle_count = static_cast<std::uint32_t>(triangles.size());
    scene.parts = {part};
    return scene;
}

void check_scene(const Scene& scene)
{
    const std::size_t count = scene.positions.size();
    if (std::max(count, scene.triangles.size()) > kMostElements)
        refuse(scene, "there are " + std::to_string(count) + " vertices and " +
                          std::to_string(scene.triangles.size()) + " triangles; at most " +
                          std::to_string(kMostElements) + " of each can be used");
    const auto lost = std::ranges::find_if_not(scene.positions, in_reach);
    if (lost != scene.positions.end())
        refuse(scene, "vertex " + std::to_string(lost - scene.positions.begin()) +
                          " has a coordinate that is no number or beyond 1e300");
    const auto wrong = std::ranges::find_if(scene.triangles, [&](glm::uvec3 triangle) {
        return std::max({triangle.x, triangle.y, triangle.z}) >= count;
    });
    if (wrong != scene.triangles.end())
        refuse(scene, "triangle " + std::to_string(wrong - scene.triangles.begin()) +
                          " uses vertex " +
                          std::to_string(std::max({wrong->x, wrong->y, wrong->z})) +
                          ", but there are " + std::to_string(count) + " vertices");
    check_corners(scene, scene.normals, "normal");
    for (const UvSet& uvs : scene.uvs)
        check_corners(scene, uvs, "texture coordinate");
}

Scene join(std::span<const Scene> scenes)
{
    Scene all;
    for (const Scene& scene : scenes) {
        require(all.positions.size() + scene.positions.size() <= kMostElements &&
                    all.triangles.size() + scene.triangles.size() <= kMostElements,
                "the files have more than " + std::to_string(kMostElements) +
                    " vertices or triangles together");
        const auto vertices = static_cast<std::uint32_t>(all.positions.size());
        const auto triangles = static_cast<std::uint32_t>(all.triangles.size());
        const auto normals = static_cast<std::uint32_t>(all.normals.values.size());
        all.name += (all.name.empty() ? "" : ", ") + scene.name;
        all.positions.insert(all.positions.end(), scene.positions.begin(), scene.positions.end());
        all.normals.values.insert(all.normals.values.end(), scene.normals.values.begin(),
                                  scene.normals.values.end());
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            all.triangles.push_back(scene.triangles[t] + vertices);
            glm::uvec3 corners(CornerNormals::kNone);
            if (!scene.normals.empty())
                corners =
                    scene.normals.corners.empty() ? scene.triangles[t] : scene.normals.corners[t];
            for (int k = 0; k < 3; ++k)
                if (corners[k] != CornerNormals::kNone)
                    corners[k] += normals;
            all.normals.corners.push_back(corners);
        }
        for (Part part : scene.parts) {
            part.first_vertex += vertices;
            part.first_triangle += triangles;
            if (part.name.empty())
                part.name = std::filesystem::path(scene.name).stem().string();
            all.parts.push_back(std::move(part));
        }
        all.notes.insert(all.notes.end(), scene.notes.begin(), scene.notes.end());
    }
    if (all.normals.values.empty())
        all.normals.corners.clear();
    return all;
}

}  // namespace surfelao
