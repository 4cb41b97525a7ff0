#include "tree/masks/tiles.h"

#include "surfels/edges.h"
#include "tree/masks/constants.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

class Tiler {
public:
    Tiler(const Geometry& geometry, std::span<const glm::vec3> normals)
        : geometry_(geometry),
          count_(static_cast<std::uint32_t>(geometry.triangles.size())),
          normals_(normals),
          taken_(count_, 0)
    {
    }

    RawVector<MaskTile> run(MaskPairs pairs)
    {
        tiles_.reserve(count_);
        if (pairs == MaskPairs::found) {
            pair_next();
            if (has_flat_edges())
                pair_others();
        }
        for (std::uint32_t t = 0; t < count_; ++t) {
            const glm::uvec3 v = geometry_.triangles[t];
            if (taken_[t] == 0)
                tiles_.push_back({{v.x, v.y, v.z, v.z}, {t, t}});
        }
        return std::move(tiles_);
    }

private:
    std::uint32_t corner(std::uint32_t triangle, std::uint32_t i) const
    {
        return geometry_.triangles[triangle][static_cast<int>(i % 3)];
    }
    std::uint32_t from(Side side) const { return geometry_.welded[corner(side / 3, side)]; }
    std::uint32_t to(Side side) const { return geometry_.welded[corner(side / 3, side % 3 + 1)]; }

    bool may_be_flat(std::uint32_t s, std::uint32_t t) const
    {
        return glm::dot(normals_[s], normals_[t]) > kMaskPairCosine;
    }

    void pair_next()
    {
        for (std::uint32_t t = 0; t + 1 < count_; ++t) {
            if (!may_be_flat(t, t + 1))
                continue;
            for (Side i = 3 * t; i < 3 * t + 3 && taken_[t] == 0; ++i) {
                for (Side k = 3 * t + 3; k < 3 * t + 6; ++k) {
                    if (from(i) == to(k) && to(i) == from(k))
                        pair(i, k);
                }
            }
        }
    }

    /// Whether many edges between triangles that are left are flat, by a look at some.
    bool has_flat_edges() const
    {
        const std::size_t vertices = geometry_.positions.size();
        const std::size_t stride = vertices / kMaskPairSample + 1;
        std::vector<std::uint8_t> examined(vertices, 0);
        for (std::size_t v = 0; v < vertices; v += stride)
            examined[geometry_.welded[v]] = 1;
        std::vector<std::uint8_t> left_out(count_);
        for (std::uint32_t t = 0; t < count_; ++t) {
            left_out[t] = taken_[t] != 0 || (examined[from(3 * t)] | examined[to(3 * t)] |
                                             examined[to(3 * t + 1)]) == 0;
        }
        std::size_t edges = 0, flat = 0;
        Edges(geometry_, left_out)
            .for_each([&](std::uint32_t lower, std::span<const EdgeSide> sides) {
                if (sides.size() != 2 || sides[0].rises() == sides[1].rises())
                    return;
                const std::size_t ends = std::size_t{examined[lower]} + examined[sides[0].upper];
                edges += ends;
                flat += may_be_flat(sides[0].triangle(), sides[1].triangle()) ? ends : 0;
            });
        return static_cast<float>(flat) > kMaskPairFlatShare * static_cast<float>(edges);
    }

    void pair_others()
    {
        // what rises along an edge that another side falls along belongs to the triangle beyond it
        const Edges edges(geometry_, taken_);
        std::vector<std::array<Side, 2>> flat;
        for (Side side = 0; side < 3 * count_; ++side) {
            if (taken_[side / 3] != 0)
                continue;
            const std::uint32_t upper = from(side), lower = to(side);
            if (upper < lower)
                continue;
            for (const EdgeSide& other : edges.at(lower)) {
                if (other.upper == upper && other.rises() &&
                    may_be_flat(other.triangle(), side / 3))
                    flat.push_back({other.side(), side});
            }
        }
        for (const auto [side, other] : flat) {
            if (is_longest(side) && is_longest(other))
                pair(side, other);
        }
        for (const auto [side, other] : flat)
            pair(side, other);
    }

    bool is_longest(Side side) const
    {
        const auto length2 = [&](Side of) {
            const glm::vec3 edge = geometry_.positions[to(of)] - geometry_.positions[from(of)];
            return glm::dot(edge, edge);
        };
        const Side first = side / 3 * 3;
        const float here = length2(side);
        return here >= length2(first) && here >= length2(first + 1) && here >= length2(first + 2);
    }

    /// Makes one tile of the triangles of two sides along one edge, if they are free and fit.
    void pair(Side side, Side other)
    {
        const std::uint32_t s = side / 3, t = other / 3;
        if (taken_[s] != 0 || taken_[t] != 0)
            return;
        const glm::uvec4 v(corner(s, side % 3 + 1), corner(s, side % 3 + 2), corner(s, side),
                           corner(t, other % 3 + 2));
        const MaskTile tile{v, {s, t}};
        if (!is_flat(tile, geometry_.positions))
            return;
        taken_[s] = taken_[t] = 1;
        tiles_.push_back(tile);
    }

    const Geometry& geometry_;
    std::uint32_t count_;
    std::span<const glm::vec3> normals_;
    std::vector<std::uint8_t> taken_;
    RawVector<MaskTile> tiles_;
};

}  // namespace

bool is_flat(const MaskTile& tile, std::span<const glm::vec3> positions)
{
    const glm::uvec4 v = tile.corners;
    if (v.z == v.w)
        return true;
    const glm::vec3 a = positions[v.x], b = positions[v.y], c = positions[v.z], d = positions[v.w];
    const glm::vec3 normal = glm::cross(c - a, d - b);
    const float area = glm::length(normal);
    const float across = glm::length(d - b);
    const float slack =
        std::min(kMaskPairSlack * std::max(glm::length(c - a), across), kMaskPairSlackLength);
    const auto beside = [&](glm::vec3 before, glm::vec3 at, glm::vec3 after) {
        return glm::dot(glm::cross(at - before, after - at), normal) < -slack * across * area;
    };
    return !(std::abs(glm::dot(a - b + c - d, normal)) > 2.0f * slack * area || beside(d, a, b) ||
             beside(b, c, d));
}

RawVector<MaskTile> tiles_of(const Geometry& geometry, std::span<const glm::vec3> normals,
                             MaskPairs pairs)
{
    return Tiler(geometry, normals).run(pairs);
}

}  // namespace surfelao
