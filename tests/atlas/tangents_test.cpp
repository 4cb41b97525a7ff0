#include "atlas/tangents.h"

#include "scenes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <functional>
#include <utility>

namespace surfelao {
namespace {

/// A mesh whose vertices lie where `place` says.
Mesh mapped(Scene scene, const std::function<glm::dvec2(glm::dvec3)>& place)
{
    UvSet set;
    for (const glm::dvec3 p : scene.positions)
        set.values.push_back(place(p));
    scene.uvs.push_back(set);
    return make_mesh(std::move(scene));
}

/// As viewers do it.
glm::dvec3 decoded(const Mesh& mesh, const Tangents& tangents, const SurfacePoint& point,
                   glm::dvec3 inside)
{
    const double weights[3] = {1.0 - point.at.x - point.at.y, point.at.x, point.at.y};
    glm::dvec3 normal(0.0), tangent(0.0);
    for (int k = 0; k < 3; ++k) {
        normal += weights[k] *
                  glm::dvec3(
                      mesh.surface.normals[mesh.surface.corners(mesh.geometry)[point.triangle][k]]);
        tangent +=
            weights[k] *
            glm::dvec3(glm::vec3(tangents[3 * point.triangle + static_cast<std::size_t>(k)]));
    }
    const glm::dvec3 bitangent =
        double{tangents[3 * point.triangle].w} * glm::cross(normal, tangent);
    return glm::normalize(inside.x * tangent + inside.y * bitangent + inside.z * normal);
}

// A wall seen from the front, its map turned and mirrored in all eight ways: red is where u grows,
// green where v, which runs down, shrinks.
TEST(Tangents, GoAlongUAndAgainstV)
{
    const Scene wall = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);  // looks along z
    for (const double u : {-1.0, 1.0}) {
        for (const double v : {-1.0, 1.0}) {
            for (const bool turned : {false, true}) {
                const glm::dvec3 along_u = turned ? glm::dvec3(0, u, 0) : glm::dvec3(u, 0, 0);
                const glm::dvec3 along_v = turned ? glm::dvec3(v, 0, 0) : glm::dvec3(0, v, 0);
                const Mesh mesh = mapped(wall, [&](glm::dvec3 p) {
                    return 0.5 + 0.25 * glm::dvec2(glm::dot(p, along_u), glm::dot(p, along_v));
                });
                const Tangents tangents = make_tangents(mesh, mesh.scene.uvs[0]);
                const SurfacePoint point{5, {0.2f, 0.3f}};
                const auto held = [&](glm::vec3 direction, bool green_down) {
                    return to_tangent_space(mesh, tangents, point, direction, green_down);
                };
                EXPECT_LT(glm::distance(held(along_u, false), {1, 0, 0}), 1e-6f);
                EXPECT_LT(glm::distance(held(-along_v, false), {0, 1, 0}), 1e-6f);
                EXPECT_LT(glm::distance(held(along_v, true), {0, 1, 0}), 1e-6f);
                EXPECT_LT(glm::distance(held({0, 0, 1}, true), {0, 0, 1}), 1e-6f);
            }
        }
    }
}

TEST(Tangents, GiveBackTheDirectionsThatWereEncoded)
{
    const Mesh mesh = mapped(scenes::bumpy_sphere(6), [](glm::dvec3 p) {
        return glm::dvec2(0.5 + 0.2 * p.x + 0.05 * p.z, 0.5 + 0.2 * p.y + 0.1 * p.z * p.z);
    });
    const Tangents tangents = make_tangents(mesh, mesh.scene.uvs[0]);
    for (std::uint32_t t = 0; t < mesh.geometry.triangles.size(); ++t) {
        const SurfacePoint point{t, {0.3f, 0.1f * static_cast<float>(t % 7)}};
        const glm::vec3 direction =
            glm::normalize(mesh.surface.normals[mesh.surface.corners(mesh.geometry)[t].x] +
                           glm::vec3(0.2, 0.7, 0));
        const glm::vec3 held = to_tangent_space(mesh, tangents, point, direction);
        EXPECT_NEAR(glm::length(held), 1.0f, 1e-6f);
        EXPECT_LT(glm::distance(decoded(mesh, tangents, point, held), glm::dvec3(direction)), 1e-5);
    }
}

// Two slopes of a roof that is smooth at the ridge: the tangents there are weighted by angles, and
// halves that are mirrored to each other share none.
TEST(Tangents, AreSharedBySmoothUnmirroredNeighbours)
{
    Scene roof = scenes::grid(2, 1, [](double s, double t) {
        return glm::dvec3(s < 0.75 ? 2.0 * s : 1.5, t, s == 0.5 ? 0.2 : 0.0);
    });
    for (const bool mirrored : {false, true}) {
        const Mesh mesh = mapped(roof, [&](glm::dvec3 p) {
            const double u = mirrored ? std::abs(p.x - 1.0) : p.x;
            return glm::dvec2(0.3 * u + 0.2 * p.y, 0.9 - 0.5 * p.y);
        });
        const Tangents tangents = make_tangents(mesh, mesh.scene.uvs[0]);
        // a corner at the ridge of each slope
        std::vector<glm::vec4> at_ridge[2];
        for (std::size_t t = 0; t < 4; ++t) {
            const glm::uvec3 corners = mesh.geometry.triangles[t];
            const auto x = [&](std::uint32_t v) { return mesh.scene.positions[v].x; };
            const int side = x(corners.x) + x(corners.y) + x(corners.z) > 3.0 ? 1 : 0;
            for (int k = 0; k < 3; ++k)
                if (x(corners[k]) == 1.0 && mesh.scene.positions[corners[k]].y == 0.0)
                    at_ridge[side].push_back(tangents[3 * t + static_cast<std::size_t>(k)]);
        }
        ASSERT_FALSE(at_ridge[0].empty() || at_ridge[1].empty());
        EXPECT_EQ(at_ridge[0].front() == at_ridge[1].front(), !mirrored);
        EXPECT_GT(at_ridge[0].front().x * (mirrored ? -1.0f : 1.0f), 0.9f);
        EXPECT_GT(at_ridge[1].front().x, 0.9f);
        EXPECT_EQ(at_ridge[0].front().w, mirrored ? -1.0f : 1.0f);
        EXPECT_EQ(at_ridge[1].front().w, 1.0f);
    }
}

TEST(Tangents, AreTheFilesWhereItHasSome)
{
    const Mesh mesh = mapped(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1),
                             [](glm::dvec3 p) { return glm::dvec2(p.x, p.y); });
    std::vector<glm::vec4> file(4, {0, 1, 0, 1});
    file[mesh.geometry.triangles[1].z] = glm::vec4(0.0f);  // not of the first triangle
    const Tangents made = make_tangents(mesh, mesh.scene.uvs[0]);
    const Tangents taken = make_tangents(mesh, mesh.scene.uvs[0], file);
    for (std::size_t corner = 0; corner < 6; ++corner)
        EXPECT_EQ(taken[corner], corner < 3 ? glm::vec4(0, 1, 0, 1) : made[corner]);
}

}  // namespace
}  // namespace surfelao
