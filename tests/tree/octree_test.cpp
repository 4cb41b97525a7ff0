#include "tree/disks/octree.h"

#include "differences.h"
#include "scenes.h"
#include "tree/morton.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <numeric>

namespace surfelao {
namespace {

std::vector<Surfel> bumpy_surfels(int cells)
{
    return surfels_at_vertices(make_geometry(scenes::bumpy_sphere(cells)));
}

/// Back, front and both in turn.
std::vector<OccluderSide> mixed_sides(std::size_t count)
{
    std::vector<OccluderSide> sides(count);
    for (std::size_t i = 0; i < count; ++i)
        sides[i] = static_cast<OccluderSide>(i % 3);
    return sides;
}

TEST(Morton, OrderIsSortedByCodeThenIndexAndHoldsEveryPoint)
{
    const std::vector<glm::vec3> points = {{1, 1, 1}, {0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 1}};
    std::vector<std::uint32_t> order;
    for (const MortonKey& key : morton_order(points))
        order.push_back(key.index);
    EXPECT_EQ(order, (std::vector<std::uint32_t>{1, 3, 2, 4, 0}));  // x is the lowest bit
}

TEST(Morton, EqualPointsHaveEqualCodesEvenWhereAllAreOne)
{
    const std::vector<glm::vec3> points(3, glm::vec3(0.3f, -0.2f, 0.1f));
    const std::vector<MortonKey> keys = morton_order(points);
    EXPECT_EQ(keys.front().code, keys.back().code);
    EXPECT_TRUE(morton_order({}).empty());
}

TEST(Morton, WhatLiesFarAwayLeavesTheRestItsCells)
{
    std::vector<glm::vec3> points;
    for (int i = 0; i < 8; ++i)
        points.emplace_back(0.001f * float(i & 1), 0.001f * float(i >> 1 & 1),
                            0.001f * float(i >> 2));
    points.emplace_back(1e6f, -1e6f, 1e6f);
    std::vector<std::uint64_t> codes;
    for (const MortonKey& key : morton_order(points))
        codes.push_back(key.code);
    EXPECT_EQ(std::unique(codes.begin(), codes.end()) - codes.begin(), 9);
}

TEST(Octree, NodesAreInPreorderAndTheirSurfelsPartitionEachRange)
{
    const std::vector<Surfel> surfels = bumpy_surfels(60);  // more than one thread's job
    const Octree octree = build_octree(surfels);
    ASSERT_EQ(octree.nodes[0].surfel_count, surfels.size());
    ASSERT_EQ(octree.nodes[0].next, octree.nodes.size());
    for (std::uint32_t i = 0; i < octree.nodes.size(); ++i) {
        const OctreeNode& node = octree.nodes[i];
        std::uint32_t surfel = node.first_surfel;
        std::uint32_t children = 0;
        for (std::uint32_t child = i + 1; child < node.next; child = octree.nodes[child].next) {
            ASSERT_EQ(octree.nodes[child].first_surfel, surfel);
            surfel += octree.nodes[child].surfel_count;
            ++children;
        }
        ASSERT_EQ(surfel,
                  children == 0 ? node.first_surfel : node.first_surfel + node.surfel_count);
        ASSERT_NE(children, 1u);
        ASSERT_EQ(node.surfel_count <= OctreeOptions{}.leaf_surfels, children == 0);
    }
}

TEST(Octree, EveryNodeHoldsItsDisksAndSumsTheirAreas)
{
    const Octree octree = build_octree(bumpy_surfels(20));
    for (const OctreeNode& node : octree.nodes) {
        double area = 0.0;
        glm::dvec3 vector_area(0.0);
        for (std::uint32_t s = node.first_surfel; s < node.first_surfel + node.surfel_count; ++s) {
            const Surfel& surfel = octree.surfels[s];
            area += surfel.area;
            vector_area += double(surfel.area) * glm::dvec3(surfel.normal);
            const float rim = std::sqrt(surfel.area / 3.14159265f);
            ASSERT_LE(glm::distance(surfel.position, node.center) + rim, node.radius * 1.00001f);
        }
        // one rounding to float of sums that were made in double
        ASSERT_NEAR(node.area, area, 1e-6 * area);
        ASSERT_NEAR(glm::distance(glm::dvec3(node.flatness * node.area * node.normal), vector_area),
                    0.0, 1e-6 * area);
    }
}

TEST(Octree, SourceIsAPermutationThatLeadsBackToTheInput)
{
    const std::vector<Surfel> surfels = bumpy_surfels(8);
    const Octree octree = build_octree(surfels);
    std::vector<std::uint32_t> sorted = octree.source;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> all(surfels.size());
    std::iota(all.begin(), all.end(), 0u);
    ASSERT_EQ(sorted, all);
    for (std::size_t i = 0; i < surfels.size(); ++i)
        EXPECT_EQ(octree.surfels[i].position, surfels[octree.source[i]].position);
}

TEST(Octree, SidesNeverMixInANodeAndFrontTurnsTheNormal)
{
    const std::vector<Surfel> surfels = bumpy_surfels(8);
    const std::vector<OccluderSide> sides = mixed_sides(surfels.size());
    const Octree octree = build_octree(surfels, sides);
    for (std::uint32_t i = 0; i < octree.nodes.size(); ++i) {
        const OctreeNode& node = octree.nodes[i];
        ASSERT_EQ(i >= octree.two_sided_nodes, node.first_surfel >= octree.two_sided_surfels);
        ASSERT_EQ(i >= octree.two_sided_nodes,
                  node.first_surfel + node.surfel_count > octree.two_sided_surfels);
    }
    for (std::uint32_t i = 0; i < octree.surfels.size(); ++i) {
        const OccluderSide side = sides[octree.source[i]];
        const float sign = side == OccluderSide::front ? -1.0f : 1.0f;
        ASSERT_EQ(i >= octree.two_sided_surfels, side == OccluderSide::both);
        ASSERT_EQ(octree.surfels[i].normal, sign * surfels[octree.source[i]].normal);
    }
}

// A walk that never accepts a node must see every surfel once.
TEST(Octree, SkippingThroughBothTreesVisitsEverySurfel)
{
    const std::vector<Surfel> surfels = bumpy_surfels(8);
    const Octree octree = build_octree(surfels, mixed_sides(surfels.size()));
    std::uint32_t seen = 0;
    for (std::uint32_t i = 0; i < octree.nodes.size(); ++i)
        if (octree.nodes[i].next == i + 1)
            seen += octree.nodes[i].surfel_count;
    EXPECT_EQ(seen, surfels.size());
}

// 100 surfels in one spot can never be told apart: they end in one leaf, and only 21 levels lie
// above any leaf.
TEST(Octree, CoincidentSurfelsEndInOneLeaf)
{
    std::vector<Surfel> surfels(100, Surfel{{0.25f, 0.25f, 0.25f}, 0.5f, {0, 0, 1}});
    surfels.push_back({{0.5f, 0.5f, 0.5f}, 0.5f, {0, 0, 1}});
    const Octree octree = build_octree(surfels, {}, {.leaf_surfels = 1});
    ASSERT_EQ(octree.nodes.size(), 3u);
    EXPECT_EQ(octree.nodes[1].surfel_count, 100u);
    EXPECT_EQ(octree.nodes[1].center, glm::vec3(0.25f));
}

TEST(Octree, NormalsThatCancelLeaveNoFlatArea)
{
    const std::vector<Surfel> surfels = {{{0, 0, 0}, 1.0f, {0, 0, 1}},
                                         {{0, 0, 0}, 1.0f, {0, 0, -1}}};
    const Octree octree = build_octree(surfels);
    EXPECT_EQ(octree.nodes[0].flatness, 0.0f);
    EXPECT_EQ(octree.nodes[0].normal, glm::vec3(0.0f));
    EXPECT_EQ(octree.nodes[0].area, 2.0f);
}

TEST(Octree, NothingGivesNothing)
{
    const Octree octree = build_octree({});
    EXPECT_TRUE(octree.nodes.empty());
    EXPECT_TRUE(octree.surfels.empty());
}

TEST(Octree, BytesDoNotDependOnTheNumberOfThreads)
{
    const std::vector<Surfel> surfels = bumpy_surfels(60);
    const std::vector<OccluderSide> sides = mixed_sides(surfels.size());
    const auto build_with = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return build_octree(surfels, sides);
    };
    const Octree one = build_with(1);
    const Octree four = build_with(4);
    EXPECT_TRUE(same_bytes(one.nodes, four.nodes));
    EXPECT_TRUE(same_bytes(one.surfels, four.surfels));
    EXPECT_TRUE(same_bytes(one.source, four.source));
}

}  // namespace
}  // namespace surfelao
