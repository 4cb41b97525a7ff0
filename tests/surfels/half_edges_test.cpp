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

/// As many sides with a neighbour as inner edges have sides; all mutual, over the same edge,
/// turned.
std::uint64_t inner_sides(const Scene& scene)
{
    const Geometry geometry = make_geometry(scene);
    const std::vector<Neighbours> neighbours = neighbours_of(geometry);
    std::uint64_t sides = 0;
    for (std::uint32_t t = 0; t < neighbours.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t other = neighbours[t][static_cast<std::size_t>(k)];
            if (other == kNoTriangle)
                continue;
            ++sides;
            const auto place = [&](std::uint32_t triangle, int corner) {
                return geometry.welded[geometry.triangles[triangle][corner % 3]];
            };
            int back = 0;
            for (int j = 0; j < 3; ++j)
                back += neighbours[other][static_cast<std::size_t>(j)] == t &&
                                place(other, j) == place(t, k + 1) &&
                                place(other, j + 1) == place(t, k)
                            ? 1
                            : 0;
            EXPECT_EQ(back, 1) << "triangle " << t << ", side " << k;
        }
    }
    return sides;
}

TEST(HalfEdges, NeighboursAreMutual)
{
    const std::uint64_t all = 3 * 2 * kAround * kAcross;
    Scene scene = torus();
    EXPECT_EQ(inner_sides(scene), all);

    // the same once more, and once turned: sheets of their own
    const std::size_t single = scene.triangles.size();
    for (std::size_t t = 0; t < 2 * single; ++t) {
        const glm::uvec3 c = scene.triangles[t % single];
        scene.triangles.push_back(t < single ? c : glm::uvec3(c.x, c.z, c.y));
    }
    EXPECT_EQ(inner_sides(scene), 3 * all);

    scene = torus();
    scene.triangles.pop_back();
    EXPECT_EQ(inner_sides(scene), all - 6) << "three sides and what was across them";

    Scene third;  // a third face at an edge has none across it
    third.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    third.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
    EXPECT_EQ(inner_sides(third), 2u);
}

// A hub is several vertices; where one ends and the next begins, nobody is across.
TEST(HalfEdges, LargeFansKeepTheirNeighbours)
{
    constexpr std::uint32_t kSides = 2000;
    Scene disc;
    disc.positions.push_back({0, 0, 0});
    for (std::uint32_t i = 0; i < kSides; ++i) {
        const double round = 2 * std::numbers::pi * i / kSides;
        disc.positions.push_back({std::cos(round), std::sin(round), 0});
        disc.triangles.push_back({0, 1 + i, 1 + (i + 1) % kSides});
    }
    EXPECT_EQ(inner_sides(disc), 2 * (kSides - (kSides + kLargestFan - 1) / kLargestFan));
}

}  // namespace
}  // namespace surfelao
