#include "atlas/layout_facts.h"

#include "scenes.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

/// A sheet of 2 x 1 units in two squares of two triangles each, spread over the whole map; the
/// right one moved away by `gap`.
MapLayout two_squares(const Scene& scene, double gap)
{
    MapLayout layout{.size = {64, 32}, .pages = std::vector<UvSet>(1)};
    UvSet& page = layout.pages[0];
    for (const glm::uvec3 triangle : scene.triangles) {
        const double middle = (scene.positions[triangle.x].x + scene.positions[triangle.y].x +
                               scene.positions[triangle.z].x) /
                              3.0;
        for (int k = 0; k < 3; ++k)
            page.values.emplace_back(scene.positions[triangle[k]].x / 2 + (middle > 1 ? gap : 0.0),
                                     scene.positions[triangle[k]].y);
        const auto last = static_cast<std::uint32_t>(page.values.size());
        page.corners.emplace_back(last - 3, last - 2, last - 1);
    }
    return layout;
}

Mesh two_square_mesh()
{
    using namespace scenes;
    return make_mesh(sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1) +
                     sheet({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1));
}

// Their vertices differ at the edge where they meet: the place counts.
TEST(LayoutFacts, ChartsAreConnectedOnTheSurfaceAndOnThePage)
{
    const Mesh mesh = two_square_mesh();
    EXPECT_EQ(facts_of(mesh, two_squares(mesh.scene, 0.0)).chart_count, 1u);
    const LayoutFacts cut = facts_of(mesh, two_squares(mesh.scene, 0.25));
    EXPECT_EQ(cut.chart_count, 2u);
    EXPECT_EQ(cut.charts[0], (std::vector<std::uint32_t>{0, 0, 1, 1}));
    MapLayout pages = two_squares(mesh.scene, 0.0);
    pages.pages.push_back(pages.pages[0]);
    pages.pages[0].corners[3] = pages.pages[1].corners[0] = glm::uvec3(UvSet::kNone);
    const LayoutFacts facts = facts_of(mesh, pages);
    constexpr std::uint32_t kNone = LayoutFacts::kNone;
    EXPECT_EQ(facts.charts[0], (std::vector<std::uint32_t>{0, 0, 0, kNone}));
    EXPECT_EQ(facts.charts[1], (std::vector<std::uint32_t>{kNone, 1, 1, 1}));
    EXPECT_EQ(facts.densities[0][3], 0.0f);
}

TEST(LayoutFacts, DensityIsInTexelsPerUnitOfTheFile)
{
    const Mesh mesh = two_square_mesh();
    MapLayout layout = two_squares(mesh.scene, 0.0);
    for (int i = 0; i < 3; ++i)  // a triangle of half the size, so of a quarter of the area
        layout.pages[0].values[static_cast<std::size_t>(i)] *= 0.5;
    const LayoutFacts facts = facts_of(mesh, layout);
    EXPECT_NEAR(facts.densities[0][0], 16.0f, 1e-3f);
    EXPECT_NEAR(facts.densities[0][1], 32.0f, 1e-3f);
    EXPECT_NEAR(facts.median_density, 32.0f, 1e-3f);
}

}  // namespace
}  // namespace surfelao
