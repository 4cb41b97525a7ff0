#include "files/triangulate.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace surfelao {
namespace {

using Polygon = std::vector<glm::dvec3>;

std::vector<glm::uvec3> cut(const Polygon& polygon)
{
    std::vector<std::uint32_t> corners(polygon.size());
    std::iota(corners.begin(), corners.end(), 0u);
    std::vector<glm::uvec3> triangles;
    triangulate(polygon, corners, triangles);
    return triangles;
}

/// Vector area of the polygon: what the triangles' vector areas must sum to, however it is cut.
glm::dvec3 vector_area(const Polygon& polygon)
{
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < polygon.size(); ++i)
        sum += glm::cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    return 0.5 * sum;
}

/// n - 2 triangles whose areas, not only their signed areas, sum to the polygon's: no overlap, no
/// triangle outside, none turned over.
void expect_exact(const Polygon& polygon, const std::string& name)
{
    const std::vector<glm::uvec3> triangles = cut(polygon);
    ASSERT_EQ(triangles.size(), polygon.size() - 2) << name;
    glm::dvec3 vector_sum(0.0);
    double sum = 0.0;
    for (const glm::uvec3 t : triangles) {
        const glm::dvec3 area =
            0.5 * glm::cross(polygon[t.y] - polygon[t.x], polygon[t.z] - polygon[t.x]);
        vector_sum += area;
        sum += glm::length(area);
    }
    const double expected = glm::length(vector_area(polygon));
    EXPECT_NEAR(glm::length(vector_sum - vector_area(polygon)), 0.0, 1e-9 * expected) << name;
    EXPECT_NEAR(sum, expected, 1e-9 * expected) << name;
}

/// Each turned and moved some way, and starting at each corner.
void expect_exact_in_any_pose(const Polygon& polygon, const std::string& name)
{
    const glm::dvec3 axes[][3] = {
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},   {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
        {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},   {{0.6, 0.8, 0}, {-0.8, 0.6, 0}, {0, 0, 1}},
        {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, {{1, 2, 2}, {2, 1, -2}, {-2, 2, -1}}};
    for (const auto& frame : axes) {
        Polygon moved;
        for (const glm::dvec3& p : polygon)
            moved.push_back(frame[0] * p.x + frame[1] * p.y + frame[2] * p.z + glm::dvec3(7));
        for (std::size_t start = 0; start < std::min<std::size_t>(polygon.size(), 8); ++start) {
            expect_exact(moved, name + " from corner " + std::to_string(start));
            std::rotate(moved.begin(), moved.begin() + 1, moved.end());
        }
    }
}

Polygon star(int points)
{
    Polygon polygon;
    for (int i = 0; i < 2 * points; ++i) {
        const double angle = std::numbers::pi * i / points;
        const double radius = i % 2 == 0 ? 1.0 : 0.3;
        polygon.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    return polygon;
}

//  _   _   _
// | |_| |_| |   teeth
// |_________|
Polygon comb(int teeth)
{
    Polygon polygon{{0, 0, 0}, {2.0 * teeth - 1, 0, 0}};
    for (int i = teeth - 1; i >= 0; --i) {
        polygon.push_back({2.0 * i + 1, 5, 0});
        polygon.push_back({2.0 * i, 5, 0});
        if (i > 0) {
            polygon.push_back({2.0 * i, 1, 0});
            polygon.push_back({2.0 * i - 1, 1, 0});
        }
    }
    return polygon;
}

Polygon spiral(int corners)
{
    Polygon polygon;
    for (int i = 0; i < corners; ++i)
        polygon.push_back(
            {(2 + 0.2 * i) * std::cos(0.3 * i), (2 + 0.2 * i) * std::sin(0.3 * i), 0});
    for (int i = corners - 1; i >= 0; --i)
        polygon.push_back(
            {(1 + 0.2 * i) * std::cos(0.3 * i), (1 + 0.2 * i) * std::sin(0.3 * i), 0});
    return polygon;
}

TEST(Triangulate, ConvexPolygonsAreTheFanOfTheirFirstCorner)
{
    const Polygon hexagon{{2, 0, 0}, {1, 2, 0}, {-1, 2, 0}, {-2, 0, 0}, {-1, -2, 0}, {1, -2, 0}};
    EXPECT_EQ(cut(hexagon), (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}));
}

TEST(Triangulate, SimplePolygonsAreCoveredExactly)
{
    expect_exact_in_any_pose({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}}, "arrow");
    expect_exact_in_any_pose({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}},
                             "L");
    expect_exact_in_any_pose(star(5), "star");
    expect_exact_in_any_pose(star(64), "sun");
    expect_exact_in_any_pose(comb(20), "comb");
    expect_exact_in_any_pose(spiral(60), "spiral");
}

TEST(Triangulate, CollinearAndRepeatedCornersDoNotHurt)
{
    expect_exact_in_any_pose({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}},
                             "collinear");
    expect_exact_in_any_pose({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}, {0, 2, 0}},
                             "collinear and concave");
    expect_exact_in_any_pose({{0, 0, 0}, {4, 0, 0}, {4, 0, 0}, {1, 1, 0}, {1, 1, 0}, {0, 4, 0}},
                             "repeated");
}

// A square ring: the hole is reached over a bridge that is walked both ways.
//   3-----------2
//   |  7-----6  |
//   |  |     |  |
//   |  4-----5  |
//   0/----------1
TEST(Triangulate, AHoleOnABridgeStaysAHole)
{
    expect_exact_in_any_pose({{0, 0, 0},
                              {4, 0, 0},
                              {4, 4, 0},
                              {0, 4, 0},
                              {0, 0, 0},
                              {1, 1, 0},
                              {1, 3, 0},
                              {3, 3, 0},
                              {3, 1, 0},
                              {1, 1, 0}},
                             "ring");
}

TEST(Triangulate, SizeAndPlaceDoNotMatter)
{
    for (const double scale : {1e-30, 1e-6, 1e6, 1e30}) {
        Polygon polygon = comb(5);
        for (glm::dvec3& p : polygon)
            p *= scale;
        EXPECT_EQ(cut(polygon), cut(comb(5))) << scale;
    }
}

TEST(Triangulate, EveryPolygonGivesItsNumberOfTriangles)
{
    const Polygon line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1.5, 0, 0}};
    const Polygon point(7, glm::dvec3(3));
    const Polygon bow_tie{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}};
    Polygon pentagram;
    for (int i = 0; i < 5; ++i)
        pentagram.push_back(
            {std::cos(4 * std::numbers::pi * i / 5), std::sin(4 * std::numbers::pi * i / 5), 0});
    for (const Polygon& polygon : {line, point, bow_tie, pentagram}) {
        const std::vector<glm::uvec3> triangles = cut(polygon);
        EXPECT_EQ(triangles.size(), polygon.size() - 2);
        std::vector<bool> used(polygon.size(), false);
        for (const glm::uvec3 t : triangles)
            used[t.x] = used[t.y] = used[t.z] = true;
        EXPECT_EQ(std::ranges::count(used, true), static_cast<std::ptrdiff_t>(polygon.size()));
    }
}

/// A corridor that winds inwards with square corners: its ears come one after the other.
Polygon square_spiral(int corners)
{
    Polygon polygon;
    const auto add = [&](int i, double inwards) {
        const double radius = i + 4 - inwards;
        const double x[] = {radius, radius, -radius, -radius};
        polygon.push_back({x[i % 4], x[(i + 3) % 4], 0});
    };
    for (int i = 0; i < corners; ++i)
        add(i, 0.0);
    for (int i = corners - 1; i >= 0; --i)
        add(i, 0.5);
    return polygon;
}

/// All corners but two lie on one hollow curve, nearly in line with their neighbours.
Polygon hollow(int corners)
{
    Polygon polygon{{0, 0, 0}, {1, 0, 0}};
    for (int i = corners - 3; i >= 0; --i) {
        const double t = static_cast<double>(i) / (corners - 3);
        polygon.push_back({t, 0.2 + 3.2 * (t - 0.5) * (t - 0.5), 0});
    }
    return polygon;
}

/// A square with rows x rows square holes; a slit leads from the edge to each column of them.
Polygon sieve(int rows)
{
    Polygon polygon{{0, 0, 0}};
    for (int column = 0; column < rows; ++column) {
        const double x = 4 * column + 2;
        polygon.push_back({x, 0, 0});
        for (int row = 0; row < rows; ++row) {
            const double y = 4 * row + 2;
            polygon.insert(polygon.end(), {{x, y, 0}, {x - 1, y + 1, 0}, {x, y + 2, 0}});
        }
        for (int row = rows - 1; row >= 0; --row) {
            const double y = 4 * row + 2;
            if (row < rows - 1)
                polygon.push_back({x, y + 2, 0});
            polygon.insert(polygon.end(), {{x + 1, y + 1, 0}, {x, y, 0}});
        }
        polygon.push_back({x, 0, 0});
    }
    const double size = 4 * rows;
    polygon.insert(polygon.end(), {{size, 0, 0}, {size, size + 1, 0}, {0, size + 1, 0}});
    return polygon;
}

// Tens of thousands of corners, about every other one reflex. The spirals and the hollow were cut
// wrongly as long as every refused corner was asked again in every round.
TEST(Triangulate, HugePolygonsAreCoveredExactlyToo)
{
    expect_exact(star(20'000), "star");
    expect_exact(comb(10'000), "comb");
    expect_exact(spiral(20'000), "spiral");
    expect_exact(square_spiral(10'000), "square spiral");
    expect_exact(hollow(20'000), "hollow");
    expect_exact(sieve(60), "sieve");
}

// A face as large as any file's: every promise holds, and it does not take seconds.
TEST(Triangulate, TwoHundredThousandCornersSlow)
{
    expect_exact(star(100'000), "star");
    expect_exact(comb(50'000), "comb");
    expect_exact(square_spiral(100'000), "square spiral");
}

// Around and around one triangle, or to and fro between a few places: nothing is right, but it
// ends.
TEST(Triangulate, PolygonsThatCrossThemselvesAllOverEnd)
{
    Polygon around;
    for (int i = 0; i < 5'000; ++i)
        around.insert(around.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    EXPECT_EQ(cut(around).size(), around.size() - 2);

    Polygon to_and_fro;
    std::uint32_t place = 1;
    for (int i = 0; i < 20'000; ++i) {
        place = 1664525u * place + 1013904223u;  // Numerical Recipes' generator
        to_and_fro.push_back({place >> 28, place >> 24 & 15u, 0});
    }
    EXPECT_EQ(cut(to_and_fro).size(), to_and_fro.size() - 2);
}

}  // namespace
}  // namespace surfelao
