#include "tree/disks.h"

#include "scenes.h"
#include "tree/brute_force.h"
#include "tree/disk_form_factor.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace surfelao {
namespace {

/// A scene as the engine gets it; every surfel casts from `side`.
struct World {
    Geometry geometry;
    std::vector<Receiver> receivers;
    Octree octree;

    explicit World(const Scene& scene, OccluderSide side = OccluderSide::back)
        : geometry(make_geometry(scene)),
          receivers(receivers_at_vertices(geometry, Definition{}.offset))
    {
        const std::vector<Surfel> surfels = surfels_at_vertices(geometry);
        octree = build_octree(surfels, std::vector<OccluderSide>(surfels.size(), side));
    }
};

double largest_difference(const std::vector<Occlusion>& a, const std::vector<Occlusion>& b)
{
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, std::abs(double(a[i].occlusion) - b[i].occlusion));
    return largest;
}

// The same sums in float and in another order: 1e-5 relative of a sum of at most a few.
TEST(Disks, OpeningZeroEqualsBruteForce)
{
    for (const OccluderSide side : {OccluderSide::back, OccluderSide::both}) {
        const World world(scenes::bumpy_sphere(16), side);
        for (const Kernel kernel : {Kernel::cosine, Kernel::bunnell}) {
            for (const int passes : {1, 3}) {
                const DiskOptions options = {
                    .definition = {.kernel = kernel}, .opening = 0.0f, .passes = passes};
                const DiskResult tree = solve_disks(world.octree, world.receivers, options);
                const DiskResult brute =
                    solve_disks_brute_force(world.octree, world.receivers, options);
                EXPECT_LT(largest_difference(tree.occlusion, brute.occlusion), 5e-5)
                    << "side " << int(side) << " kernel " << int(kernel) << " passes " << passes;
                ASSERT_EQ(tree.residuals.size(), brute.residuals.size());
            }
        }
    }
}

TEST(Disks, AConvexBodyIsOpen)
{
    const World world(scenes::sphere({0, 0, 0}, 1.0, 16));
    for (const Occlusion& o : solve_disks(world.octree, world.receivers, {}).occlusion)
        EXPECT_LT(o.occlusion, 0.01f);
}

}  // namespace
}  // namespace surfelao
