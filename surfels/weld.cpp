#include "surfels/weld.h"

#include "surfels/for_all.h"
#include "surfels/lowest_equal.h"
#include "surfels/owner_ranges.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace surfelao {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::uint64_t hash_position(glm::dvec3 p)
{
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
        hash ^= std::bit_cast<std::uint64_t>(p[axis] + 0.0);  // + 0.0: -0 and 0 are one place
        hash *= 0x9E3779B97F4A7C15u;
        hash ^= hash >> 29;
    }
    return hash;
}

/// For each vertex the lowest index of a vertex at exactly the same position.
std::vector<std::uint32_t> weld_equal(const std::vector<glm::dvec3>& positions)
{
    return lowest_equal(
        positions.size(), [&](std::uint32_t v) { return hash_position(positions[v]); },
        [&](std::uint32_t v, std::uint32_t w) { return positions[v] == positions[w]; });
}

/// Joins torn places that are equal but for noise.
class NoiseWelder {
public:
    NoiseWelder(const Scene& scene, double diagonal, const std::vector<std::uint32_t>& welded)
        : scene_(scene), reach_(kWeldDistance * diagonal), tears_(tears_of(scene.triangles, welded))
    {
        if (std::ranges::all_of(tears_, [](std::uint32_t tear) { return tear == 0; }))
            return;
        shortest_.assign(welded.size(), std::numeric_limits<double>::infinity());
        for_owner_ranges(shortest_.size(), [&](OwnerRange range) {
            for (const glm::uvec3 t : scene.triangles) {
                for (int side = 0; side < 3; ++side) {
                    const std::uint32_t a = welded[t[side]], b = welded[t[(side + 1) % 3]];
                    if (a == b || !(range.has(a) || range.has(b)))
                        continue;
                    const double length = glm::distance(scene.positions[a], scene.positions[b]);
                    for (const std::uint32_t end : {a, b}) {
                        if (range.has(end))
                            shortest_[end] = std::min(shortest_[end], length);
                    }
                }
            }
        });
    }

    /// The place that v, lowest at its own position, joins; v itself where there is none.
    std::uint32_t join(std::uint32_t v)
    {
        if (tears_[v] == 0)
            return v;
        const glm::dvec3 p = scene_.positions[v];
        const double reach = std::min(reach_, kWeldShare * shortest_[v]);
        std::uint32_t found = kNone;
        for_each_cell(p, reach, [&](std::uint64_t cell) {
            const auto entry = first_in_.find(cell);
            std::uint32_t place = entry == first_in_.end() ? kNone : entry->second;
            for (int n = 0; place != kNone && n < kMostInCell; ++n, place = next_[place]) {
                if (glm::distance(scene_.positions[place], p) <=
                    std::min(reach, kWeldShare * shortest_[place]))
                    found = std::min(found, place);
            }
        });
        if (found != kNone)
            return found;
        if (next_.empty())
            next_.assign(scene_.positions.size(), kNone);
        const auto [entry, is_new] = first_in_.try_emplace(cell_of(p), v);
        if (!is_new)
            next_[v] = std::exchange(entry->second, v);
        return v;
    }

private:
    /// Of places in one cell that are compared: more lie there only where a whole object is no
    /// larger than noise.
    static constexpr int kMostInCell = 64;

    /// In reaches: nearly all places then have only one cell to look at.
    static constexpr double kCell = 32.0;

    std::uint64_t cell_of(glm::dvec3 p) const
    {
        return hash_position(glm::floor(p / (kCell * reach_)));
    }

    /// Each cell that the cube of 2 reach around p touches, once: 1 to 8 of them.
    template <class Visit>
    void for_each_cell(glm::dvec3 p, double reach, const Visit& visit) const
    {
        const double size = kCell * reach_;
        const glm::dvec3 low = glm::floor((p - reach) / size);
        const glm::dvec3 high = glm::floor((p + reach) / size);
        // no counting from low to high: so far off that 1 is less than a rounding, it never ends
        for (int corner = 0; corner < 8; ++corner) {
            const glm::bvec3 is_high((corner & 4) != 0, (corner & 2) != 0, (corner & 1) != 0);
            if (!glm::any(glm::bvec3(is_high.x && low.x == high.x, is_high.y && low.y == high.y,
                                     is_high.z && low.z == high.z)))
                visit(hash_position(glm::mix(low, high, is_high)));
        }
    }

    const Scene& scene_;
    double reach_;
    std::vector<std::uint32_t> tears_;
    std::vector<double> shortest_;                               ///< edge at a place
    std::unordered_map<std::uint64_t, std::uint32_t> first_in_;  ///< cell -> its last place
    std::vector<std::uint32_t> next_;                            ///< and the one before it
};

}  // namespace

std::vector<std::uint32_t> tears_of(const std::vector<glm::uvec3>& triangles,
                                    const std::vector<std::uint32_t>& welded)
{
    const auto hash = [](std::uint32_t v) {
        return (v + 1) * 0x9E3779B1u ^ (v >> 7) * 0x85EBCA6Bu;
    };
    std::vector<std::uint32_t> tears(welded.size(), 0);
    for_owner_ranges(tears.size(), [&](OwnerRange range) {
        for (const glm::uvec3 t : triangles) {
            const glm::uvec3 w{welded[t.x], welded[t.y], welded[t.z]};
            const glm::uvec3 h{hash(w.x), hash(w.y), hash(w.z)};
            const glm::uvec3 differences{h.y - h.z, h.z - h.x, h.x - h.y};
            for (int corner = 0; corner < 3; ++corner) {
                if (range.has(w[corner]))
                    tears[w[corner]] += differences[corner];
            }
        }
    });
    return tears;
}

std::vector<std::uint32_t> weld(const Scene& scene, double diagonal)
{
    std::vector<std::uint32_t> welded = weld_equal(scene.positions);
    NoiseWelder noise(scene, diagonal, welded);
    for (std::uint32_t v = 0; v < welded.size(); ++v)
        welded[v] = welded[v] == v ? noise.join(v) : welded[welded[v]];
    return welded;
}

}  // namespace surfelao
