#include "surfels/topology.h"

#include "surfels/buckets.h"
#include "surfels/edges.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/repeated.h"
#include "surfels/union_find.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace surfelao {
namespace {

/// A body is flat when its volume is at most its area times this length: what rounding to floats of
/// the unit frame could make of nothing.
constexpr double kFlatThickness = 1e-7;

/// Holes that are to be small span at most this share of their body's area.
constexpr double kSmallHoles = 0.03;

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
std::vector<bool> find_left_out(const std::vector<glm::uvec3>& triangles,
                                const std::vector<std::uint32_t>& welded,
                                std::uint64_t& duplicate_count)
{
    struct Item {
        std::array<std::uint32_t, 3> places;
        std::uint32_t face;
        auto operator<=>(const Item&) const = default;
    };
    std::vector<Item> items;
    for (const std::uint32_t face : maybe_repeated(triangles, welded))
        items.push_back({sorted(triangles[face]).v, face});
    std::sort(items.begin(), items.end());
    std::vector<bool> left_out(triangles.size(), false);
    const auto alike = [](const Item& a, const Item& b) { return a.places == b.places; };
    const auto judge = [&](std::span<const Item> same) {
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
    };
    for_each_run(std::span<const Item>(items), alike, judge);
    return left_out;
}

/// An edge with more faces in the one direction than in the other.
struct OpenEdge {
    std::uint32_t lower, upper;  ///< vertices
    std::uint32_t face;          ///< any at this edge
    int forward;                 ///< faces from lower to upper less those from upper to lower
    std::uint32_t body = 0, loop = 0;
};

/// What hangs together over edges. A body is named by its lowest triangle.
struct Bodies {
    UnionFind of_face;
    UnionFind loops;  ///< of open edges, over vertices
    std::vector<OpenEdge> open_edges;
    std::vector<bool> open;  ///< at a body's name: neither all its faces nor those that count
                             ///< balance at every edge
};

Bodies find_bodies(const Geometry& geometry, const std::vector<bool>& left_out, Topology& topology)
{
    const std::size_t face_count = geometry.triangles.size();
    Bodies bodies{UnionFind(face_count), UnionFind(geometry.positions.size()), {}, {}};
    std::vector<bool> open_with_all(face_count, false);
    std::vector<bool> open_without(face_count, false);
    Edges(geometry).for_each([&](std::uint32_t lower, std::span<const EdgeSide> sides) {
        const std::uint32_t first = sides[0].triangle();
        int all_forward = 0;  // faces in the one direction less those in the other
        int forward = 0;
        int count = 0;
        for (const EdgeSide& side : sides) {
            const int step = side.rises() ? 1 : -1;
            const int counts = left_out[side.triangle()] ? 0 : 1;
            all_forward += step;
            forward += counts * step;
            count += counts;
            bodies.of_face.join(first, side.triangle());
        }
        topology.boundary_edge_count += count == 1 ? 1 : 0;
        topology.nonmanifold_edge_count += count > 2 ? 1 : 0;
        topology.misoriented_edge_count += count == 2 && forward != 0 ? 1 : 0;
        if (all_forward != 0)
            open_with_all[first] = true;
        if (forward != 0) {
            open_without[first] = true;
            bodies.loops.join(lower, sides[0].upper);
            bodies.open_edges.push_back({lower, sides[0].upper, first, forward});
        }
    });
    for (std::uint32_t face = 0; face < face_count; ++face) {
        const std::uint32_t body = bodies.of_face.root(face);
        open_with_all[body] = open_with_all[body] || open_with_all[face];
        open_without[body] = open_without[body] || open_without[face];
    }
    bodies.open.resize(face_count);
    for (std::uint32_t face = 0; face < face_count; ++face)
        bodies.open[face] = open_with_all[face] && open_without[face];
    return bodies;
}

/// What it takes to close each body, at its name: the vector areas of the loops of its open edges,
/// that is, of the least surfaces that could fill its holes or turn its misoriented patches.
std::vector<double> hole_areas(const Geometry& geometry, Bodies& bodies)
{
    std::vector<OpenEdge>& edges = bodies.open_edges;
    for (OpenEdge& edge : edges) {
        edge.body = bodies.of_face.root(edge.face);
        edge.loop = bodies.loops.root(edge.lower);
    }
    const auto key = [](const OpenEdge& edge) {
        return std::array{edge.body, edge.loop, edge.lower, edge.upper};
    };
    std::sort(edges.begin(), edges.end(),
              [&](const OpenEdge& a, const OpenEdge& b) { return key(a) < key(b); });
    std::vector<double> areas(geometry.triangles.size(), 0.0);
    const auto same_loop = [](const OpenEdge& a, const OpenEdge& b) {
        return a.body == b.body && a.loop == b.loop;
    };
    for_each_run(std::span<const OpenEdge>(edges), same_loop, [&](std::span<const OpenEdge> loop) {
        const glm::dvec3 origin = geometry.positions[loop[0].loop];
        glm::dvec3 vector_area(0.0);
        for (const OpenEdge& edge : loop) {
            const glm::dvec3 a = glm::dvec3(geometry.positions[edge.lower]) - origin;
            const glm::dvec3 b = glm::dvec3(geometry.positions[edge.upper]) - origin;
            vector_area += 0.5 * edge.forward * glm::cross(a, b);
        }
        areas[loop[0].body] += glm::length(vector_area);
    });
    return areas;
}

/// Which side casts, for each body at its name.
std::vector<OccluderSide> sides_of_bodies(const Geometry& geometry,
                                          const std::vector<glm::uvec3>& triangles,
                                          const std::vector<bool>& left_out, Bodies& bodies)
{
    // signed volume and area of each body, about a corner of its own
    std::vector<double> volume(triangles.size(), 0.0);
    std::vector<double> area(triangles.size(), 0.0);
    for (std::uint32_t face = 0; face < triangles.size(); ++face) {
        if (left_out[face])
            continue;
        const glm::uvec3 t = triangles[face];
        const std::uint32_t body = bodies.of_face.root(face);
        const glm::dvec3 origin = geometry.positions[triangles[body].x];
        const glm::dvec3 a = glm::dvec3(geometry.positions[t.x]) - origin;
        const glm::dvec3 b = glm::dvec3(geometry.positions[t.y]) - origin;
        const glm::dvec3 c = glm::dvec3(geometry.positions[t.z]) - origin;
        volume[body] += glm::dot(a, glm::cross(b, c)) / 6.0;
        area[body] += glm::length(glm::cross(b - a, c - a)) / 2.0;
    }
    const std::vector<double> holes = hole_areas(geometry, bodies);
    std::vector<OccluderSide> sides(triangles.size(), OccluderSide::both);
    for (std::uint32_t body = 0; body < triangles.size(); ++body) {
        const bool has_a_back = !bodies.open[body] || holes[body] <= kSmallHoles * area[body];
        if (has_a_back && std::abs(volume[body]) > kFlatThickness * area[body])
            sides[body] = volume[body] > 0.0 ? OccluderSide::back : OccluderSide::front;
    }
    return sides;
}

/// A component is closed when it has bodies and all of them are.
void count_components(const std::vector<glm::uvec3>& triangles, std::size_t vertex_count,
                      const std::vector<bool>& left_out, Bodies& bodies, Topology& topology)
{
    UnionFind components(vertex_count);
    for_all(triangles.size(), [&](std::size_t face) {
        components.join(triangles[face].x, triangles[face].y);
        components.join(triangles[face].y, triangles[face].z);
    });
    enum : std::uint8_t { unused, sheets, closed, ajar };
    std::vector<std::uint8_t> state(vertex_count, unused);
    for (std::uint32_t face = 0; face < triangles.size(); ++face) {
        const std::uint8_t is = left_out[face]                           ? sheets
                                : bodies.open[bodies.of_face.root(face)] ? ajar
                                                                         : closed;
        std::uint8_t& of_component = state[components.root(triangles[face].x)];
        of_component = std::max(of_component, is);
    }
    for (const std::uint8_t is : state) {
        topology.component_count += is != unused ? 1 : 0;
        topology.closed_component_count += is == closed ? 1 : 0;
    }
}

}  // namespace

Topology analyse_topology(const Geometry& geometry)
{
    const std::size_t vertex_count = geometry.positions.size();
    std::vector<glm::uvec3> triangles = geometry.triangles;  // over welded vertices
    for (glm::uvec3& t : triangles)
        t = {geometry.welded[t.x], geometry.welded[t.y], geometry.welded[t.z]};

    Topology topology;
    const std::vector<bool> left_out =
        find_left_out(triangles, geometry.welded, topology.duplicate_triangle_count);
    Bodies bodies = find_bodies(geometry, left_out, topology);
    const std::vector<OccluderSide> sides = sides_of_bodies(geometry, triangles, left_out, bodies);
    count_components(triangles, vertex_count, left_out, bodies, topology);
    for (const OccluderSide side : sides) {
        topology.solid_count += side != OccluderSide::both ? 1 : 0;
        topology.inward_count += side == OccluderSide::front ? 1 : 0;
    }

    // a vertex has the side that all its bodies agree on
    std::vector<bool> has_body(vertex_count, false);
    topology.sides.assign(vertex_count, OccluderSide::both);
    for (std::uint32_t face = 0; face < triangles.size(); ++face) {
        if (left_out[face])
            continue;
        const OccluderSide side = sides[bodies.of_face.root(face)];
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t v = triangles[face][corner];
            if (!has_body[v] || topology.sides[v] == side)
                topology.sides[v] = side;
            else
                topology.sides[v] = OccluderSide::both;
            has_body[v] = true;
        }
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
