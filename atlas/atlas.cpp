#include "atlas/atlas.h"

#include "atlas/charts.h"
#include "atlas/packing.h"
#include "surfels/errors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <string>
#include <utility>

namespace surfelao {
namespace {

/// What charts usually cover of a page: for the size of a texel, before it is known.
constexpr double kLikelyUse = 0.65;

/// Where charts cover less than this, the longest is cut in two: a few large ones fill no page. At
/// most so often, and only what is longer than this share of the page.
constexpr double kWantedUse = 0.65;
constexpr int kMostCuts = 6;
constexpr double kLongShare = 0.5;
/// What a cut must gain of the use, and how many may fail to in a row.
constexpr double kCutGain = 1.01;
constexpr int kVainCuts = 2;

void check_settings(const AtlasSettings& settings)
{
    require(settings.size >= 1 && settings.size <= kMostTexels,
            "a map has 1 to " + std::to_string(kMostTexels) + " texels a side");
    require(!settings.texels_per_unit ||
                (*settings.texels_per_unit > 0.0 && std::isfinite(*settings.texels_per_unit)),
            "texels per unit must be above 0");
    require(settings.padding <= kMostPadding,
            "padding must be 0 to " + std::to_string(kMostPadding) + " texels");
}

/// A corner as the map has it: y down.
glm::dvec2 corner_of(const Mesh& mesh, const Facets& facets, const Chart& chart, std::uint32_t t,
                     int k)
{
    const glm::dvec2 place = chart.at(glm::dvec3(mesh.geometry.positions[facets.corners[t][k]]));
    return {place.x, -place.y};
}

/// chart_of: of the triangles on the page; `own` is this one.
ChartShape shape_of(const Mesh& mesh, const Facets& facets, const Chart& chart,
                    std::span<const std::uint32_t> chart_of, std::uint32_t own)
{
    ChartShape shape;
    shape.triangles.reserve(chart.triangles.size());
    double outline = 0.0;
    for (const std::uint32_t t : chart.triangles) {
        const auto& p = shape.triangles.emplace_back(
            std::array{corner_of(mesh, facets, chart, t, 0), corner_of(mesh, facets, chart, t, 1),
                       corner_of(mesh, facets, chart, t, 2)});
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t other = facets.neighbours[t][k];
            if (other == kNoTriangle || chart_of[other] != own)
                outline += glm::distance(p[k], p[(k + 1) % 3]);
        }
    }
    if (outline > 0.0)  // a chart is scaled to the area of its surface
        shape.width = 2.0 * chart.area / outline;
    return shape;
}

/// Of each triangle its chart; kNoChart where it has none.
std::vector<std::uint32_t> charts_of_triangles(std::size_t count, std::span<const Chart> charts)
{
    std::vector<std::uint32_t> chart_of(count, kNoChart);
    for (std::uint32_t c = 0; c < charts.size(); ++c)
        for (const std::uint32_t t : charts[c].triangles)
            chart_of[t] = c;
    return chart_of;
}

/// A page's set: a value for each place in each chart.
UvSet uvs_of(const Mesh& mesh, const Facets& facets, std::span<const Chart> charts,
             std::span<const ChartPlacement> placements, std::uint32_t size)
{
    constexpr std::uint32_t kNever = 0xffffffff;
    UvSet uvs;
    uvs.corners.assign(mesh.scene.triangles.size(), glm::uvec3(UvSet::kNone));
    std::vector<std::uint32_t> last_chart(mesh.geometry.positions.size(), kNever);
    std::vector<std::uint32_t> value(mesh.geometry.positions.size());
    for (std::uint32_t c = 0; c < charts.size(); ++c) {
        for (const std::uint32_t t : charts[c].triangles) {
            glm::uvec3& corners = uvs.corners[mesh.geometry.scene_triangle(t)];
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t vertex = facets.corners[t][k];
                if (last_chart[vertex] != c) {
                    last_chart[vertex] = c;
                    value[vertex] = static_cast<std::uint32_t>(uvs.values.size());
                    const glm::dvec2 place = corner_of(mesh, facets, charts[c], t, k);
                    uvs.values.push_back(placements[c].at(place) / static_cast<double>(size));
                }
                corners[k] = value[vertex];
            }
        }
    }
    return uvs;
}

/// Edges between charts of one page, each counted once.
double length_of_seams(const Mesh& mesh, const Facets& facets,
                       std::span<const std::uint32_t> chart_of)
{
    double length = 0.0;
    for (std::uint32_t t = 0; t < chart_of.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t other = facets.neighbours[t][static_cast<std::size_t>(k)];
            if (other == kNoTriangle || other < t || chart_of[t] == kNoChart ||
                chart_of[other] == kNoChart || chart_of[other] == chart_of[t])
                continue;
            length +=
                double{glm::distance(mesh.geometry.positions[facets.corners[t][k]],
                                     mesh.geometry.positions[facets.corners[t][(k + 1) % 3]])};
        }
    }
    return length;
}

/// Sets the stretch of an atlas whose layout is there.
void measure_stretch(const Facets& facets, std::span<const std::vector<Chart>> pages, Atlas& atlas)
{
    // a chart is as large as its surface, so the mean of all is 1
    double sum = 0.0, area = 0.0;
    for (const std::vector<Chart>& charts : pages) {
        for (const Chart& chart : charts) {
            for (const std::uint32_t t : chart.triangles) {
                const double slope = glm::dot(chart.axis, glm::dvec3(facets.normals[t]));
                const double ratio = chart.scale * chart.scale * slope;
                const double stretch = std::max(ratio, 1.0 / ratio);
                sum += facets.areas[t] * stretch;
                area += facets.areas[t];
                atlas.largest_stretch = std::max(atlas.largest_stretch, stretch);
            }
        }
    }
    atlas.mean_stretch = area > 0.0 ? sum / area : 1.0;
}

std::vector<ChartShape> shapes_of(const Mesh& mesh, const Facets& facets,
                                  std::span<const std::vector<Chart>> pages)
{
    std::vector<ChartShape> shapes;
    for (std::uint32_t page = 0; page < pages.size(); ++page) {
        const std::vector<std::uint32_t> chart_of =
            charts_of_triangles(facets.areas.size(), pages[page]);
        for (std::uint32_t c = 0; c < pages[page].size(); ++c) {
            shapes.push_back(shape_of(mesh, facets, pages[page][c], chart_of, c));
            shapes.back().page = page;
        }
    }
    return shapes;
}

/// A chart in the map.
struct Extent {
    glm::dvec2 low{HUGE_VAL}, high{-HUGE_VAL};
    [[nodiscard]] int longer() const { return high.x - low.x >= high.y - low.y ? 0 : 1; }
    [[nodiscard]] double length() const { return high[longer()] - low[longer()]; }
};

Extent extent_of(const ChartShape& shape, const ChartPlacement& placement)
{
    Extent extent;
    for (const auto& triangle : shape.triangles) {
        for (const glm::dvec2 corner : triangle) {
            extent.low = glm::min(extent.low, placement.at(corner));
            extent.high = glm::max(extent.high, placement.at(corner));
        }
    }
    return extent;
}

/// Cuts charts of a single page, the longest across its middle, until the page is full enough, and
/// keeps the fullest of all that were seen.
void cut_to_fill(const Mesh& mesh, const Facets& facets, const PackingSettings& settings,
                 std::vector<std::vector<Chart>>& pages, Packing& packing, ProgressMeter& meter,
                 std::uint64_t& units)
{
    const double wanted = kWantedUse * settings.size * settings.size;
    std::vector<std::vector<Chart>> tried_pages = pages;
    Packing tried = packing;
    int vain = 0;
    for (int cuts = 0; cuts < kMostCuts && static_cast<double>(packing.covered) < wanted; ++cuts) {
        std::vector<Chart>& charts = tried_pages.front();
        const std::vector<ChartShape> shapes = shapes_of(mesh, facets, tried_pages);
        std::size_t longest = 0;
        Extent extent;
        for (std::size_t c = 0; c < charts.size(); ++c) {
            const Extent found = extent_of(shapes[c], tried.placements[c]);
            if (c == 0 || found.length() > extent.length()) {
                longest = c;
                extent = found;
            }
        }
        if (extent.length() < kLongShare * settings.size || charts[longest].triangles.size() < 2)
            return;
        const int axis = extent.longer();
        const double middle = 0.5 * (extent.low[axis] + extent.high[axis]);
        std::vector<std::uint8_t> is_beyond;
        for (const auto& [a, b, c] : shapes[longest].triangles)
            is_beyond.push_back(tried.placements[longest].at((a + b + c) / 3.0)[axis] > middle);
        std::vector<Chart> pieces = cut(mesh, facets, charts[longest], is_beyond);
        charts.erase(charts.begin() + static_cast<std::ptrdiff_t>(longest));
        std::ranges::move(pieces, std::back_inserter(charts));
        tried = pack(shapes_of(mesh, facets, tried_pages), settings, meter, units / 2);
        units -= units / 2;
        ++vain;
        if (static_cast<double>(tried.covered) >
            static_cast<double>(packing.covered) * std::pow(kCutGain, vain)) {
            packing = tried;
            pages = tried_pages;
            vain = 0;
        } else if (vain == kVainCuts) {
            return;
        }
    }
}

double texel_of(const Mesh& mesh, const AtlasSettings& settings, double area)
{
    return settings.texels_per_unit
               ? 1.0 / (*settings.texels_per_unit * mesh.geometry.frame.diagonal)
               : std::sqrt(area / kLikelyUse) / settings.size;
}

}  // namespace

Atlas make_atlas(const Mesh& mesh, const AtlasSettings& settings, const Progress& progress)
{
    check_settings(settings);
    const Geometry& geometry = mesh.geometry;
    const std::uint32_t page_count = settings.blended ? 3 : 1;
    const std::size_t count = geometry.triangles.size();
    std::uint64_t units = count * page_count;  // packing counts as much as making charts
    ProgressMeter meter(progress, 2 * units);
    const Facets facets = make_facets(mesh);
    const double area = std::accumulate(facets.areas.begin(), facets.areas.end(), 0.0);

    std::vector<std::vector<Chart>> pages;
    for (std::uint32_t page = 0; page < page_count; ++page)
        pages.push_back(settings.blended
                            ? make_axis_charts(mesh, facets, static_cast<int>(page), meter)
                            : make_charts(mesh, facets, texel_of(mesh, settings, area), meter));
    const double diagonal = geometry.frame.diagonal;
    PackingSettings packing_settings{settings.size, {}, settings.padding, page_count};
    if (settings.texels_per_unit)
        packing_settings.scale = *settings.texels_per_unit * diagonal;
    Packing packing = pack(shapes_of(mesh, facets, pages), packing_settings, meter, units / 2);
    units -= units / 2;
    if (page_count == 1 && !settings.texels_per_unit)
        cut_to_fill(mesh, facets, packing_settings, pages, packing, meter, units);
    meter.add(2 * count * page_count);  // all that may be left

    Atlas atlas;
    atlas.layout.size = {packing.size, packing.size};
    atlas.layout.is_blended = settings.blended;
    double seams = 0.0;
    for (const std::vector<Chart>& charts : pages) {
        const std::span<const ChartPlacement> placements =
            std::span(packing.placements).subspan(atlas.chart_count, charts.size());
        atlas.layout.pages.push_back(uvs_of(mesh, facets, charts, placements, packing.size));
        std::vector<std::uint32_t>& chart_of =
            atlas.chart_of.emplace_back(charts_of_triangles(count, charts));
        for (std::uint32_t& chart : chart_of)
            chart += chart == kNoChart ? 0 : atlas.chart_count;
        atlas.chart_count += static_cast<std::uint32_t>(charts.size());
        seams += length_of_seams(mesh, facets, chart_of);
    }
    measure_stretch(facets, pages, atlas);
    atlas.seam_length = area > 0.0 ? seams / std::sqrt(area) : 0.0;
    atlas.texels_per_unit = packing.scale / diagonal;
    atlas.use = static_cast<double>(packing.covered) /
                (static_cast<double>(atlas.layout.size.count()) * page_count);
    return atlas;
}

}  // namespace surfelao
