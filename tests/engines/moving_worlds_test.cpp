#include "engines/moving.h"

#include "tests/differences.h"
#include "tests/scenes.h"
#include "tests/vertex_receivers.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+=;

constexpr double kWholeTurn = 2.0 * std::numbers::pi;

/// Who is asked, and how near it is to a closed form (`exact`), to itself in another place
/// (`same`, RMS).
struct MovingRow {
    const char* name;
    EngineSettings settings;
    double exact;
    double same;
};

EngineSettings engine_at(Engine engine, float quality)
{
    EngineSettings settings;
    settings.engine = engine;
    settings.quality = quality;
    settings.rays = 4096;
    return settings;
}

// In another place masks cut what they see by another raster, so `same` is about their own error.
// Of disks a body's edges are the error, what a box shows is rounded there; and an octree along
// other axes has other clusters, by about their own error.
const MovingRow kRows[] = {
    {"masks, draft", engine_at(Engine::masks, kDraft), 0.01, 0.010},
    {"masks, good", engine_at(Engine::masks, kGood), 0.01, 0.004},
    {"disks", engine_at(Engine::disks, kGood), 0.035, 0.012},
    {"rays", engine_at(Engine::rays, 0.0f), 0.01, 0.002},
};

/// Bodies in a frame whose centre is the world's, so that a place in it is the world's by its
/// diagonal.
struct MovingWorld {
    Scene scene;
    std::vector<std::uint32_t> body_of_triangle, body_of_vertex;
    double half;  ///< of a cube that holds all that ever happens

    explicit MovingWorld(double size) : half(size) {}

    void add(const Scene& part, std::uint32_t body)
    {
        body_of_triangle.insert(body_of_triangle.end(), part.triangles.size(), body);
        body_of_vertex.insert(body_of_vertex.end(), part.positions.size(), body);
        if (scene.positions.empty())
            scene = part;
        else
            scene += part;
    }

    Geometry geometry() const
    {
        Box box;
        box.include(glm::dvec3(-half));
        box.include(glm::dvec3(half));
        return make_geometry(scene, {.frame = frame_of(box)});
    }
    double diagonal() const { return 2.0 * half * std::sqrt(3.0); }
    Placement at(glm::dvec3 place, glm::dmat3 rotation = glm::dmat3(1.0), double scale = 1.0) const
    {
        return {rotation, scale, place / diagonal()};
    }
};

glm::dmat3 turn_about_z(double angle)
{
    const double c = std::cos(angle), s = std::sin(angle);
    return {{c, s, 0.0}, {-s, c, 0.0}, {0.0, 0.0, 1.0}};
}

/// No axis, no plane of a raster.
const glm::dmat3 kAnyTurn = turn_about_z(0.7) *
                            glm::dmat3({1.0, 0.0, 0.0}, {0.0, 0.6, 0.8}, {0.0, -0.8, 0.6}) *
                            turn_about_z(0.3);

/// One frame's answers at all vertices.
std::vector<Occlusion> answers_of(MovingReceivers& receivers)
{
    receivers.solve();
    return receivers.occlusion();
}

MovingReceivers at_vertices(const MovingScene& scene, const MovingWorld& world,
                            const EngineSettings& settings)
{
    return MovingReceivers(scene, vertex_receivers(world.geometry()), world.body_of_vertex,
                           {{settings}});
}

/// The share of the hemisphere that a level rectangle hides which is `a` wide and `b` long and has
/// a corner straight above at height h.
double level_corner(double a, double b, double h)
{
    const double x = a / h, y = b / h;
    const double rx = std::sqrt(1.0 + x * x), ry = std::sqrt(1.0 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (kWholeTurn);
}

TEST(MovingWorlds, TwoBoxesThatApproachFollowTheClosedForm)
{
    MovingWorld world(3.0);
    world.add(scenes::box({-1, -1, -1}, {1, 1, 0}, 12), 0);
    world.add(scenes::box({-0.8, -0.6, 0}, {1.0, 0.9, 0.5}, 12), 1);
    const Geometry geometry = world.geometry();
    const auto unit = [&](glm::dvec3 p) { return glm::vec3(p / world.diagonal()); };
    const glm::dvec3 places[] = {{0.0, 0.0, 0.0}, {0.31, 0.13, 0.0}, {-0.55, 0.42, 0.0}};
    std::vector<Receiver> receivers;
    for (const glm::dvec3 place : places)
        receivers.push_back(
            {unit(place) + glm::vec3(0, 0, kVertexOffset), {0, 0, 1}, kVertexOffset});
    for (const MovingRow& row : kRows) {
        MovingScene scene(geometry, world.body_of_triangle, row.settings);
        MovingReceivers asked(scene, receivers, {0, 0, 0}, {{row.settings}});
        for (int step = 0; step < 10; ++step) {
            const double gap = 2.0 * std::pow(0.8, step);
            scene.place(1, world.at({0, 0, gap}));
            const std::vector<Occlusion> found = answers_of(asked);
            for (std::size_t i = 0; i < found.size(); ++i) {
                const double h = gap - kVertexOffset * world.diagonal();
                const glm::dvec3 p = places[i];
                const double right =
                    level_corner(1.0 - p.x, 0.9 - p.y, h) + level_corner(1.0 - p.x, p.y + 0.6, h) +
                    level_corner(p.x + 0.8, 0.9 - p.y, h) + level_corner(p.x + 0.8, p.y + 0.6, h);
                EXPECT_NEAR(found[i].occlusion, right, row.exact)
                    << row.name << ", place " << i << ", gap " << gap;
            }
        }
    }
}

TEST(MovingWorlds, AConvexBodyThatTurnsAloneStaysOpen)
{
    MovingWorld world(1.5);
    world.add(scenes::sphere({0, 0, 0}, 1.0, 8), 1);
    for (const MovingRow& row : kRows) {
        MovingScene scene(world.geometry(), world.body_of_triangle, row.settings);
        MovingReceivers vertices = at_vertices(scene, world, row.settings);
        for (const double angle : {0.0, 0.3, 1.1}) {
            scene.place(1, world.at({0, 0, 0}, turn_about_z(angle) * kAnyTurn));
            EXPECT_LE(mean_occlusion(answers_of(vertices)), 1e-3) << row.name << ", " << angle;
        }
    }
}

TEST(MovingWorlds, ARingTurnedByOneOfItsCopiesHasThePermutedAnswers)
{
    constexpr std::uint32_t kCopies = 8;
    MovingWorld world(2.0);
    world.add(scenes::box({-0.4, -0.3, -0.5}, {0.5, 0.3, 0.2}, 4), 0);
    const Scene copy = scenes::moved(scenes::bumpy_sphere(6),
                                     [](glm::dvec3 p) { return 0.4 * p + glm::dvec3(1.2, 0, 0); });
    const std::size_t size = copy.positions.size();
    for (std::uint32_t k = 0; k < kCopies; ++k) {
        const glm::dmat3 turn = turn_about_z(kWholeTurn * k / kCopies);
        world.add(scenes::moved(copy, [&](glm::dvec3 p) { return turn * p; }), k + 1);
    }
    for (const MovingRow& row : kRows) {
        MovingScene scene(world.geometry(), world.body_of_triangle, row.settings);
        MovingReceivers vertices = at_vertices(scene, world, row.settings);
        const std::vector<Occlusion> before = answers_of(vertices);
        for (std::uint32_t k = 0; k < kCopies; ++k)
            scene.place(k + 1, world.at({0, 0, 0}, turn_about_z(kWholeTurn / kCopies)));
        const std::vector<Occlusion> after = answers_of(vertices);
        const std::size_t first = before.size() - kCopies * size;
        std::vector<Occlusion> permuted(before.begin(), before.begin() + first);
        for (std::uint32_t k = 0; k < kCopies; ++k) {
            const std::size_t next = first + (k + 1) % kCopies * size;
            permuted.insert(permuted.end(), before.begin() + next, before.begin() + next + size);
        }
        EXPECT_LE(rms_difference(permuted, after), row.same) << row.name;
        EXPECT_GT(rms_difference(before, after), 0.01) << row.name << ": the box is not round";
    }
}

/// A bumpy body on a floor, and another one over it.
MovingWorld stage()
{
    MovingWorld world(2.5);
    world.add(scenes::sheet({-2, -2, -0.8}, {4, 0, 0}, {0, 4, 0}, 16), 0);
    world.add(scenes::moved(scenes::bumpy_sphere(8), [](glm::dvec3 p) { return 0.7 * p; }), 1);
    world.add(scenes::moved(scenes::bumpy_sphere(6),
                            [](glm::dvec3 p) { return 0.5 * p + glm::dvec3(1.2, 0.2, -0.2); }),
              2);
    return world;
}

/// The same scene with its bodies built where they stand.
std::vector<Occlusion> built_there(const MovingWorld& world, const EngineSettings& settings,
                                   const std::vector<Placement>& placements, std::uint32_t hidden)
{
    Geometry geometry = world.geometry();
    std::vector<Receiver> receivers = vertex_receivers(geometry);
    for (std::size_t v = 0; v < receivers.size(); ++v) {
        const Placement& placement = placements[world.body_of_vertex[v]];
        geometry.positions[v] = placed({geometry.positions[v], {}, 0.0f}, placement).position;
        geometry.normals[v] = placed({{}, geometry.normals[v], 0.0f}, placement).normal;
        geometry.areas[v] *= static_cast<float>(placement.scale * placement.scale);
        receivers[v] = placed(receivers[v], placement);
    }
    std::vector<glm::uvec3> triangles;
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        const glm::uvec3 triangle = geometry.triangles[t];
        const std::uint32_t body = world.body_of_triangle[t];
        if (body == hidden)
            continue;
        const bool mirrored = glm::determinant(placements[body].rotation) < 0.0;
        triangles.push_back(mirrored ? glm::uvec3(triangle.x, triangle.z, triangle.y) : triangle);
    }
    for (std::size_t v = 0; v < receivers.size(); ++v)
        geometry.areas[v] *= world.body_of_vertex[v] == hidden ? 0.0f : 1.0f;
    geometry.triangles = triangles;
    return solve(prepare(geometry, settings), receivers, settings).occlusion;
}

TEST(MovingWorlds, AHiddenBodyOccludesNothing)
{
    const MovingWorld world = stage();
    const std::vector<Placement> rest(3);
    for (const MovingRow& row : kRows) {
        MovingScene scene(world.geometry(), world.body_of_triangle, row.settings);
        MovingReceivers vertices = at_vertices(scene, world, row.settings);
        scene.hide(2);
        const auto shown =
            world.body_of_vertex.size() - std::ranges::count(world.body_of_vertex, 2u);
        EXPECT_EQ(vertices.solve().solved, shown) << row.name;
        std::vector<Occlusion> found = vertices.occlusion();
        std::vector<Occlusion> right = built_there(world, row.settings, rest, 2);
        // its own receivers are left as they were: nothing was found for them yet
        for (std::size_t v = 0; v < found.size(); ++v) {
            if (world.body_of_vertex[v] == 2)
                found[v] = right[v] = {};
        }
        EXPECT_LE(rms_difference(right, found), row.same) << row.name;
        scene.place(2, {});
        found = answers_of(vertices);
        right = built_there(world, row.settings, rest, 3);
        EXPECT_LE(rms_difference(right, found), row.same) << row.name;
    }
}

TEST(MovingWorlds, TurnedScaledAndMirroredBodiesAreAsIfBuiltThere)
{
    const MovingWorld world = stage();
    const glm::dmat3 mirror({-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0});
    const std::vector<Placement> placements = {
        {}, world.at({0.2, 0.1, 0.1}, kAnyTurn, 0.8), world.at({0.1, 0, 0.2}, mirror, 1.25)};
    for (const MovingRow& row : kRows) {
        MovingScene scene(world.geometry(), world.body_of_triangle, row.settings);
        MovingReceivers vertices = at_vertices(scene, world, row.settings);
        for (std::uint32_t body = 1; body < 3; ++body)
            scene.place(body, placements[body]);
        const std::vector<Occlusion> found = answers_of(vertices);
        EXPECT_LE(rms_difference(built_there(world, row.settings, placements, 3), found), row.same)
            << row.name;
    }
}

TEST(MovingWorlds, MovedAwayAndBackGivesTheFirstBytesOnAnyNumberOfThreads)
{
    const MovingWorld world = stage();
    for (const MovingRow& row : kRows) {
        std::vector<std::vector<Occlusion>> firsts, aways;
        for (const std::size_t threads : {1, 4}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            MovingScene scene(world.geometry(), world.body_of_triangle, row.settings);
            MovingReceivers vertices = at_vertices(scene, world, row.settings);
            firsts.push_back(answers_of(vertices));
            scene.place(1, world.at({0.4, 0.3, 0.2}, kAnyTurn));
            aways.push_back(answers_of(vertices));
            scene.hide(2);
            vertices.solve();
            scene.place(1, {});
            scene.place(2, {});
            EXPECT_TRUE(same_bytes(firsts.back(), answers_of(vertices))) << row.name;
        }
        EXPECT_TRUE(same_bytes(firsts[0], firsts[1])) << row.name;
        EXPECT_TRUE(same_bytes(aways[0], aways[1])) << row.name;
        EXPECT_FALSE(same_bytes(firsts[0], aways[0])) << row.name;
    }
}

// Where a limit is given, a body that grows asks anew what it hides of itself.
TEST(MovingWorlds, ProgressComesToItsEndOnceInEachFrame)
{
    const MovingWorld world = stage();
    const std::vector<Placement> places = {{},
                                           world.at({0.2, 0.1, 0.1}),
                                           world.at({0, 0, 0}, glm::dmat3(1.0), 0.7),
                                           world.at({9, 0, 0})};
    for (MovingRow row : kRows) {
        row.settings.definition.max_distance = 0.2f;
        MovingScene scene(world.geometry(), world.body_of_triangle, row.settings);
        MovingReceivers vertices = at_vertices(scene, world, row.settings);
        for (std::size_t frame = 0; frame < places.size(); ++frame) {
            scene.place(1, places[frame]);
            int ends = 0;
            vertices.solve([&](double done) { return ends += done == 1.0 ? 1 : 0, true; });
            EXPECT_EQ(ends, 1) << row.name << ", frame " << frame;
        }
    }
}

TEST(MovingWorlds, ADeformationThatIsAMoveIsThatMove)
{
    const MovingWorld world = stage();
    const Geometry geometry = world.geometry();
    const Placement placement = world.at({0.2, 0.1, 0.1}, kAnyTurn);
    std::vector<glm::vec3> positions = geometry.positions;
    std::vector<Receiver> own;
    const std::vector<Receiver> at_rest = vertex_receivers(geometry);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (world.body_of_vertex[v] != 1)
            continue;
        positions[v] = placed({positions[v], {}, 0.0f}, placement).position;
        own.push_back(placed(at_rest[v], placement));
    }
    for (const MovingRow& row : kRows) {
        std::vector<std::vector<Occlusion>> answers;
        for (const bool deforms : {false, true}) {
            MovingScene scene(geometry, world.body_of_triangle, row.settings);
            MovingReceivers vertices = at_vertices(scene, world, row.settings);
            if (deforms) {
                scene.deform(1, positions);
                vertices.deform(1, own);
            } else {
                scene.place(1, placement);
            }
            answers.push_back(answers_of(vertices));
        }
        EXPECT_LE(rms_difference(answers[0], answers[1]), row.same) << row.name;
    }
}

}  // namespace
}  // namespace surfelao
