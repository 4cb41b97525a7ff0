#include "tree/masks/tiles.h"

#include "tree/masks/constants.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

class Tiler {
public:
    Tiler(const Geometry& geometry, std::span<const glm::vec3> normals)
        : geometry_(geometry),
          count_(static_cast<std::uint32_t>(geometry.triangles.size())),
          normals_(normals),
          taken_(count_, 0)
    {
    }

    RawVector<MaskTile> run()
    {
        tiles_.reserve(count_);
        pair_next();
        if (has_flat_edges())
            pair_others();
        for (std::uint32_t t = 0; t < count_; ++t) {
            const glm::uvec3 v = geometry_.triangles[t];
            if (taken_[t] == 0)
                tiles_.push_back({{v.x, v.y, v.z, v.z}, {t, t}});
        }
        return std::move(tiles_);
    }

private:
    /// Side i of triangle t goes from its corner i to the next: 3 t + i.
    using Side = std::uint32_t;

    std::uint32_t corner(std::uint32_t triangle, std::uint32_t i) const
    {
        return geometry_.triangles[triangle][static_cast<int>(i % 3)];
    }
    std::uint32_t from(Side side) const { return geometry_.welded[corner(side / 3, side)]; }
    std::uint32_t to(Side side) const { return geometry_.welded[corner(side / 3, side % 3 + 1)]; }

    bool may_be_flat(std::uint32_t s, std::uint32_t t) const
    {
        return glm::dot(normals_[s], normals_[t]) > kMaskPairCosine;
    }

    void pair_next()
    {
        for (std::uint32_t t = 0; t + 1 < count_; ++t) {
            if (!may_be_flat(t, t + 1))
                continue;
            for (Side i = 3 * t; i < 3 * t + 3 && taken_[t] == 0; ++i) {
                for (Side k = 3 * t + 3; k < 3 * t + 6; ++k) {
                    if (from(i) == to(k) && to(i) == from(k))
                        pair(i, k);
                }
            }
        }
    }

    /// Whether many edges between triangles that are left are flat, by a look at some.
    bool has_flat_edges() const
    {
        struct Spoke {
            std::uint32_t hub, to;  ///< welded
            std::uint32_t triangle;
            bool inward;
        };
        const std::size_t vertices = geometry_.positions.size();
        const std::size_t stride = vertices / kMaskPairSample + 1;
        std::vector<std::uint8_t> examined(vertices, 0);
        for (std::size_t v = 0; v < vertices; v += stride)
            examined[geometry_.welded[v]] = 1;
        std::vector<Spoke> spokes;
        for (std::uint32_t t = 0; t < count_; ++t) {
            if (taken_[t] != 0)
                continue;
            const glm::uvec3 v = geometry_.triangles[t];
            const std::array<std::uint32_t, 3> at = {geometry_.welded[v.x], geometry_.welded[v.y],
                                                     geometry_.welded[v.z]};
            if ((examined[at[0]] | examined[at[1]] | examined[at[2]]) == 0)
                continue;
            for (std::size_t i = 0; i < 3; ++i) {
                if (examined[at[i]] != 0) {
                    spokes.push_back({at[i], at[(i + 1) % 3], t, false});
                    spokes.push_back({at[i], at[(i + 2) % 3], t, true});
                }
            }
        }
        std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) {
            return std::tie(a.hub, a.to, a.inward, a.triangle) <
                   std::tie(b.hub, b.to, b.inward, b.triangle);
        });
        std::size_t edges = 0, flat = 0;
        for (std::size_t i = 1; i < spokes.size(); ++i) {
            const Spoke &a = spokes[i - 1], &b = spokes[i];
            if (a.hub == b.hub && a.to == b.to && a.inward != b.inward) {
                ++edges;
                flat += may_be_flat(a.triangle, b.triangle) ? 1 : 0;
            }
        }
        return static_cast<float>(flat) > kMaskPairFlatShare * static_cast<float>(edges);
    }

    void pair_others()
    {
        // what rises from a vertex to a later one, by the lower of them
        std::vector<std::uint32_t> begin(geometry_.positions.size() + 2, 0);
        const auto each_side = [&](const auto& work) {
            for (std::uint32_t t = 0; t < count_; ++t) {
                if (taken_[t] != 0)
                    continue;
                const glm::uvec3 v = geometry_.triangles[t];
                const std::uint32_t a = geometry_.welded[v.x], b = geometry_.welded[v.y],
                                    c = geometry_.welded[v.z];
                work(3 * t, a, b);
                work(3 * t + 1, b, c);
                work(3 * t + 2, c, a);
            }
        };
        each_side([&](Side, std::uint32_t a, std::uint32_t b) { begin[a + 2] += a < b ? 1 : 0; });
        for (std::size_t v = 2; v < begin.size(); ++v)
            begin[v] += begin[v - 1];
        struct Rising {
            std::uint32_t to;
            Side side;
        };
        RawVector<Rising> rising;
        rising.resize(begin.back());
        each_side([&](Side side, std::uint32_t a, std::uint32_t b) {
            if (a < b)
                rising[begin[a + 1]++] = {b, side};
        });
        // what falls along the same edge belongs to the triangle beyond it
        std::vector<std::array<Side, 2>> flat;
        each_side([&](Side side, std::uint32_t a, std::uint32_t b) {
            for (std::uint32_t i = begin[b]; a > b && i < begin[b + 1]; ++i) {
                if (rising[i].to == a && may_be_flat(rising[i].side / 3, side / 3))
                    flat.push_back({rising[i].side, side});
            }
        });
        for (const auto [side, other] : flat) {
            if (is_longest(side) && is_longest(other))
                pair(side, other);
        }
        for (const auto [side, other] : flat)
            pair(side, other);
    }

    bool is_longest(Side side) const
    {
        const auto length2 = [&](Side of) {
            const glm::vec3 edge = geometry_.positions[to(of)] - geometry_.positions[from(of)];
            return glm::dot(edge, edge);
        };
        const Side first = side / 3 * 3;
        const float here = length2(side);
        return here >= length2(first) && here >= length2(first + 1) && here >= length2(first + 2);
    }

    /// Makes one tile of the triangles of two sides along one edge, if they are free and fit.
    void pair(Side side, Side other)
    {
        const std::uint32_t s = side / 3, t = other / 3;
        if (taken_[s] != 0 || taken_[t] != 0)
            return;
        const glm::uvec4 v(corner(s, side % 3 + 1), corner(s, side % 3 + 2), corner(s, side),
                           corner(t, other % 3 + 2));
        const glm::vec3 a = geometry_.positions[v.x], b = geometry_.positions[v.y],
                        c = geometry_.positions[v.z], d = geometry_.positions[v.w];
        const glm::vec3 normal = glm::cross(c - a, d - b);
        const float area = glm::length(normal);
        const float across = glm::length(d - b);
        const float slack =
            std::min(kMaskPairSlack * std::max(glm::length(c - a), across), kMaskPairSlackLength);
        const auto beside = [&](glm::vec3 before, glm::vec3 at, glm::vec3 after) {
            return glm::dot(glm::cross(at - before, after - at), normal) < -slack * across * area;
        };
        if (std::abs(glm::dot(a - b + c - d, normal)) > 2.0f * slack * area || beside(d, a, b) ||
            beside(b, c, d))
            return;
        taken_[s] = taken_[t] = 1;
        tiles_.push_back({v, {s, t}});
    }

    const Geometry& geometry_;
    std::uint32_t count_;
    std::span<const glm::vec3> normals_;
    std::vector<std::uint8_t> taken_;
    RawVector<MaskTile> tiles_;
};

}  // namespace

RawVector<MaskTile> tiles_of(const Geometry& geometry, std::span<const glm::vec3> normals)
{
    return Tiler(geometry, normals).run();
}

}  // namespace surfelao
