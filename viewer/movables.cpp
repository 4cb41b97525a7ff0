#include "viewer/movables.h"

#include "surfels/union_find.h"
#include "viewer/part_list.h"

#include <glm/common.hpp>

#include <limits>
#include <map>

namespace surfelao {
namespace {

constexpr std::uint32_t kNobody = Movables::kNone;

/// What the file tells apart: one name per group, one group per scene triangle.
struct NamedGroups {
    std::vector<std::string> names;
    std::vector<std::uint32_t> of_triangle;
};

NamedGroups nodes_of(const Scene& scene)
{
    NamedGroups groups;
    groups.of_triangle.assign(scene.triangles.size(), kNobody);
    std::map<std::int32_t, std::uint32_t> numbers;
    for (const Part& part : scene.parts) {
        if (part.node < 0 || part.triangle_count == 0)
            continue;
        const auto next = static_cast<std::uint32_t>(groups.names.size());
        const auto [entry, is_new] = numbers.try_emplace(part.node, next);
        if (is_new)
            groups.names.push_back(part.name);
        for (std::uint32_t t = 0; t < part.triangle_count; ++t)
            groups.of_triangle[part.first_triangle + t] = entry->second;
    }
    return groups;
}

NamedGroups labels_of(const Scene& scene)
{
    NamedGroups groups;
    groups.of_triangle.assign(scene.triangles.size(), kNobody);
    for (const Label* label : parting_labels(scene)) {
        for (const Label::Range& range : label->ranges)
            for (std::uint32_t t = 0; t < range.count; ++t)
                groups.of_triangle[range.first + t] =
                    static_cast<std::uint32_t>(groups.names.size());
        groups.names.push_back(label->name);
    }
    return groups;
}

/// Vertices that are to move together: of one group, and of one triangle.
UnionFind joined_vertices(const Mesh& mesh, const NamedGroups& groups)
{
    const Scene& scene = mesh.scene;
    UnionFind sets(scene.positions.size());
    std::vector<std::uint32_t> first_of_group(groups.names.size(), kNobody);
    const bool by_place = groups.names.size() < 2;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const glm::uvec3 triangle = scene.triangles[t];
        sets.join(triangle.x, triangle.y);
        sets.join(triangle.x, triangle.z);
        if (by_place) {
            for (int k = 0; k < 3; ++k)
                sets.join(triangle[k], mesh.geometry.welded[triangle[k]]);
            continue;
        }
        const std::uint32_t group = groups.of_triangle[t];
        if (group == kNobody)
            continue;
        if (first_of_group[group] == kNobody)
            first_of_group[group] = triangle.x;
        sets.join(triangle.x, first_of_group[group]);
    }
    return sets;
}

}  // namespace

Movables movables_of(const Mesh& mesh)
{
    const Geometry& geometry = mesh.geometry;
    NamedGroups groups = nodes_of(mesh.scene);
    if (groups.names.size() < 2)
        groups = labels_of(mesh.scene);
    UnionFind sets = joined_vertices(mesh, groups);

    Movables movables;
    std::vector<std::uint32_t> number_of_set(mesh.scene.positions.size(), kNobody);
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        std::uint32_t& number = number_of_set[sets.root(geometry.triangles[t].x)];
        if (number == kNobody) {
            number = static_cast<std::uint32_t>(movables.list.size());
            const std::uint32_t group =
                groups.names.size() < 2 ? kNobody : groups.of_triangle[geometry.scene_triangle(t)];
            Movable& movable = movables.list.emplace_back();
            movable.name = group == kNobody ? std::string() : groups.names[group];
            if (movable.name.empty())
                movable.name = "piece " + std::to_string(movables.list.size());
            movable.low = glm::vec3(std::numeric_limits<float>::max());
            movable.high = -movable.low;
        }
        Movable& movable = movables.list[number];
        ++movable.triangles;
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 p = geometry.positions[geometry.triangles[t][k]];
            movable.low = glm::min(movable.low, p);
            movable.high = glm::max(movable.high, p);
        }
    }
    // what no triangle with an area uses moves with nothing
    for (std::uint32_t v = 0; v < mesh.scene.positions.size(); ++v)
        movables.of_vertex.push_back(number_of_set[sets.root(v)]);
    return movables;
}

}  // namespace surfelao
