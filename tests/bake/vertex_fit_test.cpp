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
        : mesh(make_mesh(std::move(scene))),
          samples(fit_samples(mesh.geometry)),
          fit(mesh.geometry, mesh.surface, {}, samples)
    {
    }
    std::vector<Occlusion> solve(const std::function<double(glm::dvec3)>& occlusion) const
    {
        std::vector<Occlusion> answers;
        for (const SurfacePoint& point : samples.points) {
            const glm::uvec3 t = mesh.geometry.triangles[point.triangle];
            const std::vector<glm::dvec3>& p = mesh.scene.positions;
            const glm::dvec2 at(point.at);
            answers.push_back({static_cast<float>(occlusion((1.0 - at.x - at.y) * p[t.x] +
                                                            at.x * p[t.y] + at.y * p[t.z])),
                               kSheetNormal});
        }
        return fit.solve(answers);
    }

    Mesh mesh;
    SurfaceSamples samples;
    VertexFit fit;
};

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
    std::vector<Occlusion> answers(triangle.samples.points.size(), {0.0f, {1, 0, 0}});
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

TEST(FitSamples, AreAtLeastOneATriangleAndAsManyByArea)
{
    const Geometry geometry = make_geometry(scenes::sheet({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, 4) +
                                            scenes::sheet({0, 0, 1}, {.01, 0, 0}, {0, .01, 0}, 1));
    const SurfaceSamples samples = fit_samples(geometry);
    ASSERT_EQ(samples.first.size(), geometry.triangles.size() + 1);
    for (std::size_t t = 0; t < geometry.triangles.size(); ++t) {
        const std::uint32_t count = samples.first[t + 1] - samples.first[t];
        EXPECT_EQ(count, t < 32 ? 121u : 1u);  // 4096 / 32 = 128: 11 rows
        for (std::uint32_t s = samples.first[t]; s < samples.first[t + 1]; ++s) {
            EXPECT_EQ(samples.points[s].triangle, t);
            EXPECT_GT(samples.points[s].at.x, 0.0f);
            EXPECT_GT(samples.points[s].at.y, 0.0f);
            EXPECT_LT(samples.points[s].at.x + samples.points[s].at.y, 1.0f);
        }
    }
}

}  // namespace
}  // namespace surfelao
