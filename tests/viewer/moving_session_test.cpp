// Parts that move in a viewer, without a window.
#include "viewer/moving_session.h"

#include "bake/world.h"
#include "differences.h"
#include "files/gltf_maker.h"
#include "pixels/seen.h"
#include "scenes.h"
#include "temporary_folder.h"
#include "viewer/gizmo.h"
#include "viewer/movables.h"
#include "viewer/mover.h"
#include "viewer/pick.h"
#include "viewer/player.h"
#include "viewer/solve_model.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <thread>
#include <vector>

namespace surfelao {
namespace {

constexpr int kPickWidth = 640, kPickHeight = 480;

/// A floor, and a box that floats over it: two pieces.
Scene floor_and_box()
{
    using scenes::operator+;
    return scenes::sheet({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 12) +
           scenes::box({-0.5, 0.25, -0.5}, {0.5, 1.25, 0.5}, 4);
}

std::shared_ptr<const Model> resting_model(const Scene& scene)
{
    return std::make_shared<const Model>(make_model(make_mesh(scene), UpAxis::y));
}

/// Along x, in diagonals.
PartMove shifted_by(double x)
{
    return {.translation = {x, 0.0, 0.0}};
}

struct TwoPieces : testing::Test {
    std::shared_ptr<const Model> base = resting_model(floor_and_box());
    std::shared_ptr<const Movables> movables =
        std::make_shared<const Movables>(movables_of(*base->mesh));

    MovingQuestion box_moves() const { return {base, movables, {1}, nullptr, {}}; }
};

/// Updates until the condition holds; at most half a minute.
template <class Thing, class Condition>
bool updates_until(Thing&& update, Condition&& condition)
{
    for (int i = 0; i < 30000; ++i) {
        update();
        if (condition())
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

TEST_F(TwoPieces, AreFoundAndPickedByTheRayOfAPixel)
{
    ASSERT_EQ(movables->list.size(), 2u);
    EXPECT_EQ(movables->list[0].triangles, 2u * 12 * 12);
    EXPECT_EQ(movables->list[1].triangles, 2u * 6 * 4 * 4);
    const Camera camera = frame_points(base->seen, UpAxis::y, 4.0f / 3.0f);
    const View view = view_of(camera, kPickWidth, kPickHeight);
    const Geometry& geometry = base->geometry();
    const auto under = [&](glm::dvec3 point) {
        const auto pixel = pixel_of(view, kPickWidth, kPickHeight, point);
        const auto found = point_under(geometry.positions, geometry.triangles,
                                       sight_ray(view, kPickWidth, kPickHeight, *pixel));
        return found ? movables->of_vertex[geometry.triangles[found->triangle].x] : Movables::kNone;
    };
    EXPECT_EQ(under(movables->list[1].middle()), 1u);
    EXPECT_EQ(under(0.9f * movables->list[0].high + 0.1f * movables->list[0].middle()), 0u);
    EXPECT_EQ(under(movables->list[0].low), 1u) << "the box stands before this corner";
    EXPECT_EQ(under(glm::dvec3(0.0, 1.0, 0.0)), Movables::kNone);
    // the nearer one, from below and from above
    const auto along_y = [&](double from) {
        const SightRay ray{{0.03, from, 0.02}, {0.0, from < 0.0 ? 1.0 : -1.0, 0.0}};
        const auto found = point_under(geometry.positions, geometry.triangles, ray);
        return found ? movables->of_vertex[geometry.triangles[found->triangle].x] : Movables::kNone;
    };
    EXPECT_EQ(along_y(-2.0), 0u);
    EXPECT_EQ(along_y(2.0), 1u);
}

// A file's objects are told apart also where they touch; what shares vertices is one.
TEST(MovablesTest, AreTheFilesObjects)
{
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.file("parts.obj",
                                               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 0 0\n"
                                               "v 1 0 0\nv 0 1 0\n"
                                               "o left\nf 1 2 3\no right\nf 6 4 7\n"
                                               "o shared\nf 4 5 6\n"));
    const Movables movables = movables_of(make_mesh(scene));
    ASSERT_EQ(movables.list.size(), 2u);
    EXPECT_EQ(movables.list[0].name, "left");
    EXPECT_EQ(movables.list[1].name, "right");
    EXPECT_EQ(movables.list[1].triangles, 2u);
}

// Handles are taken where they are drawn: a drag from one place of an axis to another moves by what
// lies between them.
TEST(GizmoTest, ADragAlongAnAxisIsTheWayAlongIt)
{
    const Camera camera;
    const View view = view_of(camera, kPickWidth, kPickHeight);
    const glm::dvec3 centre(0.1, -0.05, 0.2);
    const Gizmo gizmo(view, kPickWidth, kPickHeight, centre, 90.0f);
    const double arrow = length_of_pixels(view, kPickHeight, centre, 90.0f);
    const auto seen = [&](glm::dvec3 point) {
        return *pixel_of(view, kPickWidth, kPickHeight, point);
    };
    const auto ray = [&](glm::dvec3 point) {
        return sight_ray(view, kPickWidth, kPickHeight, seen(point));
    };
    EXPECT_EQ(gizmo.handle_at(seen(centre + glm::dvec3(0.9 * arrow, 0, 0)), 5.0f),
              GizmoHandle::move_x);
    EXPECT_EQ(gizmo.handle_at(seen(centre + glm::dvec3(0, 0.9 * arrow, 0)), 5.0f),
              GizmoHandle::move_y);
    EXPECT_EQ(gizmo.handle_at(seen(centre + glm::dvec3(2.0 * arrow, 0, 0)), 5.0f),
              GizmoHandle::none);
    const PartMove start{.translation = {0.0, 1.0, 0.0}};
    const auto drag = [&](GizmoHandle handle, glm::dvec3 from, glm::dvec3 to) {
        return dragged(start, handle, centre, ray(centre + from), ray(centre + to), view.forward,
                       arrow);
    };
    const PartMove along = drag(GizmoHandle::move_x, {0.05, 0, 0}, {0.3, 0, 0});
    EXPECT_NEAR(along.translation.x, 0.25, 1e-5);
    EXPECT_EQ(along.translation.y, 1.0);
    EXPECT_EQ(along.translation.z, 0.0);
    const PartMove in_view = drag(GizmoHandle::move_in_view, {0, 0, 0}, {0.2, -0.1, 0});
    EXPECT_NEAR(glm::distance(in_view.translation, glm::dvec3(0.2, 0.9, 0.0)), 0.0, 1e-5);
    // about z, which points to the eye; about x, whose ring is seen from its edge
    const PartMove turned = drag(GizmoHandle::turn_z, {0.1, 0, 0}, {0, 0.3, 0});
    EXPECT_NEAR(glm::distance(degrees_of(turned.rotation), glm::dvec3(0, 0, 90)), 0.0, 0.01);
    const double radius = 0.75 * arrow;
    const PartMove at_edge = drag(GizmoHandle::turn_x, {0, 0, 0}, {0, -0.5 * radius, 0});
    EXPECT_NEAR(glm::radians(degrees_of(at_edge.rotation).x), 0.5, 0.02);
}

TEST(PlayerTest, LoopsStopsAndStaysInside)
{
    Player player{.first = 1.0, .last = 3.0, .seconds = 1.0, .speed = 0.5};
    player.advance(10.0);
    EXPECT_EQ(player.seconds, 1.0) << "it does not play";
    player.toggle();
    player.advance(1.0);
    EXPECT_EQ(player.seconds, 1.5);
    player.advance(4.0);
    EXPECT_EQ(player.seconds, 1.5) << "once around";
    player.loops = false;
    player.advance(100.0);
    EXPECT_EQ(player.seconds, 3.0);
    EXPECT_FALSE(player.is_playing);
    player.toggle();
    EXPECT_EQ(player.seconds, 1.0);
    player.seek(-5.0);
    EXPECT_EQ(player.seconds, 1.0);
}

// However poses come, a frame's shape and values are of the frame's pose, and the last one comes.
TEST_F(TwoPieces, FramesAreWholeAndTheLastPoseIsSolvedWell)
{
    MovingSession session;
    session.ask(box_moves());
    std::size_t torn = 0, frames = 0;
    const Geometry& geometry = base->geometry();
    const auto update = [&] {
        if (!session.update())
            return;
        const MovingFrame& frame = *session.frame();
        ++frames;
        const auto by = static_cast<float>(frame.pose.moves[0].translation.x);
        for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
            const float x = geometry.positions[v].x + (movables->of_vertex[v] == 1 ? by : 0.0f);
            torn += std::abs(frame.shape.positions[v].x - x) > 1e-6f;
        }
        torn += frame.values.size() != base->answer_count();
    };
    for (int i = 0; i <= 40; ++i) {
        session.pose({{shifted_by(0.005 * i)}}, i == 40);
        update();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(
        updates_until(update, [&] { return session.frame() && session.frame()->is_whole; }));
    EXPECT_EQ(torn, 0u);
    EXPECT_GE(frames, 2u);
    const MovingFrame& last = *session.frame();
    EXPECT_EQ(last.pose.moves[0], shifted_by(0.2));

    // the model by itself, in the same frame, solved from scratch
    EXPECT_EQ(last.posed->geometry().frame.diagonal, geometry.frame.diagonal);
    const std::vector<Occlusion> anew =
        solve_model(prepare(*last.posed, {}), *last.posed, {}).values;
    ASSERT_EQ(anew.size(), last.values.size());
    EXPECT_LT(difference(anew, last.values).rms, 0.006);
    EXPECT_EQ(last.at_points.size(), last.posed->points.size());
}

// A frame that was found before another question came, and was not taken over, is of the wrong
// model.
TEST_F(TwoPieces, NoFrameOfAnEarlierQuestionComesLater)
{
    MovingSession session;
    const auto find_a_frame = [&] {
        session.ask(box_moves());
        session.pose({{shifted_by(0.1)}}, false);
        return updates_until([] {}, [&] { return !session.solving(); });
    };
    ASSERT_TRUE(find_a_frame());
    session.forget();
    EXPECT_FALSE(session.update());
    ASSERT_TRUE(find_a_frame());
    const auto other = resting_model(scenes::box({0, 0, 0}, {1, 1, 1}, 1));
    session.ask(
        {other, std::make_shared<const Movables>(movables_of(*other->mesh)), {0}, nullptr, {}});
    EXPECT_FALSE(session.update());
}

// Moved away and back: the bytes that were known before. A small box cannot change by more than the
// tolerance what is 32 of its radii away: that keeps its bytes also where the pose rests.
TEST(MovingSessionTest, WhatNothingTouchesKeepsItsBytes)
{
    using scenes::operator+;
    const auto base = resting_model(scenes::sheet({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 12) +
                                    scenes::box({-1.9, 0.01, 1.8}, {-1.8, 0.11, 1.9}, 2));
    const auto movables = std::make_shared<const Movables>(movables_of(*base->mesh));
    const std::vector<Occlusion> known = solve_model(prepare(*base, {}), *base, {}).values;
    MovingSession session;
    session.ask({base, movables, {1}, nullptr, {}}, KnownAnswer{{{PartMove{}}}, known});
    const auto at = [&](double x, bool rests) {
        session.pose({{shifted_by(x)}}, rests);
        EXPECT_TRUE(updates_until([&] { static_cast<void>(session.update()); },
                                  [&] {
                                      const MovingFrame* frame = session.frame().get();
                                      return frame && frame->pose.moves[0] == shifted_by(x) &&
                                             frame->is_whole == rests;
                                  }));
        return session.frame()->values;
    };
    EXPECT_NE(at(0.05, false), known);
    EXPECT_EQ(at(0.0, false), known);
    const std::vector<Occlusion> away = at(0.1, true);
    const double diagonal = base->geometry().frame.diagonal;
    std::size_t far = 0, far_changes = 0, changes = 0;
    for (std::size_t v = 0; v < base->mesh->scene.positions.size(); ++v) {
        const bool is_far =
            glm::distance(base->mesh->scene.positions[v], glm::dvec3(-1.85, 0, 1.85)) >
            32.0 * 0.09 + 0.1 * diagonal;
        far += is_far;
        far_changes += is_far && away[v] != known[v];
        changes += away[v] != known[v];
    }
    EXPECT_GT(far, 10u);
    EXPECT_EQ(far_changes, 0u);
    EXPECT_GT(changes, 10u);
}

struct MovedSession : testing::Test {
    void SetUp() override { setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1); }

    /// Until nothing is on its way any more.
    bool rests()
    {
        int idle = 0;
        return updates_until(
            [&] {
                const Session::Changes changes = session.update();
                now += 0.02;
                static_cast<void>(mover.update(session, changes.file, now));
            },
            [&] {
                const bool is_done = session.state().is_solved && !session.state().is_draft &&
                                     !session.solving() && !mover.is_busy() && !mover.shown();
                idle = is_done ? idle + 1 : 0;
                return idle > 3;
            });
    }

    /// Of the vertices that a movable has: the mean, in the file's units.
    glm::dvec3 place(std::uint32_t movable) const
    {
        const Scene& scene = session.state().model->mesh->scene;
        glm::dvec3 sum(0.0);
        double count = 0.0;
        for (std::size_t v = 0; v < scene.positions.size(); ++v) {
            if (mover.movables()->of_vertex[v] == movable) {
                sum += scene.positions[v];
                count += 1.0;
            }
        }
        return sum / count;
    }

    TemporaryFolder folder;
    Session session;
    Mover mover;
    double now = 0.0;
};

// What rests is the session's own model: what is saved is what is shown. Undone, it is the file's
// again, with the bytes of a bake.
TEST_F(MovedSession, WhatRestsIsTheSessionsModelUntilItIsUndone)
{
    write_obj(folder / "two.obj", floor_and_box());
    session.open(folder / "two.obj", UpAxis::y);
    ASSERT_TRUE(rests());
    const std::vector<Occlusion> before = session.occlusion();
    const glm::dvec3 from = place(1);
    mover.select(1);
    ASSERT_TRUE(rests());
    EXPECT_TRUE(session.state().pose.is_rest());

    mover.remember();
    const double diagonal = mover.base()->geometry().frame.diagonal;
    mover.set_move(1, {.translation = glm::dvec3(0.5, 1.0, 0.0) / diagonal});
    ASSERT_TRUE(rests());
    EXPECT_TRUE(session.state().pose.by_hand);
    EXPECT_NEAR(glm::distance(place(1), from + glm::dvec3(0.5, 1.0, 0.0)), 0.0, 1e-9);
    session.save(folder / "moved.obj");
    const Scene saved = read_scene(folder / "moved.obj");
    EXPECT_NEAR(
        glm::distance(saved.positions.back(), session.state().model->mesh->scene.positions.back()),
        0.0, 1e-6);

    mover.undo();
    ASSERT_TRUE(rests());
    EXPECT_TRUE(session.state().pose.is_rest());
    EXPECT_EQ(session.state().model, mover.base());
    EXPECT_EQ(session.occlusion(), before);
}

/// A triangle that an animation moves by 2 along x from second 1 to second 3.
void write_slide(const std::filesystem::path& path)
{
    test::GltfMaker maker = test::square();
    maker.document["scenes"][0]["nodes"] = {0, 1};
    maker.document["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {0, 0, 1}}}};
    const int times =
        maker.add_accessor(maker.add_view(test::bytes_of<float>({1, 3})), 5126, "SCALAR", 2);
    const int places = maker.add_vectors<float>({0, 0, 1, 2, 0, 1});
    maker.document["animations"] = {
        {{"name", "slide"},
         {"samplers", {{{"input", times}, {"output", places}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
    std::ofstream(path, std::ios::binary) << maker.glb();
}

TEST_F(MovedSession, AnAnimationIsScrubbedAndLeft)
{
    write_slide(folder / "slide.glb");
    session.open(folder / "slide.glb", UpAxis::y);
    ASSERT_TRUE(rests());
    ASSERT_EQ(mover.animations(), std::vector<std::string>{"slide"});
    const glm::dvec3 from = place(1);
    mover.choose(0);
    ASSERT_TRUE(rests());
    EXPECT_EQ(mover.player().first, 1.0);
    EXPECT_EQ(mover.player().last, 3.0);
    mover.player().seek(2.5);
    ASSERT_TRUE(rests());
    EXPECT_NEAR(glm::distance(place(1), from + glm::dvec3(1.5, 0, 0)), 0.0, 1e-6);
    ASSERT_TRUE(session.state().pose.moment.has_value());
    EXPECT_EQ(session.state().pose.moment->seconds, 2.5);
    mover.choose(std::nullopt);
    ASSERT_TRUE(rests());
    EXPECT_TRUE(session.state().pose.is_rest());
    EXPECT_EQ(place(1), from);
}

// The moment that a file was read at is forgotten with the animation that was chosen then.
TEST_F(MovedSession, AnotherChoiceBeginsAtItsFirstKey)
{
    write_slide(folder / "slide.glb");
    const Moment moment{2.5, "slide"};
    mover.begin_at(moment);
    session.open(folder / "slide.glb", UpAxis::y, {.moment = moment});
    ASSERT_TRUE(updates_until(
        [&] {
            const Session::Changes changes = session.update();
            static_cast<void>(mover.update(session, changes.file, now));
        },
        [&] { return mover.chosen().has_value(); }));
    mover.choose(std::nullopt);
    mover.choose(0);
    ASSERT_TRUE(updates_until([&] { static_cast<void>(mover.update(session, false, now)); },
                              [&] { return mover.is_ready(); }));
    EXPECT_EQ(mover.player().seconds, 1.0);
}

}  // namespace
}  // namespace surfelao
