#include "surfels/half_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace surfelao {
namespace {

constexpr std::uint32_t kAround = 12, kAcross = 8;

/// kAround * kAcross quads, as two triangles each; closed in both directions.
Scene torus()
{
    Scene scene;
    for (std::uint32_t j = 0; j < kAcross; ++j) {
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const double a = 2 * std::numbers::pi * i / kAround;
            const double b = 2 * std::numbers::pi * j / kAcross;
            const double r = 2.0 + std::cos(b);
            scene.positions.push_back({r * std::cos(a), r * std::sin(a), std::sin(b)});
            const std::uint32_t i1 = (i + 1) % kAround, j1 = (j + 1) % kAcross;
            const auto at = [](std::uint32_t u, std::uint32_t v) { return v * kAround + u; };
            scene.triangles.push_back({at(i, j), at(i1, j), at(i1, j1)});
            scene.triangles.push_back({at(i, j), at(i1, j1), at(i, j1)});
        }
    }
    return scene;
}

TEST(HalfEdges, ATorusHasOneHandleAndNoHole)
{
    const HalfEdgeReport report = examine_half_edges(make_geometry(torus()));
    EXPECT_EQ(report.handle_count, 1u);
    EXPECT_EQ(report.hole_count, 0u);
    EXPECT_EQ(report.complex_triangle_count, 0u);
}

// Two triangles of one quad gone: a loop of 4. One triangle elsewhere: a loop of 3.
TEST(HalfEdges, HolesAreLoopsOfBorderEdges)
{
    Scene scene = torus();
    scene.triangles.erase(scene.triangles.begin() + 100);
    scene.triangles.erase(scene.triangles.begin(), scene.triangles.begin() + 2);
    const HalfEdgeReport report = examine_half_edges(make_geometry(scene));
    EXPECT_EQ(report.hole_count, 2u);
    EXPECT_EQ(report.largest_hole_edges, 4u);
    EXPECT_EQ(report.handle_count, 0u) << "only closed components count";
}

TEST(HalfEdges, AThirdFaceAtAnEdgeIsComplex)
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    scene.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
    const HalfEdgeReport report = examine_half_edges(make_geometry(scene));
    EXPECT_EQ(report.complex_triangle_count, 1u);
    EXPECT_EQ(report.hole_count, 1u);
    EXPECT_EQ(report.largest_hole_edges, 4u);
}

// Without the bound on fans this takes 10^10 steps.
TEST(HalfEdges, AFanOfEnormousValenceIsLeftOut)
{
    constexpr std::uint32_t kCount = 100'000;
    Scene scene;
    scene.positions.push_back({0, 0, 0});
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const double a = 2 * std::numbers::pi * i / kCount;
        scene.positions.push_back({std::cos(a), std::sin(a), 0});
        scene.triangles.push_back({0, 1 + i, 1 + (i + 1) % kCount});
    }
    const HalfEdgeReport report = examine_half_edges(make_geometry(scene));
    EXPECT_EQ(report.complex_triangle_count, kCount);
}

}  // namespace
}  // namespace surfelao
