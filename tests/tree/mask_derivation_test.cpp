// What docs/masks.md derives is what the engine does: its drawings are computed apart, in Python.
#include "scenes.h"
#include "surfels/geometry.h"
#include "tree/masks/constants.h"
#include "tree/masks/masks.h"
#include "tree/masks/tree.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace surfelao {
namespace {

/// Middle and two half diagonals of a rectangle in the plane.
using Rectangle = std::array<double, 6>;

/// The entry "rims nodes" of numbers.json.
std::vector<Rectangle> drawn_rectangles()
{
    std::ifstream file(SURFELAO_DRAWINGS "/numbers.json");
    std::string text((std::istreambuf_iterator<char>(file)), {});
    text.erase(0, text.find("\"rims nodes\""));
    text.erase(0, text.find('['));
    text.resize(std::min(text.size(), text.find("]\n ]")));
    for (char& c : text)
        c = c == '[' || c == ']' || c == ',' ? ' ' : c;
    std::vector<Rectangle> rectangles;
    const char* at = text.c_str();
    for (std::size_t i = 0;; ++i) {
        char* end = nullptr;
        const double value = std::strtod(at, &end);
        if (end == at)
            return rectangles;
        if (i % 6 == 0)
            rectangles.emplace_back();
        rectangles.back()[i % 6] = value;
        at = end;
    }
}

// Splits, moments, sides and rims: eight nodes of an elliptic sheet of 16 x 16 quadrilaterals.
TEST(MaskDerivation, RectanglesAreThoseOfTheDrawing)
{
    const Geometry geometry = make_geometry(
        scenes::moved(scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 16), [](glm::dvec3 p) {
            const double ring = std::max(std::abs(p.x), std::abs(p.y));
            const double length = std::hypot(p.x, p.y);
            const double scale = length > 0.0 ? ring / length : 0.0;
            return glm::dvec3(1.5 * p.x * scale, p.y * scale, 0.0);
        }));
    const auto tree = build_mask_tree(geometry);
    ASSERT_EQ(tree->nodes.size(), 511u);
    std::vector<std::uint32_t> level = {0};
    for (int depth = 0; depth < 3; ++depth) {
        std::vector<std::uint32_t> children;
        for (const std::uint32_t index : level) {
            const std::uint32_t first = tree->nodes[index].links & kMaskFirstChild;
            children.insert(children.end(), {first, first + 1});
        }
        level = children;
    }

    const std::vector<Rectangle> drawn = drawn_rectangles();
    ASSERT_EQ(drawn.size(), level.size());
    const auto turned_back = [&](glm::vec3 v) {
        return geometry.frame.diagonal * glm::dvec3(v * kMaskFrame);
    };
    for (const Rectangle& rectangle : drawn) {
        double least = 1e9;
        for (const std::uint32_t index : level) {
            const MaskNode& node = tree->nodes[index];
            const glm::dvec3 middle = turned_back(node.center) + geometry.frame.centre;
            const glm::dvec3 a = turned_back(node.axis_a), b = turned_back(node.axis_b);
            // the axes of moments have no sign of their own
            for (const auto& [u, v] :
                 {std::pair(a, b), std::pair(b, -a), std::pair(-a, -b), std::pair(-b, a)}) {
                const Rectangle shown = {middle.x, middle.y, u.x, u.y, v.x, v.y};
                double most = std::abs(middle.z);
                for (std::size_t i = 0; i < shown.size(); ++i)
                    most = std::max(most, std::abs(shown[i] - rectangle[i]));
                least = std::min(least, most);
            }
        }
        // numbers.json has five digits
        EXPECT_LT(least, 2e-4) << "at " << rectangle[0] << ", " << rectangle[1];
    }
}

}  // namespace
}  // namespace surfelao
