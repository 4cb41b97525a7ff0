#include "atlas/layout_facts.h"

#include "surfels/union_find.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <optional>
#include <utility>

namespace surfelao {
namespace {

using Corners = std::array<glm::dvec2, 3>;

/// Nothing where the triangle is not on the page.
std::optional<Corners> corners_on(const Geometry& geometry, const UvSet& uvs,
                                  std::uint32_t triangle)
{
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto at =
            uv_at(geometry, uvs, {triangle, {k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f}});
        if (!at)
            return {};
        corners[k] = *at;
    }
    return corners;
}

/// A corner's place on the surface and on the page, and its triangle.
struct PlacedCorner {
    std::uint32_t place;
    double u, v;
    std::uint32_t triangle;
    auto operator<=>(const PlacedCorner&) const = default;
    [[nodiscard]] bool meets(const PlacedCorner& other) const
    {
        return place == other.place && u == other.u && v == other.v;
    }
};

/// The charts of one page, numbered from `count` on.
std::vector<std::uint32_t> charts_of(const Geometry& geometry, const UvSet& uvs,
                                     std::uint32_t& count)
{
    const auto triangles = static_cast<std::uint32_t>(geometry.triangles.size());
    std::vector<PlacedCorner> corners;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        const auto at = corners_on(geometry, uvs, t);
        for (int k = 0; at && k < 3; ++k) {
            const glm::dvec2 uv = (*at)[static_cast<std::size_t>(k)];
            corners.push_back({geometry.welded[geometry.triangles[t][k]], uv.x, uv.y, t});
        }
    }
    std::ranges::sort(
        corners, [](const PlacedCorner& a, const PlacedCorner& b) { return std::is_lt(a <=> b); });
    UnionFind joined(triangles);
    std::vector<std::uint32_t> charts(triangles, LayoutFacts::kNone);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        charts[corners[i].triangle] = 0;
        if (i > 0 && corners[i].meets(corners[i - 1]))
            joined.join(corners[i].triangle, corners[i - 1].triangle);
    }
    for (std::uint32_t t = 0; t < triangles; ++t) {
        if (charts[t] != LayoutFacts::kNone)
            charts[t] = joined.root(t) == t ? count++ : charts[joined.root(t)];
    }
    return charts;
}

}  // namespace

LayoutFacts facts_of(const Mesh& mesh, const MapLayout& layout)
{
    const Geometry& geometry = mesh.geometry;
    const std::vector<double> areas = triangle_areas(geometry);
    const glm::dvec2 size(layout.size.width, layout.size.height);
    LayoutFacts facts;
    std::vector<std::pair<float, double>> weighted;  // densities by area
    double sum = 0.0;
    for (const UvSet& page : layout.pages) {
        facts.charts.push_back(charts_of(geometry, page, facts.chart_count));
        std::vector<float>& densities = facts.densities.emplace_back(areas.size(), 0.0f);
        for (std::uint32_t t = 0; t < areas.size(); ++t) {
            const auto at = corners_on(geometry, page, t);
            if (!at)
                continue;
            const glm::dvec2 a = size * ((*at)[1] - (*at)[0]), b = size * ((*at)[2] - (*at)[0]);
            const double texels = 0.5 * std::abs(a.x * b.y - a.y * b.x);
            densities[t] =
                static_cast<float>(std::sqrt(texels / areas[t]) / geometry.frame.diagonal);
            weighted.emplace_back(densities[t], areas[t]);
            sum += areas[t];
        }
    }
    std::ranges::sort(weighted);
    for (double below = 0.0; const auto& [density, area] : weighted) {
        below += area;
        if (below >= 0.5 * sum) {
            facts.median_density = density;
            break;
        }
    }
    return facts;
}

}  // namespace surfelao
