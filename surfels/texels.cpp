#include "surfels/texels.h"

#include "surfels/buckets.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace surfelao {
namespace {

/// Twice a triangle's area in texels below which it shows nothing.
constexpr double kFlatTwiceArea = 1e-9;
/// A triangle of this area in texels has some part above kLeastPart.
constexpr double kHasLargePart = 1e-3;

double cross(glm::dvec2 a, glm::dvec2 b)
{
    return a.x * b.y - a.y * b.x;
}

double twice_area(const glm::dvec2 (&p)[3])
{
    return cross(p[1] - p[0], p[2] - p[0]);
}

glm::uvec3 corners_in_map(const Geometry& geometry, const UvSet& uvs, std::uint32_t triangle)
{
    return uvs.corners.empty() ? geometry.triangles[triangle]
                               : uvs.corners[geometry.scene_triangle(triangle)];
}

/// On which side of the line a-b the point lies: exactly opposite for b-a.
double side_of(glm::dvec2 a, glm::dvec2 b, glm::dvec2 point)
{
    const bool turned = b.x < a.x || (b.x == a.x && b.y < a.y);
    const glm::dvec2 from = turned ? b : a, to = turned ? a : b;
    const double side = cross(to - from, point - from);
    return turned ? -side : side;
}

/// Of two triangles with a common edge one contains each point of it: the one whose edge looks up,
/// or straight left.
bool contains(const glm::dvec2 (&p)[3], glm::dvec2 point)
{
    const bool turned = twice_area(p) < 0.0;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec2 a = p[turned ? (k + 1) % 3 : k], b = p[turned ? k : (k + 1) % 3];
        const double side = side_of(a, b, point);
        const bool owns_edge = b.y < a.y || (b.y == a.y && b.x > a.x);
        if (side < 0.0 || (side == 0.0 && !owns_edge))
            return false;
    }
    return true;
}

SurfacePoint point_at(const glm::dvec2 (&p)[3], std::uint32_t triangle, glm::dvec2 place)
{
    const double whole = twice_area(p);
    double second = cross(place - p[0], p[2] - p[0]) / whole;
    double third = cross(p[1] - p[0], place - p[0]) / whole;
    second = std::clamp(second, 0.0, 1.0);
    third = std::clamp(third, 0.0, 1.0 - second);
    return {triangle, {static_cast<float>(second), static_cast<float>(third)}};
}

/// A convex polygon: a triangle cut by the four sides of a texel has seven corners at most.
struct Clipped {
    std::array<glm::dvec2, 8> corners;
    std::size_t count = 0;

    void add(glm::dvec2 corner) { corners[count++] = corner; }
};

/// What lies where sign * (corner[axis] - limit) >= 0 (Sutherland, Hodgman. Reentrant Polygon
/// Clipping. 1974).
Clipped cut(const Clipped& polygon, int axis, double limit, double sign)
{
    Clipped rest;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2 a = polygon.corners[i], b = polygon.corners[(i + 1) % polygon.count];
        const double from = sign * (a[axis] - limit), to = sign * (b[axis] - limit);
        if (from >= 0.0)
            rest.add(a);
        if ((from < 0.0) != (to < 0.0) && rest.count < rest.corners.size())
            rest.add(a + from / (from - to) * (b - a));
    }
    return rest;
}

struct PartOfTexel {
    double area = 0.0;
    glm::dvec2 centroid{0.0};
};

PartOfTexel part_in_texel(const glm::dvec2 (&p)[3], glm::dvec2 low)
{
    Clipped polygon;
    for (const glm::dvec2 corner : p)
        polygon.add(corner - low);
    for (int axis = 0; axis < 2; ++axis) {
        polygon = cut(polygon, axis, 0.0, 1.0);
        polygon = cut(polygon, axis, 1.0, -1.0);
    }
    PartOfTexel part;
    double twice = 0.0;
    glm::dvec2 sum(0.0);
    for (std::size_t i = 1; i + 1 < polygon.count; ++i) {
        const glm::dvec2 a = polygon.corners[0], b = polygon.corners[i], c = polygon.corners[i + 1];
        const double area = std::abs(cross(b - a, c - a));
        twice += area;
        sum += area / 3.0 * (a + b + c);
    }
    part.area = twice / 2.0;
    if (twice > 0.0)
        part.centroid = low + sum / twice;
    return part;
}

/// The texels that a range of the plane touches.
struct Span {
    std::int64_t begin, end;
};

Span span_of(double low, double high)
{
    return {static_cast<std::int64_t>(std::floor(low)), static_cast<std::int64_t>(std::ceil(high))};
}

std::uint32_t folded(std::int64_t texel, std::uint32_t side)
{
    const std::int64_t rest = texel % side;
    return static_cast<std::uint32_t>(rest < 0 ? rest + side : rest);
}

}  // namespace

std::optional<glm::dvec2> uv_at(const Geometry& geometry, const UvSet& uvs,
                                const SurfacePoint& point)
{
    const glm::uvec3 corners = corners_in_map(geometry, uvs, point.triangle);
    const double weights[3] = {1.0 - double{point.at.x} - double{point.at.y}, point.at.x,
                               point.at.y};
    glm::dvec2 uv(0.0);
    for (int k = 0; k < 3; ++k) {
        if (corners[k] == UvSet::kNone)
            return {};
        uv += weights[k] * uvs.values[corners[k]];
    }
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y))
        return {};
    return uv;
}

/// A few rows of the map, filled by one thread.
class MapRaster::Strip {
public:
    Strip(const MapRaster& raster, const WantedTexels& wanted, std::uint32_t first,
          std::uint32_t rows)
        : raster_(raster),
          wanted_(wanted),
          first_(first),
          rows_(rows),
          best_(std::size_t{rows} * raster.size_.width)
    {
    }

    /// Triangles in their order: all centres first, then all parts.
    void add_centres(const Placed& placed) { for_each_row(placed, &Strip::add_centres_in_row); }
    void add_parts(const Placed& placed) { for_each_row(placed, &Strip::add_parts_in_row); }

    [[nodiscard]] std::vector<Texel> texels()
    {
        std::vector<Texel> list;
        std::ranges::stable_sort(sheets_, {}, [](const Sheet& sheet) { return sheet.place; });
        std::size_t next = 0;
        for (std::size_t place = 0; place < best_.size(); ++place) {
            const Best& best = best_[place];
            const auto x = static_cast<std::uint32_t>(place % raster_.size_.width);
            const auto y = first_ + static_cast<std::uint32_t>(place / raster_.size_.width);
            if (best.is_centre) {
                for (; next < sheets_.size() && sheets_[next].place == place; ++next)
                    if (!sheets_[next].is_outside || !best.has_inside)
                        list.push_back({x, y, sheets_[next].point, 1.0f});
            } else if (best.area > 0.0f) {
                list.push_back({x, y, best.point, best.area});
            }
        }
        return list;
    }

private:
    struct Best {
        SurfacePoint point;
        float area = 0.0f;
        bool is_centre = false;   ///< then the points are in sheets_
        bool has_inside = false;  ///< one of them, or the part, is of a triangle within [0, 1]
    };
    struct Sheet {
        std::size_t place;
        SurfacePoint point;
        bool is_outside;
    };
    using Row = void (Strip::*)(const Placed&, std::int64_t y, std::size_t first_place);

    void for_each_row(const Placed& placed, Row row)
    {
        const auto& p = placed.corners;
        const Span ys =
            span_of(std::min({p[0].y, p[1].y, p[2].y}), std::max({p[0].y, p[1].y, p[2].y}));
        // of each tile the rows of this strip
        const std::int64_t height = raster_.size_.height;
        for (std::int64_t tile = ys.begin - folded(ys.begin, raster_.size_.height); tile < ys.end;
             tile += height) {
            const std::int64_t begin = std::max(ys.begin, tile + first_);
            const std::int64_t end = std::min(ys.end, tile + first_ + rows_);
            for (std::int64_t y = begin; y < end; ++y)
                (this->*row)(placed, y,
                             static_cast<std::size_t>(y - tile - first_) * raster_.size_.width);
        }
    }

    /// The flags of a row's blocks; empty where all is wanted.
    [[nodiscard]] std::span<const std::uint8_t> wanted_of_row(std::size_t first_place) const
    {
        if (wanted_.blocks.empty())
            return {};
        const std::size_t columns = raster_.size_.width / wanted_.side;
        const std::size_t y = first_ + first_place / raster_.size_.width;
        return wanted_.blocks.subspan(y / wanted_.side * columns, columns);
    }

    /// The columns in which the triangle meets low <= y <= high.
    static Span columns_in(const Placed& placed, double low, double high)
    {
        double least = HUGE_VAL, most = -HUGE_VAL;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec2 a = placed.corners[k], b = placed.corners[(k + 1) % 3];
            if (std::max(a.y, b.y) < low || std::min(a.y, b.y) > high)
                continue;
            for (const double y : {low, high}) {
                const double t = a.y == b.y ? 0.0 : std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0);
                const double x = a.x + t * (b.x - a.x);
                least = std::min({least, x, a.y == b.y ? b.x : x});
                most = std::max({most, x, a.y == b.y ? b.x : x});
            }
        }
        return least <= most ? span_of(least - 1e-9, most + 1e-9) : Span{0, 0};
    }

    void add_centres_in_row(const Placed& placed, std::int64_t y, std::size_t first_place)
    {
        const double row = static_cast<double>(y) + 0.5;
        const Span columns = columns_in(placed, row, row);
        const std::span<const std::uint8_t> wanted = wanted_of_row(first_place);
        for (std::int64_t x = columns.begin; x < columns.end; ++x) {
            const glm::dvec2 centre(static_cast<double>(x) + 0.5, row);
            const std::uint32_t column = folded(x, raster_.size_.width);
            if ((!wanted.empty() && wanted[column / wanted_.side] == 0) ||
                !contains(placed.corners, centre))
                continue;
            const std::size_t place = first_place + column;
            best_[place].is_centre = true;
            best_[place].has_inside |= !placed.is_outside;
            sheets_.push_back(
                {place, point_at(placed.corners, placed.triangle, centre), placed.is_outside});
        }
    }

    void add_parts_in_row(const Placed& placed, std::int64_t y, std::size_t first_place)
    {
        const double low = static_cast<double>(y);
        const Span columns = columns_in(placed, low, low + 1.0);
        const std::span<const std::uint8_t> wanted = wanted_of_row(first_place);
        const bool has_large_part = std::abs(twice_area(placed.corners)) > 2.0 * kHasLargePart;
        for (std::int64_t x = columns.begin; x < columns.end; ++x) {
            const std::uint32_t column = folded(x, raster_.size_.width);
            Best& best = best_[first_place + column];
            if ((!wanted.empty() && wanted[column / wanted_.side] == 0) || best.is_centre ||
                (placed.is_outside && best.has_inside))
                continue;
            const PartOfTexel part = part_in_texel(placed.corners, {static_cast<double>(x), low});
            if (!(part.area > 0.0) || (part.area < kLeastPart && has_large_part))
                continue;
            const bool is_first_inside = !placed.is_outside && !best.has_inside;
            if (!is_first_inside && static_cast<float>(part.area) <= best.area)
                continue;
            best.point = point_at(placed.corners, placed.triangle, part.centroid);
            best.area = static_cast<float>(part.area);
            best.has_inside |= !placed.is_outside;
        }
    }

    const MapRaster& raster_;
    const WantedTexels& wanted_;
    std::uint32_t first_, rows_;
    std::vector<Best> best_;
    std::vector<Sheet> sheets_;
};

MapRaster::MapRaster(const Geometry& geometry, const UvSet& uvs, MapSize size) : size_(size)
{
    require(size.width >= 1 && size.height >= 1 && size.width <= kMostTexels &&
                size.height <= kMostTexels,
            "a map has 1 to " + std::to_string(kMostTexels) + " texels a side");
    const glm::dvec2 scale(size.width, size.height);
    for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
        const glm::uvec3 corners = corners_in_map(geometry, uvs, t);
        Placed placed;
        placed.triangle = t;
        glm::dvec2 least(HUGE_VAL), most(-HUGE_VAL);
        bool is_there = true;
        for (int k = 0; k < 3; ++k) {
            if (corners[k] == UvSet::kNone) {
                is_there = false;
                break;
            }
            const glm::dvec2 uv = uvs.values[corners[k]];
            is_there &= std::isfinite(uv.x) && std::isfinite(uv.y);
            placed.corners[k] = uv * scale;
            least = glm::min(least, uv);
            most = glm::max(most, uv);
        }
        const double twice = std::abs(twice_area(placed.corners));
        is_there = is_there && most.x - least.x <= kMostTiles && most.y - least.y <= kMostTiles &&
                   twice > kFlatTwiceArea;
        if (!is_there) {
            ++flat_;
            continue;
        }
        sheets_ += 0.5 * twice / static_cast<double>(size_.count());
        placed.is_outside = least.x < 0.0 || least.y < 0.0 || most.x > 1.0 || most.y > 1.0;
        outside_ += placed.is_outside ? 1 : 0;
        placed_.push_back(placed);
    }
    of_strip_ = std::make_shared<const Buckets<std::uint32_t>>(
        (size_.height + kStripRows - 1) / kStripRows, [&](const auto& put) {
            for (std::uint32_t i = 0; i < placed_.size(); ++i) {
                const auto& p = placed_[i].corners;
                const Span ys =
                    span_of(std::min({p[0].y, p[1].y, p[2].y}), std::max({p[0].y, p[1].y, p[2].y}));
                const std::int64_t end = std::min(ys.end, ys.begin + size_.height);
                std::uint32_t row = folded(ys.begin, size_.height);
                for (std::int64_t y = ys.begin; y < end;) {
                    put(row / kStripRows, i);
                    const std::uint32_t next =
                        std::min((row / kStripRows + 1) * kStripRows, size_.height);
                    y += next - row;
                    row = next == size_.height ? 0 : next;
                }
            }
        });
}

void MapRaster::mark_shown(std::span<std::uint8_t> triangles) const
{
    for (const Placed& placed : placed_)
        triangles[placed.triangle] = 1;
}

bool MapRaster::has_wanted(const WantedTexels& wanted, std::uint32_t first,
                           std::uint32_t rows) const
{
    if (wanted.blocks.empty())
        return true;
    const std::size_t columns = size_.width / wanted.side;
    const std::size_t begin = first / wanted.side, end = (first + rows - 1) / wanted.side + 1;
    const auto flags = wanted.blocks.subspan(begin * columns, (end - begin) * columns);
    return std::ranges::find_if(flags, [](std::uint8_t flag) { return flag != 0; }) != flags.end();
}

std::vector<Texel> MapRaster::texels(std::uint32_t first, std::uint32_t rows,
                                     const WantedTexels& wanted) const
{
    SURFELAO_CHECK(wanted.blocks.empty() ||
                   wanted.blocks.size() * wanted.side * wanted.side == size_.count());
    const std::uint32_t end = std::min(size_.height, first + rows);
    if (first >= end)
        return {};
    const std::uint32_t first_strip = first / kStripRows;
    const std::uint32_t strips = (end - 1) / kStripRows + 1 - first_strip;
    std::vector<std::vector<Texel>> found(strips);
    for_tasks(strips, [&](std::size_t s) {
        const auto number = first_strip + static_cast<std::uint32_t>(s);
        const std::uint32_t begin = std::max(first, number * kStripRows);
        const std::uint32_t strip_rows = std::min(end, (number + 1) * kStripRows) - begin;
        if (!has_wanted(wanted, begin, strip_rows))
            return;
        Strip strip(*this, wanted, begin, strip_rows);
        const std::span<const std::uint32_t> list = (*of_strip_)[number];
        const auto for_each = [&](const auto& add) {
            for (std::size_t k = 0; k < list.size(); ++k)
                if (k == 0 || list[k] != list[k - 1])
                    add(placed_[list[k]]);
        };
        for_each([&](const Placed& placed) { strip.add_centres(placed); });
        for_each([&](const Placed& placed) { strip.add_parts(placed); });
        found[s] = strip.texels();
    });
    std::vector<std::size_t> begins{0};
    for (const std::vector<Texel>& some : found)
        begins.push_back(begins.back() + some.size());
    std::vector<Texel> all(begins.back());
    for_tasks(strips, [&](std::size_t s) {
        std::ranges::copy(found[s], all.begin() + static_cast<std::ptrdiff_t>(begins[s]));
    });
    return all;
}

}  // namespace surfelao
