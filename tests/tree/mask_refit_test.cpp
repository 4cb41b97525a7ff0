#include "tree/masks/refit.h"

#include "scenes.h"
#include "surfels/placement.h"
#include "tree/masks/constants.h"
#include "tree/masks/forest.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace surfelao {
namespace {

float area_of(const MaskNode& node)
{
    return glm::length(glm::cross(node.axis_a, node.axis_b));
}

/// The largest difference between two nodes in what does not depend on where their corners begin.
float difference_of(const MaskNode& a, const MaskNode& b)
{
    return std::max({glm::distance(a.center, b.center), std::abs(a.radius - b.radius),
                     std::abs(a.open_radius - b.open_radius), std::abs(area_of(a) - area_of(b)),
                     std::abs(a.thickness - b.thickness)});
}

// What turns as one is the same to rounding, where it was cut included.
TEST(MaskRefit, ARigidFormHasTheNodesOfAPlacement)
{
    const Geometry ball = make_geometry(scenes::bumpy_sphere(24));
    Placement placement;
    placement.rotation =
        glm::dmat3(glm::rotate(glm::dmat4(1.0), 1.1, glm::normalize(glm::dvec3(1, 2, -1))));
    placement.translation = {0.02, -0.05, 0.01};
    const std::vector<std::uint32_t> body(ball.triangles.size(), 1);
    MaskForest forest(ball, split_bodies(ball, body));
    forest.place(1, placement);
    const MaskNode* placed_nodes = forest.nodes();

    MaskPlan plan;
    const RawVector<MaskNode> built = build_mask_nodes(ball, MaskPairs::found, plan);
    Geometry form = ball;
    for (glm::vec3& p : form.positions)
        p = placed({p, {}, 0.0f}, placement).position;
    const auto bent = refit_mask_nodes(plan, form);
    ASSERT_TRUE(bent.has_value());
    ASSERT_EQ(bent->size(), built.size());
    std::vector<float> differences;
    for (std::size_t i = 0; i < built.size(); ++i) {
        EXPECT_EQ((*bent)[i].links & kMaskFirstChild, placed_nodes[i].links & kMaskFirstChild);
        differences.push_back(difference_of((*bent)[i], placed_nodes[i]));
    }
    std::ranges::sort(differences);
    // of a patch as long as wide the axes are any: rounding chooses
    EXPECT_LT(differences[differences.size() * 99 / 100], 1e-6f);
}

TEST(MaskRefit, AtRestItIsWhatWasBuilt)
{
    const Geometry ball = make_geometry(scenes::bumpy_sphere(24));
    MaskPlan plan;
    const RawVector<MaskNode> built = build_mask_nodes(ball, MaskPairs::found, plan);
    const auto again = refit_mask_nodes(plan, ball);
    ASSERT_TRUE(again.has_value());
    for (std::size_t i = 0; i < built.size(); ++i)
        EXPECT_LT(difference_of((*again)[i], built[i]), 1e-6f);
}

TEST(MaskRefit, RefusesWhatHasComeApart)
{
    const Geometry sheet = make_geometry(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8));
    MaskPlan pairs, single;
    static_cast<void>(build_mask_nodes(sheet, MaskPairs::found, pairs));
    static_cast<void>(build_mask_nodes(sheet, MaskPairs::none, single));
    Geometry bent = sheet;
    for (glm::vec3& p : bent.positions)
        p.z = 0.2f * std::sin(9.0f * p.x) * std::sin(8.0f * p.y);
    EXPECT_FALSE(refit_mask_nodes(pairs, bent).has_value());
    EXPECT_TRUE(refit_mask_nodes(single, bent).has_value());
    Geometry shuffled = sheet;
    for (std::size_t v = 0; v < shuffled.positions.size(); ++v)
        shuffled.positions[v] = sheet.positions[37 * v % sheet.positions.size()];
    EXPECT_FALSE(refit_mask_nodes(single, shuffled).has_value());
}

}  // namespace
}  // namespace surfelao
