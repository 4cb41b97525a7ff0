/// edges.h: which triangles meet at an edge, and in which direction each runs along it.
///
/// The one list of edges for all that asks about neighbours. Edges are between positions
/// (Geometry::welded), so seams in the file do not part neighbours, and any number of triangles may
/// meet at one. What needs a manifold's loops and fans is in half_edges.h.
#pragma once

#include "surfels/buckets.h"
#include "surfels/geometry.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Side i of triangle t runs from its corner i to the next: 3 t + i.
using Side = std::uint32_t;

/// A triangle's side as seen from the edge that it lies on.
struct EdgeSide {
    std::uint32_t upper;         ///< the edge's vertex with the higher index, welded
    std::uint32_t side_and_way;  ///< 2 * side + 1 where it runs from the lower vertex to `upper`

    [[nodiscard]] Side side() const { return side_and_way >> 1; }
    [[nodiscard]] std::uint32_t triangle() const { return side_and_way / 6; }
    [[nodiscard]] bool rises() const { return (side_and_way & 1) != 0; }
};

class Edges {
public:
    /// left_out: one per triangle, nonzero for those that take no part; empty = none. No triangle
    /// may have two corners in one position (Geometry guarantees it). Fewer than 2^31 / 3
    /// triangles. O(n): two passes, 8 bytes a side, 4 a vertex. All threads.
    explicit Edges(const Geometry& geometry, std::span<const std::uint8_t> left_out = {});

    /// The sides of all edges whose vertex with the lower index is `lower`, by rising side.
    [[nodiscard]] std::span<const EdgeSide> at(std::uint32_t lower) const { return sides_[lower]; }

    /// Calls visit(lower, sides) for each edge, by rising (lower, upper): its sides by rising side.
    /// O(n), and O(k log k) for a vertex of k edges.
    template <class Visit>
    void for_each(const Visit& visit) const
    {
        for_each_from(0, static_cast<std::uint32_t>(sides_.owner_count()), visit);
    }

    /// The same, for edges whose lower vertex is from `begin` to before `end`: a thread's share.
    template <class Visit>
    void for_each_from(std::uint32_t begin, std::uint32_t end, const Visit& visit) const
    {
        std::vector<EdgeSide> sorted;
        const auto key = [](const EdgeSide& side) {
            return std::uint64_t{side.upper} << 32 | side.side_and_way;
        };
        for (std::uint32_t lower = begin; lower < end; ++lower) {
            const std::span<const EdgeSide> own = sides_[lower];
            sorted.assign(own.begin(), own.end());
            std::sort(sorted.begin(), sorted.end(),
                      [&](const EdgeSide& a, const EdgeSide& b) { return key(a) < key(b); });
            for_each_run(
                std::span<const EdgeSide>(sorted),
                [](const EdgeSide& a, const EdgeSide& b) { return a.upper == b.upper; },
                [&](std::span<const EdgeSide> sides) { visit(lower, sides); });
        }
    }

private:
    Buckets<EdgeSide> sides_;
};

/// The corners (3 * triangle + corner) at each position, at its lowest vertex, by rising corner.
/// Fewer than 2^32 / 3 triangles. O(n).
[[nodiscard]] Buckets<std::uint32_t> corners_around(const std::vector<glm::uvec3>& triangles,
                                                    const std::vector<std::uint32_t>& welded);

}  // namespace surfelao
