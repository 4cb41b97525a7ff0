#include "tree/disks/octree.h"

#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "tree/morton.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>

namespace surfelao {
namespace {

/// Surfels in one subtree that one thread lays out by itself.
constexpr std::uint32_t kJobSurfels = 16384;

/// Node indices run up to this; a node holds at least one surfel and inner nodes two children.
constexpr std::size_t kMaxSurfels = 0x7fffffff;

/// A stretch of nodes in preorder: one node above the jobs, or the whole subtree of a job.
struct Stretch {
    std::vector<OctreeNode> nodes{};  ///< `next` counts from the stretch's first node
    std::uint32_t first_surfel = 0;
    std::uint32_t surfel_count = 0;
    std::size_t end_stretch = 0;  ///< the stretch that follows this subtree
};

/// The shape of the tree over one sorted run of keys; centres and areas are filled in later.
class Layout {
public:
    Layout(std::span<const MortonKey> keys, std::uint32_t leaf_surfels)
        : keys_(keys), leaf_surfels_(leaf_surfels)
    {
    }

    /// Preorder nodes of the surfels [first, first + count), to the end of `nodes`.
    void emit(std::uint32_t first, std::uint32_t count, std::vector<OctreeNode>& nodes) const
    {
        const std::size_t self = nodes.size();
        nodes.push_back({.first_surfel = first, .surfel_count = count});
        if (!is_leaf(first, count))
            for_each_child(first, count,
                           [&](std::uint32_t begin, std::uint32_t n) { emit(begin, n, nodes); });
        nodes[self].next = static_cast<std::uint32_t>(nodes.size());
    }

    /// The same, cut into stretches of which the large subtrees are still to be emitted.
    void cut(std::uint32_t first, std::uint32_t count, std::vector<Stretch>& stretches) const
    {
        const std::size_t self = stretches.size();
        stretches.push_back({.first_surfel = first, .surfel_count = count});
        if (count > kJobSurfels && !is_leaf(first, count)) {
            stretches[self].nodes.push_back({.first_surfel = first, .surfel_count = count});
            for_each_child(first, count,
                           [&](std::uint32_t begin, std::uint32_t n) { cut(begin, n, stretches); });
        }
        stretches[self].end_stretch = stretches.size();
    }

private:
    bool is_leaf(std::uint32_t first, std::uint32_t count) const
    {
        return count <= leaf_surfels_ || keys_[first].code == keys_[first + count - 1].code;
    }

    /// Splits at the highest level at which the codes differ, so no node has a single child.
    template <class Visit>
    void for_each_child(std::uint32_t first, std::uint32_t count, const Visit& visit) const
    {
        const std::uint64_t differing = keys_[first].code ^ keys_[first + count - 1].code;
        const int shift = (63 - std::countl_zero(differing)) / 3 * 3;
        const std::uint32_t end = first + count;
        while (first < end) {
            const std::uint64_t child = keys_[first].code >> shift;
            const auto last = std::partition_point(
                keys_.begin() + first, keys_.begin() + end,
                [&](const MortonKey& key) { return key.code >> shift == child; });
            const auto next = static_cast<std::uint32_t>(last - keys_.begin());
            visit(first, next - first);
            first = next;
        }
    }

    std::span<const MortonKey> keys_;
    std::uint32_t leaf_surfels_;
};

/// Appends the tree over the surfels from first_surfel on whose sorted keys are given.
void append_tree(Octree& octree, std::span<const MortonKey> keys, std::uint32_t first_surfel,
                 const OctreeOptions& options)
{
    if (keys.empty())
        return;
    // cut into stretches, lay out the large subtrees in parallel
    const Layout layout(keys, options.leaf_surfels);
    std::vector<Stretch> stretches;
    layout.cut(0, static_cast<std::uint32_t>(keys.size()), stretches);
    for_tasks(stretches.size(), [&](std::size_t s) {
        if (stretches[s].nodes.empty())
            layout.emit(stretches[s].first_surfel, stretches[s].surfel_count, stretches[s].nodes);
    });

    // join them: every stretch's first node ends where its subtree's last stretch does
    std::vector<std::size_t> begin(stretches.size() + 1, octree.nodes.size());
    for (std::size_t s = 0; s < stretches.size(); ++s)
        begin[s + 1] = begin[s] + stretches[s].nodes.size();
    octree.nodes.resize(begin.back());
    for_tasks(stretches.size(), [&](std::size_t s) {
        OctreeNode* out = octree.nodes.data() + begin[s];
        for (const OctreeNode& node : stretches[s].nodes) {
            *out = node;
            out->next += static_cast<std::uint32_t>(begin[s]);
            out->first_surfel += first_surfel;
            ++out;
        }
        octree.nodes[begin[s]].next = static_cast<std::uint32_t>(begin[stretches[s].end_stretch]);
    });
}

/// Fills in what a node is as a disk, from its own range of surfels.
void aggregate(const Octree& octree, OctreeNode& node)
{
    const std::span surfels(octree.surfels.data() + node.first_surfel, node.surfel_count);
    double area = 0.0;
    glm::dvec3 moment(0.0);
    glm::dvec3 vector_area(0.0);
    for (const Surfel& surfel : surfels) {
        area += surfel.area;
        moment += static_cast<double>(surfel.area) * glm::dvec3(surfel.position);
        vector_area += static_cast<double>(surfel.area) * glm::dvec3(surfel.normal);
    }
    node.center = glm::vec3(moment / area);
    const double flat_area = glm::length(vector_area);
    if (flat_area > 0.0)
        node.normal = glm::vec3(vector_area / flat_area);
    node.flatness = static_cast<float>(std::min(1.0, flat_area / area));
    node.area = static_cast<float>(area);
    for (const Surfel& surfel : surfels) {
        const float rim = std::sqrt(surfel.area * std::numbers::inv_pi_v<float>);
        node.radius = std::max(node.radius, glm::distance(node.center, surfel.position) + rim);
    }
}

}  // namespace

Octree build_octree(std::span<const Surfel> surfels, std::span<const OccluderSide> sides,
                    const OctreeOptions& options)
{
    SURFELAO_CHECK(sides.empty() || sides.size() == surfels.size());
    if (surfels.size() > kMaxSurfels)
        throw std::runtime_error("disks take at most " + std::to_string(kMaxSurfels) +
                                 " surfels; the scene gives " + std::to_string(surfels.size()));
    SURFELAO_CHECK(options.leaf_surfels >= 1);
    const auto side = [&](std::uint32_t i) {
        return sides.empty() ? OccluderSide::back : sides[i];
    };

    // Morton order, one-sided surfels first
    std::vector<glm::vec3> positions(surfels.size());
    std::transform(surfels.begin(), surfels.end(), positions.begin(),
                   [](const Surfel& surfel) { return surfel.position; });
    std::vector<MortonKey> keys = morton_order(positions);
    const auto two_sided = std::stable_partition(
        keys.begin(), keys.end(),
        [&](const MortonKey& key) { return side(key.index) != OccluderSide::both; });

    Octree octree;
    octree.surfels.resize(surfels.size());
    octree.source.resize(surfels.size());
    octree.two_sided_surfels = static_cast<std::uint32_t>(two_sided - keys.begin());
    for_all(keys.size(), [&](std::size_t i) {
        const std::uint32_t source = keys[i].index;
        octree.source[i] = source;
        octree.surfels[i] = surfels[source];
        if (side(source) == OccluderSide::front)
            octree.surfels[i].normal = -surfels[source].normal;
    });

    const std::span<const MortonKey> all(keys);
    append_tree(octree, all.first(octree.two_sided_surfels), 0, options);
    octree.two_sided_nodes = static_cast<std::uint32_t>(octree.nodes.size());
    append_tree(octree, all.subspan(octree.two_sided_surfels), octree.two_sided_surfels, options);

    for_all(octree.nodes.size(), 256, [&](std::size_t i) { aggregate(octree, octree.nodes[i]); });
    return octree;
}

}  // namespace surfelao
