#include "tree/receiver_groups.h"

#include "surfels/for_all.h"
#include "tree/discard.h"
#include "tree/lanes.h"
#include "tree/part.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

/// Receivers; smaller groups are made in less time than it takes to hand them to another thread.
constexpr std::size_t kParallelGroup = 2048;

/// Receivers: the large pages of the columns are then filled one after the other, and the keys
/// behind them given back, whatever the number of threads: 10 MB less at the peak of 10^7.
constexpr std::size_t kColumnsAtOnce = std::size_t{1} << 18;

/// Receivers: 28 MiB.
constexpr std::size_t kForgottenAtOnce = std::size_t{1} << 20;

/// Keys among which a pivot is chosen at most: mostly it is then within a sixteenth of the place
/// that is looked for.
constexpr std::size_t kSample = 63;

/// Where a receiver stands, in the frame of the groups.
struct alignas(16) Key {
    std::array<float, 3> at;
    std::uint32_t receiver;
};

/// Keys, 16 MiB: so many have as much memory again to be parted into. More of them have it for a
/// quarter, or a solution would need most memory while its receivers are sorted.
constexpr std::size_t kLeastSpare = std::size_t{1} << 20;

/// Brings the keys for which below(key) before the others, and returns how many they are. O(n), and
/// where `spare` is smaller than `keys`, one that was brought forward changes places with another.
template <class Below>
std::size_t part_in_place(std::span<Key> keys, const Below& below, std::span<Key> spare)
{
    std::size_t first = 0;
    for (std::size_t begin = 0; begin < keys.size(); begin += spare.size()) {
        const std::span<Key> some =
            keys.subspan(begin, std::min(spare.size(), keys.size() - begin));
        const std::size_t found = part<Key>(some, below, spare.data());
        for_blocks(spare.first(some.size()), [&](std::span<const Key> block, std::size_t i) {
            std::copy(block.begin(), block.end(), some.begin() + i * kPartBlock);
        });
        // others of before stand from `first` on, those that were found from `begin` on
        const std::size_t moved = std::min(begin - first, found);
        std::swap_ranges(keys.begin() + first, keys.begin() + first + moved,
                         keys.begin() + begin + found - moved);
        first += found;
    }
    return first;
}

/// Brings the first `rank` keys along an axis before the others; of keys at one place those of the
/// first receivers. O(n) on average; std::nth_element does the same with a branch for each key, in
/// twice the time.
void select(std::span<Key> keys, std::size_t rank, std::size_t axis, std::span<Key> spare)
{
    while (rank > 0 && rank < keys.size()) {
        // the place that has the rank in a sample
        std::array<float, kSample> sample;
        const std::size_t count = std::clamp(keys.size() / 8, std::size_t{1}, kSample);
        for (std::size_t i = 0; i < count; ++i)
            sample[i] = keys[(2 * i + 1) * keys.size() / (2 * count)].at[axis];
        const auto middle =
            sample.begin() + static_cast<std::ptrdiff_t>(rank * count / keys.size());
        std::nth_element(sample.begin(), middle,
                         sample.begin() + static_cast<std::ptrdiff_t>(count));
        const float place = *middle;

        std::size_t first = part_in_place(
            keys, [=](const Key& key) { return key.at[axis] < place; }, spare);
        if (first == 0) {
            first = part_in_place(
                keys, [=](const Key& key) { return key.at[axis] <= place; }, spare);
            if (rank < first) {
                std::nth_element(
                    keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(rank),
                    keys.begin() + static_cast<std::ptrdiff_t>(first),
                    [](const Key& a, const Key& b) { return a.receiver < b.receiver; });
                return;
            }
        }
        if (rank < first) {
            keys = keys.first(first);
        } else {
            keys = keys.subspan(first);
            rank -= first;
        }
    }
}

/// Sums over a group.
struct Sums {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0};
};

class Grouper {
public:
    /// answers: become as many as receivers, with their normals; null: the receivers stay.
    Grouper(std::span<const Receiver> receivers, const glm::mat3& frame,
            std::vector<Occlusion>* answers)
        : receivers_(receivers), answers_(answers), frame_(frame)
    {
    }

    ReceiverGroups build(const ForgetReceivers& forget)
    {
        make_keys(forget);
        keys_.erase(std::remove_if(
                        keys_.begin(), keys_.end(),
                        [&](const Key& key) { return normal_of(key.receiver) == glm::vec3(0.0f); }),
                    keys_.end());
        if (keys_.empty())
            return {};
        spare_.resize(std::min(keys_.size(), std::max(kLeastSpare, keys_.size() / 4)));
        sort_keys(0, keys_.size(), spare_);
        spare_ = RawVector<Key>();  // before there are columns
        out_.order.resize(keys_.size());
        for (auto* columns : {&out_.position, &out_.normal}) {
            for (RawVector<float>& column : *columns) {
                column.resize(keys_.size() + kGroupSize);
                std::fill_n(column.end() - kGroupSize, kGroupSize, 0.0f);
            }
        }
        out_.leaves.resize(leaf_count(keys_.size()));
        out_.groups.resize(2 * out_.leaves.size() - 1);
        build_group(0, 1, 0, keys_.size());
        return std::move(out_);
    }

private:
    void make_keys(const ForgetReceivers& forget)
    {
        const std::size_t count = receivers_.size();
        keys_.resize(count);
        if (answers_ != nullptr)
            answers_->reserve(count);
        for (std::size_t begin = 0; begin < count; begin += kForgottenAtOnce) {
            const std::size_t end = std::min(count, begin + kForgottenAtOnce);
            const std::span<Key> keys = std::span(keys_).subspan(begin, end - begin);
            if (answers_ != nullptr)
                answers_->resize(end);  // memory that what is forgotten leaves
            for_blocks(keys, [&](std::span<Key> block, std::size_t) {
                for (Key& key : block) {
                    const auto receiver = static_cast<std::uint32_t>(&key - keys_.data());
                    const glm::vec3 p = frame_ * receivers_[receiver].position;
                    key = {{p.x, p.y, p.z}, receiver};
                    if (answers_ != nullptr)
                        (*answers_)[receiver].bent_normal = receivers_[receiver].normal;
                }
            });
            if (forget)
                forget(begin, end);
        }
    }

    static std::size_t leaf_count(std::size_t receivers)
    {
        return (receivers + kGroupSize - 1) / kGroupSize;
    }

    /// Where keys [begin, end) are cut in two, so that all leaves but the last are full.
    static std::size_t middle_of(std::size_t begin, std::size_t end)
    {
        return begin + leaf_count(end - begin) / 2 * kGroupSize;
    }

    /// On two threads where so many keys are worth it.
    template <class Left, class Right>
    static void do_both(std::size_t keys, const Left& left, const Right& right)
    {
        if (keys > kParallelGroup) {
            surfelao::do_both(left, right);
        } else {
            left();
            right();
        }
    }

    /// In two at the median of the longest extent, again and again.
    void sort_keys(std::size_t begin, std::size_t end, std::span<Key> spare)
    {
        const std::size_t middle = middle_of(begin, end);
        if (middle == begin)
            return;
        select(std::span(keys_).subspan(begin, end - begin), middle - begin,
               longest_axis(begin, end), spare);
        if (spare.size() < end - begin) {  // so many that each half takes all threads
            sort_keys(begin, middle, spare);
            sort_keys(middle, end, spare);
            return;
        }
        do_both(
            end - begin, [&] { sort_keys(begin, middle, spare.first(middle - begin)); },
            [&] { sort_keys(middle, end, spare.subspan(middle - begin)); });
    }

    /// Group `index` over keys [begin, end); its descendants stand at [first, first + 2
    /// (leaves-1)).
    Sums build_group(std::size_t index, std::size_t first, std::size_t begin, std::size_t end)
    {
        ReceiverGroup& group = out_.groups[index];
        group.begin = static_cast<std::uint32_t>(begin);
        group.end = static_cast<std::uint32_t>(end);
        group.first_child = 0;
        const std::size_t leaves = leaf_count(end - begin);
        Sums sums;
        if (leaves == 1) {
            out_.leaves[begin / kGroupSize] = static_cast<std::uint32_t>(index);
            sums = finish_leaf(begin, end);
        } else {
            group.first_child = static_cast<std::uint32_t>(first);
            const std::size_t middle = middle_of(begin, end);
            const std::size_t left_first = first + 2;
            const std::size_t right_first = left_first + 2 * (leaf_count(middle - begin) - 1);
            Sums right_sums;
            const auto build_left = [&] { sums = build_group(first, left_first, begin, middle); };
            const auto build_right = [&] {
                right_sums = build_group(first + 1, right_first, middle, end);
            };
            if (end - begin > kColumnsAtOnce) {
                build_left();
                build_right();
            } else {
                do_both(end - begin, build_left, build_right);
            }
            discard(std::span(keys_).subspan(begin, end - begin));
            sums.position += right_sums.position;
            sums.normal += right_sums.normal;
        }
        bound(group, sums);
        return sums;
    }

    glm::vec3 normal_of(std::uint32_t receiver) const
    {
        return answers_ == nullptr ? receivers_[receiver].normal
                                   : (*answers_)[receiver].bent_normal;
    }

    std::size_t longest_axis(std::size_t begin, std::size_t end) const
    {
        // the fourth lane is the receiver and of no meaning
        Float4 low = std::bit_cast<Float4>(keys_[begin]);
        Float4 high = low;
        for (std::size_t i = begin + 1; i < end; ++i) {
            const Float4 at = std::bit_cast<Float4>(keys_[i]);
            low = least(low, at);
            high = most(high, at);
        }
        const Float4 length = high - low;
        std::size_t axis = 0;
        for (std::size_t k = 1; k < 3; ++k) {
            if (length[k] > length[axis])
                axis = k;
        }
        return axis;
    }

    /// Writes order and columns.
    Sums finish_leaf(std::size_t begin, std::size_t end)
    {
        Sums sums;
        for (std::size_t i = begin; i < end; ++i) {
            const Key& key = keys_[i];
            const glm::vec3 normal = frame_ * normal_of(key.receiver);
            out_.order[i] = key.receiver;
            for (std::size_t k = 0; k < 3; ++k) {
                out_.position[k][i] = key.at[k];
                out_.normal[k][i] = normal[static_cast<int>(k)];
            }
            sums.position += glm::dvec3(key.at[0], key.at[1], key.at[2]);
            sums.normal += glm::dvec3(normal);
        }
        return sums;
    }

    /// The centre is the centroid of the points: the box's lies inside of the body, and darkens.
    void bound(ReceiverGroup& group, const Sums& sums) const
    {
        const glm::vec3 center(sums.position / static_cast<double>(group.end - group.begin));
        const double length = glm::length(sums.normal);
        const glm::vec3 axis =
            length > 0.0 ? glm::vec3(sums.normal / length)
                         : glm::vec3(out_.normal[0][group.begin], out_.normal[1][group.begin],
                                     out_.normal[2][group.begin]);
        Float4 radius2 = all_lanes(0.0f);
        Float4 rise = all_lanes(-std::numeric_limits<float>::max());
        Float4 cone_cos = all_lanes(1.0f);
        for (std::uint32_t i = group.begin; i < group.end; i += kFloat4Lanes) {
            const Bool4 inside = Bool4{0, 1, 2, 3} < static_cast<std::int32_t>(group.end - i);
            const Float4 x = load_lanes(&out_.position[0][i]) - center.x;
            const Float4 y = load_lanes(&out_.position[1][i]) - center.y;
            const Float4 z = load_lanes(&out_.position[2][i]) - center.z;
            const Float4 nx = load_lanes(&out_.normal[0][i]);
            const Float4 ny = load_lanes(&out_.normal[1][i]);
            const Float4 nz = load_lanes(&out_.normal[2][i]);
            // lanes beyond the end change nothing
            radius2 = most(radius2, inside ? x * x + y * y + z * z : radius2);
            rise = most(rise, inside ? -(nx * x + ny * y + nz * z) : rise);
            cone_cos = least(cone_cos, inside ? nx * axis.x + ny * axis.y + nz * axis.z : cone_cos);
        }
        for (int k = 0; k < 3; ++k) {
            group.center[k] = center[k];
            group.axis[k] = axis[k];
        }
        group.radius = std::sqrt(std::max({radius2[0], radius2[1], radius2[2], radius2[3]}));
        group.rise = std::max({rise[0], rise[1], rise[2], rise[3]});
        group.cone_cos =
            std::max(-1.0f, std::min({cone_cos[0], cone_cos[1], cone_cos[2], cone_cos[3]}));
        group.cone_sin = std::sqrt(1.0f - group.cone_cos * group.cone_cos);
    }

    std::span<const Receiver> receivers_;
    std::vector<Occlusion>* answers_;
    glm::mat3 frame_;
    RawVector<Key> keys_, spare_;
    ReceiverGroups out_;
};

}  // namespace

ReceiverGroups group_receivers(std::span<const Receiver> receivers, const glm::mat3& frame)
{
    return Grouper(receivers, frame, nullptr).build({});
}

ReceiverGroups group_receivers(std::span<const Receiver> receivers, const glm::mat3& frame,
                               std::vector<Occlusion>& answers, const ForgetReceivers& forget)
{
    return Grouper(receivers, frame, &answers).build(forget);
}

}  // namespace surfelao
