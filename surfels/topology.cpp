#include "surfels/topology.h"

#include "surfels/errors.h"
#include "surfels/union_find.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace surfelao {
namespace {

/// A body is flat when its volume is at most its area times this length: what rounding to floats of
/// the unit frame could make of nothing.
constexpr double kFlatThickness = 1e-7;

/// Holes that are to be small span at most this share of their body's area.
constexpr double kSmallHoles = 0.03;

/// Items sorted by an owner below `owner_count`, then by value: counting sort, then each owner's
/// own (few, unless a vertex has an enormous valence; then n log n).
template <class Item>
class Buckets {
public:
    /// for_each(put) must call put(owner, item) for every item, in the same order each time.
    template <class ForEach>
    Buckets(std::size_t owner_count, const ForEach& for_each) : first_(owner_count + 1, 0)
    {
        for_each([this](std::uint32_t owner, const Item&) { ++first_[owner + 1]; });
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        items_.resize(first_.back());
        std::vector<std::uint64_t> next(first_.begin(), first_.end() - 1);
        for_each([&](std::uint32_t owner, const Item& item) { items_[next[owner]++] = item; });
        for (std::size_t owner = 0; owner < owner_count; ++owner)
            std::sort(items_.begin() + static_cast<std::ptrdiff_t>(first_[owner]),
                      items_.begin() + static_cast<std::ptrdiff_t>(first_[owner + 1]));
    }

    /// Calls visit(owner, items) for each run of an owner's items that are alike.
    template <class Alike, class Visit>
    void for_each_run(const Alike& alike, const Visit& visit) const
    {
        for (std::uint32_t owner = 0; owner + 1 < first_.size(); ++owner) {
            for (std::uint64_t begin = first_[owner]; begin < first_[owner + 1];) {
                std::uint64_t end = begin + 1;
                while (end < first_[owner + 1] && alike(items_[begin], items_[end]))
                    ++end;
                visit(owner, std::span<const Item>(&items_[begin], end - begin));
                begin = end;
            }
        }
    }

private:
    std::vector<std::uint64_t> first_;
    std::vector<Item> items_;
};

/// Corners of a triangle by rising index, and whether the turn was changed by that.
struct Sorted {
    std::array<std::uint32_t, 3> v;
    bool turned;
};

Sorted sorted(glm::uvec3 t)
{
    bool turned = false;
    const auto order = [&](std::uint32_t& a, std::uint32_t& b) {
        if (a > b) {
            std::swap(a, b);
            turned = !turned;
        }
    };
    order(t.x, t.y);
    order(t.y, t.z);
    order(t.x, t.y);
    return {{t.x, t.y, t.z}, turned};
}

/// Which triangles take no part because others use the same three positions (see topology.h), and
/// how many use the positions of an earlier one.
std::vector<bool> find_left_out(const std::vector<glm::uvec3>& triangles, std::size_t vertex_count,
                                std::uint64_t& duplicate_count)
{
    struct Item {
        std::uint32_t middle, high, face;
        auto operator<=>(const Item&) const = default;
    };
    const Buckets<Item> by_lowest(vertex_count, [&](const auto& put) {
        for (std::uint32_t face = 0; face < triangles.size(); ++face) {
            const Sorted s = sorted(triangles[face]);
            put(s.v[0], {s.v[1], s.v[2], face});
        }
    });
    std::vector<bool> left_out(triangles.size(), false);
    const auto alike = [](const Item& a, const Item& b) {
        return a.middle == b.middle && a.high == b.high;
    };
    by_lowest.for_each_run(alike, [&](std::uint32_t, std::span<const Item> same) {
        duplicate_count += same.size() - 1;
        std::array<std::size_t, 2> wound{};
        for (const Item& item : same)
            ++wound[sorted(triangles[item.face]).turned];
        // the winding in the majority is the surface's, once
        bool missing = wound[0] != wound[1];
        for (const Item& item : same) {
            const bool turned = sorted(triangles[item.face]).turned;
            left_out[item.face] = !missing || wound[turned] < wound[!turned];
            missing = missing && left_out[item.face];
        }
    });
    return left_out;
}

/// An edge with more faces in the one direction than in the other.
struct OpenEdge {
    std::uint32_t lower, upper;  ///< vertices
    std::uint32_t face;          ///< any at this edge
    int forward;                 ///< faces from lower to upper less those from upper to lower
    std::uint32_t body = 0, loop = 0;
};

/// What it takes to close each body, at its root: the vector areas of the loops of its open edges,
/// that is, of the least surfaces that could fill its holes or turn its misoriented patches.
std::vector<double> hole_areas(const Geometry& geometry, std::vector<OpenEdge> edges,
                               UnionFind& loops, UnionFind& bodies)
{
    for (OpenEdge& edge : edges) {
        edge.body = bodies.root(edge.face);
        edge.loop = loops.root(edge.lower);
    }
    const auto key = [](const OpenEdge& edge) {
        return std::array{edge.body, edge.loop, edge.lower, edge.upper};
    };
    std::sort(edges.begin(), edges.end(),
              [&](const OpenEdge& a, const OpenEdge& b) { return key(a) < key(b); });
    std::vector<double> areas(geometry.triangles.size(), 0.0);
    for (std::size_t i = 0; i < edges.size();) {
        const OpenEdge& first = edges[i];
        const glm::dvec3 origin = geometry.positions[first.loop];
        glm::dvec3 vector_area(0.0);
        for (; i < edges.size() && edges[i].body == first.body && edges[i].loop == first.loop;
             ++i) {
            const glm::dvec3 a = glm::dvec3(geometry.positions[edges[i].lower]) - origin;
            const glm::dvec3 b = glm::dvec3(geometry.positions[edges[i].upper]) - origin;
            vector_area += 0.5 * edges[i].forward * glm::cross(a, b);
        }
        areas[first.body] += glm::length(vector_area);
    }
    return areas;
}

}  // namespace

Topology analyse_topology(const Geometry& geometry)
{
    const std::size_t vertex_count = geometry.positions.size();
    std::vector<glm::uvec3> triangles = geometry.triangles;  // over welded vertices
    SURFELAO_CHECK(triangles.size() < (std::size_t{1} << 31));
    for (glm::uvec3& t : triangles)
        t = {geometry.welded[t.x], geometry.welded[t.y], geometry.welded[t.z]};

    Topology topology;
    const std::vector<bool> left_out =
        find_left_out(triangles, vertex_count, topology.duplicate_triangle_count);

    // the faces at each edge, found at its lower vertex: other vertex, face, direction in 64 bits
    const auto face_of = [](std::uint64_t item) {
        return static_cast<std::uint32_t>(item & 0xFFFFFFFFu) >> 1;
    };
    const Buckets<std::uint64_t> by_lower(vertex_count, [&](const auto& put) {
        for (std::uint32_t face = 0; face < triangles.size(); ++face) {
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t from = triangles[face][corner];
                const std::uint32_t to = triangles[face][(corner + 1) % 3];
                const std::uint64_t forward = from < to ? 1 : 0;
                put(std::min(from, to),
                    std::uint64_t{std::max(from, to)} << 32 | std::uint64_t{face} << 1 | forward);
            }
        }
    });

    // bodies hang together over edges; they stay closed while all edges are balanced, either with
    // all faces or without those left out
    UnionFind bodies(triangles.size());
    UnionFind loops(vertex_count);  // of open edges
    std::vector<OpenEdge> open_edges;
    std::vector<bool> open_with_all(triangles.size(), false);
    std::vector<bool> open_without(triangles.size(), false);
    const auto same_edge = [](std::uint64_t a, std::uint64_t b) { return a >> 32 == b >> 32; };
    by_lower.for_each_run(
        same_edge, [&](std::uint32_t lower, std::span<const std::uint64_t> faces) {
            const std::uint32_t first = face_of(faces[0]);
            int all_forward = 0;  // faces in the one direction less those in the other
            int forward = 0;
            int count = 0;
            for (const std::uint64_t face : faces) {
                const int step = face & 1 ? 1 : -1;
                const int counts = left_out[face_of(face)] ? 0 : 1;
                all_forward += step;
                forward += counts * step;
                count += counts;
                bodies.join(first, face_of(face));
            }
            topology.boundary_edge_count += count == 1 ? 1 : 0;
            topology.nonmanifold_edge_count += count > 2 ? 1 : 0;
            topology.misoriented_edge_count += count == 2 && forward != 0 ? 1 : 0;
            if (all_forward != 0)
                open_with_all[first] = true;
            if (forward != 0) {
                open_without[first] = true;
                const auto upper = static_cast<std::uint32_t>(faces[0] >> 32);
                loops.join(lower, upper);
                open_edges.push_back({lower, upper, first, forward});
            }
        });
    for (std::uint32_t face = 0; face < triangles.size(); ++face) {
        const std::uint32_t body = bodies.root(face);
        open_with_all[body] = open_with_all[body] || open_with_all[face];
        open_without[body] = open_without[body] || open_without[face];
    }
    const auto is_open = [&](std::uint32_t body) {
        return open_with_all[body] && open_without[body];
    };

    // signed volume and area of each body, at its root, about a corner of its own
    std::vector<double> volume(triangles.size(), 0.0);
    std::vector<double> area(triangles.size(), 0.0);
    UnionFind components(vertex_count);
    for (std::uint32_t face = 0; face < triangles.size(); ++face) {
        const glm::uvec3 t = triangles[face];
        components.join(t.x, t.y);
        components.join(t.y, t.z);
        if (left_out[face])
            continue;
        const std::uint32_t body = bodies.root(face);
        const glm::dvec3 origin = geometry.positions[triangles[body].x];
        const glm::dvec3 a = glm::dvec3(geometry.positions[t.x]) - origin;
        const glm::dvec3 b = glm::dvec3(geometry.positions[t.y]) - origin;
        const glm::dvec3 c = glm::dvec3(geometry.positions[t.z]) - origin;
        volume[body] += glm::dot(a, glm::cross(b, c)) / 6.0;
        area[body] += glm::length(glm::cross(b - a, c - a)) / 2.0;
    }
    const std::vector<double> holes = hole_areas(geometry, open_edges, loops, bodies);
    const auto side_of_body = [&](std::uint32_t body) {
        const bool has_a_back = !is_open(body) || holes[body] <= kSmallHoles * area[body];
        if (!has_a_back || std::abs(volume[body]) <= kFlatThickness * area[body])
            return OccluderSide::both;
        return volume[body] > 0.0 ? OccluderSide::back : OccluderSide::front;
    };

    // a vertex has the side that all its bodies agree on
    std::vector<bool> has_body(vertex_count, false);
    topology.sides.assign(vertex_count, OccluderSide::both);
    for (std::uint32_t face = 0; face < triangles.size(); ++face) {
        if (left_out[face])
            continue;
        const OccluderSide side = side_of_body(bodies.root(face));
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t v = triangles[face][corner];
            if (!has_body[v] || topology.sides[v] == side)
                topology.sides[v] = side;
            else
                topology.sides[v] = OccluderSide::both;
            has_body[v] = true;
        }
    }

    // a component is closed when it has bodies and all of them are
    enum : std::uint8_t { unused, sheets, closed, ajar };
    std::vector<std::uint8_t> state(vertex_count, unused);
    for (std::uint32_t face = 0; face < triangles.size(); ++face) {
        const std::uint8_t is = left_out[face]               ? sheets
                                : is_open(bodies.root(face)) ? ajar
                                                             : closed;
        std::uint8_t& of_component = state[components.root(triangles[face].x)];
        of_component = std::max(of_component, is);
    }
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        topology.component_count += state[v] != unused ? 1 : 0;
        topology.closed_component_count += state[v] == closed ? 1 : 0;
    }
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        topology.sides[v] = topology.sides[geometry.welded[v]];
    return topology;
}

std::vector<OccluderSide> sides_of(const SurfelCloud& cloud, const Topology& topology)
{
    std::vector<OccluderSide> sides(cloud.surfels.size());
    for (std::size_t i = 0; i < sides.size(); ++i)
        sides[i] = topology.sides[cloud.vertices[i]];
    return sides;
}

}  // namespace surfelao
