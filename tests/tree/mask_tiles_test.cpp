#include "tree/masks/tiles.h"

#include "scenes.h"
#include "surfels/geometry.h"
#include "surfels/receiver.h"
#include "tree/masks/masks.h"
#include "tree/masks/tree.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

RawVector<MaskTile> tiles(const Geometry& geometry)
{
    std::vector<glm::vec3> normals;
    for (const glm::uvec3 t : geometry.triangles) {
        const glm::vec3 a = geometry.positions[t.x];
        normals.push_back(
            glm::normalize(glm::cross(geometry.positions[t.y] - a, geometry.positions[t.z] - a)));
    }
    return tiles_of(geometry, normals);
}

/// How many pairs; checks that all triangles are there once and say what their tile says.
std::size_t pair_count(const Scene& scene)
{
    const Geometry geometry = make_geometry(scene);
    std::vector<int> found(geometry.triangles.size(), 0);
    std::size_t pairs = 0;
    // from its least corner on
    const auto turned = [](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        return a < b && a < c ? glm::uvec3(a, b, c)
                              : (b < c ? glm::uvec3(b, c, a) : glm::uvec3(c, a, b));
    };
    const auto expect = [&](std::uint32_t triangle, std::uint32_t a, std::uint32_t b,
                            std::uint32_t c) {
        ++found[triangle];
        const glm::uvec3 v = geometry.triangles[triangle];
        const auto at = [&](std::uint32_t vertex) { return geometry.welded[vertex]; };
        EXPECT_EQ(turned(at(v.x), at(v.y), at(v.z)), turned(at(a), at(b), at(c)));
    };
    for (const auto& [v, triangles] : tiles(geometry)) {
        expect(triangles[0], v.x, v.y, v.z);
        if (triangles[0] == triangles[1]) {
            EXPECT_EQ(v.z, v.w);
        } else {
            expect(triangles[1], v.z, v.w, v.x);
            ++pairs;
        }
    }
    EXPECT_EQ(std::count(found.begin(), found.end(), 1), static_cast<std::ptrdiff_t>(found.size()));
    return pairs;
}

/// a b c and c d a.
Scene two(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d)
{
    return scenes::triangle(a, b, c) + scenes::triangle(c, d, a);
}

TEST(MaskTiles, AnyConvexFlatQuadrilateralIsOne)
{
    EXPECT_EQ(pair_count(two({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0})), 1u);
    EXPECT_EQ(pair_count(two({0, 0, 0}, {4, 0, 1}, {3, 1, 1}, {1, 1, 0.5})), 1u);  // trapezoid
    EXPECT_EQ(pair_count(two({0, 0, 0}, {3, 0, 0}, {4, 1, 0}, {0.1, 0.5, 0})), 1u);
    EXPECT_EQ(pair_count(two({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0})), 0u);  // no area
    // two halves of a triangle
    EXPECT_EQ(pair_count(two({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0})), 1u);
}

TEST(MaskTiles, BentHollowAndUnlikePairsStayApart)
{
    EXPECT_EQ(pair_count(two({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.01})), 0u);
    EXPECT_EQ(pair_count(two({0, 0, 0}, {2, -1, 0}, {0.5, 0, 0}, {2, 1, 0})), 0u);  // folded over
    // darts
    EXPECT_EQ(pair_count(two({0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0})), 0u);
    EXPECT_EQ(pair_count(two({0, 0, 0}, {1, -1, 0}, {0, 1, 0}, {-1, -1, 0})), 0u);
    const Scene half = scenes::triangle({0, 0, 0}, {1, 0, 0}, {1, 1, 0});
    EXPECT_EQ(pair_count(half + scenes::triangle({0, 0, 0}, {0, 1, 0}, {1, 1, 0})), 0u);
    EXPECT_EQ(pair_count(half + scenes::triangle({0, 0, 0.1}, {1, 1, 0.1}, {0, 1, 0.1})), 0u);
}

/// A cone's mantle between two circles.
Scene mantle(int slices)
{
    return scenes::grid(slices, 1, [&](double s, double t) {
        const double angle = 2.0 * std::numbers::pi * s;
        const double radius = 2.0 - t;
        return glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), 3.0 * t);
    });
}

// Whatever the order of the triangles.
TEST(MaskTiles, TrapezoidsOfAConeArePairs)
{
    Scene scene = mantle(40);
    EXPECT_EQ(pair_count(scene), 40u);
    std::vector<glm::uvec3> scattered;
    for (std::size_t i = 0; i < 80; ++i)
        scattered.push_back(scene.triangles[i * 37 % 80]);
    scene.triangles = scattered;
    EXPECT_EQ(pair_count(scene), 40u);
    EXPECT_EQ(build_mask_tree(make_geometry(scene))->nodes.size(), 79u);
}

// Pairs are exact: at any quality a cone covers what its triangles cover, sampled and seen from
// everywhere around, or from inside.
TEST(MaskTiles, TrapezoidsCoverWhatTheirTrianglesCover)
{
    const Geometry geometry = make_geometry(mantle(6));
    Scene bent = mantle(6);
    // too little to be seen, too much for a pair
    for (std::size_t i = 0; i < bent.positions.size(); i += 2)
        bent.positions[i].z += 0.02;
    const Geometry apart = make_geometry(bent);
    const auto pairs = build_mask_tree(geometry), triangles = build_mask_tree(apart);
    ASSERT_EQ(pairs->nodes.size(), 11u);
    ASSERT_EQ(triangles->nodes.size(), 23u);
    std::vector<Receiver> receivers;
    for (int i = 0; i < 200; ++i) {
        const float angle = 2.4f * static_cast<float>(i);
        const float height = static_cast<float>(i) / 200.0f - 0.5f;
        const glm::vec3 at(0.9f * height * std::cos(angle), 0.9f * height * std::sin(angle),
                           height);
        receivers.push_back({at, glm::normalize(glm::vec3(-at.y, at.x, 0.1f) - at)});
    }
    const auto draft = solve_masks(*pairs, receivers, {.quality = MaskOptions::kDraft});
    const auto exact = solve_masks(*triangles, receivers, {.exact = true});
    double squares = 0.0;
    for (std::size_t i = 0; i < receivers.size(); ++i)
        squares += std::pow(draft[i].occlusion - exact[i].occlusion, 2);
    EXPECT_LT(std::sqrt(squares / 200.0), 0.004);
}

TEST(MaskTiles, NoTrianglesNoTiles)
{
    EXPECT_EQ(pair_count(Scene{}), 0u);
}

}  // namespace
}  // namespace surfelao
