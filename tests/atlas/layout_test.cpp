#include "atlas/layout.h"

#include "scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

/// A square in the plane z = 0 that lies on the page `page` of so many.
MapLayout layout_on(const Scene& scene, std::uint32_t page, std::uint32_t pages, bool blended)
{
    MapLayout layout{.size = {8, 8}, .pages = std::vector<UvSet>(pages), .is_blended = blended};
    for (std::uint32_t k = 0; k < pages; ++k) {
        for (const glm::dvec3 p : scene.positions)
            layout.pages[k].values.emplace_back(p.x, p.y);
        if (k != page)
            layout.pages[k].corners.assign(scene.triangles.size(), glm::uvec3(UvSet::kNone));
    }
    return layout;
}

TEST(Layout, PointLiesOnThePageOfItsTriangle)
{
    const Mesh mesh = make_mesh(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1));
    const SurfacePoint point{0, {0.25f, 0.5f}};
    const MapLayout tiles = layout_on(mesh.scene, 1, 3, false);
    const PagePlaces places = places_of(mesh, tiles, point);
    ASSERT_EQ(places.count, 1u);
    EXPECT_EQ(places.list[0].page, 1u);
    EXPECT_EQ(places.list[0].weight, 1.0f);
    EXPECT_EQ(places.list[0].uv, *uv_at(mesh.geometry, tiles.pages[1], point));
    EXPECT_EQ(places_of(mesh, layout_on(mesh.scene, 7, 3, false), point).count, 0u);
}

/// Normals interpolate from (0, 0, 1) to (1, 0, 0): pages weigh by the squares of x and z, each
/// less a quarter of their sum.
TEST(Layout, BlendedPagesWeighByTheSquaresOfTheNormal)
{
    Mesh mesh = make_mesh(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1));
    for (std::uint32_t v = 0; v < mesh.surface.normals.size(); ++v)
        mesh.surface.normals[v] =
            mesh.scene.positions[v].x > 0.5 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    MapLayout layout = layout_on(mesh.scene, 0, 3, true);
    layout.pages[1] = layout.pages[2] = layout.pages[0];
    std::vector<Map> maps;
    for (const float value : {0.9f, 0.1f, 0.3f})
        maps.emplace_back(8, 8, 1, value);
    for (std::uint32_t t = 0; t < 2; ++t) {
        const SurfacePoint point{t, {0.3f, 0.2f}};
        const PagePlaces places = places_of(mesh, layout, point);
        ASSERT_EQ(places.count, 3u);
        const double x = uv_at(mesh.geometry, layout.pages[0], point)->x;
        const double square = x * x / (x * x + (1 - x) * (1 - x));
        const double share = std::clamp((square - 0.25) / 0.5, 0.0, 1.0);
        EXPECT_NEAR(fetch_at(maps, places), share * 0.9 + (1 - share) * 0.3, 1e-6);
    }
}

}  // namespace
}  // namespace surfelao
