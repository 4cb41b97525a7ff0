#include "atlas/udim.h"

#include "scenes.h"

#include <gtest/gtest.h>

namespace surfelao {
namespace {

// A quad for each of some tiles; the last two lie on none.
TEST(Udim, PutsEachTriangleOnTheTileOfItsMiddle)
{
    const glm::dvec2 corners[] = {{0, 0}, {1, 0}, {0, -1}, {9, 0}, {2, -12}, {10, 0}, {0, 1}};
    Scene scene;
    UvSet uvs;
    for (const glm::dvec2 low : corners) {
        using scenes::operator+;
        const Scene quad = scenes::sheet({low.x, low.y, 0}, {1, 0, 0}, {0, 1, 0}, 1);
        scene = scene.positions.empty() ? quad : std::move(scene) + quad;
    }
    for (const glm::dvec3 p : scene.positions)
        uvs.values.emplace_back(p.x, p.y);
    const MapLayout layout = udim_layout(scene, uvs, {4, 4});
    EXPECT_EQ(layout.tiles, (std::vector<std::uint32_t>{1001, 1002, 1010, 1011, 1123}));
    ASSERT_EQ(layout.pages.size(), 5u);
    const std::size_t quad_on[] = {0, 1, 3, 2, 4};  // of each page
    for (std::size_t page = 0; page < 5; ++page) {
        const UvSet& set = layout.pages[page];
        ASSERT_EQ(set.corners.size(), scene.triangles.size());
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            for (int k = 0; k < 3; ++k) {
                if (t / 2 != quad_on[page]) {
                    EXPECT_EQ(set.corners[t][k], UvSet::kNone);
                    continue;
                }
                const glm::dvec2 uv = set.values[set.corners[t][k]];
                const glm::dvec3 p = scene.positions[scene.triangles[t][k]];
                EXPECT_EQ(uv.x, p.x - corners[quad_on[page]].x);
                EXPECT_EQ(uv.y, p.y - corners[quad_on[page]].y);
            }
        }
    }
}

}  // namespace
}  // namespace surfelao
