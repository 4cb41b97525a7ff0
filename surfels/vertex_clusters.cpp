#include "surfels/vertex_clusters.h"

#include "surfels/for_all.h"
#include "surfels/lowest_equal.h"
#include "surfels/owner_ranges.h"
#include "surfels/weld.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace surfelao {
namespace {

/// Length of the mean of the normals of a cluster. Those of a tube's quarter have .90: it would
/// become a fifth thinner.
constexpr float kAlike = 0.92f;

/// Cells are so many cubes deep, that slanted surfaces are cut into columns and not into corners
/// too. Of a bumpy sphere of 1.1 million triangles, cubes: time of a grid 1.09.
constexpr float kDepth = 8.0f;

/// Extent of a cluster along any axis, in cubes: a column of what is steeper than its side, or of
/// sheets behind each other, is left as it is.
constexpr float kMostExtent = 1.5f;

/// Cubes along the diagonal; twenty bits of a key hold the places of twice as many.
constexpr float kMostCubes = 1 << 19;

constexpr std::uint64_t kAlone = std::uint64_t{1} << 63;

/// Of the six along the axes the one that a normal is nearest to.
std::uint64_t side_of(glm::vec3 normal)
{
    const glm::vec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    return static_cast<std::uint64_t>(2 * axis + (normal[axis] < 0.0f ? 1 : 0));
}

std::uint64_t hash(std::uint64_t key)
{
    key *= 0x9E3779B97F4A7C15u;
    key ^= key >> 32;
    key *= 0xD6E8FEB86659FD93u;
    return key ^ key >> 32;
}

struct Cluster {
    glm::dvec3 sum{0.0};     ///< of the places
    glm::vec3 normal{0.0f};  ///< sum of the normals
    std::uint32_t size = 0;
    glm::vec3 low{std::numeric_limits<float>::max()};
    glm::vec3 high{-std::numeric_limits<float>::max()};

    /// Whether it can be one vertex. cubes: along the diagonal
    [[nodiscard]] bool is_one(float cubes) const
    {
        const glm::vec3 extent = cubes * (high - low);
        if (std::max({extent.x, extent.y, extent.z}) > kMostExtent)
            return false;
        return size > 0 && glm::length(normal) >= kAlike * static_cast<float>(size);
    }
};

}  // namespace

Geometry cluster_vertices(const Geometry& geometry, float cube)
{
    const std::vector<std::uint32_t>& welded = geometry.welded;
    const std::size_t count = geometry.positions.size();
    const std::vector<std::uint32_t> tears = tears_of(geometry.triangles, welded);
    const float cubes = std::min(1.0f / cube, kMostCubes);
    std::vector<std::uint64_t> keys(count);
    for_all(count, [&](std::size_t v) {
        const glm::vec3 normal = geometry.normals[v];
        if (welded[v] != v || tears[v] != 0 || normal == glm::vec3(0.0f)) {
            keys[v] = kAlone | welded[v];
            return;
        }
        const std::uint64_t side = side_of(normal);
        glm::vec3 size(cubes);
        size[static_cast<int>(side / 2)] /= kDepth;
        const glm::uvec3 at(glm::floor(size * (geometry.positions[v] + 1.0f)));
        keys[v] = ((std::uint64_t{at.x} << 40 | std::uint64_t{at.y} << 20 | at.z) << 3) | side;
    });
    std::vector<std::uint32_t> name = lowest_equal(
        count, [&](std::uint32_t v) { return hash(keys[v]); },
        [&](std::uint32_t v, std::uint32_t w) { return keys[v] == keys[w]; });

    std::vector<Cluster> clusters(count);
    for_owner_ranges(count, [&](OwnerRange range) {
        for (std::size_t v = 0; v < count; ++v) {
            if (welded[v] != v || !range.has(name[v]))
                continue;
            Cluster& cluster = clusters[name[v]];
            cluster.sum += glm::dvec3(geometry.positions[v]);
            cluster.normal += geometry.normals[v];
            ++cluster.size;
            cluster.low = glm::min(cluster.low, geometry.positions[v]);
            cluster.high = glm::max(cluster.high, geometry.positions[v]);
        }
    });
    for_all(count, [&](std::size_t v) {
        if (welded[v] == v && !clusters[name[v]].is_one(cubes))
            name[v] = static_cast<std::uint32_t>(v);
    });

    std::vector<glm::uvec3> triangles;
    for (const glm::uvec3 t : geometry.triangles) {
        const glm::uvec3 n{name[welded[t.x]], name[welded[t.y]], name[welded[t.z]]};
        if (n.x != n.y && n.y != n.z && n.z != n.x)
            triangles.push_back(n);
    }
    if (triangles.empty())
        return geometry;
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> number(count, kUnused);
    std::vector<glm::dvec3> places;
    for (glm::uvec3& t : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t v = t[corner];
            if (number[v] == kUnused) {
                number[v] = static_cast<std::uint32_t>(places.size());
                const Cluster& cluster = clusters[v];
                const glm::dvec3 place = cluster.is_one(cubes)
                                             ? cluster.sum / static_cast<double>(cluster.size)
                                             : glm::dvec3(geometry.positions[v]);
                places.push_back(geometry.frame.centre + geometry.frame.diagonal * place);
            }
            t[corner] = number[v];
        }
    }
    return make_geometry(make_scene(places, triangles), {.frame = geometry.frame});
}

}  // namespace surfelao
