#include "atlas/occupancy.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace surfelao {
namespace {

constexpr std::uint32_t kNoEntry = 0xffffffff;

double cross_of(glm::dvec2 a, glm::dvec2 b)
{
    return a.x * b.y - a.y * b.x;
}

/// Whether a side of a has all of b on its outer side.
bool is_parted_by_a_side(const FlatTriangle& a, const FlatTriangle& b)
{
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 from = a[k], side = a[(k + 1) % 3] - from;
        if (cross_of(side, b[0] - from) <= 0.0 && cross_of(side, b[1] - from) <= 0.0 &&
            cross_of(side, b[2] - from) <= 0.0)
            return true;
    }
    return false;
}

struct FlatBox {
    glm::dvec2 low, high;
};

FlatBox box_of(const FlatTriangle& t)
{
    return {{std::min({t[0].x, t[1].x, t[2].x}), std::min({t[0].y, t[1].y, t[2].y})},
            {std::max({t[0].x, t[1].x, t[2].x}), std::max({t[0].y, t[1].y, t[2].y})}};
}

/// The cells of one grid that a box touches.
struct Cells {
    Cells(const FlatBox& box, int exponent)
        : low_x(cell_of(box.low.x, exponent)),
          low_y(cell_of(box.low.y, exponent)),
          high_x(cell_of(box.high.x, exponent)),
          high_y(cell_of(box.high.y, exponent))
    {
    }

    static std::int64_t cell_of(double coordinate, int exponent)
    {
        return static_cast<std::int64_t>(std::floor(std::ldexp(coordinate, -exponent)));
    }
    [[nodiscard]] double count() const
    {
        return static_cast<double>(high_x - low_x + 1) * static_cast<double>(high_y - low_y + 1);
    }
    template <class Visit>
    void for_each(const Visit& visit) const
    {
        for (std::int64_t y = low_y; y <= high_y; ++y)
            for (std::int64_t x = low_x; x <= high_x; ++x)
                visit(x, y);
    }

    std::int64_t low_x, low_y, high_x, high_y;
};

/// Finer grids than 2^-40 of the unit frame tell nothing apart that floats do.
constexpr int kFinest = -40;

int exponent_of(const FlatBox& box)
{
    const double extent = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
    return extent > 0.0 ? std::max(kFinest, std::ilogb(extent) + 1) : kFinest;
}

}  // namespace

double twice_area(const FlatTriangle& triangle)
{
    return cross_of(triangle[1] - triangle[0], triangle[2] - triangle[0]);
}

bool overlap(const FlatTriangle& a, const FlatTriangle& b)
{
    return !is_parted_by_a_side(a, b) && !is_parted_by_a_side(b, a);
}

Occupancy::Occupancy(std::size_t expected) : heads_(std::bit_ceil(4 * expected + 16), kNoEntry)
{
    placed_.reserve(expected);
    entries_.reserve(3 * expected);
}

std::uint32_t Occupancy::add_sheet()
{
    sheets_.emplace_back();
    return static_cast<std::uint32_t>(sheets_.size() - 1);
}

std::uint32_t Occupancy::slot_of(std::uint32_t sheet, int exponent, std::int64_t x,
                                 std::int64_t y) const
{
    std::uint64_t key = sheet * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(exponent + 64);
    for (const std::int64_t part : {x, y}) {
        key = (key ^ static_cast<std::uint64_t>(part)) * 0xbf58476d1ce4e5b9u;
        key ^= key >> 31;
    }
    return static_cast<std::uint32_t>(key & (heads_.size() - 1));
}

bool Occupancy::fits(std::uint32_t sheet, const FlatTriangle& triangle) const
{
    if (!(twice_area(triangle) > 0.0))
        return false;
    const FlatBox box = box_of(triangle);
    for (const Level& level : sheets_[sheet]) {
        const Cells cells(box, level.exponent);
        bool is_free = true;
        if (cells.count() > static_cast<double>(level.placed.size())) {
            for (const std::uint32_t other : level.placed)
                is_free = is_free && !overlap(triangle, placed_[other].corners);
        } else {
            cells.for_each([&](std::int64_t x, std::int64_t y) {
                std::uint32_t at = heads_[slot_of(sheet, level.exponent, x, y)];
                for (; is_free && at != kNoEntry; at = entries_[at].next)
                    is_free = entries_[at].sheet != sheet ||
                              !overlap(triangle, placed_[entries_[at].placed].corners);
            });
        }
        if (!is_free)
            return false;
    }
    return true;
}

void Occupancy::add(std::uint32_t sheet, const FlatTriangle& triangle)
{
    const FlatBox box = box_of(triangle);
    const int exponent = exponent_of(box);
    const auto index = static_cast<std::uint32_t>(placed_.size());
    placed_.push_back({triangle, static_cast<std::uint32_t>(entries_.size()),
                       static_cast<std::int16_t>(exponent)});
    std::vector<Level>& levels = sheets_[sheet];
    auto level = std::ranges::find(levels, exponent, &Level::exponent);
    if (level == levels.end())
        level = levels.insert(levels.end(), Level{exponent, {}});
    level->placed.push_back(index);
    Cells(box, exponent).for_each([&](std::int64_t x, std::int64_t y) {
        const std::uint32_t slot = slot_of(sheet, exponent, x, y);
        entries_.push_back({sheet, index, heads_[slot], slot});
        heads_[slot] = static_cast<std::uint32_t>(entries_.size() - 1);
    });
}

void Occupancy::drop_last(std::uint32_t sheet, std::size_t count)
{
    for (; count > 0; --count) {
        const Placed& last = placed_.back();
        while (entries_.size() > last.first_entry) {
            heads_[entries_.back().slot] = entries_.back().next;
            entries_.pop_back();
        }
        std::ranges::find(sheets_[sheet], int{last.exponent}, &Level::exponent)->placed.pop_back();
        placed_.pop_back();
    }
}

}  // namespace surfelao
