#include "bake/plot.h"

#include <gtest/gtest.h>

#include <regex>
#include <vector>

namespace surfelao {
namespace {

const Plot kPlot = {"error & time",
                    "seconds",
                    "error",
                    {{"masks", {{0.01, 0.1, "draft"}, {0.1, 0.01, "good"}, {1.0, 0.001, "best"}}},
                     {"Embree", {{0.4, 0.02, "4 rays"}}}}};

/// Places of the points, in the order of the drawing.
std::vector<std::pair<double, double>> points_of(const std::string& svg)
{
    const std::regex circle("cx=\"([0-9.]+)\" cy=\"([0-9.]+)\" fill=\"[^\"]*\"><title>");
    std::vector<std::pair<double, double>> points;
    for (std::sregex_iterator at(svg.begin(), svg.end(), circle), end; at != end; ++at)
        points.emplace_back(std::stod((*at)[1]), std::stod((*at)[2]));
    return points;
}

TEST(Plot, DecadesAreEquallyLongOnBothAxes)
{
    const auto points = points_of(svg_of(kPlot));
    ASSERT_EQ(points.size(), 4u);
    const auto [x, y] = points[0];
    EXPECT_NEAR(points[1].first - x, points[2].first - points[1].first, 0.2);
    EXPECT_NEAR(points[1].second - y, points[2].second - points[1].second, 0.2);
    EXPECT_GT(points[1].first, x);   // slower: to the right
    EXPECT_GT(points[1].second, y);  // more exact: further down
}

TEST(Plot, NamesLinesPointsAndAxesAndIsAFileToo)
{
    const std::string svg = svg_of(kPlot);
    for (const char* text : {">masks<", ">Embree<", ">draft<", ">good<", ">4 rays<", ">seconds<",
                             ">error<", ">error &amp; time<", ">0.01<", ">1<"})
        EXPECT_NE(svg.find(text), std::string::npos) << text;
    EXPECT_EQ(svg.find("xmlns"), std::string::npos);  // of the page
    EXPECT_NE(svg_file_of(kPlot).find("xmlns=\"http://www.w3.org/2000/svg\""), std::string::npos);
}

// One point has neither a width nor a height.
TEST(Plot, ASinglePointHasAPlace)
{
    const auto points = points_of(svg_of({"t", "x", "y", {{"masks", {{3.0, 0.02, "good"}}}}}));
    ASSERT_EQ(points.size(), 1u);
    EXPECT_GT(points[0].first, 60.0);
    EXPECT_LT(points[0].first, 640.0);
}

}  // namespace
}  // namespace surfelao
