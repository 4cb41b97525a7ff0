#include "surfels/triangulate.h"

#include "surfels/errors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

/// Twice the signed area of a b c: positive when counterclockwise.
double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The polygon seen so that it runs counterclockwise, relative to its first corner.
std::vector<glm::dvec2> project(std::span<const glm::dvec3> positions,
                                std::span<const std::uint32_t> corners)
{
    const std::size_t n = corners.size();
    const glm::dvec3 origin = positions[corners[0]];
    glm::dvec3 size(0.0);
    for (const std::uint32_t corner : corners)
        size = glm::max(size, glm::abs(positions[corner] - origin));
    // unit size keeps the products below away from under- and overflow
    const double scale = std::max({size.x, size.y, size.z});
    glm::dvec3 normal(0.0);
    if (scale > 0.0) {
        glm::dvec3 from = (positions[corners[n - 1]] - origin) / scale;
        for (const std::uint32_t corner : corners) {
            const glm::dvec3 to = (positions[corner] - origin) / scale;
            normal += glm::cross(from, to);
            from = to;
        }
    }
    const glm::dvec3 length = glm::abs(normal);
    const int drop =
        length.x > length.y ? (length.x > length.z ? 0 : 2) : (length.y > length.z ? 1 : 2);
    const int u = (drop + 1) % 3;
    const int v = (drop + 2) % 3;
    std::vector<glm::dvec2> flat(n);
    for (std::size_t i = 0; i < n; ++i) {
        glm::dvec3 p = positions[corners[i]] - origin;
        if (scale > 0.0)
            p /= scale;
        flat[i] = normal[drop] < 0.0 ? glm::dvec2(p[v], p[u]) : glm::dvec2(p[u], p[v]);
    }
    return flat;
}

/// No corner turns right, and the corners go around once.
bool is_convex(const std::vector<glm::dvec2>& flat)
{
    const std::size_t n = flat.size();
    int x_reversals = 0;
    double last_dx = 0.0;
    double first_dx = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec2 a = flat[i];
        const glm::dvec2 b = flat[(i + 1) % n];
        if (turn(a, b, flat[(i + 2) % n]) < 0.0)
            return false;
        const double dx = b.x - a.x;
        if (dx == 0.0)
            continue;
        if (first_dx == 0.0)
            first_dx = dx;
        if (last_dx * dx < 0.0)
            ++x_reversals;
        last_dx = dx;
    }
    if (last_dx * first_dx < 0.0)
        ++x_reversals;
    return x_reversals <= 2;
}

/// Cuts ears off a polygon until three corners are left. All corners are indices into `flat`.
class EarClipper {
public:
    explicit EarClipper(const std::vector<glm::dvec2>& flat)
        : flat_(flat),
          next_(flat.size()),
          previous_(flat.size()),
          tests_left_(kEarTestsPerCorner * flat.size())
    {
        const std::uint32_t n = static_cast<std::uint32_t>(flat.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            next_[i] = (i + 1) % n;
            previous_[i] = (i + n - 1) % n;
        }
        sort_reflex_into_cells();
    }

    template <class Emit>
    void run(const Emit& emit)
    {
        std::uint32_t left = static_cast<std::uint32_t>(flat_.size());
        std::uint32_t at = 0;
        Demand demand = Demand::ear;
        std::uint32_t refused = 0;  // corners in a row that did not meet the demand
        std::uint32_t cuts = 0;     // to go until the demand is an ear again
        while (left > 3) {
            if (tests_left_ == 0)
                demand = Demand::nothing;
            if (!meets(demand, at)) {
                at = next_[at];
                if (++refused < left)
                    continue;
                // a round in vain: the polygon touches or crosses itself, or is flat. One lesser
                // cut usually helps; many corners take a share at once, so that rounds stay few
                demand = demand == Demand::ear ? Demand::touching_ear : Demand::nothing;
                cuts = left / kRoundsInVain + 1;
                refused = 0;
                continue;
            }
            emit(previous_[at], at, next_[at]);
            next_[previous_[at]] = next_[at];
            previous_[next_[at]] = previous_[at];
            const std::uint32_t neighbour = next_[at];
            next_[at] = at;  // gone
            // leaving the neighbour out gives fewer slivers than going around one corner
            at = tests_left_ == 0 ? neighbour : next_[neighbour];
            refused = 0;
            --left;
            if (demand != Demand::ear && --cuts == 0)
                demand = Demand::ear;
        }
        emit(previous_[at], at, next_[at]);
    }

private:
    static constexpr std::uint32_t kRoundsInVain = 64;  ///< a bound for n ln n of them

    enum class Demand {
        ear,           ///< turns left, and no other corner lies in or on the triangle
        touching_ear,  ///< does not turn right, and no other corner lies inside the triangle
        nothing,
    };

    [[nodiscard]] double turn_at(std::uint32_t i) const
    {
        return turn(flat_[previous_[i]], flat_[i], flat_[next_[i]]);
    }

    /// Corners that turn left cannot lie in an ear of a simple polygon unless one that turns right
    /// does, so only reflex corners are asked; those that are gone or turn left by now are dropped.
    bool meets(Demand demand, std::uint32_t tip)
    {
        if (demand == Demand::nothing)
            return true;
        spend_test();
        const glm::dvec2 a = flat_[previous_[tip]];
        const glm::dvec2 b = flat_[tip];
        const glm::dvec2 c = flat_[next_[tip]];
        const double tip_turn = turn(a, b, c);
        const bool strict = demand == Demand::ear;
        if (strict ? tip_turn <= 0.0 : tip_turn < 0.0)
            return false;
        const glm::dvec2 low = glm::min(a, glm::min(b, c));
        const glm::dvec2 high = glm::max(a, glm::max(b, c));
        const glm::uvec2 first = cell_of(low);
        const glm::uvec2 last = cell_of(high);
        for (std::uint32_t y = first.y; y <= last.y; ++y) {
            for (std::uint32_t x = first.x; x <= last.x; ++x) {
                Cell& cell = cells_[y * cells_per_side_ + x];
                spend_test();
                for (std::uint32_t r = cell.begin; r < cell.end;) {
                    spend_test();
                    const std::uint32_t i = reflex_[r];
                    const glm::dvec2 p = flat_[i];
                    if (next_[i] == i || turn_at(i) > 0.0) {
                        reflex_[r] = reflex_[--cell.end];
                        continue;
                    }
                    ++r;
                    if (p == a || p == b || p == c)
                        continue;
                    const double inside = std::min({turn(a, b, p), turn(b, c, p), turn(c, a, p)});
                    if (strict ? inside >= 0.0 : inside > 0.0)
                        return false;
                }
            }
        }
        return true;
    }

    /// A square grid over the polygon with about as many cells as corners: small ears then meet few
    /// of the reflex corners.
    void sort_reflex_into_cells()
    {
        low_ = high_ = flat_[0];
        for (const glm::dvec2 p : flat_) {
            low_ = glm::min(low_, p);
            high_ = glm::max(high_, p);
        }
        cells_per_side_ =
            static_cast<std::uint32_t>(std::sqrt(static_cast<double>(flat_.size()))) / 2 + 1;
        cells_.resize(std::size_t{cells_per_side_} * cells_per_side_);
        const auto cell_at = [this](std::uint32_t i) -> Cell& {
            const glm::uvec2 cell = cell_of(flat_[i]);
            return cells_[cell.y * cells_per_side_ + cell.x];
        };
        std::vector<std::uint32_t> reflex;
        for (std::uint32_t i = 0; i < flat_.size(); ++i) {
            if (turn_at(i) > 0.0)
                continue;
            reflex.push_back(i);
            ++cell_at(i).end;
        }
        std::uint32_t begin = 0;
        for (Cell& cell : cells_) {
            const std::uint32_t count = cell.end;
            cell = {begin, begin};
            begin += count;
        }
        reflex_.resize(reflex.size());
        for (const std::uint32_t i : reflex)
            reflex_[cell_at(i).end++] = i;
    }

    /// Rises with either coordinate, so the corners of a box bound the cells of what lies in it.
    [[nodiscard]] glm::uvec2 cell_of(glm::dvec2 p) const
    {
        const auto along = [this](double at, double low, double high) {
            const double cell = high > low ? (at - low) / (high - low) * cells_per_side_ : 0.0;
            return std::min(static_cast<std::uint32_t>(cell), cells_per_side_ - 1);
        };
        return {along(p.x, low_.x, high_.x), along(p.y, low_.y, high_.y)};
    }

    void spend_test() { tests_left_ -= tests_left_ > 0 ? 1 : 0; }

    const std::vector<glm::dvec2>& flat_;
    std::vector<std::uint32_t> next_;  ///< itself where the corner is gone
    std::vector<std::uint32_t> previous_;
    struct Cell {
        std::uint32_t begin = 0;  ///< into reflex_
        std::uint32_t end = 0;
    };
    std::vector<Cell> cells_;
    std::vector<std::uint32_t> reflex_;  ///< cell by cell; those found convex or gone are dropped
    glm::dvec2 low_{0.0};
    glm::dvec2 high_{0.0};
    std::uint32_t cells_per_side_ = 1;
    std::uint64_t tests_left_;
};

}  // namespace

void triangulate(std::span<const glm::dvec3> positions, std::span<const std::uint32_t> corners,
                 std::vector<glm::uvec3>& triangles)
{
    SURFELAO_DCHECK(corners.size() >= 3);
    const auto emit = [&](std::size_t a, std::size_t b, std::size_t c) {
        triangles.emplace_back(corners[a], corners[b], corners[c]);
    };
    if (corners.size() == 3)
        return emit(0, 1, 2);
    std::vector<glm::dvec2> flat = project(positions, corners);

    // a corner at the place of the one before it is cut off at once: it would hide the turn there
    std::vector<std::uint32_t> kept;
    std::vector<std::uint32_t> repeated;
    for (std::uint32_t i = 0; i < flat.size(); ++i)
        (i > 0 && flat[i] == flat[kept.back()] ? repeated : kept).push_back(i);
    while (kept.size() > 1 && flat[kept.back()] == flat[kept.front()]) {
        repeated.push_back(kept.back());
        kept.pop_back();
    }
    while (kept.size() < 3) {
        kept.push_back(repeated.back());
        repeated.pop_back();
    }
    for (const std::uint32_t i : repeated)
        emit(i, (i + 1) % flat.size(), (i + flat.size() - 1) % flat.size());
    for (std::size_t i = 0; i < kept.size(); ++i)
        flat[i] = flat[kept[i]];
    flat.resize(kept.size());
    const auto emit_kept = [&](std::size_t a, std::size_t b, std::size_t c) {
        emit(kept[a], kept[b], kept[c]);
    };

    if (!is_convex(flat))
        return EarClipper(flat).run(emit_kept);
    for (std::size_t i = 2; i < flat.size(); ++i)
        emit_kept(0, i - 1, i);
}

}  // namespace surfelao
