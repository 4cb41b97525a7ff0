#include "bake/vertex_fit.h"

#include "differences.h"
#include "engines/threads.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace surfelao {
namespace {

using scenes::operator+;

constexpr glm::vec3 kSheetNormal{0, 0, 1};

/// A mesh with its fit, answered by a function of the place in the scene.
struct Fitted {
    explicit Fitted(Scene scene)
        : mesh(make_mesh(std::move(scene))), fit(mesh.geometry, mesh.surface, {})
    {
    }
    std::vector<Occlusion> answers(const std::function<double(glm::dvec3)>& occlusion) const
    {
        std::vector<Occlusion> answers;
        for (const SurfacePoint& point : fit.samples().points) {
            const glm::uvec3 t = mesh.geometry.triangles[point.triangle];
            const std::vector<glm::dvec3>& p = mesh.scene.positions;
            const glm::dvec2 at(point.at);
            answers.push_back({static_cast<float>(occlusion((1.0 - at.x - at.y) * p[t.x] +
                                                            at.x * p[t.y] + at.y * p[t.z])),
                               kSheetNormal});
        }
        return answers;
    }
    std::vector<Occlusion> solve(const std::function<double(glm::dvec3)>& occlusion) const
    {
        return fit.solve(answers(occlusion));
    }

    Mesh mesh;
    VertexFit fit;
};

// Steps that are known before come as near as people see: to answers that wave, and to noise.
TEST(VertexFit, LocalStepsAreNearTheFit)
{
    const Fitted sphere(scenes::bumpy_sphere(24));
    double phase = 0.0;
    const std::vector<Occlusion> answers = sphere.answers([&](glm::dvec3 p) {
        return 0.4 + 0.2 * std::sin(9.0 * p.x + 5.0 * p.y) + 0.05 * std::sin(phase += 1.7);
    });
    const std::vector<Occlusion> values = sphere.fit.solve(answers);
    const std::vector<Occlusion> local = sphere.fit.solve_locally(answers);
    double squares = 0.0;
    for (std::size_t v = 0; v < values.size(); ++v) {
        const double difference = values[v].occlusion - local[v].occlusion;
        squares += difference * difference;
        ASSERT_LT(std::abs(difference), 0.01);
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(values.size())), 0.001);
}

// What changes at one end of a band of 60 squares changes no bit behind kLocalSteps + 1 edges.
TEST(VertexFit, LocalStepsReachNoFurther)
{
    constexpr int kSquares = 60;
    const Fitted band(scenes::sheet({0, 0, 0}, {kSquares, 0, 0}, {0, kSquares, 0}, kSquares));
    const auto values = [&](double at_the_end) {
        return band.fit.solve_locally(
            band.answers([&](glm::dvec3 p) { return p.x < 1.0 ? at_the_end : 0.3; }));
    };
    const std::vector<Occlusion> before = values(0.2), after = values(0.9);
    const std::vector<glm::dvec3>& places = band.mesh.scene.positions;
    std::size_t changed = 0;
    for (std::size_t v = 0; v < places.size(); ++v) {
        const bool is_near = places[v].x <= kLocalSteps + 2.0;
        ASSERT_TRUE(is_near || before[v] == after[v]) << places[v].x;
        changed += before[v] == after[v] ? 0 : 1;
    }
    EXPECT_GT(changed, 2u * (kSquares + 1));
}

TEST(VertexFit, ConstantIsKept)
{
    const Fitted sphere(scenes::bumpy_sphere(12));
    for (const Occlusion& value : sphere.solve([](glm::dvec3) { return 0.3; }))
        ASSERT_NEAR(value.occlusion, 0.3, 1e-6);
}

// What vertices can hold is found again, but for the smoothness, which flattens it at the rim.
TEST(VertexFit, LinearIsFoundAgain)
{
    const auto linear = [](glm::dvec3 p) { return 0.2 + 0.3 * p.x + 0.4 * p.y; };
    const Fitted sheet(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8));
    const std::vector<Occlusion> values = sheet.solve(linear);
    for (std::size_t v = 0; v < values.size(); ++v)
        ASSERT_NEAR(values[v].occlusion, linear(sheet.mesh.scene.positions[v]), 2e-2) << v;
}

/// Values at the vertices of two sheets that meet at y = 0 without sharing vertices there: the
/// first is closed, the second open.
std::vector<Occlusion> values_of_two_sheets(glm::dvec3 second_side)
{
    const Fitted sheets(scenes::sheet({0, -1, 0}, {1, 0, 0}, {0, 1, 0}, 2) +
                        scenes::sheet({0, 0, 0}, {1, 0, 0}, second_side, 2));
    return sheets.solve([](glm::dvec3 p) { return p.y < 0.0 ? 1.0 : 0.0; });
}

// Vertices 6 to 8 of the first sheet stand where 0 to 2 of the second one do.
TEST(VertexFit, UnknownsAreMergedOverSeams)
{
    const std::vector<Occlusion> values = values_of_two_sheets({0, 1, 0});
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(values[6 + i].occlusion, values[9 + i].occlusion);
        EXPECT_NEAR(values[6 + i].occlusion, 0.5, 0.2);
    }
}

TEST(VertexFit, UnknownsAreNotMergedOverCreases)
{
    const std::vector<Occlusion> values = values_of_two_sheets({0, 1e-9, 1});
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(values[6 + i].occlusion, 1.0, 1e-6);
        EXPECT_NEAR(values[9 + i].occlusion, 0.0, 1e-6);
    }
}

TEST(VertexFit, BentNormalsWeighByVisibility)
{
    const Fitted triangle(scenes::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
    std::vector<Occlusion> answers(triangle.fit.samples().points.size(), {0.0f, {1, 0, 0}});
    for (std::size_t i = 0; i < answers.size(); i += 2)
        answers[i] = {1.0f, {0, 1, 0}};  // closed: their bent normals are nobody's
    for (const Occlusion& value : triangle.fit.solve(answers))
        EXPECT_NEAR(value.bent_normal.x, 1.0f, 1e-6f);
    for (Occlusion& answer : answers)
        answer.occlusion = 1.0f;
    for (const Occlusion& value : triangle.fit.solve(answers))
        EXPECT_EQ(value.bent_normal, kSheetNormal);  // nothing is open: the vertex's own normal
}

TEST(VertexFit, UnusedVerticesAreNamed)
{
    Scene scene = scenes::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    scene.positions.push_back({1, 1, 0});
    const Fitted fitted(scene);
    EXPECT_EQ(fitted.fit.unused_vertices(), std::vector<std::uint32_t>{3});
    EXPECT_EQ(fitted.solve([](glm::dvec3) { return 1.0; })[3].occlusion, 0.0f);
}

TEST(VertexFit, SameBytesForAnyNumberOfThreads)
{
    const auto wavy = [](glm::dvec3 p) { return 0.5 + 0.4 * std::sin(9.0 * p.x + 5.0 * p.z); };
    const Scene scene = scenes::bumpy_sphere(40);  // several blocks of unknowns
    const auto solve = [&](int threads) {
        const ThreadLimit limit(threads);
        return Fitted(scene).solve(wavy);
    };
    const std::vector<Occlusion> one = solve(1);
    EXPECT_TRUE(same_bytes(one, solve(2)));
    EXPECT_TRUE(same_bytes(one, solve(5)));
}

/// A sheet of 3 * 3 quads, each cut along its first or its second diagonal.
Scene cut_sheet(bool along_second)
{
    Scene scene = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1.2, 0}, 3);
    for (std::size_t t = 0; along_second && t < scene.triangles.size(); t += 2) {
        const std::uint32_t row = static_cast<std::uint32_t>(t) / 6, column = t / 2 % 3;
        const std::uint32_t a = 4 * row + column, b = a + 1, c = a + 5, d = a + 4;
        const glm::uvec3 first = scene.triangles[t];
        const bool has_ac = first == glm::uvec3(a, b, c);
        scene.triangles[t] = has_ac ? glm::uvec3(a, b, d) : glm::uvec3(a, b, c);
        scene.triangles[t + 1] = has_ac ? glm::uvec3(b, c, d) : glm::uvec3(a, c, d);
    }
    return scene;
}

TEST(VertexFit, QuadsDoNotDependOnTheirCut)
{
    const auto curved = [](glm::dvec3 p) { return p.x * p.x + 0.3 * p.y * (1.0 - p.x); };
    const Fitted one(cut_sheet(false)), other(cut_sheet(true));
    ASSERT_NE(one.mesh.scene.triangles, other.mesh.scene.triangles);
    const std::vector<Occlusion> values = one.solve(curved), others = other.solve(curved);
    for (std::size_t v = 0; v < values.size(); ++v)
        EXPECT_NEAR(values[v].occlusion, others[v].occlusion, 1e-3) << v;  // where it stops
}

TEST(FitSamples, StandForTheWholeAreaAndAreAtLeastOneATriangle)
{
    const Mesh mesh = make_mesh(scenes::sheet({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, 4) +
                                scenes::triangle({0, 0, 1}, {.01, 0, 1}, {0, .01, 1}));
    const VertexFit fit(mesh.geometry, mesh.surface, {});
    const SurfaceSamples& samples = fit.samples();
    ASSERT_EQ(samples.areas.size(), samples.points.size());
    std::vector<double> areas(mesh.geometry.triangles.size(), 0.0);
    for (std::size_t s = 0; s < samples.points.size(); ++s) {
        const glm::vec2 at = samples.points[s].at;
        EXPECT_GE(at.x, 0.0f);
        EXPECT_GE(at.y, 0.0f);
        EXPECT_LE(at.x + at.y, 1.0f + 1e-6f);
        areas[samples.points[s].triangle] += samples.areas[s];
    }
    const double diagonal = mesh.geometry.frame.diagonal;
    for (std::size_t t = 0; t < 32; t += 2)  // two triangles are a quad
        EXPECT_NEAR((areas[t] + areas[t + 1]) * diagonal * diagonal, 9.0 / 16.0, 1e-5) << t;
    EXPECT_NEAR(areas[32] * diagonal * diagonal, 5e-5, 1e-8);
}

// Quads and triangles of several samples.
TEST(FitSamples, AreTheSameAfterFolding)
{
    const Mesh mesh =
        make_mesh(scenes::sheet({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, 4) + scenes::bumpy_sphere(8));
    VertexFit folded(mesh.geometry, mesh.surface, {});
    const SurfaceSamples before = folded.samples();
    ASSERT_FALSE(before.quads.empty());
    folded.fold(0, 1);
    folded.fold(1, before.points.size());
    EXPECT_EQ(folded.samples().points.size(), before.quad_weights.size());
    folded.unfold();
    const SurfaceSamples& after = folded.samples();
    EXPECT_EQ(after.areas, before.areas);
    EXPECT_EQ(after.first_sample, before.first_sample);
    ASSERT_EQ(after.points.size(), before.points.size());
    for (std::size_t i = 0; i < after.points.size(); ++i) {
        EXPECT_EQ(after.points[i].triangle, before.points[i].triangle) << i;
        EXPECT_EQ(after.points[i].at, before.points[i].at) << i;
    }
}

}  // namespace
}  // namespace surfelao
