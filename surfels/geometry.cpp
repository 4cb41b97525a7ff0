#include "surfels/geometry.h"

#include "surfels/edges.h"
#include "surfels/for_all.h"
#include "surfels/owner_ranges.h"
#include "surfels/repeated.h"
#include "surfels/weld.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
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
template <class Again>
void for_each_repeated(const std::vector<glm::uvec3>& triangles,
                       const std::vector<std::uint32_t>& welded, const Again& again)
{
    const std::vector<std::uint32_t> suspects = maybe_repeated(triangles, welded);
    constexpr glm::uvec3 kEmpty{0, 0, 0};  // no triangle with area has its corners in one position
    std::vector<glm::uvec3> slots(std::bit_ceil(suspects.size() * 4 + 1), kEmpty);
    for (const std::uint32_t t : suspects) {
        const glm::uvec3 key = positions_of(triangles[t], welded);
        std::size_t slot =
            (key.x * 0x9E3779B1u ^ key.y * 0x85EBCA6Bu ^ key.z * 0xC2B2AE35u) & (slots.size() - 1);
        while (slots[slot] != kEmpty && slots[slot] != key)
            slot = (slot + 1) & (slots.size() - 1);
        if (slots[slot] == key)
            again(triangles[t]);
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

/// Vertices of the scene in the unit frame, in double.
struct UnitPositions {
    const Scene& scene;
    const Frame& frame;
    glm::dvec3 operator[](std::uint32_t v) const
    {
        return (scene.positions[v] - frame.centre) / frame.diagonal;
    }
    /// Of twice a triangle's area.
    [[nodiscard]] glm::dvec3 vector_of(glm::uvec3 triangle) const
    {
        const glm::dvec3 a = (*this)[triangle.x];
        return glm::cross((*this)[triangle.y] - a, (*this)[triangle.z] - a);
    }
};

bool has_area(const UnitPositions& positions, glm::uvec3 triangle)
{
    const glm::dvec3 a = positions[triangle.x], b = positions[triangle.y],
                     c = positions[triangle.z];
    const glm::dvec3 doubled = glm::cross(b - a, c - a);
    const double longest2 =
        std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
    const glm::vec3 fa(a), fb(b), fc(c);
    const glm::vec3 rounded = glm::cross(fb - fa, fc - fa);
    return glm::length(doubled) > kZeroAreaRatio * longest2 && glm::dot(rounded, rounded) > 0.0f;
}

/// Keeps the triangles that are there and have area. Returns those without.
std::vector<glm::uvec3> keep_triangles(const std::vector<glm::uvec3>& triangles,
                                       const std::vector<bool>& left_out,
                                       const UnitPositions& positions, Geometry& geometry)
{
    enum : std::uint8_t { stays, is_flat, is_out };
    std::vector<std::uint8_t> fates(triangles.size(), stays);
    for_all(triangles.size(), [&](std::size_t t) {
        if (!left_out.empty() && left_out[t])
            fates[t] = is_out;
        else if (!has_area(positions, triangles[t]))
            fates[t] = is_flat;
    });
    std::vector<glm::uvec3> dropped;
    const auto lost = std::ranges::count_if(fates, [](std::uint8_t fate) { return fate != stays; });
    if (lost == 0) {
        geometry.triangles = triangles;
        return dropped;
    }
    const std::size_t kept = triangles.size() - static_cast<std::size_t>(lost);
    geometry.triangles.reserve(kept);
    geometry.kept.reserve(kept);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (fates[t] == is_flat)
            dropped.push_back(triangles[t]);
        if (fates[t] != stays)
            continue;
        geometry.triangles.push_back(triangles[t]);
        geometry.kept.push_back(static_cast<std::uint32_t>(t));
    }
    return dropped;
}

/// What the kept triangles give to the places around them.
struct Sums {
    explicit Sums(std::size_t vertex_count)
        : vector(vertex_count, glm::dvec3(0.0)), area(vertex_count, 0.0), is_used(vertex_count, 0)
    {
    }

    std::vector<glm::dvec3> vector;     ///< vector areas, at the lowest vertex of the place
    std::vector<double> area;           ///< likewise
    std::vector<std::uint8_t> is_used;  ///< whether a triangle uses this very vertex
    std::vector<double> repeated_area;  ///< of triangles whose place an earlier one has, at the
                                        ///< place; empty: none does
    [[nodiscard]] bool cancels(std::uint32_t place) const
    {
        return glm::length(vector[place]) <= kCancelled * area[place];
    }
};

Sums sums_of(const UnitPositions& positions, const Geometry& geometry)
{
    Sums sums(geometry.positions.size());
    for_owner_ranges(sums.area.size(), [&](OwnerRange range) {
        for (const glm::uvec3 t : geometry.triangles) {
            const glm::uvec3 w{geometry.welded[t.x], geometry.welded[t.y], geometry.welded[t.z]};
            const bool has_any = range.has(w.x) || range.has(w.y) || range.has(w.z);
            const glm::dvec3 vector = has_any ? 0.5 * positions.vector_of(t) : glm::dvec3(0.0);
            const double area = glm::length(vector);
            for (int corner = 0; corner < 3; ++corner) {
                if (range.has(t[corner]))
                    sums.is_used[t[corner]] = 1;
                if (!range.has(w[corner]))
                    continue;
                sums.vector[w[corner]] += vector;
                sums.area[w[corner]] += area;
            }
        }
    });
    for_each_repeated(geometry.triangles, geometry.welded, [&](glm::uvec3 triangle) {
        sums.repeated_area.resize(sums.area.size(), 0.0);
        const double area = 0.5 * glm::length(positions.vector_of(triangle));
        for (int corner = 0; corner < 3; ++corner)
            sums.repeated_area[geometry.welded[triangle[corner]]] += area;
    });
    return sums;
}

/// Where the sum at a place cancels, of each vertex the mean over its own triangles; where that
/// cancels too, the normal of its largest.
void set_own_normals(const UnitPositions& positions, const Sums& sums, Geometry& geometry)
{
    struct Own {
        glm::dvec3 vector{0.0};
        double area = 0.0, largest_area = 0.0;
        glm::dvec3 largest{0.0};
    };
    std::vector<std::uint32_t> number(sums.area.size(), kNone);
    std::vector<Own> own;
    for (std::uint32_t v = 0; v < number.size(); ++v) {
        if (sums.is_used[v] == 0 || !sums.cancels(geometry.welded[v]))
            continue;
        number[v] = static_cast<std::uint32_t>(own.size());
        own.emplace_back();
    }
    for (const glm::uvec3 t : geometry.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            if (number[t[corner]] == kNone)
                continue;
            Own& sum = own[number[t[corner]]];
            const glm::dvec3 doubled = positions.vector_of(t);
            const double area = 0.5 * glm::length(doubled);
            sum.vector += 0.5 * doubled;
            sum.area += area;
            if (area > sum.largest_area) {
                sum.largest_area = area;
                sum.largest = doubled;
            }
        }
    }
    for (std::uint32_t v = 0; v < number.size(); ++v) {
        if (number[v] == kNone)
            continue;
        const Own& sum = own[number[v]];
        const bool cancels = glm::length(sum.vector) <= kCancelled * sum.area;
        geometry.normals[v] = glm::vec3(glm::normalize(cancels ? sum.largest : sum.vector));
    }
}

void set_areas_and_normals(const UnitPositions& positions, const Sums& sums, Geometry& geometry)
{
    const std::size_t vertex_count = geometry.positions.size();
    std::atomic<bool> is_any_cancelled{false};
    for_all(vertex_count, [&](std::size_t v) {
        const std::uint32_t w = geometry.welded[v];
        if (w == v) {
            const double repeated = sums.repeated_area.empty() ? 0.0 : sums.repeated_area[v];
            geometry.areas[v] = static_cast<float>((sums.area[v] - repeated) / 3.0);
        }
        if (sums.is_used[v] == 0)
            return;
        if (sums.cancels(w))
            is_any_cancelled.store(true, std::memory_order_relaxed);
        else
            geometry.normals[v] = glm::vec3(glm::normalize(sums.vector[w]));
    });
    if (is_any_cancelled)
        set_own_normals(positions, sums, geometry);
    // the lowest vertex carries the area of its position, so it needs a normal even when no kept
    // triangle uses that very vertex
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        const std::uint32_t w = geometry.welded[v];
        if (geometry.normals[w] == glm::vec3(0.0f))
            geometry.normals[w] = geometry.normals[v];
    }
}

/// What `include` puts into a box for each of the triangles 0 to count - 1.
template <class Include>
Box box_of_all(std::size_t count, const Include& include)
{
    constexpr std::size_t kBlock = 4096;
    std::vector<Box> boxes((count + kBlock - 1) / kBlock);
    for_tasks(boxes.size(), [&](std::size_t block) {
        for (std::size_t t = block * kBlock; t < std::min(count, (block + 1) * kBlock); ++t)
            include(boxes[block], t);
    });
    Box all;
    for (const Box& box : boxes) {
        all.low = glm::min(all.low, box.low);
        all.high = glm::max(all.high, box.high);
    }
    return all;
}

}  // namespace

Box box_of(const Scene& scene, const std::vector<bool>& left_out)
{
    return box_of_all(scene.triangles.size(), [&](Box& box, std::size_t t) {
        if (!left_out.empty() && left_out[t])
            return;
        for (int corner = 0; corner < 3; ++corner)
            box.include(scene.positions[scene.triangles[t][corner]]);
    });
}

Box box_of(const Geometry& geometry)
{
    return box_of_all(geometry.triangles.size(), [&](Box& box, std::size_t t) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 place(geometry.positions[geometry.triangles[t][corner]]);
            box.include(geometry.frame.centre + geometry.frame.diagonal * place);
        }
    });
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
    for_all(vertex_count, [&](std::size_t v) {
        geometry.positions[v] =
            glm::vec3(glm::clamp(positions[static_cast<std::uint32_t>(v)], -kOutside, kOutside));
    });
    const std::vector<glm::uvec3> dropped =
        keep_triangles(scene.triangles, scope.left_out, positions, geometry);
    geometry.dropped_triangles = dropped.size();
    set_areas_and_normals(positions, sums_of(positions, geometry), geometry);
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
    std::vector<double> areas(geometry.triangles.size());
    for_all(areas.size(), [&](std::size_t i) {
        const glm::uvec3 t = geometry.triangles[i];
        const glm::dvec3 a(geometry.positions[t.x]);
        areas[i] = 0.5 * glm::length(glm::cross(glm::dvec3(geometry.positions[t.y]) - a,
                                                glm::dvec3(geometry.positions[t.z]) - a));
    });
    return areas;
}

}  // namespace surfelao
