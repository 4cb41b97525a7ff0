#include "surfels/geometry.h"

#include "surfels/edges.h"
#include "surfels/weld.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Below this share of the summed areas a vector sum counts as cancelled: its direction would be
/// rounding noise of the file's floats.
constexpr double kCancelled = 1e-5;

/// In the unit frame: no farther off stand vertices of what is left out, so that they are finite.
constexpr double kOutside = 1e6;

/// Calls again(triangle) for each triangle whose three positions an earlier one has.
///
/// Nearly all meshes have none, so a bit per hash value sifts first: only triangles that share
/// theirs with another one (a sixteenth by chance) are compared, in a table that fits the cache.
template <class Again>
void for_each_repeated(const std::vector<glm::uvec3>& triangles,
                       const std::vector<std::uint32_t>& welded, const Again& again)
{
    const auto key_of = [&](glm::uvec3 t) {  // the positions in rising order
        t = {welded[t.x], welded[t.y], welded[t.z]};
        const std::uint32_t low = std::min({t.x, t.y, t.z}), high = std::max({t.x, t.y, t.z});
        return glm::uvec3(low, t.x ^ t.y ^ t.z ^ low ^ high, high);
    };
    const auto hash_of = [](glm::uvec3 key) {
        std::uint64_t hash = (std::uint64_t{key.x} << 32 | key.y) * 0x9E3779B97F4A7C15u;
        hash = (hash ^ hash >> 29 ^ key.z) * 0x9E3779B97F4A7C15u;
        return hash ^ hash >> 32;
    };
    const std::size_t bits = std::bit_ceil(triangles.size() * 16);
    std::vector<bool> met(bits), met_again(bits);
    std::size_t suspects = 0;
    for (const glm::uvec3 triangle : triangles) {
        const std::size_t bit = hash_of(key_of(triangle)) & (bits - 1);
        if (met[bit]) {
            met_again[bit] = true;
            ++suspects;
        }
        met[bit] = true;
    }

    constexpr glm::uvec3 kEmpty{0, 0, 0};  // no triangle with area has its corners in one position
    std::vector<glm::uvec3> slots(std::bit_ceil(suspects * 4 + 1), kEmpty);  // <= half full
    for (const glm::uvec3 triangle : triangles) {
        const glm::uvec3 key = key_of(triangle);
        const std::uint64_t hash = hash_of(key);
        if (!met_again[hash & (bits - 1)])
            continue;
        std::size_t slot = (hash >> 32) & (slots.size() - 1);
        while (slots[slot] != kEmpty && slots[slot] != key)
            slot = (slot + 1) & (slots.size() - 1);
        if (slots[slot] == key)
            again(triangle);
        slots[slot] = key;
    }
}

/// A position that only dropped triangles use takes the normal of the nearest neighbour along them
/// (breadth first, so chains of degenerate triangles end at a real neighbour).
void borrow_normals(const std::vector<glm::uvec3>& dropped, Geometry& geometry)
{
    if (dropped.empty())
        return;
    const std::vector<std::uint32_t>& welded = geometry.welded;
    const Buckets<std::uint32_t> corners = corners_around(dropped, welded);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t v = 0; v < welded.size(); ++v) {
        if (!corners[v].empty() && geometry.normals[v] != glm::vec3(0.0f))
            queue.push_back(v);
    }
    for (std::size_t head = 0; head < queue.size(); ++head) {
        const std::uint32_t from = queue[head];
        for (const std::uint32_t at : corners[from]) {
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t to = welded[dropped[at / 3][corner]];
                if (geometry.normals[to] == glm::vec3(0.0f)) {
                    geometry.normals[to] = geometry.normals[from];
                    queue.push_back(to);
                }
            }
        }
    }
}

/// What the kept triangles give to the places and vertices around them.
struct Sums {
    explicit Sums(std::size_t vertex_count)
        : position_vector(vertex_count, glm::dvec3(0.0)),
          own_vector(vertex_count, glm::dvec3(0.0)),
          position_area(vertex_count, 0.0),
          own_area(vertex_count, 0.0),
          repeated_area(vertex_count, 0.0),
          largest(vertex_count, {0.0, kNone})
    {
    }

    std::vector<glm::dvec3> position_vector, own_vector;  ///< vector areas
    std::vector<double> position_area, own_area;
    std::vector<double> repeated_area;  ///< of triangles whose place an earlier one has
    std::vector<std::pair<double, std::uint32_t>> largest;  ///< own triangle: area, index
};

/// Vertices of the scene in the unit frame, in double.
struct UnitPositions {
    const Scene& scene;
    const Frame& frame;
    glm::dvec3 operator[](std::uint32_t v) const
    {
        return (scene.positions[v] - frame.centre) / frame.diagonal;
    }
};

/// Keeps the triangles with area and sums their vector areas, per position and per vertex. Returns
/// those without.
std::vector<glm::uvec3> keep_triangles(const std::vector<glm::uvec3>& triangles,
                                       const std::vector<bool>& left_out,
                                       const UnitPositions& positions, Geometry& geometry,
                                       Sums& sums)
{
    std::vector<glm::uvec3> dropped;
    geometry.triangles.reserve(triangles.size());
    bool all_kept = true;
    const auto pass_over = [&](std::size_t t) {
        if (all_kept) {
            geometry.kept.resize(t);
            std::iota(geometry.kept.begin(), geometry.kept.end(), 0u);
        }
        all_kept = false;
    };
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (!left_out.empty() && left_out[t]) {
            pass_over(t);
            continue;
        }
        const glm::uvec3 triangle = triangles[t];
        const glm::dvec3 a = positions[triangle[0]];
        const glm::dvec3 b = positions[triangle[1]];
        const glm::dvec3 c = positions[triangle[2]];
        const glm::dvec3 doubled = glm::cross(b - a, c - a);
        const double longest2 =
            std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
        const glm::vec3 fa(a), fb(b), fc(c);
        const glm::vec3 rounded = glm::cross(fb - fa, fc - fa);
        if (!(glm::length(doubled) > kZeroAreaRatio * longest2) ||
            !(glm::dot(rounded, rounded) > 0.0f)) {
            pass_over(t);
            dropped.push_back(triangle);
            continue;
        }
        if (!all_kept)
            geometry.kept.push_back(static_cast<std::uint32_t>(t));
        const std::uint32_t index = static_cast<std::uint32_t>(geometry.triangles.size());
        geometry.triangles.push_back(triangle);
        const double area = 0.5 * glm::length(doubled);
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t v = triangle[corner];
            const std::uint32_t w = geometry.welded[v];
            sums.position_vector[w] += 0.5 * doubled;
            sums.position_area[w] += area;
            sums.own_vector[v] += 0.5 * doubled;
            sums.own_area[v] += area;
            if (area > sums.largest[v].first)
                sums.largest[v] = {area, index};
        }
    }
    for_each_repeated(geometry.triangles, geometry.welded, [&](glm::uvec3 triangle) {
        const glm::dvec3 a = positions[triangle[0]];
        const double area =
            0.5 * glm::length(glm::cross(positions[triangle[1]] - a, positions[triangle[2]] - a));
        for (int corner = 0; corner < 3; ++corner)
            sums.repeated_area[geometry.welded[triangle[corner]]] += area;
    });
    return dropped;
}

void set_areas_and_normals(const UnitPositions& positions, const Sums& sums, Geometry& geometry)
{
    const auto vertex_count = static_cast<std::uint32_t>(geometry.positions.size());
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        const std::uint32_t w = geometry.welded[v];
        if (w == v)
            geometry.areas[v] =
                static_cast<float>((sums.position_area[v] - sums.repeated_area[v]) / 3.0);
        if (sums.own_area[v] == 0.0)
            continue;
        glm::dvec3 sum = sums.position_vector[w];
        if (glm::length(sum) <= kCancelled * sums.position_area[w])
            sum = sums.own_vector[v];
        if (glm::length(sum) <= kCancelled * sums.own_area[v]) {
            const glm::uvec3 triangle = geometry.triangles[sums.largest[v].second];
            sum = glm::cross(positions[triangle[1]] - positions[triangle[0]],
                             positions[triangle[2]] - positions[triangle[0]]);
        }
        geometry.normals[v] = glm::vec3(glm::normalize(sum));
    }
    // the lowest vertex carries the area of its position, so it needs a normal even when no kept
    // triangle uses that very vertex
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        const std::uint32_t w = geometry.welded[v];
        if (geometry.normals[w] == glm::vec3(0.0f))
            geometry.normals[w] = geometry.normals[v];
    }
}

}  // namespace

Box box_of(const Scene& scene, const std::vector<bool>& left_out)
{
    Box box;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        if (!left_out.empty() && left_out[t])
            continue;
        for (int corner = 0; corner < 3; ++corner)
            box.include(scene.positions[scene.triangles[t][corner]]);
    }
    return box;
}

Frame frame_of(const Box& box)
{
    if (!(box.low.x <= box.high.x))
        return {};
    // hypot: the squares of the file's extremes (1e-30, 1e38) stay inside a double either way
    const glm::dvec3 size = box.high - box.low;
    const double diagonal = std::hypot(size.x, size.y, size.z);
    return {box.low + 0.5 * size, diagonal > 0.0 ? diagonal : 1.0};
}

Geometry make_geometry(const Scene& scene, const GeometryScope& scope)
{
    check_scene(scene);
    Geometry geometry;
    const std::size_t vertex_count = scene.positions.size();
    geometry.frame = scope.frame ? *scope.frame : frame_of(box_of(scene, scope.left_out));
    geometry.welded = weld(scene, geometry.frame.diagonal);
    geometry.positions.resize(vertex_count);
    geometry.normals.assign(vertex_count, glm::vec3(0.0f));
    geometry.areas.assign(vertex_count, 0.0f);

    const UnitPositions positions{scene, geometry.frame};
    for (std::uint32_t v = 0; v < vertex_count; ++v)
        geometry.positions[v] = glm::vec3(glm::clamp(positions[v], -kOutside, kOutside));
    Sums sums(vertex_count);
    const std::vector<glm::uvec3> dropped =
        keep_triangles(scene.triangles, scope.left_out, positions, geometry, sums);
    geometry.dropped_triangles = dropped.size();
    set_areas_and_normals(positions, sums, geometry);
    borrow_normals(dropped, geometry);

    // everyone at a position has a normal as soon as anyone has
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        if (geometry.normals[v] == glm::vec3(0.0f))
            geometry.normals[v] = geometry.normals[geometry.welded[v]];
    }
    return geometry;
}

std::vector<double> triangle_areas(const Geometry& geometry)
{
    std::vector<double> areas;
    areas.reserve(geometry.triangles.size());
    for (const glm::uvec3 t : geometry.triangles) {
        const glm::dvec3 a(geometry.positions[t.x]);
        areas.push_back(0.5 * glm::length(glm::cross(glm::dvec3(geometry.positions[t.y]) - a,
                                                     glm::dvec3(geometry.positions[t.z]) - a)));
    }
    return areas;
}

}  // namespace surfelao
