#include "tree/masks/tree.h"

#include "differences.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "surfels/geometry.h"
#include "tree/masks/kernel.h"
#include "tree/masks/masks.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace surfelao {
namespace {

using Triangle = std::array<glm::vec3, 3>;

std::uint32_t first_child(const MaskNode& node)
{
    return node.links & kMaskFirstChild;
}

/// The triangles below a node, as its leaves show them. Counts visits.
std::vector<Triangle> triangles_below(const MaskTree& tree, std::size_t index,
                                      std::vector<int>& visits)
{
    const MaskNode& node = tree.nodes.at(index);
    ++visits.at(index);
    if (first_child(node) == 0) {
        const glm::vec3 even = node.center + node.skew, odd = node.center - node.skew;
        const glm::vec3 a = even + node.axis_a, b = odd + node.axis_b, c = even - node.axis_a;
        EXPECT_LT(node.open_radius, 0.0f);
        if ((node.links & kMaskTriangle) != 0)
            return {{a, b, c}};
        return {{a, b, c}, {c, odd - node.axis_b, a}};
    }
    EXPECT_GE(node.open_radius, 0.0f);
    std::vector<Triangle> all = triangles_below(tree, first_child(node), visits);
    const std::vector<Triangle> more = triangles_below(tree, first_child(node) + 1, visits);
    all.insert(all.end(), more.begin(), more.end());

    // no corner is outside of radius and slab; both are rounded, hence the millionths of the scene
    const bool exact = node.open_radius == 0.0f;
    const glm::vec3 normal = glm::normalize(glm::cross(node.axis_a, node.axis_b));
    float farthest = 0.0f, highest = 0.0f;
    for (const Triangle& triangle : all) {
        for (const glm::vec3 corner : triangle) {
            farthest = std::max(farthest, glm::length(corner - node.center));
            highest = std::max(highest, std::abs(glm::dot(corner - node.center, normal)));
        }
    }
    EXPECT_LE(farthest, node.radius * (exact ? 1.0002f : 1.0f) + 2e-6f);
    EXPECT_LE(highest, node.thickness + 2e-6f);
    return all;
}

void expect_whole(const Geometry& geometry)
{
    const auto tree = build_mask_tree(geometry);
    const std::size_t count = geometry.triangles.size();
    std::vector<int> visits(tree->nodes.size(), 0);
    std::vector<Triangle> found = triangles_below(*tree, 0, visits);
    EXPECT_EQ(std::count(visits.begin(), visits.end(), 1),
              static_cast<std::ptrdiff_t>(visits.size()));
    ASSERT_EQ(found.size(), count);

    // the leaves are the triangles
    const auto center = [](const Triangle& t) { return (t[0] + t[1] + t[2]) / 3.0f; };
    std::vector<Triangle> expected;
    for (const glm::uvec3 t : geometry.triangles) {
        expected.push_back({kMaskFrame * geometry.positions[t.x],
                            kMaskFrame * geometry.positions[t.y],
                            kMaskFrame * geometry.positions[t.z]});
    }
    glm::dvec3 sum(0.0), expected_sum(0.0);
    double squares = 0.0, expected_squares = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 a(center(found[i])), b(center(expected[i]));
        sum += a;
        expected_sum += b;
        squares += glm::dot(a, a);
        expected_squares += glm::dot(b, b);
    }
    EXPECT_LT(glm::length(sum - expected_sum), 1e-6 * static_cast<double>(count));
    EXPECT_NEAR(squares, expected_squares, 1e-6 * static_cast<double>(count));
}

TEST(MaskTree, HoldsEveryTriangleOnceAndBoundsIt)
{
    expect_whole(make_geometry(scenes::bumpy_sphere(12)));
    using scenes::operator+;
    expect_whole(make_geometry(scenes::room({-3, -3, -3}, {3, 3, 3}, 7) +
                               scenes::sphere({0, 0, 0}, 1.0, 5)));
}

// Nothing parts them but halving.
TEST(MaskTree, TrianglesAtOnePlaceAreHalved)
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.triangles.assign(100, glm::uvec3(0, 1, 2));
    expect_whole(make_geometry(scene));
    scene.triangles.assign(1, glm::uvec3(0, 1, 2));
    expect_whole(make_geometry(scene));
}

TEST(MaskTree, IsEmptyWithoutTriangles)
{
    EXPECT_TRUE(build_mask_tree(make_geometry(Scene{}))->nodes.empty());
}

TEST(MaskTree, TessellatedRectangleIsOneRectangle)
{
    for (const int cells : {1, 3, 40}) {
        // ever smaller towards one side, so that the halves hold unlike numbers
        const Scene scene =
            scenes::moved(scenes::sheet({0, 0, 0}, {3, 0, 0}, {0, 1, 0}, cells), [](glm::dvec3 p) {
                p.x = p.x * p.x * p.x / 9.0;
                return p;
            });
        const auto tree = build_mask_tree(make_geometry(scene));
        const MaskNode& root = tree->nodes.front();
        EXPECT_LE(root.open_radius, 0.0f) << cells;
        EXPECT_NEAR(root.radius, 0.5f, 1e-4f) << cells;
        const float u = glm::length(root.axis_a - root.axis_b);
        const float v = glm::length(root.axis_a + root.axis_b);
        EXPECT_NEAR(std::max(u, v) / std::min(u, v), 3.0f, 1e-3f) << cells;
    }
}

// A link has 28 bits; such a tree itself would take 16 GiB.
std::ptrdiff_t exact_nodes(const Scene& scene)
{
    const auto tree = build_mask_tree(make_geometry(scene));
    return std::ranges::count_if(tree->nodes,
                                 [](const MaskNode& node) { return node.open_radius <= 0.0f; });
}

// A floor in the form of an L: cut along its cells it is made of a few rectangles.
TEST(MaskTree, WhatFacesOneWayIsCutAlongItsEdges)
{
    Scene floor = scenes::sheet({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 16);
    std::erase_if(floor.triangles, [&](glm::uvec3 t) {
        const glm::dvec3 p = floor.positions[t.x] + floor.positions[t.y] + floor.positions[t.z];
        return p.x > 3.0 && p.y > 3.0;
    });
    floor.parts[0].triangle_count = static_cast<std::uint32_t>(floor.triangles.size());
    const glm::dmat3 turn(
        glm::rotate(glm::dmat4(1.0), 0.6, glm::normalize(glm::dvec3(1.0, 2.0, 3.0))));
    const std::ptrdiff_t along_axes = exact_nodes(floor);
    EXPECT_EQ(exact_nodes(scenes::moved(floor, [&](glm::dvec3 p) { return turn * p; })),
              along_axes);
}

TEST(MaskTree, MoreLeavesThanLinksCanCountAreRefused)
{
    EXPECT_NO_THROW(check_mask_tiles(kMostMaskTiles, 2 * kMostMaskTiles));
    try {
        check_mask_tiles(kMostMaskTiles + 1, 200'000'000);
        ADD_FAILURE() << "nothing thrown";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "too many triangles for masks: 200000000, at most 134217728, a flat pair "
                     "counting as one");
    }
}

TEST(MaskTree, SameBytesForAnyNumberOfThreads)
{
    const Geometry geometry = make_geometry(scenes::bumpy_sphere(80));
    ASSERT_GT(geometry.triangles.size(), 65536u);  // the largest nodes are split by all threads
    const auto build = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return build_mask_tree(geometry);
    };
    const auto one = build(1);
    for (const std::size_t threads : {2, 5}) {
        const auto more = build(threads);
        EXPECT_TRUE(same_bytes(one->nodes, more->nodes));
    }
}

}  // namespace
}  // namespace surfelao
