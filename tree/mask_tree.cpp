#include "tree/mask_tree.h"

#include "tree/mask_kernel.h"
#include "tree/masks.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace surfelao {
namespace {

/// A unit of normal counts as this many diagonals of the node when it is split: neighbours that
/// look elsewhere are parted before they become one rectangle.
constexpr float kNormalExtent = 0.5f;

/// A node that is not flat is opened as if its radius were larger by this factor times 1 -
/// flatness.
constexpr float kFlatnessPenalty = 10.0f;

/// Rectangles of flat nodes are drawn a little larger: their neighbours most likely continue the
/// same plane, and the rim closes the cracks. None from a flatness of 1 - 1/kDilationSlope down.
constexpr float kDilation = 0.08f;
constexpr float kDilationSlope = 40.0f;

/// A rectangle's area follows from its second moments; a disk's is 1.05 times as large as that, and
/// no convex shape's is larger. What is above this factor overlaps itself.
constexpr float kSpreadMargin = 1.1f;

/// Triangles that tile a rectangle to within this share of its area and size are one rectangle.
constexpr float kWhole = 1e-4f;

/// A patch counts as a sheet without gaps where it is at least this flat and fills this share of
/// the rectangle that its second moments describe. Cracks are filled, and rims drawn, at sheets
/// only: between leaves there are none.
constexpr float kSheetFlatness = 0.8f;
constexpr float kSheetCover = 0.75f;

/// A patch with gaps would be drawn as one rectangle in their midst: it is opened as if its radius
/// were larger by this factor times what its cover lacks of a sheet's.
constexpr float kGapPenalty = 10.0f;

/// Radius and thickness are measured at the corners up to this many triangles, and bounded by the
/// children's above.
constexpr std::size_t kExactBounds = 32;

constexpr std::size_t kParallelSplit = 2048;  ///< smaller subtrees are built by one thread

/// Where the splits look: centroid and unit normal of one triangle.
struct Key {
    std::array<float, 6> at;
    std::uint32_t triangle;
    std::uint32_t padding = 0;
};

struct Extent {
    std::array<float, 6> low, high;

    Extent()
    {
        low.fill(std::numeric_limits<float>::max());
        high.fill(-std::numeric_limits<float>::max());
    }
    void add(const std::array<float, 6>& at)
    {
        for (int i = 0; i < 6; ++i) {
            low[i] = std::min(low[i], at[i]);
            high[i] = std::max(high[i], at[i]);
        }
    }
};

struct Corners {
    glm::vec3 a, b, c;
};

/// Symmetric 3x3 matrix.
struct Spread {
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    void add_square(glm::vec3 v, float weight)
    {
        const glm::vec3 w = weight * v;
        xx += w.x * v.x;
        xy += w.x * v.y;
        xz += w.x * v.z;
        yy += w.y * v.y;
        yz += w.y * v.z;
        zz += w.z * v.z;
    }
    void add(const Spread& other)
    {
        xx += other.xx;
        xy += other.xy;
        xz += other.xz;
        yy += other.yy;
        yz += other.yz;
        zz += other.zz;
    }
    glm::vec3 times(glm::vec3 v) const
    {
        return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
                xz * v.x + yz * v.y + zz * v.z};
    }
};

/// What a node hands to its parent.
struct Patch {
    glm::vec3 center{0.0f};
    glm::vec3 vector_area{0.0f};
    glm::vec3 normal{0.0f};
    float area = 0.0f;
    float radius = 0.0f;
    float thickness = 0.0f;
    Spread spread;  ///< integral of (x - center)(x - center)^T over the area
};

glm::vec3 perpendicular(glm::vec3 n)
{
    // the branchless basis of Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    return {1.0f + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

class Builder {
public:
    explicit Builder(const Geometry& geometry)
        : geometry_(geometry), keys_(geometry.triangles.size())
    {
    }

    std::vector<MaskNode> build()
    {
        if (keys_.empty())
            return {};
        nodes_.resize(2 * keys_.size() - 1);
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, keys_.size(), 4096),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              for (std::size_t t = range.begin(); t < range.end(); ++t)
                                  keys_[t] = key_of(static_cast<std::uint32_t>(t));
                          });
        Extent extent;
        for (const Key& key : keys_)
            extent.add(key.at);
        build_node(0, 1, 0, keys_.size(), extent);
        return std::move(nodes_);
    }

private:
    Corners corners(std::uint32_t triangle) const
    {
        const glm::uvec3 t = geometry_.triangles[triangle];
        return {kMaskFrame * geometry_.positions[t.x], kMaskFrame * geometry_.positions[t.y],
                kMaskFrame * geometry_.positions[t.z]};
    }

    Key key_of(std::uint32_t triangle) const
    {
        // in the scene's own axes: what is built along them is cut along them
        const glm::uvec3 t = geometry_.triangles[triangle];
        const Corners p{geometry_.positions[t.x], geometry_.positions[t.y],
                        geometry_.positions[t.z]};
        const glm::vec3 center = (p.a + p.b + p.c) * (1.0f / 3.0f);
        const glm::vec3 cross = glm::cross(p.b - p.a, p.c - p.a);
        const float length = glm::length(cross);
        const glm::vec3 normal = length > 0.0f ? cross / length : glm::vec3(0.0f);
        return {{center.x, center.y, center.z, normal.x, normal.y, normal.z}, triangle};
    }

    /// Node `index` over keys [begin, end); its descendants stand in nodes [first, first + 2
    /// (n-1)).
    Patch build_node(std::size_t index, std::size_t first, std::size_t begin, std::size_t end,
                     const Extent& extent)
    {
        if (end - begin == 1)
            return finish_triangle(index, keys_[begin].triangle);

        Extent below, above;
        const std::size_t middle = split(begin, end, extent, below, above);
        const std::size_t left_first = first + 2;
        const std::size_t right_first = left_first + 2 * (middle - begin - 1);
        Patch left, right;
        if (end - begin > kParallelSplit) {
            tbb::parallel_invoke(
                [&] { left = build_node(first, left_first, begin, middle, below); },
                [&] { right = build_node(first + 1, right_first, middle, end, above); });
        } else {
            left = build_node(first, left_first, begin, middle, below);
            right = build_node(first + 1, right_first, middle, end, above);
        }
        nodes_[index].links = static_cast<std::uint32_t>(first);
        return finish_inner(index, begin, end, left, right);
    }

    /// At the middle of the longest of the six extents; where that parts nothing, in two halves.
    std::size_t split(std::size_t begin, std::size_t end, const Extent& extent, Extent& below,
                      Extent& above)
    {
        std::array<float, 6> length;
        float diagonal2 = 0.0f;
        for (int i = 0; i < 6; ++i) {
            length[i] = extent.high[i] - extent.low[i];
            diagonal2 += i < 3 ? length[i] * length[i] : 0.0f;
        }
        for (int i = 3; i < 6; ++i)
            length[i] *= kNormalExtent * std::sqrt(diagonal2);
        const auto axis = static_cast<std::size_t>(std::max_element(length.begin(), length.end()) -
                                                   length.begin());
        const float plane = 0.5f * (extent.low[axis] + extent.high[axis]);
        std::size_t left = begin;
        std::size_t right = end;
        while (left < right) {
            if (keys_[left].at[axis] < plane) {
                below.add(keys_[left].at);
                ++left;
            } else {
                above.add(keys_[left].at);
                std::swap(keys_[left], keys_[--right]);
            }
        }
        if (left != begin && left != end)
            return left;
        left = begin + (end - begin) / 2;
        below = above = Extent();
        for (std::size_t i = begin; i < end; ++i)
            (i < left ? below : above).add(keys_[i].at);
        return left;
    }

    Patch finish_triangle(std::size_t index, std::uint32_t triangle)
    {
        const Corners p = corners(triangle);
        Patch patch;
        patch.center = (p.a + p.b + p.c) * (1.0f / 3.0f);
        const glm::vec3 a = p.a - patch.center;
        const glm::vec3 b = p.b - patch.center;
        const glm::vec3 c = p.c - patch.center;
        patch.vector_area = 0.5f * glm::cross(p.b - p.a, p.c - p.a);
        patch.area = glm::length(patch.vector_area);
        patch.normal = patch.area > 0.0f ? patch.vector_area / patch.area : glm::vec3(0, 0, 1);
        patch.radius = std::sqrt(std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)}));
        for (const glm::vec3 corner : {a, b, c})
            patch.spread.add_square(corner, patch.area / 12.0f);
        nodes_[index] = {patch.center, patch.radius, patch.normal, 0.0f, a, 0.0f, b, 0};
        return patch;
    }

    Patch finish_inner(std::size_t index, std::size_t begin, std::size_t end, const Patch& left,
                       const Patch& right)
    {
        Patch patch;
        patch.area = left.area + right.area;
        const float share = patch.area > 0.0f ? right.area / patch.area : 0.5f;
        const glm::vec3 apart = right.center - left.center;
        patch.center = left.center + share * apart;
        patch.vector_area = left.vector_area + right.vector_area;
        patch.spread = left.spread;
        patch.spread.add(right.spread);
        patch.spread.add_square(apart, left.area * share);
        const float seen_area = glm::length(patch.vector_area);
        const float flatness = patch.area > 0.0f ? std::min(1.0f, seen_area / patch.area) : 0.0f;
        patch.normal = seen_area > 0.0f ? patch.vector_area / seen_area : left.normal;
        bound(patch, begin, end, left, right);

        MaskNode& node = nodes_[index];
        node.center = patch.center;
        node.radius = patch.radius;
        node.normal = patch.normal;
        node.thickness = patch.thickness;
        node.open_radius = patch.radius * (1.0f + kFlatnessPenalty * (1.0f - flatness));
        set_rectangle(node, patch, seen_area, flatness, begin, end);
        return patch;
    }

    void bound(Patch& patch, std::size_t begin, std::size_t end, const Patch& left,
               const Patch& right) const
    {
        if (end - begin <= kExactBounds) {
            float farthest = 0.0f;
            for (std::size_t i = begin; i < end; ++i) {
                const Corners p = corners(keys_[i].triangle);
                for (const glm::vec3 corner : {p.a, p.b, p.c}) {
                    const glm::vec3 d = corner - patch.center;
                    farthest = std::max(farthest, glm::dot(d, d));
                    patch.thickness =
                        std::max(patch.thickness, std::abs(glm::dot(d, patch.normal)));
                }
            }
            patch.radius = std::sqrt(farthest);
            return;
        }
        for (const Patch* child : {&left, &right}) {
            const glm::vec3 d = child->center - patch.center;
            patch.radius = std::max(patch.radius, glm::length(d) + child->radius);
            const float rise = glm::length(glm::cross(child->normal, patch.normal)) * child->radius;
            patch.thickness =
                std::max(patch.thickness, std::abs(glm::dot(d, patch.normal)) +
                                              std::min(child->radius, child->thickness + rise));
        }
    }

    /// Axes of the second moments in the plane; sides in the ratio of the spreads, scaled to the
    /// area, never longer than the node.
    void set_rectangle(MaskNode& node, const Patch& patch, float seen_area, float flatness,
                       std::size_t begin, std::size_t end) const
    {
        const glm::vec3 t = perpendicular(patch.normal);
        const glm::vec3 b = glm::cross(patch.normal, t);
        // mean squares, not integrals: the products below must not underflow at small triangles
        const float per_area = patch.area > 0.0f ? 1.0f / patch.area : 0.0f;
        const glm::vec3 st = per_area * patch.spread.times(t);
        const float tt = glm::dot(st, t);
        const float tb = glm::dot(st, b);
        const float bb = per_area * glm::dot(patch.spread.times(b), b);
        // eigenvalues of ((tt, tb), (tb, bb)): mean +- deviation; the axis by half angles
        const float mean = 0.5f * (tt + bb);
        const float half = 0.5f * (tt - bb);
        const float deviation = std::sqrt(half * half + tb * tb);
        float cosine = 1.0f;
        float sine = 0.0f;
        if (deviation > 0.0f) {
            const float c2 = half / deviation;
            cosine = std::sqrt(std::max(0.0f, 0.5f * (1.0f + c2)));
            sine = std::copysign(std::sqrt(std::max(0.0f, 0.5f * (1.0f - c2))), tb);
        }
        const glm::vec3 axis = cosine * t + sine * b;
        const float wide = mean + deviation;
        const float narrow = std::max(mean - deviation, 1e-12f * mean);
        const float spread_area = 12.0f * std::sqrt(wide * narrow);

        const float cover = spread_area > 0.0f ? patch.area / spread_area : 1.0f;
        node.open_radius += patch.radius * kGapPenalty * std::max(0.0f, kSheetCover - cover);
        const bool may_be_whole = flatness > 1.0f - kWhole &&
                                  std::abs(spread_area - patch.area) < 10.0f * kWhole * patch.area;
        if (may_be_whole) {
            // a square has no axes of its own: its triangles' edges lie along them
            const Corners p = corners(keys_[begin].triangle);
            for (const glm::vec3 direction : {axis, p.b - p.a, p.c - p.b, p.a - p.c}) {
                if (set_whole_rectangle(node, patch, glm::normalize(direction), begin, end))
                    return;
            }
        }

        // sheets that lie on each other count once: their spread tells how wide they are together
        const float quarter = 0.25f * std::min(seen_area, kSpreadMargin * spread_area);
        float length_u = 0.0f;
        float length_v = 0.0f;
        if (quarter > 0.0f && narrow > 0.0f) {
            length_u = std::sqrt(quarter * std::sqrt(wide / narrow));
            length_u = std::min(length_u, patch.radius);
            length_v = quarter / length_u;
            const float diagonal = std::sqrt(length_u * length_u + length_v * length_v);
            const float shrink = std::min(1.0f, patch.radius / diagonal);
            const bool sheet = flatness > kSheetFlatness && patch.area > kSheetCover * spread_area;
            const float rim = std::max(0.0f, 1.0f - kDilationSlope * (1.0f - flatness));
            const float grow = sheet ? 1.0f + kDilation * rim : 1.0f;
            if (sheet)
                node.links |= kMaskSheet;
            length_u *= shrink * grow;
            length_v *= shrink * grow;
        }
        node.axis_u = length_u * axis;
        node.axis_v = length_v * glm::cross(patch.normal, axis);
    }

    /// Where the triangles tile a rectangle with sides along and across `axis`, the node is that
    /// rectangle, no approximation, and need not ever be opened.
    bool set_whole_rectangle(MaskNode& node, const Patch& patch, glm::vec3 axis, std::size_t begin,
                             std::size_t end) const
    {
        const glm::vec3 across = glm::cross(patch.normal, axis);
        glm::vec3 low(std::numeric_limits<float>::max());
        glm::vec3 high(-std::numeric_limits<float>::max());
        for (std::size_t i = begin; i < end; ++i) {
            const Corners p = corners(keys_[i].triangle);
            for (const glm::vec3 corner : {p.a, p.b, p.c}) {
                const glm::vec3 d = corner - patch.center;
                const glm::vec3 at(glm::dot(d, axis), glm::dot(d, across),
                                   glm::dot(d, patch.normal));
                low = glm::min(low, at);
                high = glm::max(high, at);
            }
        }
        const glm::vec3 half = 0.5f * (high - low);
        const float along2 = glm::dot(patch.spread.times(axis), axis) / patch.area;
        const float across2 = glm::dot(patch.spread.times(across), across) / patch.area;
        const auto differ = [](float a, float b, float limit) {
            return !(std::abs(a - b) <= limit * b);
        };
        if (half.z > kWhole * patch.radius || differ(patch.area, 4.0f * half.x * half.y, kWhole) ||
            differ(along2, half.x * half.x / 3.0f, 10.0f * kWhole) ||
            differ(across2, half.y * half.y / 3.0f, 10.0f * kWhole))
            return false;
        const glm::vec3 middle = 0.5f * (low + high);
        node.center = patch.center + middle.x * axis + middle.y * across;
        node.radius = std::sqrt(half.x * half.x + half.y * half.y);
        node.open_radius = 0.0f;
        node.axis_u = half.x * axis;
        node.axis_v = half.y * across;
        return true;
    }

    const Geometry& geometry_;
    std::vector<Key> keys_;
    std::vector<MaskNode> nodes_;
};

}  // namespace

std::shared_ptr<const MaskTree> build_mask_tree(const Geometry& geometry)
{
    auto tree = std::make_shared<MaskTree>();
    tree->nodes = Builder(geometry).build();
    return tree;
}

}  // namespace surfelao
