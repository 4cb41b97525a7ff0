/// scene_checks.h: what every scene that a reader hands out must be like.
#pragma once

#include "surfels/errors.h"
#include "surfels/geometry.h"
#include "surfels/scene.h"
#include "surfels/topology.h"

#include <cmath>
#include <cstdint>

namespace surfelao {

inline void check_invariants(const Scene& scene)
{
    SURFELAO_CHECK(!scene.positions.empty());
    for (const glm::dvec3& position : scene.positions)
        SURFELAO_CHECK(std::isfinite(position.x + position.y + position.z));
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    for (const Part& part : scene.parts) {
        SURFELAO_CHECK(part.first_vertex == vertices && part.first_triangle == triangles);
        vertices += part.vertex_count;
        triangles += part.triangle_count;
        for (std::uint64_t t = part.first_triangle; t < triangles; ++t) {
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t vertex = scene.triangles[t][corner];
                SURFELAO_CHECK(vertex >= part.first_vertex && vertex < vertices);
            }
        }
    }
    SURFELAO_CHECK(vertices == scene.positions.size() && triangles == scene.triangles.size());
    check_scene(scene);  // the normals too
}

/// What stands right behind the readers takes any scene.
inline void check_geometry(const Scene& scene)
{
    const Geometry geometry = make_geometry(scene);
    SURFELAO_CHECK(geometry.triangles.size() + geometry.dropped_triangles ==
                   scene.triangles.size());
    for (const glm::vec3& normal : geometry.normals) {
        const float squared = normal.x * normal.x + normal.y * normal.y + normal.z * normal.z;
        SURFELAO_CHECK(squared == 0.0f || std::abs(squared - 1.0f) < 1e-5f);
    }
    SURFELAO_CHECK(analyse_topology(geometry).sides.size() == scene.positions.size());
}

}  // namespace surfelao
