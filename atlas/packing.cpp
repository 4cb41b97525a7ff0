#include "atlas/packing.h"

#include "atlas/bit_mask.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/number_text.h"
#include "surfels/texels.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace surfelao {
namespace {

/// Pages are packed in at most so many cells a side.
constexpr std::uint32_t kMostCells = 1024;
/// What rounding may move a corner, in texels: so far, a triangle touches its neighbour texels.
constexpr double kCornerNoise = 1e-6;
/// More hull edges than this are tried in steps.
constexpr std::size_t kMostHullEdges = 512;

glm::dvec2 product(glm::dvec2 a, glm::dvec2 b)  // of complex numbers: a turn and a scale
{
    return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}

double turn_of(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Andrew's monotone chain (Another efficient algorithm for convex hulls in two dimensions. 1979).
std::vector<glm::dvec2> hull_of(const ChartShape& shape)
{
    std::vector<glm::dvec2> points;
    for (const auto& triangle : shape.triangles)
        points.insert(points.end(), triangle.begin(), triangle.end());
    const auto key = [](glm::dvec2 p) { return std::pair(p.x, p.y); };
    std::ranges::sort(points, {}, key);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::vector<glm::dvec2> hull;
    for (int half = 0; half < 2; ++half) {
        const std::size_t start = hull.size();
        for (const glm::dvec2 p : points) {
            while (hull.size() >= start + 2 &&
                   turn_of(hull[hull.size() - 2], hull.back(), p) <= 0.0)
                hull.pop_back();
            hull.push_back(p);
        }
        if (hull.size() > start + 1)
            hull.pop_back();
        std::ranges::reverse(points);
    }
    return hull;
}

/// A shape in its smallest rectangle, which lies along the axes, at the origin, and is not higher
/// than wide.
struct Upright {
    glm::dvec2 right{1.0, 0.0};  ///< the turn
    glm::dvec2 low{0.0};         ///< of the turned shape
    glm::dvec2 extent{0.0};
    double area = 0.0;
};

Upright upright(const ChartShape& shape)
{
    const std::vector<glm::dvec2> hull = hull_of(shape);
    Upright best;
    double least = HUGE_VAL;
    const std::size_t step = 1 + hull.size() / kMostHullEdges;
    for (std::size_t i = 0; i < hull.size(); i += step) {
        const glm::dvec2 edge = hull[(i + 1) % hull.size()] - hull[i];
        const double length = glm::length(edge);
        Upright found;
        if (length > 0.0)
            found.right = {edge.x / length, -edge.y / length};
        glm::dvec2 high(-HUGE_VAL);
        for (int turned = 0; turned < 2; ++turned) {
            found.low = glm::dvec2(HUGE_VAL);
            high = glm::dvec2(-HUGE_VAL);
            for (const glm::dvec2 p : hull) {
                const glm::dvec2 q = product(found.right, p);
                found.low = glm::min(found.low, q);
                high = glm::max(high, q);
            }
            found.extent = high - found.low;
            if (found.extent.x >= found.extent.y)
                break;
            found.right = product({0.0, 1.0}, found.right);
        }
        if (found.extent.x * found.extent.y < least) {
            least = found.extent.x * found.extent.y;
            best = found;
        }
    }
    for (const auto& t : shape.triangles)
        best.area += 0.5 * std::abs(turn_of(t[0], t[1], t[2]));
    return best;
}

/// The columns in which a triangle meets low <= y <= low + 1.
std::pair<double, double> columns_in_row(const std::array<glm::dvec2, 3>& p, double low)
{
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 a = p[k], b = p[(k + 1) % 3];
        if (std::max(a.y, b.y) < low || std::min(a.y, b.y) > low + 1.0)
            continue;
        for (const double y : {low, low + 1.0}) {
            const double t = a.y == b.y ? 0.0 : std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0);
            const double x = a.x + t * (b.x - a.x);
            least = std::min({least, x, a.y == b.y ? b.x : x});
            most = std::max({most, x, a.y == b.y ? b.x : x});
        }
    }
    return {least, most};
}

/// The texels that a triangle touches.
void draw(const std::array<glm::dvec2, 3>& p, BitMask& mask)
{
    const auto cell = [](double coordinate, std::uint32_t end) {
        return static_cast<std::uint32_t>(
            std::clamp(coordinate, 0.0, static_cast<double>(end) - 1.0));
    };
    const std::uint32_t first =
        cell(std::min({p[0].y, p[1].y, p[2].y}) - kCornerNoise, mask.height());
    const std::uint32_t last =
        cell(std::max({p[0].y, p[1].y, p[2].y}) + kCornerNoise, mask.height());
    if (last - first < 2) {
        const double low = std::min({p[0].x, p[1].x, p[2].x});
        const double high = std::max({p[0].x, p[1].x, p[2].x});
        const std::uint32_t begin = cell(low - kCornerNoise, mask.width());
        const std::uint32_t end = cell(high + kCornerNoise, mask.width());
        if (end - begin < 2) {
            for (std::uint32_t y = first; y <= last; ++y)
                mask.set(y, begin, end + 1);
            return;
        }
    }
    for (std::uint32_t y = first; y <= last; ++y) {
        const auto [least, most] = columns_in_row(p, y);
        if (least <= most)
            mask.set(y, cell(least - kCornerNoise, mask.width()),
                     cell(most + kCornerNoise, mask.width()) + 1);
    }
}

/// Rows of a stencil that are looked at before all of it is.
constexpr std::uint32_t kProbes = 6;

/// A shape as the packing sees it, in cells and in one of its turns, with its padding.
struct Stencil {
    explicit Stencil(BitMask cells) : mask(std::move(cells))
    {
        std::vector<std::pair<std::uint32_t, CellRun>> runs;
        for (std::uint32_t y = 0; y < mask.height(); ++y)
            runs.emplace_back(y, longest_run(mask.row(y), mask.width(), true));
        std::ranges::stable_sort(runs, std::greater{},
                                 [](const auto& run) { return run.second.length; });
        // the longest, and what is long and far from it
        for (const auto& run : runs) {
            const bool is_near = std::ranges::any_of(probes, [&](const auto& probe) {
                const std::uint32_t away =
                    std::max(probe.first, run.first) - std::min(probe.first, run.first);
                return away < mask.height() / (2 * kProbes);
            });
            if (probes.size() < kProbes && !is_near)
                probes.push_back(run);
        }
    }

    BitMask mask;
    std::vector<std::pair<std::uint32_t, CellRun>> probes;  ///< rows, and the longest run of each
};

/// Where a stencil was put.
struct Spot {
    std::uint32_t x = 0, y = 0;
    std::uint32_t turn = 0;
};

/// A page while it is filled.
class Page {
public:
    explicit Page(std::uint32_t cells)
        : taken_(cells, cells), free_run_(cells, cells), row_((cells + 63) / 64)
    {
    }

    /// The first place from the top, above row `end`, where it fits; from there, from the left.
    std::optional<Spot> find(const Stencil& stencil, std::uint32_t end)
    {
        const BitMask& mask = stencil.mask;
        if (mask.width() > taken_.width() || mask.height() > taken_.height())
            return {};
        end = std::min(end, taken_.height() - mask.height() + 1);
        for (std::uint32_t y = from_[kind_of(mask)]; y < end; ++y) {
            const bool may_fit = std::ranges::all_of(stencil.probes, [&](const auto& probe) {
                return free_run_[y + probe.first] >= probe.second.length;
            });
            if (!may_fit)
                continue;
            if (const auto x = find_in_row(stencil, y))
                return Spot{*x, y};
        }
        return {};
    }

    void put(const BitMask& mask, Spot spot)
    {
        taken_.stamp(mask, spot.x, spot.y);
        for (std::uint32_t y = spot.y; y < spot.y + mask.height(); ++y)
            free_run_[y] = longest_run(taken_.row(y), taken_.width(), false).length;
        from_[kind_of(mask)] = spot.y;
    }

private:
    /// Stencils of one kind are much alike, and the later ones smaller.
    using Kind = std::pair<std::uint32_t, std::uint32_t>;
    static Kind kind_of(const BitMask& mask)
    {
        const auto step = [](std::uint32_t length) {
            const auto octave = static_cast<std::uint32_t>(std::bit_width(length));
            return octave * 8 + (octave > 4 ? length >> (octave - 4) & 7 : length);
        };
        return {step(mask.width()), step(mask.height())};
    }

    std::optional<std::uint32_t> find_in_row(const Stencil& stencil, std::uint32_t y)
    {
        // what the probes leave over
        const std::uint32_t places = taken_.width() - stencil.mask.width() + 1;
        blocked_.assign((places + 63) / 64, 0);
        for (const auto& [row, run] : stencil.probes) {
            std::ranges::copy(taken_.row(y + row), row_.begin());
            smear_down(row_, run.length);
            shift_down(row_, run.begin);
            bool has_place = false;
            for (std::size_t i = 0; i < blocked_.size(); ++i) {
                blocked_[i] |= row_[i];
                has_place = has_place || blocked_[i] != ~std::uint64_t{0};
            }
            if (!has_place)
                return {};
        }
        for (std::size_t i = 0; i < blocked_.size(); ++i) {
            for (std::uint64_t open = ~blocked_[i]; open != 0; open &= open - 1) {
                const auto x = static_cast<std::uint32_t>(i * 64) +
                               static_cast<std::uint32_t>(std::countr_zero(open));
                if (x < places && !taken_.meets(stencil.mask, x, y))
                    return x;
            }
        }
        return {};
    }

    BitMask taken_;
    std::vector<std::uint32_t> free_run_;  ///< longest, per row
    std::map<Kind, std::uint32_t> from_;   ///< where the last of its kind came to lie
    std::vector<std::uint64_t> row_, blocked_;
};

/// Which shapes go first: the widest across, or with the largest rectangle, longest rectangle, or
/// area. None is always best.
constexpr std::size_t kOrders = 4;

struct Trial {
    double scale = 0.0;
    std::size_t order = 0;
};

class Packer {
public:
    Packer(std::span<const ChartShape> shapes, const PackingSettings& settings)
        : shapes_(shapes),
          pages_(settings.pages),
          padding_(std::max(1u, settings.padding)),
          upright_(shapes.size())
    {
        for_tasks(shapes.size(), [&](std::size_t i) { upright_[i] = upright(shapes[i]); });
        const std::array<std::function<double(const Upright&)>, kOrders> sizes{
            [](const Upright& one) { return one.extent.y; },
            [](const Upright& one) { return one.extent.x * one.extent.y; },
            [](const Upright& one) { return one.extent.x + one.extent.y; },
            [](const Upright& one) { return one.area; }};
        for (std::size_t k = 0; k < kOrders; ++k) {
            orders_[k].resize(shapes.size());
            std::iota(orders_[k].begin(), orders_[k].end(), std::size_t{0});
            std::ranges::stable_sort(orders_[k], std::greater{}, [&](std::size_t i) {
                return std::pair(sizes[k](upright_[i]), upright_[i].extent.x);
            });
        }
    }

    /// The area of the fullest page, and of the longest shape.
    [[nodiscard]] double area() const
    {
        std::vector<double> areas(pages_, 0.0);
        for (std::size_t i = 0; i < shapes_.size(); ++i)
            areas[shapes_[i].page] += upright_[i].area;
        return *std::ranges::max_element(areas);
    }
    [[nodiscard]] double longest() const
    {
        double longest = 0.0;
        for (const Upright& one : upright_)
            longest = std::max(longest, one.extent.x);
        return longest;
    }

    /// Nothing where they do not fit.
    [[nodiscard]] std::optional<Packing> at(const Trial& trial, std::uint32_t size) const
    {
        const double scale = trial.scale;
        if (longest() * scale + 2.0 * padding_ > size)
            return {};
        const std::uint32_t cell = (size + kMostCells - 1) / kMostCells;
        std::vector<BitMask> masks(shapes_.size());  // with padding
        std::vector<std::uint64_t> covered(shapes_.size());
        for_tasks(shapes_.size(), [&](std::size_t i) {
            const BitMask own = drawn(i, scale);
            covered[i] = own.count();
            masks[i] = own.dilated(padding_of(i, scale));
        });
        std::vector<std::uint64_t> needed(pages_, 0);
        for (std::size_t i = 0; i < shapes_.size(); ++i)
            needed[shapes_[i].page] += masks[i].count();
        if (std::ranges::max(needed) > std::uint64_t{size} * size)
            return {};
        Packing packing{size, scale, std::vector<ChartPlacement>(shapes_.size()), 0};
        packing.covered = std::accumulate(covered.begin(), covered.end(), std::uint64_t{0});
        std::vector<Page> pages(pages_, Page(size / cell));
        for (const std::size_t i : orders_[trial.order]) {
            const auto spot = put(masks[i], cell, pages[shapes_[i].page]);
            if (!spot)
                return {};
            packing.placements[i] = placement(i, scale, masks[i], cell, *spot);
        }
        return packing;
    }

private:
    /// The shape's own texels: as few as hold it, with the shape in their middle.
    [[nodiscard]] BitMask drawn(std::size_t i, double scale) const
    {
        const glm::dvec2 extent = scale * upright_[i].extent;
        const auto cells = [](double length) {
            return std::max(1u, static_cast<std::uint32_t>(std::ceil(length - kCornerNoise)));
        };
        BitMask mask(cells(extent.x), cells(extent.y));
        const ChartPlacement place = local(i, scale, mask);
        for (const auto& t : shapes_[i].triangles)
            draw({place.at(t[0]), place.at(t[1]), place.at(t[2])}, mask);
        return mask;
    }

    [[nodiscard]] std::uint32_t padding_of(std::size_t i, double scale) const
    {
        const double enough = std::round(kPaddingOfWidth * scale * shapes_[i].width);
        return static_cast<std::uint32_t>(std::clamp(enough, 1.0, static_cast<double>(padding_)));
    }

    /// From the shape's plane to its mask.
    [[nodiscard]] ChartPlacement local(std::size_t i, double scale, const BitMask& mask) const
    {
        const Upright& one = upright_[i];
        const glm::dvec2 room = glm::dvec2(mask.width(), mask.height()) - scale * one.extent;
        return {scale * one.right, 0.5 * room - scale * one.low};
    }

    /// In the turn that comes to lie highest.
    static std::optional<Spot> put(BitMask texels, std::uint32_t cell, Page& page)
    {
        std::optional<Spot> best;
        BitMask best_mask;
        std::uint32_t end = kMostTexels;
        for (std::uint32_t turn = 0; turn < 4; ++turn) {
            if (turn > 0)
                texels = texels.turned();
            const Stencil stencil(cell > 1 ? texels.coarser(cell) : texels);
            if (const auto spot = page.find(stencil, end)) {
                best = Spot{spot->x, spot->y, turn};
                end = spot->y;
                best_mask = stencil.mask;
            }
        }
        if (best)
            page.put(best_mask, *best);
        return best;
    }

    [[nodiscard]] ChartPlacement placement(std::size_t i, double scale, const BitMask& mask,
                                           std::uint32_t cell, Spot spot) const
    {
        ChartPlacement place = local(i, scale, mask);
        double width = mask.width(), height = mask.height();
        for (std::uint32_t turn = 0; turn < spot.turn; ++turn) {
            place.right = product({0.0, 1.0}, place.right);
            place.origin = {height - place.origin.y, place.origin.x};
            std::swap(width, height);
        }
        place.origin += glm::dvec2(cell) * glm::dvec2(spot.x, spot.y);
        return place;
    }

    std::span<const ChartShape> shapes_;
    std::uint32_t pages_, padding_;
    std::vector<Upright> upright_;
    std::array<std::vector<std::size_t>, kOrders> orders_;
};

/// Tried at a time, whatever the number of cores.
constexpr std::size_t kTrials = 4;
using Trials = std::array<Trial, kTrials>;
static_assert(kTrials == kOrders);

class Search {
public:
    Search(const Packer& packer, ProgressMeter& progress, std::uint64_t units)
        : packer_(packer), progress_(progress), units_left_(units)
    {
    }

    std::optional<Packing> first_that_fits(const Trials& trials, std::uint32_t size)
    {
        std::array<std::optional<Packing>, kTrials> found;
        for_tasks(kTrials, [&](std::size_t i) { found[i] = packer_.at(trials[i], size); });
        tell();
        for (std::optional<Packing>& one : found)
            if (one)
                return std::move(one);
        return {};
    }

    std::optional<Packing> at(double scale, std::uint32_t size)
    {
        std::optional<Packing> found = packer_.at({scale, 0}, size);
        tell();
        return found;
    }

    void finish() { progress_.add(units_left_); }

private:
    /// How long a search takes is not known beforehand.
    void tell()
    {
        const std::uint64_t units = units_left_ / 8;
        units_left_ -= units;
        progress_.add(units);
    }

    const Packer& packer_;
    ProgressMeter& progress_;
    std::uint64_t units_left_;
};

/// The share of a page that shapes may cover at most, and the first step down from there.
constexpr double kMostUse = 0.95;
constexpr double kUseStep = 0.87;
/// From the best scale up, in steps of about a percent of use, in any order that fits.
constexpr double kClimb = 1.005;
constexpr int kMostClimbs = 8;
/// Of more shapes the order makes no difference.
constexpr std::size_t kMostOrdered = 500;

std::optional<Packing> largest_scale(const Packer& packer, const PackingSettings& settings,
                                     Search& search)
{
    const double room = settings.size - 2.0 * std::max(1u, settings.padding);
    if (!(room > 0.0))
        return {};
    double scale =
        std::min(settings.size * std::sqrt(kMostUse / packer.area()), room / packer.longest());
    // down in larger and larger steps
    std::optional<Packing> best;
    double step = std::sqrt(kUseStep);
    for (bool is_last = false; !best && !is_last; step = best ? step : step * step) {
        Trials trials;
        for (Trial& trial : trials) {
            trial.scale = scale;
            scale *= step;
        }
        is_last = !(packer.longest() * scale >= step);
        best = search.first_that_fits(trials, settings.size);
    }
    if (!best)
        return {};
    // the next larger scale did not fit: what is between?
    Trials trials;
    for (std::size_t i = 0; i < kTrials; ++i)
        trials[i].scale = best->scale * std::pow(step, -static_cast<double>(kTrials - i) /
                                                           static_cast<double>(kTrials + 1));
    if (auto better = search.first_that_fits(trials, settings.size))
        best = std::move(better);
    const int most = best->placements.size() <= kMostOrdered ? kMostClimbs : 0;
    for (int climbs = 0; climbs < most; ++climbs) {
        for (std::size_t i = 0; i < kTrials; ++i)
            trials[i] = {best->scale * kClimb, i};
        auto better = search.first_that_fits(trials, settings.size);
        if (!better)
            break;
        best = std::move(better);
    }
    return best;
}

std::optional<Packing> smallest_size(const Packer& packer, double scale, std::uint32_t padding,
                                     Search& search)
{
    const auto rounded = [](double size) {
        return static_cast<std::uint32_t>(std::ceil(size / 4.0)) * 4;
    };
    const double least = std::max(scale * std::sqrt(packer.area()),
                                  scale * packer.longest() + 2.0 * std::max(1u, padding));
    if (least > kMostTexels)
        return {};
    std::uint32_t below = rounded(least) - 4;  // does not fit
    std::optional<Packing> best;
    for (double factor = 1.08; !best; factor *= 1.08) {
        const std::uint32_t size = std::min(kMostTexels, rounded(least * factor));
        best = search.at(scale, size);
        if (!best) {
            if (size == kMostTexels)
                return {};
            below = size;
        }
    }
    while (best->size - below > 4) {
        const std::uint32_t middle = below + (best->size - below) / 8 * 4;
        if (auto smaller = search.at(scale, middle))
            best = std::move(smaller);
        else
            below = middle;
    }
    return best;
}

}  // namespace

Packing pack(std::span<const ChartShape> shapes, const PackingSettings& settings,
             ProgressMeter& progress, std::uint64_t units)
{
    if (shapes.empty())
        return {settings.size, settings.scale.value_or(1.0), {}, 0};
    const Packer packer(shapes, settings);
    Search search(packer, progress, units);
    std::optional<Packing> packing =
        settings.scale ? smallest_size(packer, *settings.scale, settings.padding, search)
                       : largest_scale(packer, settings, search);
    const std::string count = count_text(shapes.size(), "chart");
    const std::string padding = " with a padding of " + std::to_string(settings.padding);
    if (!packing && settings.scale)
        throw SettingsError("no room for " + count + " in a map of " + std::to_string(kMostTexels) +
                            " texels a side at that many texels per unit" + padding);
    if (!packing)
        throw SettingsError("no room for " + count + " in a map of " +
                            std::to_string(settings.size) + " texels a side" + padding);
    search.finish();
    return std::move(*packing);
}

}  // namespace surfelao
