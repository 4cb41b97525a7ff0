#include "tree/masks/solids.h"

#include "scenes.h"
#include "surfels/geometry.h"
#include "surfels/receiver.h"
#include "tests/vertex_receivers.h"
#include "tree/masks/kernel.h"
#include "tree/masks/masks.h"
#include "tree/masks/tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

using scenes::operator+;
using scenes::operator+=;

std::size_t solid_triangles(const Scene& scene)
{
    const std::vector<std::uint8_t> solid = small_solids(make_geometry(scene));
    return static_cast<std::size_t>(std::count(solid.begin(), solid.end(), 1));
}

const Scene kBox = scenes::box({0, 0, 0}, {1, 2, 3}, 1);

TEST(MaskSolids, AClosedOutwardBodyIsOne)
{
    EXPECT_EQ(solid_triangles(kBox), 12u);
    EXPECT_EQ(solid_triangles(kBox + scenes::box({0.5, 0.5, 0.5}, {4, 4, 4}, 1)), 24u);
    EXPECT_EQ(solid_triangles(kBox + scenes::sheet({9, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2)), 12u);
}

TEST(MaskSolids, OpenInwardAndLargeBodiesAreNone)
{
    Scene open = kBox;
    open.triangles.pop_back();
    EXPECT_EQ(solid_triangles(open), 0u);
    EXPECT_EQ(solid_triangles(scenes::flipped(kBox)), 0u);
    Scene one_turned = kBox;
    std::swap(one_turned.triangles[5].x, one_turned.triangles[5].y);
    EXPECT_EQ(solid_triangles(one_turned), 0u);
    EXPECT_EQ(solid_triangles(scenes::sphere({0, 0, 0}, 1, 3)), 0u);  // 108 triangles
}

// A corner pushed in until the faces beside it look at the middle from the front: somewhere the
// winding number may be negative.
TEST(MaskSolids, ABodyThatIsNoStarIsNone)
{
    Scene dented = kBox;
    dented.positions[dented.triangles[0].x] = {0.9, 1.9, 2.9};
    EXPECT_EQ(solid_triangles(dented), 0u);
}

// Boxes through each other, receivers outside and inside of them: the far sides alone cover what
// all sides cover. Coarse faces are exact at any quality, so the oracle's answer is met.
TEST(MaskSolids, FarSidesCoverWhatAllSidesCover)
{
    Scene scene = scenes::sheet({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 24);
    for (int i = 0; i < 12; ++i) {
        const double x = std::cos(1.7 * i) * 1.5, y = std::sin(2.3 * i) * 1.5, z = -0.2 + 0.1 * i;
        scene += scenes::box({x, y, z}, {x + 0.9, y + 0.6, z + 0.8}, 1);
    }
    const Geometry geometry = make_geometry(scene);
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    const auto tree = build_mask_tree(geometry);
    const auto one_sided = solve_masks(*tree, receivers, {.quality = 4.0f});
    const auto all_sides = solve_masks(*tree, receivers, {.exact = true});
    double sum2 = 0.0;
    for (std::size_t i = 0; i < receivers.size(); ++i)
        sum2 += std::pow(one_sided[i].occlusion - all_sides[i].occlusion, 2);
    EXPECT_LT(std::sqrt(sum2 / static_cast<double>(receivers.size())), 0.002);
}

// Within a limit the far side may be out of reach where the near one is not.
TEST(MaskSolids, ALimitSeesTheNearSide)
{
    const Geometry geometry = make_geometry(scenes::sheet({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 24) +
                                            scenes::box({-2, -2, 0.2}, {2, 2, 2.5}, 1));
    const Receiver under[] = {{(glm::vec3(glm::dvec3(0.1, 0.1, 0.01) - geometry.frame.centre) /
                                static_cast<float>(geometry.frame.diagonal)),
                               {0, 0, 1}}};
    MaskOptions options;
    options.definition.max_distance = static_cast<float>(0.5 / geometry.frame.diagonal);
    const auto tree = build_mask_tree(geometry);
    // the cone within the limit about the axis: 1 - (0.19 / 0.5)^2
    EXPECT_NEAR(solve_masks(*tree, under, options)[0].occlusion, 0.856, 0.02);
}

TEST(MaskTree, FrontsThatAreHollowAreMarked)
{
    const auto hollow_nodes = [](const Scene& scene) {
        const auto tree = build_mask_tree(make_geometry(scene));
        return std::count_if(tree->nodes.begin(), tree->nodes.end(),
                             [](const MaskNode& node) { return (node.links & kMaskHollow) != 0; });
    };
    const Scene sphere = scenes::sphere({0, 0, 0}, 1, 12);
    EXPECT_EQ(hollow_nodes(sphere), 0);
    EXPECT_GT(hollow_nodes(scenes::flipped(sphere)), 100);
    EXPECT_EQ(hollow_nodes(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 20)), 0);
}

}  // namespace
}  // namespace surfelao
