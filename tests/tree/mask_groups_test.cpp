#include "tree/masks/groups.h"

#include "scenes.h"
#include "surfels/geometry.h"
#include "tree/masks/tree.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace surfelao {
namespace {

std::vector<Receiver> receivers_of(const Scene& scene)
{
    return receivers_at_vertices(make_geometry(scene), 1e-4f);
}

void expect_grouped(const std::vector<Receiver>& receivers)
{
    const MaskGroups found = group_for_masks(receivers);
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
    std::size_t leaves = 0;
    for (const MaskGroup& group : found.groups) {
        ASSERT_LT(group.begin, group.end);
        if (group.first_child == 0) {
            ++leaves;
            EXPECT_LE(group.end - group.begin, kMaskGroupSize);
        } else {
            const MaskGroup& left = found.groups.at(group.first_child);
            const MaskGroup& right = found.groups.at(group.first_child + 1);
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
    EXPECT_EQ(leaves, (expected.size() + kMaskGroupSize - 1) / kMaskGroupSize);
}

TEST(MaskGroups, HoldEveryReceiverOnceAndBoundIt)
{
    expect_grouped(receivers_of(scenes::bumpy_sphere(12)));
    expect_grouped(receivers_of(scenes::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})));
}

TEST(MaskGroups, LeaveOutReceiversWithoutANormal)
{
    std::vector<Receiver> receivers = receivers_of(scenes::bumpy_sphere(8));
    for (std::size_t i = 0; i < receivers.size(); i += 3)
        receivers[i].normal = glm::vec3(0.0f);
    expect_grouped(receivers);
    for (Receiver& receiver : receivers)
        receiver.normal = glm::vec3(0.0f);
    EXPECT_TRUE(group_for_masks(receivers).groups.empty());
}

// Nothing but their number parts them; and a grid has many receivers at each place of an axis.
TEST(MaskGroups, PartReceiversAtOnePlace)
{
    expect_grouped(std::vector<Receiver>(1000, Receiver{{0.1f, 0.2f, 0.3f}, {0, 0, 1}}));
    std::vector<Receiver> grid;
    for (int i = 0; i < 1000; ++i)
        grid.push_back({{0.1f * static_cast<float>(i % 2), 0.0f, 0.0f}, {0, 0, 1}});
    expect_grouped(grid);
}

TEST(MaskGroups, SameBytesForAnyNumberOfThreads)
{
    const std::vector<Receiver> receivers = receivers_of(scenes::bumpy_sphere(110));
    ASSERT_GT(receivers.size(), 65536u);  // the largest groups are split by all threads
    const auto group = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return group_for_masks(receivers);
    };
    const MaskGroups one = group(1);
    for (const std::size_t threads : {2, 5}) {
        const MaskGroups more = group(threads);
        EXPECT_EQ(one.order, more.order);
        ASSERT_EQ(one.groups.size(), more.groups.size());
        EXPECT_EQ(std::memcmp(one.groups.data(), more.groups.data(),
                              one.groups.size() * sizeof(MaskGroup)),
                  0);
    }
}

}  // namespace
}  // namespace surfelao
