#include "files/triangulate.h"

#include "surfels/errors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

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

constexpr std::uint32_t kNone = ~0u;

/// A set of numbers that knows the next one after any place: a bit each, and above every 64 bits
/// one that says whether any of them is set.
class NumberSet {
public:
    /// All numbers below `count`.
    explicit NumberSet(std::uint32_t count)
    {
        do {
            const std::uint32_t in_last_word = count % 64;
            count = (count + 63) / 64;
            levels_.emplace_back(count, ~std::uint64_t{0});
            if (in_last_word != 0)
                levels_.back().back() >>= 64 - in_last_word;
        } while (count > 1);
    }

    void insert(std::uint32_t number)
    {
        for (std::vector<std::uint64_t>& level : levels_) {
            level[number / 64] |= std::uint64_t{1} << number % 64;
            number /= 64;
        }
    }

    void erase(std::uint32_t number)
    {
        for (std::vector<std::uint64_t>& level : levels_) {
            level[number / 64] &= ~(std::uint64_t{1} << number % 64);
            if (level[number / 64] != 0)
                return;
            number /= 64;
        }
    }

    /// The least member that is not below `from`; kNone if there is none.
    [[nodiscard]] std::uint32_t next(std::uint32_t from) const
    {
        for (std::size_t level = 0; level < levels_.size(); ++level) {
            if (from / 64 >= levels_[level].size())
                return kNone;
            const std::uint64_t rest = levels_[level][from / 64] >> from % 64;
            if (rest == 0) {
                from = from / 64 + 1;
                continue;
            }
            from += static_cast<std::uint32_t>(std::countr_zero(rest));
            while (level > 0)
                from = 64 * from +
                       static_cast<std::uint32_t>(std::countr_zero(levels_[--level][from]));
            return from;
        }
        return kNone;
    }

private:
    std::vector<std::vector<std::uint64_t>> levels_;
};

/// Points in a balanced tree of bounding boxes, which shrink as points are taken out.
class PointTree {
public:
    /// Holds those of the points that are listed.
    PointTree(const std::vector<glm::dvec2>& points, const std::vector<std::uint32_t>& listed)
        : place_(points.size(), kNone)
    {
        members_.reserve(listed.size());
        for (const std::uint32_t point : listed)
            members_.push_back({points[point], point});
        while (leaf_count_ * kLeafSize < members_.size())
            leaf_count_ *= 2;
        sort(0, members_.size(), leaf_count_);
        for (std::uint32_t i = 0; i < members_.size(); ++i)
            place_[members_[i].point] = i;
        members_.resize(leaf_count_ * kLeafSize);
        boxes_.resize(2 * leaf_count_);
        for (std::size_t node = boxes_.size(); --node > 0;)
            boxes_[node] = box_of(node);
    }

    [[nodiscard]] bool contains(std::uint32_t point) const { return place_[point] != kNone; }

    void erase(std::uint32_t point)
    {
        members_[place_[point]].point = kNone;
        for (std::size_t node = leaf_count_ + place_[point] / kLeafSize; node > 0; node /= 2)
            boxes_[node] = box_of(node);
        place_[point] = kNone;
    }

    /// Any point inside the counterclockwise triangle, or, if `closed`, on its edges, but none at
    /// the place of one of its corners; kNone if there is none. Takes what it costs from `budget`.
    [[nodiscard]] std::uint32_t find_in(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, bool closed,
                                        std::uint64_t& budget) const
    {
        const auto spend = [&] { budget -= budget > 0 ? 1 : 0; };
        const auto is_in = [closed](double inside) { return closed ? inside >= 0 : inside > 0; };
        const Box around{glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
        const auto may_hold = [&](const Box& box) {
            return box.low.x <= around.high.x && box.low.y <= around.high.y &&
                   box.high.x >= around.low.x && box.high.y >= around.low.y &&
                   is_in(most_left(a, b, box)) && is_in(most_left(b, c, box)) &&
                   is_in(most_left(c, a, box));
        };
        std::size_t node = 1;
        while (true) {
            spend();
            if (may_hold(boxes_[node])) {
                if (node < leaf_count_) {
                    node *= 2;
                    continue;
                }
                for (std::size_t i = 0; i < kLeafSize; ++i) {
                    const auto [p, point] = members_[(node - leaf_count_) * kLeafSize + i];
                    if (point == kNone)
                        continue;
                    spend();
                    if (p != a && p != b && p != c &&
                        is_in(std::min({turn(a, b, p), turn(b, c, p), turn(c, a, p)})))
                        return point;
                }
            }
            // to the next subtree on the right
            while (node % 2 == 1) {
                if (node == 1)
                    return kNone;
                node /= 2;
            }
            ++node;
        }
    }

private:
    static constexpr std::size_t kLeafSize = 8;

    struct Member {
        glm::dvec2 at{0.0};
        std::uint32_t point = kNone;  ///< kNone: no one, or taken out
    };

    struct Box {
        glm::dvec2 low{std::numeric_limits<double>::infinity()};
        glm::dvec2 high{-std::numeric_limits<double>::infinity()};
    };

    /// The greatest turn(a, b, p) of any p in the box, rounding included: turn rises or falls with
    /// each coordinate of p.
    static double most_left(glm::dvec2 a, glm::dvec2 b, const Box& box)
    {
        return turn(a, b, {b.y > a.y ? box.low.x : box.high.x, b.x > a.x ? box.high.y : box.low.y});
    }

    /// Halves members_[first, last) until each leaf has its own, the first leaves full.
    void sort(std::size_t first, std::size_t last, std::size_t leaves)
    {
        const std::size_t middle = first + leaves / 2 * kLeafSize;
        if (leaves > 1 && middle < last) {
            Box box;
            for (std::size_t i = first; i < last; ++i)
                grow(box, {members_[i].at, members_[i].at});
            const int axis = box.high.x - box.low.x > box.high.y - box.low.y ? 0 : 1;
            const auto at = [this](std::size_t i) {
                return members_.begin() + static_cast<std::ptrdiff_t>(i);
            };
            std::nth_element(
                at(first), at(middle), at(last),
                [axis](const Member& a, const Member& b) { return a.at[axis] < b.at[axis]; });
            sort(middle, last, leaves / 2);
        }
        if (leaves > 1)
            sort(first, std::min(middle, last), leaves / 2);
    }

    static void grow(Box& box, const Box& by)
    {
        box = {glm::min(box.low, by.low), glm::max(box.high, by.high)};
    }

    [[nodiscard]] Box box_of(std::size_t node) const
    {
        Box box;
        if (node < leaf_count_) {
            grow(box, boxes_[2 * node]);
            grow(box, boxes_[2 * node + 1]);
            return box;
        }
        for (std::size_t i = 0; i < kLeafSize; ++i) {
            const Member& member = members_[(node - leaf_count_) * kLeafSize + i];
            if (member.point != kNone)
                grow(box, {member.at, member.at});
        }
        return box;
    }

    std::vector<Member> members_;       ///< kLeafSize a leaf
    std::vector<std::uint32_t> place_;  ///< per point: in members_; kNone if it is not there
    std::size_t leaf_count_ = 1;        ///< a power of two
    std::vector<Box> boxes_;            ///< node n has the children 2 n and 2 n + 1; 1 is the root
};

/// Cuts ears off a polygon until three corners are left. All corners are indices into `flat`.
///
/// A refused corner is asked again only when its answer may have changed: when one of its
/// neighbours went, or when the corner that lay in its triangle went or turns left by now.
class EarClipper {
public:
    explicit EarClipper(const std::vector<glm::dvec2>& flat)
        : flat_(flat),
          count_(static_cast<std::uint32_t>(flat.size())),
          next_(flat.size()),
          previous_(flat.size()),
          open_(count_),
          refused_next_(2 * flat.size()),
          refused_previous_(2 * flat.size()),
          reflex_(flat, reflex_corners()),
          tests_left_(
              std::min(kMostEarTests * flat.size(), kManyEarTests + kFewEarTests * flat.size()))
    {
        for (std::uint32_t i = 0; i < count_; ++i) {
            next_[i] = (i + 1) % count_;
            previous_[i] = (i + count_ - 1) % count_;
        }
        std::iota(refused_next_.begin(), refused_next_.end(), 0u);
        std::iota(refused_previous_.begin(), refused_previous_.end(), 0u);
    }

    template <class Emit>
    void run(const Emit& emit)
    {
        std::uint32_t left = count_;
        std::uint32_t at = 0;
        std::uint32_t cuts = 0;  // to go until the demand is an ear again
        while (left > 3) {
            if (tests_left_ == 0)
                demand_ = Demand::nothing;
            const std::uint32_t tip = demand_ == Demand::nothing ? at : next_open(at);
            if (tip == kNone) {
                // a round in vain: the polygon touches or crosses itself, or is flat. One lesser
                // cut usually helps; many corners take a share at once, so that rounds stay few
                const bool touching = demand_ == Demand::ear;
                ask_for(touching ? Demand::touching_ear : Demand::nothing, at);
                if (!touching)
                    tests_left_ =
                        std::min(tests_left_, kTestsOfCrossing + kTestsOfCrossingPerCorner * left);
                cuts = left / (touching ? kShareOfTouching : kShareOfNothing) + 1;
                continue;
            }
            if (!meets_demand(tip))
                continue;
            emit(previous_[tip], tip, next_[tip]);
            const std::uint32_t neighbour = next_[tip];
            cut(tip);
            // leaving the neighbour out gives fewer slivers than going around one corner
            at = tests_left_ == 0 ? neighbour : next_[neighbour];
            --left;
            if (demand_ != Demand::ear && --cuts == 0)
                ask_for(Demand::ear, at);
        }
        emit(previous_[at], at, next_[at]);
    }

private:
    // one in so many corners is cut on a lesser demand before the better one is made again
    static constexpr std::uint32_t kShareOfTouching = 64;
    static constexpr std::uint32_t kShareOfNothing = 8;
    // what is left of a polygon that crosses itself gets no more tests than this
    static constexpr std::uint64_t kTestsOfCrossing = 16384;
    static constexpr std::uint64_t kTestsOfCrossingPerCorner = 16;

    enum class Demand {
        ear,           ///< turns left, and no other corner lies in or on the triangle
        touching_ear,  ///< does not turn right, and no other corner lies inside the triangle
        nothing,
    };

    [[nodiscard]] double turn_at(std::uint32_t i) const
    {
        return turn(flat_[previous_[i]], flat_[i], flat_[next_[i]]);
    }

    [[nodiscard]] std::vector<std::uint32_t> reflex_corners() const
    {
        std::vector<std::uint32_t> corners;
        for (std::uint32_t i = 0; i < count_; ++i) {
            const std::uint32_t before = (i + count_ - 1) % count_;
            if (turn(flat_[before], flat_[i], flat_[(i + 1) % count_]) <= 0.0)
                corners.push_back(i);
        }
        return corners;
    }

    /// The first corner from `at` on, around the polygon, that may meet the demand.
    [[nodiscard]] std::uint32_t next_open(std::uint32_t at) const
    {
        const std::uint32_t tip = open_.next(at);
        return tip == kNone ? open_.next(0) : tip;
    }

    /// A new demand opens all corners.
    void ask_for(Demand demand, std::uint32_t at)
    {
        demand_ = demand;
        std::uint32_t i = at;
        do {
            open_.insert(i);
            i = next_[i];
        } while (i != at);
    }

    /// Corners that turn left cannot lie in an ear of a simple polygon unless one that turns right
    /// does, so only reflex corners are asked. A tip that does not meet the demand is closed.
    bool meets_demand(std::uint32_t tip)
    {
        if (demand_ == Demand::nothing)
            return true;
        tests_left_ -= tests_left_ > 0 ? 1 : 0;
        const bool strict = demand_ == Demand::ear;
        const double tip_turn = turn_at(tip);
        if (strict ? tip_turn <= 0.0 : tip_turn < 0.0) {
            open_.erase(tip);
            return false;
        }
        const std::uint32_t reason = reflex_.find_in(flat_[previous_[tip]], flat_[tip],
                                                     flat_[next_[tip]], strict, tests_left_);
        if (reason == kNone)
            return true;
        open_.erase(tip);
        unlink(tip);
        const std::uint32_t head = count_ + reason;
        refused_next_[tip] = refused_next_[head];
        refused_previous_[tip] = head;
        refused_previous_[refused_next_[head]] = tip;
        refused_next_[head] = tip;
        return false;
    }

    void cut(std::uint32_t tip)
    {
        const std::uint32_t neighbours[] = {previous_[tip], next_[tip]};
        next_[neighbours[0]] = neighbours[1];
        previous_[neighbours[1]] = neighbours[0];
        open_.erase(tip);
        unlink(tip);
        if (reflex_.contains(tip))
            release(tip);
        for (const std::uint32_t i : neighbours) {
            open_.insert(i);
            if (reflex_.contains(i) && turn_at(i) > 0.0)
                release(i);
        }
    }

    /// `reason` is no longer in anyone's way.
    void release(std::uint32_t reason)
    {
        reflex_.erase(reason);
        const std::uint32_t head = count_ + reason;
        while (refused_next_[head] != head) {
            open_.insert(refused_next_[head]);
            unlink(refused_next_[head]);
        }
    }

    void unlink(std::uint32_t tip)
    {
        refused_next_[refused_previous_[tip]] = refused_next_[tip];
        refused_previous_[refused_next_[tip]] = refused_previous_[tip];
        refused_next_[tip] = refused_previous_[tip] = tip;
    }

    const std::vector<glm::dvec2>& flat_;
    const std::uint32_t count_;
    std::vector<std::uint32_t> next_;
    std::vector<std::uint32_t> previous_;
    Demand demand_ = Demand::ear;
    NumberSet open_;  ///< corners that may meet the demand
    /// Rings of the corners that are refused for the same reason; entry count_ + reason heads it.
    std::vector<std::uint32_t> refused_next_;
    std::vector<std::uint32_t> refused_previous_;
    PointTree reflex_;  ///< corners that did not turn left at first, and did not since
    std::uint64_t tests_left_;
};

}  // namespace

void triangulate(std::span<const glm::dvec3> positions, std::span<const std::uint32_t> corners,
                 std::vector<glm::uvec3>& triangles)
{
    SURFELAO_DCHECK(corners.size() >= 3);
    const auto emit = [&](std::size_t a, std::size_t b, std::size_t c) {
        triangles.emplace_back(a, b, c);
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
