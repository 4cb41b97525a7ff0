#include "bake/subdivide.h"

#include "bake/subdivide_job.h"
#include "engines/threads.h"
#include "scenes.h"
#include "surfels/topology.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <functional>
#include <map>
#include <utility>

namespace surfelao {
namespace {

using scenes::operator+;

/// Answers by place alone, in the unit frame.
Ask by_place(const std::function<double(glm::vec3)>& occlusion)
{
    return [occlusion](std::span<const Receiver> receivers, const Progress&) {
        std::vector<Occlusion> answers;
        for (const Receiver& receiver : receivers)
            answers.push_back({static_cast<float>(occlusion(receiver.position)), {}});
        return answers;
    };
}

/// A round spot with a hard rim.
double spot(glm::vec3 p)
{
    return glm::distance(p, glm::vec3(0.1f, 0.05f, 0.0f)) < 0.2f ? 0.9 : 0.1;
}

/// Two sheets that touch along x = 1, each with vertices of its own there.
Scene torn_sheet()
{
    return scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2) +
           scenes::sheet({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2);
}

Scene ball_on_floor()
{
    return scenes::sheet({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1) +
           scenes::sphere({0.3, 0.2, 0.5}, 0.5, 16);
}

struct CutWorld {
    const char* name;
    Scene scene;
};

std::vector<CutWorld> cut_worlds()
{
    return {{"sheet", scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1)},
            {"torn sheet", torn_sheet()},
            {"box", scenes::box({0, 0, 0}, {1, 2, 1}, 1)},
            {"sphere", scenes::sphere({0, 0, 0}, 1, 3)},
            {"ball on floor", ball_on_floor()}};
}

Scene refined(const Scene& scene, const Ask& ask, double tolerance = 0.02)
{
    const Mesh mesh = make_mesh(scene);
    return plain_refined(mesh.scene, subdivide(mesh, tolerance, 1e-4f, ask).refinement);
}

TEST(Subdivide, CutsNothingThatDoesNotBend)
{
    const Ask constant = by_place([](glm::vec3) { return 0.4; });
    const Ask linear =
        by_place([](glm::vec3 p) { return 0.5 + 0.4 * p.x - 0.3 * p.y + 0.2 * p.z; });
    for (const CutWorld& world : cut_worlds()) {
        for (const Ask& ask : {constant, linear})
            EXPECT_EQ(refined(world.scene, ask).triangles.size(), world.scene.triangles.size())
                << world.name;
    }
}

/// What a cut leaves as it is.
struct CutShape {
    double area = 0.0, boundary = 0.0;
    std::int64_t euler = 0;
    std::uint64_t torn = 0;
};

CutShape cut_shape_of(const Scene& scene)
{
    const Geometry geometry = make_geometry(scene);
    CutShape shape;
    for (const double area : triangle_areas(geometry))
        shape.area += area;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    std::map<std::uint32_t, int> vertices;
    for (const glm::uvec3& t : geometry.triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = geometry.welded[t[k]], b = geometry.welded[t[(k + 1) % 3]];
            ++edges[std::minmax(a, b)];
            ++vertices[a];
        }
    }
    for (const auto& [edge, count] : edges) {
        if (count == 1)
            shape.boundary +=
                glm::distance(geometry.positions[edge.first], geometry.positions[edge.second]);
    }
    shape.euler = static_cast<std::int64_t>(vertices.size()) -
                  static_cast<std::int64_t>(edges.size()) +
                  static_cast<std::int64_t>(geometry.triangles.size());
    const Topology topology = analyse_topology(geometry);
    shape.torn = topology.nonmanifold_edge_count + topology.misoriented_edge_count;
    return shape;
}

// A corner of a piece within another's edge would be a torn edge: a longer boundary.
TEST(Subdivide, LeavesAreaBoundaryAndEulerNumber)
{
    for (const CutWorld& world : cut_worlds()) {
        const Scene after = refined(world.scene, by_place(spot));
        const CutShape old_shape = cut_shape_of(world.scene), shape = cut_shape_of(after);
        EXPECT_GT(after.triangles.size(), world.scene.triangles.size() + 50) << world.name;
        EXPECT_NEAR(shape.area, old_shape.area, 1e-5 * old_shape.area) << world.name;
        EXPECT_NEAR(shape.boundary, old_shape.boundary, 1e-5) << world.name;
        EXPECT_EQ(shape.euler, old_shape.euler) << world.name;
        EXPECT_EQ(shape.torn, old_shape.torn) << world.name;
    }
}

TEST(Subdivide, KeepsTheOldVerticesFirst)
{
    const Scene scene = scenes::box({0, 0, 0}, {1, 2, 1}, 1);
    const Scene after = refined(scene, by_place(spot));
    ASSERT_GT(after.positions.size(), scene.positions.size());
    EXPECT_TRUE(
        std::equal(scene.positions.begin(), scene.positions.end(), after.positions.begin()));
}

TEST(Subdivide, CutsNextToNothingTheSecondTime)
{
    for (const CutWorld& world : cut_worlds()) {
        const Scene once = refined(world.scene, by_place(spot));
        const Scene twice = refined(once, by_place(spot));
        EXPECT_LT(static_cast<double>(twice.triangles.size()),
                  1.01 * static_cast<double>(once.triangles.size()))
            << world.name;
    }
}

// Masks answer otherwise where the same surface has finer triangles.
TEST(Subdivide, CutsNextToNothingWhereTheAnswersMove)
{
    const auto wave = [](double size) {
        return by_place([size](glm::vec3 p) {
            return 0.5 + size * std::sin(20.0 * p.x) * std::sin(20.0 * p.y);
        });
    };
    const Scene sheet = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
    const Scene once = refined(sheet, wave(0.4));
    const Scene twice = refined(once, wave(0.4 * 1.05));
    EXPECT_GT(once.triangles.size(), 100u);
    EXPECT_EQ(twice.triangles.size(), once.triangles.size());
}

// Nothing of it shows at the middles of the floor's edges.
TEST(Subdivide, FindsWhatStandsWithinATriangle)
{
    const auto small = [](glm::vec3 p) {
        return glm::distance(p, glm::vec3(0.21f, 0.1f, 0.0f)) < 0.03f ? 0.9 : 0.1;
    };
    const Scene floor = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
    EXPECT_GT(refined(floor, by_place(small)).triangles.size(), 100u);
}

Mesh baked_mesh(const Scene& scene, double tolerance, const EngineSettings& engine = {})
{
    const Mesh mesh = make_mesh(scene);
    Occluders occluders(mesh.geometry);
    SubdivisionReport report;
    return subdivided(mesh, tolerance, {}, engine, occluders, {}, report);
}

std::vector<Occlusion> values_on(const Mesh& mesh, const Scene& occluding)
{
    const Geometry geometry = make_geometry(occluding);
    const VertexTarget target(std::make_shared<const Mesh>(mesh), {});
    return target.values(solve(prepare(geometry), target.receivers()).occlusion);
}

/// A ball that touches a plane covers R^2 h / (d^2 + h^2)^1.5 of a point's hemisphere, at the
/// distance d from where it stands, h = R.
TEST(Subdivide, ShowsTheShadowOfABallOnTwoTriangles)
{
    const Scene scene = ball_on_floor();
    const auto exact = [](glm::dvec3 p) {
        const double d2 = (p.x - 0.3) * (p.x - 0.3) + (p.y - 0.2) * (p.y - 0.2);
        return 0.125 / std::pow(d2 + 0.25, 1.5);
    };
    const Mesh mesh = baked_mesh(scene, 0.02);
    const std::vector<Occlusion> values = values_on(mesh, scene);
    double seen = 0.0, right = 0.0, whole = 0.0;
    for (const glm::uvec3& t : mesh.scene.triangles) {
        const glm::dvec3 a = mesh.scene.positions[t.x], b = mesh.scene.positions[t.y],
                         c = mesh.scene.positions[t.z];
        if (std::abs(a.z) + std::abs(b.z) + std::abs(c.z) > 1e-6)
            continue;
        const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
        whole += area;
        seen +=
            area / 3.0 * (values[t.x].occlusion + values[t.y].occlusion + values[t.z].occlusion);
        constexpr int kRows = 24;  // of the sum that stands for the integral over a triangle
        for (int i = 0; i < kRows; ++i) {
            for (int j = 0; j < kRows - i; ++j) {
                const double u = (i + 1.0 / 3.0) / kRows, v = (j + 1.0 / 3.0) / kRows;
                right +=
                    area * (2.0 / (kRows * (kRows + 1.0))) * exact(a + u * (b - a) + v * (c - a));
            }
        }
    }
    EXPECT_NEAR(whole, 16.0, 1e-6);
    EXPECT_NEAR(seen / whole, right / whole, 0.005);
}

TEST(Subdivide, GivesTheSameMeshForAnyNumberOfThreadsAndEngine)
{
    const Scene scene = ball_on_floor();
    const auto of = [&](int threads, Engine engine) {
        const ThreadLimit limit(threads);
        EngineSettings settings;
        settings.engine = engine;
        const Mesh mesh = baked_mesh(scene, 0.02, settings);
        return std::pair(mesh.scene.positions, mesh.scene.triangles);
    };
    const auto first = of(1, Engine::masks);
    EXPECT_GT(first.first.size(), scene.positions.size());
    for (const Engine engine : {Engine::masks, Engine::disks, Engine::rays})
        EXPECT_EQ(of(3, engine), first) << name_of(engine);
}

TEST(Subdivide, LeavesOutWhatTheMeshLeavesOut)
{
    const Scene scene = torn_sheet();
    GeometryScope scope;
    scope.left_out.assign(scene.triangles.size(), false);
    scope.left_out[0] = true;
    const Mesh mesh = make_mesh(scene, {}, scope);
    const Subdivision found = subdivide(mesh, 0.02, 1e-4f, by_place(spot));
    const Mesh after =
        refined_mesh(mesh, found.refinement, plain_refined(mesh.scene, found.refinement));
    EXPECT_EQ(after.geometry.frame.diagonal, mesh.geometry.frame.diagonal);
    EXPECT_EQ(after.geometry.triangles.size() + found.refinement.pieces_of(0).size(),
              after.scene.triangles.size());
}

TEST(Subdivide, InterpolatesNormals)
{
    const Mesh mesh = make_mesh(scenes::sphere({0, 0, 0}, 1, 3));
    const Subdivision found = subdivide(mesh, 0.02, 1e-4f, by_place(spot));
    const Mesh after =
        refined_mesh(mesh, found.refinement, plain_refined(mesh.scene, found.refinement));
    const auto least = [](const Mesh& m) {
        double cosine = 1.0;
        for (std::size_t v = 0; v < m.scene.positions.size(); ++v)
            cosine = std::min(cosine, glm::dot(glm::dvec3(m.surface.normals[v]),
                                               glm::normalize(m.scene.positions[v])));
        return cosine;
    };
    EXPECT_GT(least(after), 0.975);
    EXPECT_LT(least(make_mesh(plain_refined(mesh.scene, found.refinement))), 0.96);  // facets
}

TEST(Subdivide, StopsWhenToldSo)
{
    const Mesh mesh = make_mesh(ball_on_floor());
    EXPECT_THROW(static_cast<void>(
                     subdivide(mesh, 0.02, 1e-4f, by_place(spot), [](double) { return false; })),
                 Cancelled);
}

}  // namespace
}  // namespace surfelao
