#include "tree/receiver_groups.h"

#include "scenes.h"
#include "surfels/geometry.h"
#include "tests/vertex_receivers.h"
#include "tree/discard.h"
#include "tree/masks/tree.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

namespace surfelao {
namespace {

std::vector<Receiver> receivers_of(const Scene& scene)
{
    return vertex_receivers(make_geometry(scene));
}

void expect_grouped(const std::vector<Receiver>& receivers)
{
    const ReceiverGroups found = group_receivers(receivers, kMaskFrame);
    std::vector<std::uint32_t> expected, order(found.order.begin(), found.order.end());
    for (std::uint32_t i = 0; i < receivers.size(); ++i) {
        if (receivers[i].normal != glm::vec3(0.0f))
            expected.push_back(i);
    }
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, expected);

    const auto column = [](const auto& columns, std::size_t i) {
        return glm::vec3(columns[0][i], columns[1][i], columns[2][i]);
    };
    std::size_t leaf_count = 0;
    for (const ReceiverGroup& group : found.groups) {
        ASSERT_LT(group.begin, group.end);
        if (group.first_child == 0) {
            ++leaf_count;
            EXPECT_LE(group.end - group.begin, kGroupSize);
        } else {
            const ReceiverGroup& left = found.groups.at(group.first_child);
            const ReceiverGroup& right = found.groups.at(group.first_child + 1);
            EXPECT_EQ(left.begin, group.begin);
            EXPECT_EQ(left.end, right.begin);
            EXPECT_EQ(right.end, group.end);
        }
        const glm::vec3 center(group.center[0], group.center[1], group.center[2]);
        const glm::vec3 axis(group.axis[0], group.axis[1], group.axis[2]);
        float radius = 0.0f, rise = -1.0f, cone_cos = 1.0f;
        for (std::size_t i = group.begin; i < group.end; ++i) {
            const Receiver& receiver = receivers[found.order[i]];
            const glm::vec3 position = column(found.position, i), normal = column(found.normal, i);
            EXPECT_LT(glm::length(position - kMaskFrame * receiver.position), 1e-6f);
            EXPECT_LT(glm::length(normal - kMaskFrame * receiver.normal), 1e-6f);
            radius = std::max(radius, glm::length(position - center));
            rise = std::max(rise, -glm::dot(normal, position - center));
            cone_cos = std::min(cone_cos, glm::dot(normal, axis));
        }
        EXPECT_NEAR(group.radius, radius, 1e-6f);
        EXPECT_NEAR(group.rise, rise, 1e-6f);
        EXPECT_NEAR(group.cone_cos, cone_cos, 1e-6f);
    }
    // all leaves but the last are full
    EXPECT_EQ(leaf_count, (expected.size() + kGroupSize - 1) / kGroupSize);
    ASSERT_EQ(found.leaves.size(), leaf_count);
    for (std::size_t k = 0; k < leaf_count; ++k) {
        const ReceiverGroup& leaf = found.groups.at(found.leaves[k]);
        EXPECT_EQ(leaf.first_child, 0u);
        EXPECT_EQ(leaf.begin, k * kGroupSize);
    }
}

TEST(ReceiverGroups, HoldEveryReceiverOnceAndBoundIt)
{
    expect_grouped(receivers_of(scenes::bumpy_sphere(12)));
    expect_grouped(receivers_of(scenes::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})));
}

// What the disks leave out by rise_of_cone() is above nobody's tangent plane.
TEST(ReceiverGroups, APointBelowTheConeIsBelowEveryHorizon)
{
    const std::vector<Receiver> receivers = receivers_of(scenes::bumpy_sphere(24));
    const ReceiverGroups found = group_receivers(receivers);
    std::size_t below = 0;
    for (const ReceiverGroup& group : found.groups) {
        const glm::vec3 center(group.center[0], group.center[1], group.center[2]);
        const glm::vec3 axis(group.axis[0], group.axis[1], group.axis[2]);
        for (std::size_t k = 0; k < receivers.size(); k += 7) {
            const glm::vec3 v = receivers[k].position - center;
            const float along = glm::dot(v, axis);
            const float across = glm::length(v - along * axis);
            if (along * group.cone_cos + across * group.cone_sin + rise_of_cone(group) >= 0.0f)
                continue;
            ++below;
            for (std::uint32_t i = group.begin; i < group.end; ++i) {
                const Receiver& receiver = receivers[found.order[i]];
                EXPECT_LE(glm::dot(receiver.normal, receivers[k].position - receiver.position),
                          1e-6f);
            }
        }
    }
    EXPECT_GT(below, 1000u);
    EXPECT_EQ(rise_of_cone(found.groups[0]), std::numeric_limits<float>::infinity())
        << "normals all around";
}

TEST(ReceiverGroups, LeaveOutReceiversWithoutANormal)
{
    std::vector<Receiver> receivers = receivers_of(scenes::bumpy_sphere(8));
    for (std::size_t i = 0; i < receivers.size(); i += 3)
        receivers[i].normal = glm::vec3(0.0f);
    expect_grouped(receivers);
    for (Receiver& receiver : receivers)
        receiver.normal = glm::vec3(0.0f);
    EXPECT_TRUE(group_receivers(receivers).groups.empty());
}

// Nothing but their number parts them; and a grid has many receivers at each place of an axis.
TEST(ReceiverGroups, PartReceiversAtOnePlace)
{
    expect_grouped(std::vector<Receiver>(1000, Receiver{{0.1f, 0.2f, 0.3f}, {0, 0, 1}}));
    std::vector<Receiver> grid;
    for (int i = 0; i < 1000; ++i)
        grid.push_back({{0.1f * static_cast<float>(i % 2), 0.0f, 0.0f}, {0, 0, 1}});
    expect_grouped(grid);
}

TEST(ReceiverGroups, SameBytesForAnyNumberOfThreads)
{
    const std::vector<Receiver> receivers = receivers_of(scenes::bumpy_sphere(110));
    ASSERT_GT(receivers.size(), 65536u);  // the largest groups are split by all threads
    const auto group = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return group_receivers(receivers);
    };
    const ReceiverGroups one = group(1);
    for (const std::size_t threads : {2, 5}) {
        const ReceiverGroups more = group(threads);
        EXPECT_EQ(one.order, more.order);
        ASSERT_EQ(one.groups.size(), more.groups.size());
        EXPECT_EQ(std::memcmp(one.groups.data(), more.groups.data(),
                              one.groups.size() * sizeof(ReceiverGroup)),
                  0);
    }
}

// More than are parted at once.
TEST(ReceiverGroups, PartTheMostAlongTheLongestAxisToo)
{
    std::vector<Receiver> receivers(5 << 18);
    std::uint32_t state = 1;
    const auto next = [&] {
        state = 1664525u * state + 1013904223u;
        return static_cast<float>(state >> 8) * 0x1p-24f;
    };
    for (Receiver& receiver : receivers) {
        const float x = next(), y = 0.7f * next();
        receiver = {{x, y, 0.4f * next()}, {0, 0, 1}};
    }
    const ReceiverGroups found = group_receivers(receivers);
    std::vector<std::uint32_t> order(found.order.begin(), found.order.end());
    std::sort(order.begin(), order.end());
    ASSERT_EQ(order.size(), receivers.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        ASSERT_EQ(order[i], i);
    const auto parted = [&](const ReceiverGroup& group, int axis) {
        const RawVector<float>& at = found.position[axis];
        const std::uint32_t middle = found.groups[group.first_child].end;
        return *std::max_element(at.begin() + group.begin, at.begin() + middle) <=
               *std::min_element(at.begin() + middle, at.begin() + group.end);
    };
    EXPECT_TRUE(parted(found.groups[0], 0));
    EXPECT_TRUE(parted(found.groups[found.groups[0].first_child], 1));
    EXPECT_TRUE(parted(found.groups[found.groups[0].first_child + 1], 1));
}

// Whole pages within the range may go, nothing beside it.
TEST(Discard, LeavesWhatIsOutsideOfTheRange)
{
    RawVector<std::uint32_t> numbers;
    numbers.resize(4 * kLargePage / sizeof(std::uint32_t));
    std::iota(numbers.begin(), numbers.end(), 1u);
    const std::size_t begin = 12345, end = numbers.size() - 54321;
    discard(std::span(numbers).subspan(begin, end - begin));
    std::size_t changed = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        changed += (i < begin || i >= end) && numbers[i] != i + 1 ? 1 : 0;
    EXPECT_EQ(changed, 0u);
}

}  // namespace
}  // namespace surfelao
