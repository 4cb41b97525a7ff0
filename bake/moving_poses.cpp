#include "bake/moving_poses.h"

#include "bake/roles.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <utility>

namespace surfelao {
namespace {

glm::dvec3 moved(const glm::dmat4& matrix, const glm::dvec3& position)
{
    return glm::dvec3(matrix * glm::dvec4(position, 1.0));
}

/// Where a normal goes that stands on a surface which the matrix moves; zero where that is flat.
glm::vec3 moved_normal(const glm::dmat3& matrix, glm::vec3 normal)
{
    const glm::dmat3 cofactors(glm::cross(matrix[1], matrix[2]), glm::cross(matrix[2], matrix[0]),
                               glm::cross(matrix[0], matrix[1]));
    const glm::dvec3 there = glm::determinant(matrix) < 0.0 ? -(cofactors * glm::dvec3(normal))
                                                            : cofactors * glm::dvec3(normal);
    const double length = glm::length(there);
    return length > 0.0 ? glm::vec3(there / length) : glm::vec3(0.0f);
}

/// Columns: two edges of a triangle and its unit normal.
glm::dmat3 basis_of(const std::vector<glm::vec3>& positions, const glm::uvec3& t)
{
    const glm::dvec3 first(positions[t.y] - positions[t.x]),
        second(positions[t.z] - positions[t.x]);
    const glm::dvec3 normal = glm::cross(first, second);
    const double length = glm::length(normal);
    return {first, second, length > 0.0 ? normal / length : glm::dvec3(0.0)};
}

}  // namespace

Scene read_rest(const std::filesystem::path& input, const ReadOptions& reading)
{
    ReadOptions at_rest = reading;
    at_rest.moment.reset();
    at_rest.is_played = true;
    return read_scene(input, at_rest);
}

std::vector<Scene> read_occluders(const PartChoice& choice, const ReadOptions& reading)
{
    std::vector<Scene> scenes;
    for (const std::filesystem::path& file : choice.occluders) {
        scenes.push_back(read_rest(file, reading));
        check_occluder(scenes.back());
    }
    return scenes;
}

bool is_same_pose(const PartPose& a, const PartPose& b)
{
    return a.is_gone == b.is_gone && a.from_rest == b.from_rest && a.positions == b.positions;
}

void move_scene(const Scene& rest, const Motion& motion, const std::vector<PartPose>& poses,
                Scene& scene)
{
    for (std::size_t p = 0; p < poses.size(); ++p) {
        if (motion.bodies()[p] == 0)
            continue;
        const Part& part = rest.parts[p];
        const PartPose& pose = poses[p];
        const glm::dmat3 linear(pose.from_rest);
        for (std::uint32_t i = 0; i < part.vertex_count; ++i) {
            const std::uint32_t v = part.first_vertex + i;
            scene.positions[v] = pose.positions.empty() ? moved(pose.from_rest, rest.positions[v])
                                                        : pose.positions[i];
            if (!scene.normals.empty())
                scene.normals.values[v] = pose.normals.empty()
                                              ? moved_normal(linear, rest.normals.values[v])
                                              : pose.normals[i];
        }
        const bool is_turned = glm::determinant(linear) < 0.0;
        for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count;
             ++t) {
            scene.triangles[t] = rest.triangles[t];
            if (is_turned)
                std::swap(scene.triangles[t].y, scene.triangles[t].z);
        }
    }
}

void include(const Scene& scene, const std::vector<PartPose>& poses,
             const std::vector<bool>& left_out, Box& box)
{
    for (std::size_t p = 0; p < scene.parts.size(); ++p) {
        if (poses[p].is_gone)
            continue;
        const Part& part = scene.parts[p];
        for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count;
             ++t) {
            if (!left_out.empty() && left_out[t])
                continue;
            for (int corner = 0; corner < 3; ++corner)
                box.include(scene.positions[scene.triangles[t][corner]]);
        }
    }
}

void follow_triangles(const std::vector<glm::vec3>& made_positions,
                      const std::vector<glm::vec3>& made_normals, Mesh& mesh)
{
    std::vector<glm::dvec3> sums(made_normals.size(), glm::dvec3(0.0));
    for (std::size_t t = 0; t < mesh.geometry.triangles.size(); ++t) {
        const glm::uvec3 triangle = mesh.geometry.triangles[t];
        const glm::dmat3 from = basis_of(made_positions, triangle);
        const glm::dmat3 to = basis_of(mesh.geometry.positions, triangle);
        const double area = glm::length(glm::cross(to[0], to[1]));
        if (!(area > 0.0))
            continue;
        const glm::dmat3 turn = glm::inverse(glm::transpose(to)) * glm::transpose(from);
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t wedge = mesh.surface.corners(mesh.geometry)[t][corner];
            const glm::dvec3 normal = turn * glm::dvec3(made_normals[wedge]);
            const double length = glm::length(normal);
            if (length > 0.0)
                sums[wedge] += area / length * normal;
        }
    }
    for (std::size_t wedge = 0; wedge < sums.size(); ++wedge) {
        const double length = glm::length(sums[wedge]);
        if (length > 0.0)
            mesh.surface.normals[wedge] = glm::vec3(sums[wedge] / length);
    }
}

}  // namespace surfelao
