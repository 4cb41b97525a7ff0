#include "engines/moving.h"

#include "differences.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "tests/vertex_receivers.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <malloc.h>

#include <cmath>
#include <utility>
#include <vector>

// What scenes that move promise, asked of masks; closed forms over all engines are
// moving_worlds_test.cpp.
namespace surfelao {
namespace {

using scenes::operator+;

/// Scenes one after the other as bodies 0, 1, ...
struct Stage {
    Geometry geometry;
    std::vector<std::uint32_t> body_of_triangle, body_of_receiver;
    std::vector<Receiver> receivers;

    explicit Stage(const std::vector<Scene>& bodies)
    {
        Scene all = bodies[0];
        std::vector<std::uint32_t> body_of_scene_triangle;
        for (std::uint32_t k = 0; k < bodies.size(); ++k) {
            if (k > 0)
                all = all + bodies[k];
            body_of_scene_triangle.insert(body_of_scene_triangle.end(), bodies[k].triangles.size(),
                                          k);
            body_of_receiver.insert(body_of_receiver.end(), bodies[k].positions.size(), k);
        }
        geometry = make_geometry(all);
        for (std::size_t t = 0; t < geometry.triangles.size(); ++t)
            body_of_triangle.push_back(body_of_scene_triangle[geometry.scene_triangle(t)]);
        receivers = vertex_receivers(geometry);
    }

    MovingReceivers receivers_of(const MovingScene& scene, const MovingSettings& settings) const
    {
        return {scene, receivers, body_of_receiver, settings};
    }

    /// The geometry as it is with one body placed.
    Geometry placed_geometry(std::uint32_t body, const Placement& placement) const
    {
        Geometry moved = geometry;
        for (std::size_t v = 0; v < moved.positions.size(); ++v) {
            if (body_of_receiver[v] != body)
                continue;
            const Receiver at = placed({moved.positions[v], moved.normals[v], 0.0f}, placement);
            moved.positions[v] = at.position;
            moved.normals[v] = at.normal;
        }
        return moved;
    }

    /// Of one body.
    std::vector<Occlusion> part(const std::vector<Occlusion>& answers, std::uint32_t body) const
    {
        std::vector<Occlusion> found;
        for (std::size_t i = 0; i < answers.size(); ++i) {
            if (body_of_receiver[i] == body)
                found.push_back(answers[i]);
        }
        return found;
    }
};

MovingSettings with_tolerance(float tolerance)
{
    MovingSettings settings;
    settings.tolerance = tolerance;
    return settings;
}

Placement turned(double angle, glm::dvec3 axis, glm::dvec3 translation = glm::dvec3(0.0),
                 double scale = 1.0)
{
    return {glm::dmat3(glm::rotate(glm::dmat4(1.0), angle, axis)), scale, translation};
}

/// A bumpy ground with a smaller bumpy ball over it.
Stage ball_over_hills()
{
    const auto hills = [](double x, double y) {
        return 0.05 * std::sin(12.0 * x) * std::cos(9.0 * y);
    };
    const auto small = [](glm::dvec3 p) { return 0.15 * p + glm::dvec3(0.5, 0.5, 0.3); };
    return Stage({scenes::height_field(40, hills), scenes::moved(scenes::bumpy_sphere(8), small)});
}

TEST(Moving, OneBodyHasTheBytesOfPreparing)
{
    const Stage stage({scenes::bumpy_sphere(12)});
    const MovingScene scene(stage.geometry, stage.body_of_triangle);
    const std::vector<Occlusion> prepared =
        solve(prepare(stage.geometry), stage.receivers).occlusion;
    EXPECT_TRUE(same_bytes(scene.solve(stage.receivers).occlusion, prepared));
    MovingReceivers receivers = stage.receivers_of(scene, {});
    receivers.solve();
    EXPECT_TRUE(same_bytes(receivers.occlusion(), prepared));
}

TEST(Moving, AwayAndBackGivesTheFirstBytes)
{
    const Stage stage = ball_over_hills();
    MovingScene scene(stage.geometry, stage.body_of_triangle);
    MovingReceivers receivers = stage.receivers_of(scene, {});
    receivers.solve();
    const std::vector<Occlusion> first = receivers.occlusion();
    // slowly, so that each step by itself changes little
    for (int step = 1; step <= 12; ++step) {
        scene.place(1, turned(0.1 * step, {0, 0, 1}, glm::dvec3(0.0, 0.0, 0.12 * step)));
        receivers.solve();
    }
    EXPECT_GT(rms_difference(first, receivers.occlusion()), 0.02);
    scene.hide(1);
    receivers.solve();
    scene.place(1, {});
    receivers.solve();
    EXPECT_TRUE(same_bytes(receivers.occlusion(), first));
}

TEST(Moving, NothingMovedIsNothingSolved)
{
    const Stage stage = ball_over_hills();
    MovingScene scene(stage.geometry, stage.body_of_triangle);
    MovingReceivers receivers = stage.receivers_of(scene, {});
    EXPECT_EQ(receivers.solve().solved, stage.receivers.size());
    EXPECT_EQ(receivers.solve().solved, 0u);
    scene.place(1, {});
    EXPECT_EQ(receivers.solve().solved, 0u);
}

TEST(Moving, FollowsWhatIsBuiltAnew)
{
    const Stage stage = ball_over_hills();
    MovingScene scene(stage.geometry, stage.body_of_triangle);
    // turned, mirrored and larger
    Placement placement = turned(0.7, glm::normalize(glm::dvec3(1, 2, 3)), {0.1, 0, -0.05}, 1.5);
    placement.rotation[0] = -placement.rotation[0];
    scene.place(1, placement);
    Definition with_all;
    with_all.max_distance = 0.3f;
    with_all.falloff = Falloff::smooth;
    with_all.ground = Ground{{0, 0, 1}, -0.15f};
    for (const Definition& definition : {Definition{}, with_all}) {
        MovingSettings settings;
        settings.definition = definition;
        settings.quality = kBest;
        settings.tolerance = 0.0f;
        MovingReceivers receivers = stage.receivers_of(scene, settings);
        receivers.solve();
        const Geometry moved = stage.placed_geometry(1, placement);
        const std::vector<Occlusion> rebuilt =
            solve(prepare(moved), receivers.receivers(), settings).occlusion;
        const Difference found = difference(rebuilt, receivers.occlusion());
        EXPECT_LT(found.rms, 0.004);
        EXPECT_LT(found.bent_normal, 0.02);
        EXPECT_LT(rms_difference(rebuilt, scene.solve(receivers.receivers(), settings).occlusion),
                  0.004);
    }
}

// One-sided drawing of small solids asks which way round their triangles run.
TEST(Moving, AMirroredSolidIsStillSolid)
{
    const Stage stage({scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 30),
                       scenes::box({-0.2, -0.2, 0.1}, {0.2, 0.2, 0.5}, 1)});
    MovingScene scene(stage.geometry, stage.body_of_triangle);
    MovingReceivers receivers = stage.receivers_of(scene, {});
    receivers.solve();
    const std::vector<Occlusion> upright = stage.part(receivers.occlusion(), 0);
    Placement mirrored;
    mirrored.rotation[0].x = -1.0;
    scene.place(1, mirrored);
    receivers.solve();
    EXPECT_LT(rms_difference(upright, stage.part(receivers.occlusion(), 0)), 1e-4);
}

TEST(Moving, FarPartsChangeNoByteAndNearOnesNoMoreThanTheTolerance)
{
    const auto to_side = [](glm::dvec3 p) { return 0.02 * p + glm::dvec3(1.5, 0.5, 0.2); };
    const Stage stage({scenes::height_field(40, [](double x, double y) { return x * y / 4; }),
                       scenes::moved(scenes::sphere({}, 1.0, 6), to_side)});
    MovingScene scene(stage.geometry, stage.body_of_triangle);
    MovingReceivers receivers = stage.receivers_of(scene, {});
    const FrameReport first = receivers.solve();
    EXPECT_LE(first.bound, 0.002f);
    const std::vector<Occlusion> still = stage.part(receivers.occlusion(), 0);
    scene.place(1, turned(1.0, {0, 0, 1}, {0.05, 0.0, 0.1}));
    receivers.solve();
    EXPECT_TRUE(same_bytes(stage.part(receivers.occlusion(), 0), still));
    // towards the hills: at its first step over the tolerance nobody jumps
    std::vector<Occlusion> before = still;
    double largest = 0.0;
    for (int step = 0; step < 40; ++step) {
        scene.place(1, turned(0.0, {0, 0, 1}, {-0.005 * step, 0.0, 0.0}));
        const FrameReport report = receivers.solve();
        EXPECT_LE(report.bound, 0.002f);
        const std::vector<Occlusion> now = stage.part(receivers.occlusion(), 0);
        largest = std::max(largest, difference(before, now).largest);
        before = now;
    }
    EXPECT_GT(rms_difference(still, before), 0.0);
    EXPECT_LT(largest, 0.004);
}

TEST(Moving, AConvexPartThatTurnsAloneStaysOpen)
{
    const Stage stage({scenes::sphere({}, 1.0, 12), scenes::sphere({9, 0, 0}, 1.0, 12)});
    MovingScene scene(stage.geometry, stage.body_of_triangle);
    scene.hide(1);
    scene.place(1, turned(0.4, {0, 1, 0}, {0, 0, 3}));
    MovingReceivers receivers = stage.receivers_of(scene, {});
    receivers.solve();
    for (const Occlusion& answer : receivers.occlusion())
        EXPECT_EQ(answer.occlusion, 0.0f);
}

TEST(Moving, ARigidFormIsAPlacement)
{
    const Stage stage = ball_over_hills();
    const Placement placement =
        turned(0.9, glm::normalize(glm::dvec3(2, -1, 1)), {0.05, -0.1, 0.1});
    const Geometry moved = stage.placed_geometry(1, placement);
    MovingScene bent(stage.geometry, stage.body_of_triangle);
    MovingScene turned_scene(stage.geometry, stage.body_of_triangle);
    turned_scene.place(1, placement);
    bent.deform(1, moved.positions);
    MovingReceivers receivers = stage.receivers_of(turned_scene, {});
    receivers.solve();
    const std::vector<Receiver>& at = receivers.receivers();
    // a bit of a mask is worth .002: rounding turns some
    EXPECT_LT(rms_difference(turned_scene.solve(at).occlusion, bent.solve(at).occlusion), 1e-4);
    // at rest: the same tree, to rounding
    bent.deform(1, stage.geometry.positions);
    const MovingScene still(stage.geometry, stage.body_of_triangle);
    EXPECT_LT(rms_difference(still.solve(at).occlusion, bent.solve(at).occlusion), 1e-4);
}

TEST(Moving, ABentFormIsAsGoodAsBuiltAnew)
{
    const Stage stage = ball_over_hills();
    // the ball is bent and stretched
    Geometry form = stage.geometry;
    std::vector<Receiver> of_ball;
    for (std::size_t v = 0; v < form.positions.size(); ++v) {
        if (stage.body_of_receiver[v] != 1)
            continue;
        glm::vec3& p = form.positions[v];
        p.x += 0.8f * p.z * p.z;
        p.y *= 1.2f;
        of_ball.push_back({p + kVertexOffset * form.normals[v], form.normals[v], kVertexOffset});
    }
    MovingScene scene(stage.geometry, stage.body_of_triangle);
    MovingReceivers receivers = stage.receivers_of(scene, with_tolerance(0.0f));
    scene.deform(1, form.positions);
    receivers.deform(1, of_ball);
    receivers.solve();
    // against what draws all triangles: the refitted tree is no worse than the new one
    const std::vector<Occlusion> rebuilt = solve(prepare(form), receivers.receivers()).occlusion;
    SolveSettings finest;
    finest.quality = 4.0f;
    const std::vector<Occlusion> right =
        solve(prepare(form), receivers.receivers(), finest).occlusion;
    EXPECT_LT(rms_difference(right, receivers.occlusion()), rms_difference(right, rebuilt) + 0.001);
    // the answers follow the form alone
    const std::vector<Occlusion> first = receivers.occlusion();
    scene.place(1, turned(1.0, {1, 0, 0}));
    receivers.solve();
    scene.deform(1, form.positions);
    receivers.deform(1, of_ball);
    receivers.solve();
    EXPECT_TRUE(same_bytes(receivers.occlusion(), first));
}

// Two triangles of a square are one tile until they are folded.
TEST(Moving, AFoldedPairIsTwoTriangles)
{
    const Stage stage({scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 20),
                       scenes::sheet({-0.5, -0.5, 0.5}, {1, 0, 0}, {0, 1, 0}, 1)});
    std::vector<glm::vec3> folded = stage.geometry.positions;
    folded.back().z += 0.15f;
    MovingScene scene(stage.geometry, stage.body_of_triangle);
    scene.deform(1, folded);
    Geometry form = stage.geometry;
    form.positions = folded;
    SolveSettings best;
    best.quality = kBest;
    const std::vector<Receiver> floor(stage.receivers.begin(), stage.receivers.end() - 4);
    EXPECT_LT(rms_difference(solve(prepare(form), floor, best).occlusion,
                             scene.solve(floor, best).occlusion),
              0.001);
}

TEST(Moving, TheSameBytesForAnyNumberOfThreads)
{
    const Stage stage = ball_over_hills();
    const auto answers = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        MovingScene scene(stage.geometry, stage.body_of_triangle);
        MovingReceivers receivers = stage.receivers_of(scene, {});
        receivers.solve();
        scene.place(1, turned(0.3, {0, 0, 1}, {0.02, 0.0, 0.0}));
        receivers.solve();
        return receivers.occlusion();
    };
    EXPECT_TRUE(same_bytes(answers(1), answers(4)));
}

TEST(Moving, AThousandFramesNeedNoMoreMemory)
{
    const Stage stage({scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 8),
                       scenes::sphere({0, 0, 0.4}, 0.2, 4), scenes::sphere({1, 0, 0.4}, 0.2, 4)});
    MovingScene scene(stage.geometry, stage.body_of_triangle);
    MovingReceivers receivers = stage.receivers_of(scene, with_tolerance(0.0f));
    const auto frame = [&](int i) {
        scene.place(1, turned(0.01 * i, {0, 0, 1}, {0.0, 0.0, 0.1 * std::sin(0.02 * i)}));
        if (i % 10 == 0)
            scene.deform(2, stage.geometry.positions);
        receivers.solve();
    };
    const auto in_use = [] { return mallinfo2().uordblks + mallinfo2().hblkhd; };
    for (int i = 0; i < 50; ++i)
        frame(i);
    const std::size_t before = in_use();
    for (int i = 50; i < 1000; ++i)
        frame(i);
    // less than a kilobyte a frame: a thread that joins late brings buffers of its own
    EXPECT_LT(in_use(), before + 1000000);
}

TEST(Moving, CancelledInAFrameTheNextIsWhole)
{
    const Stage stage = ball_over_hills();
    MovingScene scene(stage.geometry, stage.body_of_triangle);
    MovingReceivers receivers = stage.receivers_of(scene, {});
    const auto stop = [](double) { return false; };
    EXPECT_THROW(receivers.solve(stop), Cancelled);
    receivers.solve();
    scene.place(1, turned(0.3, {0, 0, 1}, {0.02, 0.0, 0.0}));
    EXPECT_THROW(receivers.solve(stop), Cancelled);
    receivers.solve();
    MovingReceivers others = stage.receivers_of(scene, {});
    others.solve();
    EXPECT_TRUE(same_bytes(receivers.occlusion(), others.occlusion()));
}

TEST(Moving, ReceiversFollowASceneThatIsMovedElsewhere)
{
    const Stage stage = ball_over_hills();
    MovingScene first(stage.geometry, stage.body_of_triangle);
    MovingReceivers receivers = stage.receivers_of(first, {});
    MovingScene scene = std::move(first);
    scene.place(1, turned(0.3, {0, 0, 1}, {0.02, 0.0, 0.0}));
    receivers.solve();
    MovingReceivers others = stage.receivers_of(scene, {});
    others.solve();
    EXPECT_TRUE(same_bytes(receivers.occlusion(), others.occlusion()));
}

TEST(Moving, WrongUseIsTold)
{
    const Stage stage = ball_over_hills();
    MovingScene scene(stage.geometry, stage.body_of_triangle);
    EXPECT_THROW(scene.place(0, {}), SettingsError);
    EXPECT_THROW(scene.place(2, {}), SettingsError);
    EXPECT_THROW(scene.deform(1, std::vector<glm::vec3>(3)), SettingsError);
    EXPECT_THROW(static_cast<void>(stage.receivers_of(scene, with_tolerance(-1.0f))),
                 SettingsError);
    MovingReceivers receivers = stage.receivers_of(scene, {});
    scene.place(1, {glm::dmat3(1.0), 1.0, {1e9, 0, 0}});
    EXPECT_THROW(receivers.solve(), InputError);
}

TEST(Placements, ThereAndBack)
{
    const Placement a = turned(0.3, {0, 0, 1}, {1, 2, 3}, 2.0);
    const Placement back = inverse(a) * a;
    EXPECT_NEAR(back.scale, 1.0, 1e-15);
    EXPECT_LT(glm::length(back.translation), 1e-14);
    const auto again = placement_of(matrix_of(a));
    ASSERT_TRUE(again.has_value());
    EXPECT_NEAR(again->scale, 2.0, 1e-14);
    glm::dmat4 sheared = matrix_of(a);
    sheared[0].y += 1e-3;
    EXPECT_FALSE(placement_of(sheared).has_value());
}

}  // namespace
}  // namespace surfelao
