#include "atlas/charts.h"

#include "atlas/layout.h"
#include "atlas/occupancy.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

namespace surfelao {
namespace {

constexpr std::uint32_t kUnassigned = 0xffffffff;
constexpr int kTrialGrowths = 3;
constexpr std::size_t kFacetGrain = 4096;

double cos_deg(double degrees)
{
    return std::cos(glm::radians(degrees));
}

glm::dvec3 doubled_area(const Geometry& geometry, glm::uvec3 corners)
{
    const glm::dvec3 a(geometry.positions[corners.x]);
    return glm::cross(glm::dvec3(geometry.positions[corners.y]) - a,
                      glm::dvec3(geometry.positions[corners.z]) - a);
}

/// A chart without triangles.
Chart chart_along(glm::dvec3 axis)
{
    Chart chart;
    chart.axis = axis;
    const glm::dvec3 across = std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    chart.right = glm::normalize(glm::cross(across, axis));
    chart.up = glm::cross(axis, chart.right);
    return chart;
}

FlatTriangle projected(const Geometry& geometry, const Facets& facets, const Chart& chart,
                       std::uint32_t t)
{
    FlatTriangle flat;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 p(geometry.positions[facets.corners[t][k]]);
        flat[static_cast<std::size_t>(k)] = {glm::dot(chart.right, p), glm::dot(chart.up, p)};
    }
    return flat;
}

/// Puts the triangles in order and sets what follows from them.
void finish(const Geometry& geometry, const Facets& facets, Chart& chart)
{
    std::ranges::sort(chart.triangles);
    chart.area = 0.0;
    double flat = 0.0;
    for (const std::uint32_t t : chart.triangles) {
        chart.area += facets.areas[t];
        flat += 0.5 * twice_area(projected(geometry, facets, chart, t));
    }
    chart.scale = flat > 0.0 ? std::sqrt(chart.area / flat) : 1.0;
}

/// A chart while it is made.
struct Draft {
    Chart chart;
    std::uint32_t sheet = 0;  ///< its plane
    glm::dvec3 normals{0.0};  ///< weighted by area
    double perimeter = 0.0;   ///< when borders were last looked at
};

/// Two charts with a common border.
struct Border {
    std::uint32_t first, second;  ///< first < second
    double smooth, hard;          ///< length
};

class ChartMaker {
public:
    ChartMaker(const Mesh& mesh, const Facets& facets, ProgressMeter& progress)
        : geometry_(mesh.geometry),
          facets_(facets),
          progress_(progress),
          occupancy_(facets.areas.size()),
          chart_of_(facets.areas.size(), kUnassigned),
          stamp_(facets.areas.size(), 0)
    {
    }

    /// Charts of the triangles in the list, from the largest on. axis_for(triangle): of the chart
    /// that it begins. All keep facing their axis within the limit.
    void grow(std::vector<std::uint32_t> members,
              const std::function<glm::dvec3(std::uint32_t)>& axis_for, double limit,
              bool over_hard_edges)
    {
        over_hard_edges_ = over_hard_edges;
        const double least = cos_deg(limit);
        is_free_.assign(facets_.areas.size(), 0);
        for (const std::uint32_t t : members)
            is_free_[t] = 1;
        std::ranges::stable_sort(members, std::greater{},
                                 [&](std::uint32_t t) { return facets_.areas[t]; });
        for (const std::uint32_t seed : members)
            if (is_free_[seed] != 0)
                grow_from(seed, axis_for(seed), least);
    }

    /// The mean normal of what would belong to a chart that begins here, three times over.
    [[nodiscard]] glm::dvec3 fitted_axis(std::uint32_t seed, double limit)
    {
        const double least = cos_deg(limit);
        glm::dvec3 axis = facets_.normals[seed];
        for (int trial = 0; trial < kTrialGrowths; ++trial) {
            ++last_stamp_;
            stamp_[seed] = last_stamp_;
            queue_.assign(1, seed);
            glm::dvec3 sum(0.0);
            for (std::size_t head = 0; head < queue_.size(); ++head) {
                const std::uint32_t t = queue_[head];
                sum += facets_.areas[t] * glm::dvec3(facets_.normals[t]);
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::uint32_t next = facets_.neighbours[t][k];
                    if (!is_free_across(t, k) || stamp_[next] == last_stamp_ ||
                        !faces(next, axis, least))
                        continue;
                    stamp_[next] = last_stamp_;
                    queue_.push_back(next);
                }
            }
            const glm::dvec3 mean = glm::normalize(sum);
            if (!faces(seed, mean, least))
                break;
            axis = mean;
        }
        return axis;
    }

    /// Takes narrow strips apart; their triangles.
    [[nodiscard]] std::vector<std::uint32_t> release_strips(double texel)
    {
        (void)borders();
        std::vector<std::uint32_t> released;
        for (Draft& draft : drafts_) {
            if (!is_strip(draft, texel))
                continue;
            released.insert(released.end(), draft.chart.triangles.begin(),
                            draft.chart.triangles.end());
            draft.chart.triangles.clear();
        }
        std::ranges::sort(released);
        return released;
    }

    /// Makes one of charts with a common border, as long as any two can be.
    void join(double texel)
    {
        std::set<std::pair<std::uint32_t, std::uint32_t>> refused;
        for (bool has_joined = true; has_joined;) {
            has_joined = false;
            for (const Border& border : borders()) {
                const std::uint32_t a = owner(border.first), b = owner(border.second);
                const auto pair = std::minmax(a, b);
                if (a == b || refused.contains(pair))
                    continue;
                if (join_two(a, b, border.smooth > 0.0, texel))
                    has_joined = true;
                else
                    refused.insert(pair);
            }
        }
    }

    [[nodiscard]] std::vector<Chart> charts()
    {
        std::vector<Chart> list;
        for (Draft& draft : drafts_) {
            if (draft.chart.triangles.empty())
                continue;
            finish(geometry_, facets_, draft.chart);
            list.push_back(std::move(draft.chart));
        }
        return list;
    }

private:
    [[nodiscard]] bool faces(std::uint32_t t, glm::dvec3 axis, double least) const
    {
        return glm::dot(glm::dvec3(facets_.shading[t]), axis) > least &&
               glm::dot(glm::dvec3(facets_.normals[t]), axis) > steepest_;
    }

    /// Lays a triangle into a chart, unless its place is taken.
    bool lay(const Draft& draft, std::uint32_t t)
    {
        const FlatTriangle flat = projected(geometry_, facets_, draft.chart, t);
        const bool fits = occupancy_.fits(draft.sheet, flat);
        if (fits)
            occupancy_.add(draft.sheet, flat);
        return fits;
    }

    void take(Draft& draft, std::uint32_t id, std::uint32_t t)
    {
        draft.chart.triangles.push_back(t);
        draft.chart.area += facets_.areas[t];
        draft.normals += facets_.areas[t] * glm::dvec3(facets_.normals[t]);
        chart_of_[t] = id;
    }

    void grow_from(std::uint32_t seed, glm::dvec3 axis, double least)
    {
        const auto id = static_cast<std::uint32_t>(drafts_.size());
        drafts_.push_back({chart_along(axis), occupancy_.add_sheet()});
        Draft& draft = drafts_.back();
        root_.push_back(id);
        const auto take_free = [&](std::uint32_t t) {
            is_free_[t] = 0;
            take(draft, id, t);
        };
        lay(draft, seed);  // a triangle that rounding makes flat belongs to its chart all the same
        take_free(seed);
        for (std::size_t head = 0; head < draft.chart.triangles.size(); ++head) {
            const std::uint32_t t = draft.chart.triangles[head];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t next = facets_.neighbours[t][k];
                if (is_free_across(t, k) && faces(next, axis, least) && lay(draft, next))
                    take_free(next);
            }
        }
        progress_.add(draft.chart.triangles.size());
    }

    [[nodiscard]] bool is_free_across(std::uint32_t t, std::size_t k) const
    {
        const std::uint32_t next = facets_.neighbours[t][k];
        return next != kNoTriangle && (over_hard_edges_ || facets_.is_smooth[t][k]) &&
               is_free_[next] != 0;
    }

    std::uint32_t owner(std::uint32_t chart)
    {
        while (root_[chart] != chart)
            chart = root_[chart] = root_[root_[chart]];
        return chart;
    }

    /// Longest first.
    [[nodiscard]] std::vector<Border> borders()
    {
        std::vector<Border> sides;
        for (Draft& draft : drafts_)
            draft.perimeter = 0.0;
        for (std::uint32_t t = 0; t < chart_of_.size(); ++t) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t other = facets_.neighbours[t][k];
                if (other != kNoTriangle && chart_of_[t] == chart_of_[other])
                    continue;
                const glm::vec3 from = geometry_.positions[facets_.corners[t][static_cast<int>(k)]];
                const glm::vec3 to =
                    geometry_.positions[facets_.corners[t][static_cast<int>((k + 1) % 3)]];
                const double length = glm::distance(from, to);
                drafts_[chart_of_[t]].perimeter += length;
                if (other == kNoTriangle || chart_of_[t] > chart_of_[other])
                    continue;
                const bool is_smooth = facets_.is_smooth[t][k];
                sides.push_back({chart_of_[t], chart_of_[other], is_smooth ? length : 0.0,
                                 is_smooth ? 0.0 : length});
            }
        }
        std::ranges::stable_sort(
            sides, {}, [](const Border& border) { return std::pair(border.first, border.second); });
        std::vector<Border> whole;
        for (const Border& side : sides) {
            if (!whole.empty() && whole.back().first == side.first &&
                whole.back().second == side.second) {
                whole.back().smooth += side.smooth;
                whole.back().hard += side.hard;
            } else {
                whole.push_back(side);
            }
        }
        std::ranges::stable_sort(whole, std::greater{}, [](const Border& border) {
            return std::pair(border.smooth, border.hard);
        });
        return whole;
    }

    [[nodiscard]] static bool is_strip(const Draft& draft, double texel)
    {
        return draft.chart.triangles.size() >= kFewChartTriangles &&
               2.0 * draft.chart.area < kNarrowTexels * texel * draft.perimeter;
    }

    bool join_two(std::uint32_t a, std::uint32_t b, bool has_smooth_border, double texel)
    {
        if (drafts_[a].chart.area < drafts_[b].chart.area)
            std::swap(a, b);
        const Chart& smaller = drafts_[b].chart;
        const double texels = smaller.area / (texel * texel);
        const bool is_small =
            texels < kSmallChartTexels ||
            (smaller.triangles.size() < kFewChartTriangles && texels < kFewChartTexels);
        if (!has_smooth_border && texels >= kSmallChartTexels && !is_strip(drafts_[b], texel))
            return false;
        const double least = cos_deg(is_small ? kSteepest : kChartLimit);
        return absorb(a, b, least) || (!is_small && unite(a, b, least));
    }

    /// Adds b to a, along a's axis.
    bool absorb(std::uint32_t a, std::uint32_t b, double least)
    {
        Draft& larger = drafts_[a];
        Draft& smaller = drafts_[b];
        if (!all_face(smaller, larger.chart.axis, least) || !lay_all(larger, smaller, 0))
            return false;
        for (const std::uint32_t t : smaller.chart.triangles)
            take(larger, a, t);
        smaller.chart.triangles.clear();
        root_[b] = a;
        return true;
    }

    /// Makes a new chart of both, along their mean normal.
    bool unite(std::uint32_t a, std::uint32_t b, double least)
    {
        const glm::dvec3 axis = glm::normalize(drafts_[a].normals + drafts_[b].normals);
        if (!all_face(drafts_[a], axis, least) || !all_face(drafts_[b], axis, least))
            return false;
        const auto id = static_cast<std::uint32_t>(drafts_.size());
        Draft both{chart_along(axis), occupancy_.add_sheet()};
        if (!lay_all(both, drafts_[a], 0) ||
            !lay_all(both, drafts_[b], drafts_[a].chart.triangles.size()))
            return false;
        for (const std::uint32_t part : {a, b}) {
            for (const std::uint32_t t : drafts_[part].chart.triangles)
                take(both, id, t);
            drafts_[part].chart.triangles.clear();
            root_[part] = id;
        }
        drafts_.push_back(std::move(both));
        root_.push_back(id);
        return true;
    }

    [[nodiscard]] bool all_face(const Draft& draft, glm::dvec3 axis, double least) const
    {
        return std::ranges::all_of(draft.chart.triangles,
                                   [&](std::uint32_t t) { return faces(t, axis, least); });
    }

    /// Lays all of `from` into `draft`, or takes back also the `before` that were laid last.
    bool lay_all(const Draft& draft, const Draft& from, std::size_t before)
    {
        std::size_t laid = 0;
        for (const std::uint32_t t : from.chart.triangles) {
            if (!lay(draft, t)) {
                occupancy_.drop_last(draft.sheet, laid + before);
                return false;
            }
            ++laid;
        }
        return true;
    }

    const Geometry& geometry_;
    const Facets& facets_;
    ProgressMeter& progress_;
    const double steepest_ = cos_deg(kSteepest);
    Occupancy occupancy_;
    std::vector<Draft> drafts_;
    std::vector<std::uint32_t> root_;      ///< per draft, the one it has become part of
    std::vector<std::uint32_t> chart_of_;  ///< per triangle
    std::vector<std::uint8_t> is_free_;
    bool over_hard_edges_ = false;
    std::vector<std::uint32_t> stamp_;  ///< of the last trial growth that saw a triangle
    std::uint32_t last_stamp_ = 0;
    std::vector<std::uint32_t> queue_;
};

/// Whether the corner normals on both sides of a triangle's side agree at one of its ends at least.
bool is_smooth_side(const Mesh& mesh, const Facets& facets, std::uint32_t t, std::size_t k)
{
    const std::uint32_t other = facets.neighbours[t][k];
    for (const std::size_t end : {k, (k + 1) % 3}) {
        const int corner = static_cast<int>(end);
        const glm::uvec3 places = facets.corners[other];
        const std::uint32_t place = facets.corners[t][corner];
        const int across = places.x == place ? 0 : places.y == place ? 1 : 2;
        const std::vector<glm::vec3>& normals = mesh.surface.normals;
        const std::vector<glm::uvec3>& corners = mesh.surface.corners(mesh.geometry);
        if (glm::dot(normals[corners[t][corner]], normals[corners[other][across]]) >=
            static_cast<float>(cos_deg(kHardEdge)))
            return true;
    }
    return false;
}

/// Whether any normal between those of a triangle's corners is within kLeastPageAngle of the side
/// of the axis that the triangle faces.
bool has_weight_on_page(const Mesh& mesh, const Facets& facets, std::uint32_t t, int axis)
{
    const glm::vec3 own = facets.normals[t];
    const glm::vec3 sizes = glm::abs(own);
    if (sizes[axis] == std::max({sizes.x, sizes.y, sizes.z}))
        return true;
    if (sizes[axis] <= static_cast<float>(cos_deg(kSteepest)))
        return false;
    const glm::vec3 mean = facets.shading[t];
    float least = 1.0f;  // of mean . corner: all normals between them are in this cone
    const glm::uvec3 corners = mesh.surface.corners(mesh.geometry)[t];
    for (int k = 0; k < 3; ++k)
        least = std::min(least, glm::dot(mean, mesh.surface.normals[corners[k]]));
    const float spread = std::acos(std::clamp(least, -1.0f, 1.0f));
    const float away =
        std::acos(std::clamp(std::copysign(mean[axis], mean[axis] * own[axis]), -1.0f, 1.0f));
    return away - spread < std::acos(std::sqrt(kLeastPageWeight));
}

}  // namespace

glm::dvec2 Chart::at(glm::dvec3 position) const
{
    return scale * glm::dvec2(glm::dot(right, position), glm::dot(up, position));
}

Facets make_facets(const Mesh& mesh)
{
    const Geometry& geometry = mesh.geometry;
    const std::size_t count = geometry.triangles.size();
    Facets facets;
    facets.corners.resize(count);
    facets.normals.resize(count);
    facets.shading.resize(count);
    facets.areas.resize(count);
    facets.neighbours = neighbours_of(geometry);
    std::vector<std::uint8_t> is_alone(count, 0);
    for_all(count, kFacetGrain, [&](std::size_t t) {
        const glm::uvec3 own = geometry.triangles[t];
        const glm::uvec3 welded(geometry.welded[own.x], geometry.welded[own.y],
                                geometry.welded[own.z]);
        const glm::dvec3 true_area = doubled_area(geometry, own);
        is_alone[t] = glm::dot(doubled_area(geometry, welded), true_area) > 0.0 ? 0 : 1;
        facets.corners[t] = is_alone[t] != 0 ? own : welded;
        const glm::dvec3 doubled = doubled_area(geometry, facets.corners[t]);
        facets.areas[t] = 0.5 * glm::length(doubled);
        facets.normals[t] = glm::vec3(doubled / glm::length(doubled));
        glm::vec3 sum(0.0f);
        for (int k = 0; k < 3; ++k)
            sum += mesh.surface.normals[mesh.surface.corners(geometry)[t][k]];
        const float length = glm::length(sum);
        facets.shading[t] = length > 0.1f ? sum / length : facets.normals[t];
    });
    for (std::size_t t = 0; t < count; ++t)
        for (std::uint32_t& other : facets.neighbours[t])
            if (other != kNoTriangle && (is_alone[t] != 0 || is_alone[other] != 0))
                other = kNoTriangle;
    facets.is_smooth.resize(count);
    for_all(count, kFacetGrain, [&](std::size_t t) {
        for (std::size_t k = 0; k < 3; ++k)
            facets.is_smooth[t][k] = facets.neighbours[t][k] != kNoTriangle &&
                                     is_smooth_side(mesh, facets, static_cast<std::uint32_t>(t), k);
    });
    return facets;
}

std::vector<Chart> make_charts(const Mesh& mesh, const Facets& facets, double texel,
                               ProgressMeter& progress)
{
    ChartMaker maker(mesh, facets, progress);
    std::vector<std::uint32_t> all(facets.areas.size());
    std::iota(all.begin(), all.end(), 0u);
    const auto fitted = [&](std::uint32_t seed) { return maker.fitted_axis(seed, kChartLimit); };
    maker.grow(std::move(all), fitted, kChartLimit, /*over_hard_edges=*/false);
    maker.grow(maker.release_strips(texel), fitted, kChartLimit, /*over_hard_edges=*/true);
    maker.join(texel);
    return maker.charts();
}

std::vector<Chart> cut(const Mesh& mesh, const Facets& facets, const Chart& chart,
                       const std::vector<std::uint8_t>& is_beyond)
{
    constexpr std::uint8_t kElsewhere = 2;
    std::vector<std::uint8_t> side(facets.areas.size(), kElsewhere);
    for (std::size_t i = 0; i < chart.triangles.size(); ++i)
        side[chart.triangles[i]] = is_beyond[i];
    std::vector<Chart> pieces;
    for (const std::uint32_t start : chart.triangles) {
        if (side[start] == kElsewhere)
            continue;
        const std::uint8_t own = std::exchange(side[start], kElsewhere);
        Chart piece{chart.right, chart.up, chart.axis, {start}};
        for (std::size_t head = 0; head < piece.triangles.size(); ++head) {
            for (const std::uint32_t next : facets.neighbours[piece.triangles[head]]) {
                if (next == kNoTriangle || side[next] != own)
                    continue;
                side[next] = kElsewhere;
                piece.triangles.push_back(next);
            }
        }
        finish(mesh.geometry, facets, piece);
        pieces.push_back(std::move(piece));
    }
    return pieces;
}

std::vector<Chart> make_axis_charts(const Mesh& mesh, const Facets& facets, int axis,
                                    ProgressMeter& progress)
{
    ChartMaker maker(mesh, facets, progress);
    for (const double side : {1.0, -1.0}) {
        std::vector<std::uint32_t> members;
        for (std::uint32_t t = 0; t < facets.areas.size(); ++t)
            if (side * double{facets.normals[t][axis]} > 0.0 &&
                has_weight_on_page(mesh, facets, t, axis))
                members.push_back(t);
        glm::dvec3 direction(0.0);
        direction[axis] = side;
        maker.grow(
            std::move(members), [&](std::uint32_t) { return direction; }, 180.0,
            /*over_hard_edges=*/false);
    }
    return maker.charts();
}

}  // namespace surfelao
