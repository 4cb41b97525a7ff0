#include "atlas/tangents.h"

#include "surfels/edges.h"
#include "surfels/errors.h"
#include "surfels/union_find.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace surfelao {
namespace {

/// The square of a length, in diagonals, that is none: no direction follows from it.
constexpr double kNoLength = 1e-30;

/// A triangle as a tangent space sees it.
struct TangentTriangle {
    glm::dvec2 uvs[3];
    glm::dvec3 along_u{0.0};  ///< unit length; zero where there is none
    float sign = 0.0f;        ///< 1: v as OBJ has it turns with the triangle; -1: mirrored; 0: flat
};

glm::dvec3 unit_or_zero(glm::dvec3 vector)
{
    const double square = glm::dot(vector, vector);
    return square > kNoLength ? vector / std::sqrt(square) : glm::dvec3(0.0);
}

glm::dvec3 corner_position(const Geometry& geometry, std::uint32_t corner)
{
    return geometry.positions[geometry.triangles[corner / 3][static_cast<int>(corner % 3)]];
}

glm::dvec3 corner_normal(const Mesh& mesh, std::uint32_t corner)
{
    const glm::uvec3 wedges = mesh.surface.corners(mesh.geometry)[corner / 3];
    return mesh.surface.normals[wedges[static_cast<int>(corner % 3)]];
}

TangentTriangle tangent_triangle(const Geometry& geometry, const UvSet& uvs, std::uint32_t triangle)
{
    constexpr glm::vec2 kCorners[3] = {{0, 0}, {1, 0}, {0, 1}};
    TangentTriangle made;
    for (int k = 0; k < 3; ++k) {
        const std::optional<glm::dvec2> uv = uv_at(geometry, uvs, {triangle, kCorners[k]});
        if (!uv)
            return made;
        made.uvs[k] = {uv->x, 1.0 - uv->y};
    }
    const glm::dvec2 second = made.uvs[1] - made.uvs[0], third = made.uvs[2] - made.uvs[0];
    const double twice = second.x * third.y - second.y * third.x;
    if (twice == 0.0)
        return made;
    const glm::dvec3 origin = corner_position(geometry, 3 * triangle);
    const glm::dvec3 a = corner_position(geometry, 3 * triangle + 1) - origin;
    const glm::dvec3 b = corner_position(geometry, 3 * triangle + 2) - origin;
    made.sign = twice > 0.0 ? 1.0f : -1.0f;
    made.along_u = unit_or_zero((third.y * a - second.y * b) / twice);
    return made;
}

/// Corners at one end of a common edge that share a tangent.
bool are_alike(const Mesh& mesh, const std::vector<TangentTriangle>& triangles, std::uint32_t a,
               std::uint32_t b)
{
    return triangles[a / 3].uvs[a % 3] == triangles[b / 3].uvs[b % 3] &&
           glm::dot(corner_normal(mesh, a), corner_normal(mesh, b)) >= kSameNormal;
}

/// Joins the corners that share a tangent, edge by edge.
UnionFind tangent_groups(const Mesh& mesh, const std::vector<TangentTriangle>& triangles)
{
    UnionFind groups(3 * triangles.size());
    const auto join = [&](const EdgeSide& rising, const EdgeSide& falling) {
        const std::uint32_t a = rising.triangle(), b = falling.triangle();
        const std::uint32_t low[2] = {rising.side(), 3 * b + (falling.side() % 3 + 1) % 3};
        const std::uint32_t high[2] = {3 * a + (rising.side() % 3 + 1) % 3, falling.side()};
        if (triangles[a].sign != 0.0f && triangles[a].sign == triangles[b].sign &&
            are_alike(mesh, triangles, low[0], low[1]) &&
            are_alike(mesh, triangles, high[0], high[1])) {
            groups.join(low[0], low[1]);
            groups.join(high[0], high[1]);
        }
    };
    Edges(mesh.geometry).for_each([&](std::uint32_t, std::span<const EdgeSide> sides) {
        if (sides.size() > kMostTangentSides)
            return;
        for (const EdgeSide& rising : sides)
            for (const EdgeSide& falling : sides)
                if (rising.rises() && !falling.rises())
                    join(rising, falling);
    });
    return groups;
}

/// The angle of a triangle at a corner, seen along the normal.
double angle_at(const Geometry& geometry, std::uint32_t corner, glm::dvec3 normal)
{
    const std::uint32_t first = corner - corner % 3;
    const glm::dvec3 origin = corner_position(geometry, corner);
    glm::dvec3 sides[2];
    for (std::uint32_t k = 0; k < 2; ++k) {
        const glm::dvec3 side =
            corner_position(geometry, first + (corner % 3 + k + 1) % 3) - origin;
        sides[k] = unit_or_zero(side - glm::dot(side, normal) * normal);
    }
    return std::acos(std::clamp(glm::dot(sides[0], sides[1]), -1.0, 1.0));
}

void take_file_tangents(const Geometry& geometry, std::span<const glm::vec4> of_vertices,
                        Tangents& tangents)
{
    SURFELAO_CHECK(of_vertices.size() == geometry.positions.size());
    const auto has_length = [](glm::vec4 tangent) {
        return unit_or_zero(glm::vec3(tangent)) != glm::dvec3(0.0) && tangent.w != 0.0f;
    };
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        const glm::uvec3 corners = geometry.triangles[t];
        if (has_length(of_vertices[corners.x]) && has_length(of_vertices[corners.y]) &&
            has_length(of_vertices[corners.z]))
            for (int k = 0; k < 3; ++k)
                tangents[3 * t + static_cast<std::size_t>(k)] = of_vertices[corners[k]];
    }
}

}  // namespace

Tangents make_tangents(const Mesh& mesh, const UvSet& uvs, std::span<const glm::vec4> of_vertices)
{
    const std::size_t count = mesh.geometry.triangles.size();
    std::vector<TangentTriangle> triangles(count);
    for (std::uint32_t t = 0; t < count; ++t)
        triangles[t] = tangent_triangle(mesh.geometry, uvs, t);
    UnionFind groups = tangent_groups(mesh, triangles);
    std::vector<glm::dvec3> sums(3 * count, glm::dvec3(0.0));
    for (std::uint32_t corner = 0; corner < 3 * count; ++corner) {
        const glm::dvec3 along = triangles[corner / 3].along_u;
        const glm::dvec3 normal = corner_normal(mesh, corner);
        sums[groups.root(corner)] += angle_at(mesh.geometry, corner, normal) *
                                     unit_or_zero(along - glm::dot(along, normal) * normal);
    }
    Tangents tangents(3 * count, glm::vec4(0.0f));
    for (std::uint32_t corner = 0; corner < 3 * count; ++corner) {
        const TangentTriangle& triangle = triangles[corner / 3];
        const glm::dvec3 mean = unit_or_zero(sums[groups.root(corner)]);
        if (triangle.sign != 0.0f)
            tangents[corner] = {glm::vec3(mean == glm::dvec3(0.0) ? triangle.along_u : mean),
                                triangle.sign};
    }
    if (!of_vertices.empty())
        take_file_tangents(mesh.geometry, of_vertices, tangents);
    return tangents;
}

glm::vec3 to_tangent_space(const Mesh& mesh, const Tangents& tangents, const SurfacePoint& point,
                           glm::vec3 direction, bool green_down)
{
    const double weights[3] = {1.0 - double{point.at.x} - double{point.at.y}, point.at.x,
                               point.at.y};
    glm::dvec3 normal(0.0), tangent(0.0);
    for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t corner = 3 * point.triangle + k;
        normal += weights[k] * corner_normal(mesh, corner);
        tangent += weights[k] * glm::dvec3(glm::vec3(tangents[corner]));
    }
    const double sign = tangents[3 * point.triangle].w;
    const glm::dmat3 frame(tangent, sign * glm::cross(normal, tangent), normal);
    if (std::abs(glm::determinant(frame)) < kNoLength)
        return glm::vec3(0.0f);
    glm::dvec3 inside = unit_or_zero(glm::inverse(frame) * glm::dvec3(direction));
    if (green_down)
        inside.y = -inside.y;
    return inside;
}

}  // namespace surfelao
