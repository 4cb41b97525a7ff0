#include "viewer/coarse.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

namespace surfelao {
namespace {

constexpr float kGrowth = 1.2f;  // of the cells where they leave too much
constexpr float kFar = 8.0f;     // diagonals: nothing of a model lies farther out

/// Of a place and the side that is faced there.
std::uint64_t cell_of(glm::vec3 place, glm::vec3 normal, float side)
{
    constexpr std::uint64_t kMost = (1u << 20) - 1;
    const glm::vec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::uint64_t cell = static_cast<std::uint64_t>(2 * axis + (normal[axis] < 0.0f ? 1 : 0));
    for (int k = 0; k < 3; ++k) {
        const float step = std::floor((std::clamp(place[k], -kFar, kFar) + kFar) / side);
        cell = cell << 20 | std::min(static_cast<std::uint64_t>(step), kMost);
    }
    return cell;
}

/// For each wedge the one that stands for its cell.
std::vector<std::uint32_t> kept_wedges(const Geometry& geometry, const Surface& surface, float side)
{
    const auto place = [&](std::uint32_t wedge) {
        return geometry.positions[surface.vertex_of(wedge)];
    };
    std::vector<std::pair<std::uint64_t, std::uint32_t>> cells;
    cells.reserve(surface.normals.size());
    for (std::uint32_t wedge = 0; wedge < surface.normals.size(); ++wedge)
        cells.emplace_back(cell_of(place(wedge), surface.normals[wedge], side), wedge);
    std::ranges::sort(cells);
    std::vector<std::uint32_t> kept(cells.size());
    for (std::size_t first = 0, end = 0; first < cells.size(); first = end) {
        glm::dvec3 sum(0.0);
        for (; end < cells.size() && cells[end].first == cells[first].first; ++end)
            sum += glm::dvec3(place(cells[end].second));
        const glm::vec3 mean(sum / static_cast<double>(end - first));
        std::uint32_t nearest = cells[first].second;
        for (std::size_t i = first; i < end; ++i) {
            if (glm::distance(place(cells[i].second), mean) < glm::distance(place(nearest), mean))
                nearest = cells[i].second;
        }
        for (std::size_t i = first; i < end; ++i)
            kept[cells[i].second] = nearest;
    }
    return kept;
}

std::vector<glm::uvec3> merged(const Geometry& geometry, const Surface& surface, float side)
{
    const std::vector<std::uint32_t> kept = kept_wedges(geometry, surface, side);
    std::vector<glm::uvec3> triangles;
    for (const glm::uvec3& corners : surface.corners(geometry)) {
        glm::uvec3 t(kept[corners.x], kept[corners.y], kept[corners.z]);
        if (t.x == t.y || t.y == t.z || t.z == t.x)
            continue;
        while (t.x > t.y || t.x > t.z)  // the same way round, from the least on
            t = {t.y, t.z, t.x};
        triangles.push_back(t);
    }
    std::ranges::sort(triangles, {}, [](const glm::uvec3& t) { return std::tuple(t.x, t.y, t.z); });
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    return triangles;
}

}  // namespace

std::vector<glm::uvec3> coarse_triangles(const Geometry& geometry, const Surface& surface,
                                         std::size_t most)
{
    if (geometry.triangles.size() <= most)
        return surface.corners(geometry);
    double area = 0.0;
    for (const glm::uvec3 t : geometry.triangles) {
        const glm::vec3 a = geometry.positions[t.x];
        area += 0.5 * static_cast<double>(glm::length(
                          glm::cross(geometry.positions[t.y] - a, geometry.positions[t.z] - a)));
    }
    // a flat surface has two triangles a cell
    auto side = static_cast<float>(std::sqrt(2.0 * area / static_cast<double>(most)));
    side = std::max(side, 1e-4f);
    std::vector<glm::uvec3> triangles = merged(geometry, surface, side);
    while (triangles.size() > most) {
        side *= kGrowth;
        triangles = merged(geometry, surface, side);
    }
    return triangles;
}

std::size_t moving_detail(const DetailTimes& times)
{
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (!times[i] || *times[i] <= kMovingMs)
            return i;
    }
    return times.size() - 1;
}

}  // namespace surfelao
