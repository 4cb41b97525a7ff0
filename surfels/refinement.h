/// refinement.h: a scene's triangles cut into smaller ones at the middles of their edges.
#pragma once

#include "surfels/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Invariants: a new vertex is the middle of two that come before it, in a triangle of both, or,
/// where these are the same, a copy that some of its triangles have in its place; all triangles at
/// one edge, as the welded surface has it (Geometry::welded), are cut there alike, so that no
/// corner of a piece lies within the edge of another. A single piece has its corners in the
/// triangle's order.
struct Refinement {
    std::uint32_t old_vertices = 0;
    std::vector<glm::uvec2> parents;   ///< of each new vertex; their numbers follow the old ones'
    std::vector<glm::uvec3> pieces;    ///< in the order of the old triangles, wound like them
    std::vector<std::uint32_t> first;  ///< of each old triangle's pieces; and one more, their end

    [[nodiscard]] std::span<const glm::uvec3> pieces_of(std::size_t triangle) const
    {
        return std::span(pieces).subspan(first[triangle], first[triangle + 1] - first[triangle]);
    }
    [[nodiscard]] bool splits(std::size_t triangle) const
    {
        return first[triangle + 1] - first[triangle] > 1;
    }
};

/// The mean of two directions, of the mean of their lengths; the first where they cancel.
[[nodiscard]] glm::dvec3 middle_direction(const glm::dvec3& a, const glm::dvec3& b);

/// Something that the corners of a triangle have, at all vertices of its pieces.
template <class Value>
class PieceValues {
public:
    /// corners: of the old triangle; values: one for each. middle(a, b): of two vertices' values,
    /// called once for each new vertex, in their order. O(pieces log pieces).
    template <class Middle>
    PieceValues(const Refinement& refinement, std::size_t triangle, const glm::uvec3& corners,
                const std::array<Value, 3>& values, const Middle& middle)
    {
        vertices_.assign({corners.x, corners.y, corners.z});
        for (const glm::uvec3& piece : refinement.pieces_of(triangle))
            vertices_.insert(vertices_.end(), {piece.x, piece.y, piece.z});
        std::ranges::sort(vertices_);
        vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
        for (const std::uint32_t vertex : vertices_) {
            if (vertex >= refinement.old_vertices) {
                const glm::uvec2 of = refinement.parents[vertex - refinement.old_vertices];
                values_.push_back(middle((*this)[of.x], (*this)[of.y]));
            } else {
                values_.push_back(
                    values[vertex == corners.x ? 0u : (vertex == corners.y ? 1u : 2u)]);
            }
        }
    }

    /// Of a corner of a piece.
    [[nodiscard]] const Value& operator[](std::uint32_t vertex) const
    {
        const auto place = std::ranges::lower_bound(vertices_, vertex);
        return values_[static_cast<std::size_t>(place - vertices_.begin())];
    }

    /// visit(vertex, value) may change it.
    template <class Visit>
    void for_each(const Visit& visit)
    {
        for (std::size_t i = 0; i < vertices_.size(); ++i)
            visit(vertices_[i], values_[i]);
    }

private:
    std::vector<std::uint32_t> vertices_;  ///< rising
    std::vector<Value> values_;
};

/// A scene whose file nobody needs, without an asset: positions, parts and labels; normals, texture
/// coordinates and tangents are left out. New vertices stand behind the old ones of their part.
/// O(n).
[[nodiscard]] Scene plain_refined(const Scene& scene, const Refinement& refinement);

}  // namespace surfelao
