#include "surfels/edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

namespace surfelao {
namespace {

using Seen = std::tuple<std::uint32_t, std::uint32_t, Side, bool>;  // lower, upper, side, rises

std::vector<Seen> seen(const Edges& edges)
{
    std::vector<Seen> all;
    edges.for_each([&](std::uint32_t lower, std::span<const EdgeSide> sides) {
        for (const EdgeSide& side : sides) {
            all.emplace_back(lower, side.upper, side.side(), side.rises());
            EXPECT_EQ(side.triangle(), side.side() / 3);
        }
    });
    return all;
}

//  1---3      two triangles along 1-2, the second with vertices of its own (4 = 2, 5 = 1), and
//  | \ |      a third one that stands on the same edge and runs as the first does
//  0---2
Geometry wings()
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    scene.triangles = {{0, 2, 1}, {4, 3, 5}, {2, 1, 6}};
    return make_geometry(scene);
}

TEST(Edges, AreBetweenPositionsAndInOrder)
{
    EXPECT_EQ(seen(Edges(wings())), (std::vector<Seen>{{0, 1, 2, false},
                                                       {0, 2, 0, true},
                                                       {1, 2, 1, false},
                                                       {1, 2, 5, true},
                                                       {1, 2, 6, false},
                                                       {1, 3, 4, false},
                                                       {1, 6, 7, true},
                                                       {2, 3, 3, true},
                                                       {2, 6, 8, false}}));
}

TEST(Edges, LeaveOutWhatTheyAreTold)
{
    const std::vector<std::uint8_t> left_out = {1, 0, 1};
    EXPECT_EQ(seen(Edges(wings(), left_out)),
              (std::vector<Seen>{{1, 2, 5, true}, {1, 3, 4, false}, {2, 3, 3, true}}));
    EXPECT_TRUE(seen(Edges(Geometry())).empty());
}

TEST(Edges, CornersAroundAPositionAreThoseOfAllItsVertices)
{
    const Geometry geometry = wings();
    const Buckets<std::uint32_t> corners = corners_around(geometry.triangles, geometry.welded);
    EXPECT_TRUE(std::ranges::equal(corners[2], std::vector<std::uint32_t>{1, 3, 6}));
    EXPECT_TRUE(corners[4].empty()) << "its place is vertex 2";
}

}  // namespace
}  // namespace surfelao
