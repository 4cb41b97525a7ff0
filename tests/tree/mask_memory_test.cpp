#include "tree/masks/memory.h"

#include "differences.h"
#include "scenes.h"
#include "tests/vertex_receivers.h"

#include <gtest/gtest.h>

#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

struct TwoBalls {
    Geometry geometry;
    std::vector<std::uint32_t> body_of_triangle, body_of_receiver;
    std::vector<Receiver> receivers;

    /// other: a smaller copy of `ball`.
    TwoBalls(const Scene& ball, double size, glm::dvec3 place)
    {
        const Scene other = scenes::moved(ball, [&](glm::dvec3 p) { return size * p + place; });
        geometry = make_geometry(ball + other);
        body_of_receiver.assign(ball.positions.size(), 0);
        body_of_receiver.resize(geometry.positions.size(), 1);
        for (std::size_t t = 0; t < geometry.triangles.size(); ++t)
            body_of_triangle.push_back(geometry.triangles[t].x < ball.positions.size() ? 0 : 1);
        receivers = vertex_receivers(geometry);
    }

    /// After a move, with masks kept or not.
    std::vector<Occlusion> answers(const MaskOptions& options, std::size_t keep_most) const
    {
        MaskForest forest(geometry, split_bodies(geometry, body_of_triangle));
        MaskMemory memory(forest, receivers, body_of_receiver, options, 0.0f, keep_most);
        std::vector<Occlusion> answers(receivers.size());
        memory.solve(answers, {});
        Placement placement;
        placement.scale = 1.25;
        placement.translation = {-0.05, 0.02, 0.0};
        forest.place(1, placement);
        memory.solve(answers, {});
        return answers;
    }
};

// Exactly, nothing is left out where it is closed: the bits are the same, and so are the sums.
TEST(MaskMemory, KeptMasksAreTheSameBits)
{
    const TwoBalls balls(scenes::bumpy_sphere(10), 0.5, {1.4, 0.3, 0});
    for (const MaskKernelSet kernel : available_mask_kernels()) {
        const MaskOptions options{.exact = true, .kernel = kernel};
        EXPECT_TRUE(same_bytes(balls.answers(options, kMaskKeepMost), balls.answers(options, 0)))
            << name_of(kernel);
    }
}

// What is left out where it is closed, and how much of the slope is seen, are told otherwise.
TEST(MaskMemory, KeptMasksAreAsGoodWithEarlyEnds)
{
    // beside each other, and one within the other, where cracks are filled
    const TwoBalls beside(scenes::bumpy_sphere(10), 0.5, {1.4, 0.3, 0});
    const TwoBalls within(scenes::flipped(scenes::bumpy_sphere(16)), 0.2, {0.2, 0.1, 0});
    Definition limited{.max_distance = 0.4f, .falloff = Falloff::smooth};
    limited.ground = Ground{{0, 1, 0}, -0.3f};
    for (const Definition& definition : {Definition{}, limited}) {
        const MaskOptions options{.definition = definition, .quality = MaskOptions::kCoarsest};
        const MaskOptions better{.definition = definition, .quality = MaskOptions::kBest};
        for (const TwoBalls* balls : {&beside, &within}) {
            const std::vector<Occlusion> truth = balls->answers(better, 0);
            const std::vector<Occlusion> kept = balls->answers(options, kMaskKeepMost);
            const double anew = rms_difference(balls->answers(options, 0), truth);
            EXPECT_LT(rms_difference(kept, truth), 1.02 * anew);
            EXPECT_GT(mean_occlusion(kept), 0.1);
        }
    }
}

// A floor before a wall, and a ball behind the wall: its far nodes have a slope at the floor, but
// nobody sees them.
TEST(MaskMemory, ABodyThatIsHiddenChangesNothing)
{
    const Scene world = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 12) +
                        scenes::sheet({-4, 1.2, -1}, {9, 0, 0}, {0, 0, 5}, 1);
    const Scene ball = scenes::moved(
        scenes::bumpy_sphere(10), [](glm::dvec3 p) { return glm::dvec3(0.5, 2.5, 0.6) + 0.5 * p; });
    const Geometry geometry = make_geometry(world + ball);
    const std::size_t count = world.positions.size();
    std::vector<std::uint32_t> body_of_triangle;
    for (const glm::uvec3 t : geometry.triangles)
        body_of_triangle.push_back(t.x < count ? 0 : 1);
    std::vector<Receiver> receivers = vertex_receivers(geometry);
    receivers.resize(count);
    MaskForest forest(geometry, split_bodies(geometry, body_of_triangle));
    MaskMemory memory(forest, receivers, std::vector<std::uint32_t>(count, 0), {}, 0.0f);
    std::vector<Occlusion> with(count), without(count);
    memory.solve(with, {});
    forest.hide(1);
    memory.solve(without, {});
    EXPECT_GT(mean_occlusion(without), 0.1);
    EXPECT_TRUE(same_bytes(with, without)) << rms_difference(with, without);
}

// A ball that is faced covers (b / d)^2; below the horizon nothing.
TEST(MaskMemory, WhatABallCoversAtMost)
{
    ReceiverGroup group{};
    group.axis[2] = 1.0f;
    group.cone_cos = 1.0f;
    EXPECT_FLOAT_EQ(most_covered(group, {{0, 0, 4}, 1.0f}, 100.0f), 1.0f / 16.0f);
    EXPECT_EQ(most_covered(group, {{4, 0, -1.01f}, 1.0f}, 100.0f), 0.0f);
    EXPECT_EQ(most_covered(group, {{0, 0, 4}, 1.0f}, 3.0f), 0.0f);
    EXPECT_EQ(most_covered(group, {{0.5f, 0, 0}, 1.0f}, 100.0f), 1.0f);
    // half of it above the horizon: 2/3 of sin^3 over pi, by its cap at most so much
    const float half = most_covered(group, {{10, 0, 0}, 1.0f}, 100.0f);
    EXPECT_GT(half, 2.0f / 3.0f / 3.14159f * 1e-3f);
    EXPECT_LT(half, 2e-3f);
}

}  // namespace
}  // namespace surfelao
