#include "surfels/triangulate.h"

#include "surfels/errors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>

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
        for (std::uint32_t i = 0; i < n; ++i) {
            if (turn_at(i) <= 0.0)
                reflex_.push_back(i);
        }
    }

    template <class Emit>
    void run(const Emit& emit)
    {
        std::uint32_t left = static_cast<std::uint32_t>(flat_.size());
        std::uint32_t at = 0;
        std::uint32_t refused = 0;  // corners in a row that were no ear
        while (left > 3) {
            // a round without an ear: the polygon touches or crosses itself, or is flat
            const Demand demand = tests_left_ == 0 || refused >= 2 * left ? Demand::nothing
                                  : refused >= left                       ? Demand::touching_ear
                                                                          : Demand::ear;
            if (!meets(demand, at)) {
                at = next_[at];
                ++refused;
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
        }
        emit(previous_[at], at, next_[at]);
    }

private:
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
        const glm::dvec2 a = flat_[previous_[tip]];
        const glm::dvec2 b = flat_[tip];
        const glm::dvec2 c = flat_[next_[tip]];
        const double tip_turn = turn(a, b, c);
        const bool strict = demand == Demand::ear;
        if (strict ? tip_turn <= 0.0 : tip_turn < 0.0)
            return false;
        const glm::dvec2 low = glm::min(a, glm::min(b, c));
        const glm::dvec2 high = glm::max(a, glm::max(b, c));
        for (std::size_t r = 0; r < reflex_.size();) {
            if (tests_left_ > 0)
                --tests_left_;
            const std::uint32_t i = reflex_[r];
            const glm::dvec2 p = flat_[i];
            const bool apart = p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y ||
                               p == a || p == b || p == c;
            if (apart) {
                ++r;
                continue;
            }
            if (next_[i] == i || turn_at(i) > 0.0) {
                reflex_[r] = reflex_.back();
                reflex_.pop_back();
                continue;
            }
            const double inside = std::min({turn(a, b, p), turn(b, c, p), turn(c, a, p)});
            if (strict ? inside >= 0.0 : inside > 0.0)
                return false;
            ++r;
        }
        return true;
    }

    const std::vector<glm::dvec2>& flat_;
    std::vector<std::uint32_t> next_;  ///< itself where the corner is gone
    std::vector<std::uint32_t> previous_;
    std::vector<std::uint32_t> reflex_;
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
    const std::vector<glm::dvec2> flat = project(positions, corners);
    if (!is_convex(flat))
        return EarClipper(flat).run(emit);
    for (std::size_t i = 2; i < corners.size(); ++i)
        emit(0, i - 1, i);
}

}  // namespace surfelao
