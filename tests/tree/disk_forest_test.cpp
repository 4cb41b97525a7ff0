#include "tree/disks/disk_memory.h"

#include "differences.h"
#include "scenes.h"
#include "surfels/topology.h"
#include "tests/vertex_receivers.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace surfelao {
namespace {

struct ForestBody {
    Geometry geometry;
    std::vector<Receiver> receivers;
    Octree octree;

    explicit ForestBody(const Scene& scene)
        : geometry(make_geometry(scene)), receivers(vertex_receivers(geometry))
    {
        const SurfelCloud cloud = surfels_of(geometry);
        octree = build_octree(cloud.surfels, sides_of(cloud, analyse_topology(geometry)));
    }
};

DiskForest forest_of_two(const ForestBody& a, const ForestBody& b)
{
    std::vector<Octree> octrees;
    octrees.push_back(a.octree);
    octrees.push_back(b.octree);
    return DiskForest(std::move(octrees));
}

TEST(DiskForest, OneBodyIsItsOctreeAndItsMemoryAnswersAsSolveDisks)
{
    const ForestBody body(scenes::bumpy_sphere(10));
    for (const int passes : {1, 2, 4}) {
        const DiskForest forest({body.octree});
        const std::vector<std::uint32_t> of(body.receivers.size(), 0);
        DiskMemory memory(forest, body.receivers, of, {.passes = passes});
        std::vector<Occlusion> answers(of.size());
        const DiskFrame frame = memory.solve(forest, answers);
        const DiskResult right = solve_disks(body.octree, body.receivers, {.passes = passes});
        EXPECT_TRUE(same_bytes(right.occlusion, answers)) << passes;
        EXPECT_EQ(right.residuals, frame.residuals) << passes;
    }
}

TEST(DiskForest, BodiesStandSideBySideOneSidedOnesFirst)
{
    const ForestBody closed(scenes::box({0, 0, 0}, {1, 1, 1}, 4));
    const ForestBody open(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 6));
    DiskForest forest = forest_of_two(open, closed);
    const Octree first = forest.octree();
    EXPECT_EQ(first.nodes.size(), open.octree.nodes.size() + closed.octree.nodes.size());
    EXPECT_EQ(first.two_sided_nodes, closed.octree.nodes.size());
    EXPECT_EQ(first.two_sided_surfels, closed.octree.surfels.size());
    EXPECT_EQ(first.nodes.back().next, first.nodes.size());

    forest.hide(1);
    forest.update();
    EXPECT_EQ(forest.octree().two_sided_nodes, 0u);
    EXPECT_TRUE(same_bytes(open.octree.nodes, forest.octree().nodes));
    forest.place(1, {.scale = 0.5});
    forest.update();
    EXPECT_FLOAT_EQ(forest.octree().nodes[0].area, 0.25f * closed.octree.nodes[0].area);
    EXPECT_FLOAT_EQ(forest.octree().nodes[0].radius, 0.5f * closed.octree.nodes[0].radius);
    forest.place(1, {});
    forest.update();
    EXPECT_TRUE(same_bytes(first.nodes, forest.octree().nodes));
    EXPECT_TRUE(same_bytes(first.surfels, forest.octree().surfels));
}

TEST(DiskForest, WhatIsRememberedAtOneScaleIsNotTakenForAnother)
{
    const ForestBody body(scenes::bumpy_sphere(10));
    DiskForest forest({body.octree});
    DiskOptions options;
    options.definition.max_distance = 0.2f;
    const std::vector<std::uint32_t> of(body.receivers.size(), 0);
    DiskMemory memory(forest, body.receivers, of, options);
    std::vector<Occlusion> answers(of.size());
    memory.solve(forest, answers);
    const Placement half{.scale = 0.5};
    forest.place(0, half);
    forest.update();
    memory.solve(forest, answers);
    options.definition.max_distance = 0.4f;  // of a body twice as large: the same
    const DiskResult right = solve_disks(body.octree, body.receivers, options);
    EXPECT_LE(difference(right.occlusion, answers).largest, 1e-4);
}

}  // namespace
}  // namespace surfelao
