#include "tree/mask_groups.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

/// A unit of normal counts as this many diagonals where receivers are parted.
constexpr float kNormalExtent = 0.0f;
constexpr std::size_t kParallelSplit = 4096;

struct Key {
    std::array<float, 6> at;
    std::uint32_t receiver;
    std::uint32_t padding = 0;
};

class Grouper {
public:
    explicit Grouper(std::span<const Receiver> receivers) : receivers_(receivers)
    {
        keys_.reserve(receivers.size());
        for (std::uint32_t i = 0; i < receivers.size(); ++i) {
            const glm::vec3 p = receivers[i].position;
            const glm::vec3 n = receivers[i].normal;
            if (n == glm::vec3(0.0f))
                continue;
            keys_.push_back(
                {{p.x, p.y, p.z, kNormalExtent * n.x, kNormalExtent * n.y, kNormalExtent * n.z},
                 i});
        }
    }

    MaskGroups build()
    {
        MaskGroups out;
        if (keys_.empty())
            return out;
        groups_.resize(2 * leaf_count(keys_.size()) - 1);
        build_group(0, 1, 0, keys_.size());
        out.groups = std::move(groups_);
        out.order.resize(keys_.size());
        std::transform(keys_.begin(), keys_.end(), out.order.begin(),
                       [](const Key& key) { return key.receiver; });
        return out;
    }

private:
    static std::size_t leaf_count(std::size_t receivers)
    {
        return (receivers + kMaskGroupSize - 1) / kMaskGroupSize;
    }

    /// Group `index` over keys [begin, end); its descendants stand at [first, first + 2
    /// (leaves-1)).
    void build_group(std::size_t index, std::size_t first, std::size_t begin, std::size_t end)
    {
        MaskGroup& group = groups_[index];
        group.begin = static_cast<std::uint32_t>(begin);
        group.end = static_cast<std::uint32_t>(end);
        bound(group);
        const std::size_t leaves = leaf_count(end - begin);
        if (leaves == 1) {
            group.first_child = 0;
            return;
        }
        group.first_child = static_cast<std::uint32_t>(first);

        // in two at the median of the longest extent, so that all leaves but the last are full
        const std::size_t left_leaves = leaves / 2;
        const std::size_t middle = begin + left_leaves * kMaskGroupSize;
        const int axis = longest_axis(begin, end);
        std::nth_element(
            keys_.begin() + static_cast<std::ptrdiff_t>(begin),
            keys_.begin() + static_cast<std::ptrdiff_t>(middle),
            keys_.begin() + static_cast<std::ptrdiff_t>(end), [axis](const Key& a, const Key& b) {
                return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.receiver < b.receiver;
            });
        const std::size_t left_first = first + 2;
        const std::size_t right_first = left_first + 2 * (left_leaves - 1);
        const auto left = [&] { build_group(first, left_first, begin, middle); };
        const auto right = [&] { build_group(first + 1, right_first, middle, end); };
        if (end - begin > kParallelSplit) {
            tbb::parallel_invoke(left, right);
        } else {
            left();
            right();
        }
    }

    int longest_axis(std::size_t begin, std::size_t end) const
    {
        std::array<float, 6> low = keys_[begin].at;
        std::array<float, 6> high = low;
        for (std::size_t i = begin + 1; i < end; ++i) {
            for (int k = 0; k < 6; ++k) {
                low[k] = std::min(low[k], keys_[i].at[k]);
                high[k] = std::max(high[k], keys_[i].at[k]);
            }
        }
        int axis = 0;
        for (int k = 1; k < 6; ++k) {
            if (high[k] - low[k] > high[axis] - low[axis])
                axis = k;
        }
        return axis;
    }

    /// The centre is the centroid of the points: the box's lies inside of the body, and darkens.
    void bound(MaskGroup& group) const
    {
        glm::dvec3 sum(0.0);
        glm::dvec3 normals(0.0);
        for (std::uint32_t i = group.begin; i < group.end; ++i) {
            sum += receiver(i).position;
            normals += receiver(i).normal;
        }
        const glm::vec3 center(sum / static_cast<double>(group.end - group.begin));
        const double length = glm::length(normals);
        const glm::vec3 axis =
            length > 0.0 ? glm::vec3(normals / length) : receiver(group.begin).normal;
        float radius2 = 0.0f;
        float rise = -std::numeric_limits<float>::max();
        float cone_cos = 1.0f;
        for (std::uint32_t i = group.begin; i < group.end; ++i) {
            const glm::vec3 d = receiver(i).position - center;
            radius2 = std::max(radius2, glm::dot(d, d));
            rise = std::max(rise, -glm::dot(receiver(i).normal, d));
            cone_cos = std::min(cone_cos, glm::dot(receiver(i).normal, axis));
        }
        cone_cos = std::max(-1.0f, cone_cos);
        for (int k = 0; k < 3; ++k) {
            group.center[k] = center[k];
            group.axis[k] = axis[k];
        }
        group.radius = std::sqrt(radius2);
        group.cone_cos = cone_cos;
        group.cone_sin = std::sqrt(1.0f - cone_cos * cone_cos);
        group.rise = rise;
    }

    const Receiver& receiver(std::uint32_t i) const { return receivers_[keys_[i].receiver]; }

    std::span<const Receiver> receivers_;
    std::vector<Key> keys_;
    std::vector<MaskGroup> groups_;
};

}  // namespace

MaskGroups group_for_masks(std::span<const Receiver> receivers)
{
    return Grouper(receivers).build();
}

}  // namespace surfelao
