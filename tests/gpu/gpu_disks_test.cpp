#include "gpu/gpu_disks.h"

#include "differences.h"
#include "gpu/answers.h"
#include "scenes.h"
#include "surfels/surfel.h"
#include "surfels/topology.h"
#include "tests/gpu/contexts.h"
#include "tests/vertex_receivers.h"
#include "tree/disks/disks.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace surfelao {
namespace {

constexpr float kUnlimited = std::numeric_limits<float>::infinity();

DiskResult solve_on_gpu(const Octree& octree, std::span<const Receiver> receivers,
                        const DiskOptions& options, const Progress& progress = {})
{
    GpuDiskResult found = GpuDisks(test_context(), octree).solve(receivers, options, progress);
    return {read_answers(found.answers, receivers.size()), std::move(found.residuals)};
}

/// A scene as the engine gets it. Every third surfel casts from both sides where `mixed`.
struct World {
    Geometry geometry;
    std::vector<Receiver> receivers;
    Octree octree;

    explicit World(const Scene& scene, bool mixed = false)
        : geometry(make_geometry(scene)), receivers(vertex_receivers(geometry))
    {
        const std::vector<Surfel> surfels = surfels_at_vertices(geometry);
        std::vector<OccluderSide> sides(surfels.size(), OccluderSide::back);
        for (std::size_t i = 0; mixed && i < sides.size(); i += 3)
            sides[i] = OccluderSide::both;
        octree = build_octree(surfels, sides);
    }

    /// Of triangles, as large as in the scene but for those above an area.
    World(const Scene& scene, OccluderSide side, double largest)
        : geometry(make_geometry(scene)), receivers(vertex_receivers(geometry))
    {
        const SurfelCloud cloud = surfels_of(geometry, largest);
        octree = build_octree(cloud.surfels, std::vector<OccluderSide>(cloud.surfels.size(), side));
    }
};

/// Both engines with these options; the same formulas in the same order up to rounding, and the
/// same nodes opened: 1e-4. Measured on llvmpipe: 6e-7.
void expect_twins(const World& world, const DiskOptions& options, const char* what)
{
    const DiskResult cpu = solve_disks(world.octree, world.receivers, options);
    const DiskResult gpu = solve_on_gpu(world.octree, world.receivers, options);
    ASSERT_EQ(cpu.occlusion.size(), gpu.occlusion.size()) << what;
    const Difference apart = difference(cpu.occlusion, gpu.occlusion);
    EXPECT_LT(apart.largest, 1e-4) << what;
    EXPECT_LT(apart.largest_bent_normal, 1e-4) << what;
    ASSERT_EQ(cpu.residuals.size(), gpu.residuals.size()) << what;
    for (std::size_t i = 0; i < cpu.residuals.size(); ++i)
        EXPECT_NEAR(cpu.residuals[i], gpu.residuals[i], 1e-5) << what;
}

TEST(GpuDisks, OnePassEqualsTheCpu)
{
    expect_twins(World(scenes::bumpy_sphere(12)), {.passes = 1}, "one-sided");
}

TEST(GpuDisks, CorrectedPassesEqualTheCpu)
{
    expect_twins(World(scenes::bumpy_sphere(12)), {.passes = 4}, "one-sided");
}

TEST(GpuDisks, LaterSolvesStartFromWhatIsCorrectedAndAnswerAlike)
{
    const World world(scenes::bumpy_sphere(8), true);
    const GpuDisks engine(test_context(), world.octree);
    const std::span<const Receiver> receivers = world.receivers;
    DiskOptions near;
    near.definition.max_distance = 0.3f;
    for (const DiskOptions& options :
         {DiskOptions{.passes = 3}, DiskOptions{.passes = 3}, near, near, DiskOptions{.passes = 1},
          DiskOptions{.opening = 0.3f}, DiskOptions{.opening = 0.6f}, DiskOptions{}}) {
        const DiskResult fresh = solve_on_gpu(world.octree, receivers, options);
        // the first to ask may be another one
        static_cast<void>(engine.solve(receivers.first(1), options));
        const GpuDiskResult later = engine.solve(receivers, options);
        EXPECT_TRUE(same_bytes(fresh.occlusion, read_answers(later.answers, receivers.size())));
        EXPECT_EQ(fresh.residuals, later.residuals);
    }
}

TEST(GpuDisks, MixedSidesEqualTheCpu)
{
    expect_twins(World(scenes::bumpy_sphere(12), true), {.passes = 3}, "mixed sides");
    expect_twins(World(scenes::room({0, 0, 0}, {1, 2, 1}, 8), true), {.passes = 3}, "a room");
}

TEST(GpuDisks, TrianglesEqualTheCpu)
{
    for (const OccluderSide side : {OccluderSide::back, OccluderSide::both}) {
        const World world(scenes::room({0, 0, 0}, {1, 2, 1}, 2), side, 2e-3);
        ASSERT_GT(world.octree.surfels.front().reach, 0.0f);
        expect_twins(world, {.passes = 3}, "triangles");
        expect_twins(world, {.definition = {.max_distance = 0.3f}}, "triangles, cut off");
    }
}

TEST(GpuDisks, LimitsFalloffKernelAndStrengthEqualTheCpu)
{
    const World world(scenes::bumpy_sphere(8));
    for (const Falloff falloff : {Falloff::none, Falloff::smooth}) {
        for (const Kernel kernel : {Kernel::cosine, Kernel::bunnell})
            expect_twins(
                world,
                {.definition = {.max_distance = 0.1f, .falloff = falloff, .kernel = kernel},
                 .strength = 0.7f},
                falloff == Falloff::none ? "cut off" : "smooth");
    }
    expect_twins(world, {.definition = {.max_distance = kUnlimited, .kernel = Kernel::bunnell}},
                 "Bunnell's kernel");
}

TEST(GpuDisks, EveryOpeningEqualsTheCpu)
{
    const World world(scenes::bumpy_sphere(12));
    for (const float opening : {kDraftOpening, kGoodOpening, kBestOpening})
        expect_twins(world, {.opening = opening}, "a quality's opening");
    expect_twins(world, {.opening = 0.0f}, "every surfel");
}

// llvmpipe ends loops after 65,535 rounds, so a longer list must be cut and gone on with. Inside a
// closed body the sum over all surfels is 1; one that ends early is less.
TEST(GpuDisks, ListsLongerThanADriversLoopsAreSummedToTheEnd)
{
    World world(scenes::sphere({0, 0, 0}, 1.0, 90));
    ASSERT_GT(world.octree.surfels.size() + world.octree.nodes.size(), 65536u);
    world.receivers = {{{0, 0, 0}, {0, 0, 1}}, {{0.1f, 0, 0}, {0, 1, 0}}};
    expect_twins(world, {.opening = 0.0f, .passes = 1}, "inside a sphere");
}

TEST(GpuDisks, NothingToSeeAndNobodyToAsk)
{
    const World world(scenes::sphere({0, 0, 0}, 1.0, 4));
    EXPECT_TRUE(solve_on_gpu(world.octree, {}, {}).occlusion.empty());

    const std::vector<Receiver> receivers = {{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, 0}}};
    const std::vector<Occlusion> alone = solve_on_gpu(Octree{}, receivers, {}).occlusion;
    EXPECT_EQ(alone[0].occlusion, 0.0f);
    EXPECT_EQ(alone[0].bent_normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(alone[1].occlusion, 0.0f);
    EXPECT_EQ(alone[1].bent_normal, glm::vec3(0, 0, 0)) << "no normal, no hemisphere";
}

TEST(GpuDisks, ProgressRunsToTheEndAndStopsWhenAsked)
{
    const World world(scenes::bumpy_sphere(12));
    double last = 0.0;
    static_cast<void>(solve_on_gpu(world.octree, world.receivers, {}, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
        return true;
    }));
    EXPECT_EQ(last, 1.0);
    EXPECT_THROW(static_cast<void>(
                     solve_on_gpu(world.octree, world.receivers, {}, [](double) { return false; })),
                 Cancelled);
}

}  // namespace
}  // namespace surfelao
