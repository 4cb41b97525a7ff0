#include "bake/map_bake.h"

#include "atlas/tangents.h"
#include "bake/bent_space.h"
#include "bake/surface_error.h"
#include "laid_out.h"
#include "scenes.h"
#include "seen_of_wall.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfelao {
namespace {

constexpr double kWide = 20.0;

/// Wall and floor in three charts: the wall, the floor near to it, and the rest, turned by a
/// quarter; the seam lies across the slope of the occlusion. Corners lie on whole texels of a map
/// of 128, so that turns and shifts change no digit.
Spot wall_near_and_far(glm::dvec3 p, glm::dvec3 middle)
{
    const double y = p.y / kWide + 0.5;
    if (middle.x == 0.0)
        return {0, {(4.0 + 60.0 * p.z / kWide) / 128.0, (64.0 + 16.0 * y) / 128.0}};
    if (middle.x < 5.0)
        return {0, {(4.0 + 16.0 * y) / 128.0, (20.0 + 4.0 * p.x) / 128.0}};
    return {0, {(50.0 + 4.0 * (p.x - 5.0)) / 128.0, (8.0 + 16.0 * y) / 128.0}};
}

// What is shown along the floor goes over the seam as if there were none.
TEST(MapSeams, ShowTheProfileOfAWallOnBothSides)
{
    const Mesh mesh = make_mesh(scenes::wall_and_floor(kWide, 40));
    // off the grid of texels by other amounts on each side
    const MapLayout layout =
        laid_out(mesh.scene, {128, 128}, 1, [](glm::dvec3 p, glm::dvec3 middle) {
            const glm::dvec2 uv = wall_near_and_far(p, middle).uv;
            return Spot{0, middle.x > 5.0 ? 1.07 * uv + 0.003 : uv + 0.0025};
        });
    for (const auto& [engine, tolerance] :
         {std::pair(Engine::masks, 0.012), {Engine::rays, 0.004}}) {
        EngineSettings settings;
        settings.engine = engine;
        settings.rays = 4096;
        const MapBake bake = bake_map(mesh, layout, {.depth = MapDepth::whole}, settings, {});
        EXPECT_EQ(bake.smooth_seams, 80u);
        EXPECT_EQ(bake.seams, 160u);
        EXPECT_LT(bake.jump.rms, 0.0006);
        EXPECT_LT(bake.jump.most, 0.002);
        for (std::uint32_t t = 0; t < mesh.geometry.triangles.size(); ++t) {
            const SurfacePoint point{t, {0.3f, 0.4f}};
            const glm::uvec3 corners = mesh.geometry.triangles[t];
            const glm::dvec3 p = 0.3 * mesh.scene.positions[corners.x] +
                                 0.3 * mesh.scene.positions[corners.y] +
                                 0.4 * mesh.scene.positions[corners.z];
            if (p.x < 3.0 || p.x > 8.0 || std::abs(p.y) > 8.0)  // eight texels around the seam
                continue;
            EXPECT_NEAR(1.0 - fetch_at(bake.visibility, places_of(mesh, layout, point)),
                        seen_of_wall(p.x, kWide, kWide / 2 - p.y, kWide / 2 + p.y), tolerance)
                << p.x << " " << p.y;
        }
    }
}

TEST(MapSeams, AreTheSameWhereverChartsLie)
{
    // which texels are asked, and in which groups, hangs on the map's columns and rows
    constexpr float kSame = 0.009f;
    const Mesh mesh = make_mesh(scenes::wall_and_floor(kWide, 8));
    const auto baked = [&](const std::function<glm::dvec2(glm::dvec2)>& move) {
        const MapLayout layout =
            laid_out(mesh.scene, {128, 128}, 1, [&](glm::dvec3 p, glm::dvec3 middle) {
                return Spot{0, move(wall_near_and_far(p, middle).uv)};
            });
        return bake_map(mesh, layout, {.check = 0}, {}, {}).visibility[0];
    };
    const Map straight = baked([](glm::dvec2 uv) { return uv; });
    const Map shifted = baked([](glm::dvec2 uv) { return uv + glm::dvec2(11, 7) / 128.0; });
    const Map turned = baked([](glm::dvec2 uv) { return glm::dvec2(1.0 - uv.y, uv.x); });
    const Map mirrored = baked([](glm::dvec2 uv) { return glm::dvec2(uv.y, uv.x); });
    for (std::uint32_t y = 0; y < 110; ++y) {
        for (std::uint32_t x = 0; x < 110; ++x) {
            const float value = straight.values[straight.index(x, y)];
            const auto expect_same = [&](const Map& map, std::size_t texel) {
                EXPECT_NEAR(map.values[texel], value, kSame) << x << " " << y;
            };
            expect_same(shifted, shifted.index(x + 11, y + 7));
            expect_same(turned, turned.index(127 - y, x));
            expect_same(mirrored, mirrored.index(y, x));
        }
    }
}

TEST(MapSeams, LeaveAConvexBodyOpenAndAClosedRoomDark)
{
    EngineSettings rays;
    rays.engine = Engine::rays;
    const auto bake = [&](Scene scene) {
        const Mesh mesh = make_mesh(std::move(scene), {.source = NormalSource::flat});
        return bake_map(mesh, laid_out(mesh.scene, {96, 64}, 1, side_of_cube), {}, rays, {});
    };
    const MapBake box = bake(scenes::box(glm::dvec3(-1.0), glm::dvec3(1.0), 5));
    EXPECT_EQ(std::ranges::min(box.visibility[0].values), 1.0f);
    const MapBake room = bake(scenes::room(glm::dvec3(-1.0), glm::dvec3(1.0), 5));
    EXPECT_EQ(std::ranges::max(room.visibility[0].values), 0.0f);
    EXPECT_EQ(room.hidden, 0u);
}

// In tangent space the floor's two charts, of which one is turned, have frames of their own.
TEST(MapSeams, JoinBentNormalsOnlyWhereTheyAreInOneSpace)
{
    const Mesh mesh = make_mesh(scenes::wall_and_floor(kWide, 8));
    const MapLayout layout = laid_out(mesh.scene, {128, 128}, 1, wall_near_and_far);
    const auto baked = [&](BentSpace space, bool joins) {
        const MapSettings settings{.bent = bent_encoder(mesh, layout, space),
                                   .joins_bent = joins,
                                   .depth = MapDepth::whole,
                                   .check = 0};
        return bake_map(mesh, layout, settings, {}, {}).bent[0];
    };
    const auto at = [](const Map& map, const Texel& texel) {
        const float* value = &map.values[map.index(texel.x, texel.y)];
        return 2.0f * glm::vec3(value[0], value[1], value[2]) - 1.0f;
    };
    const Map tangent = baked(BentSpace::tangent, false);
    const Map world = baked(BentSpace::world, false), joined = baked(BentSpace::world, true);
    const Tangents tangents = make_tangents(mesh, layout.pages[0]);
    for (const Texel& texel :
         MapRaster(mesh.geometry, layout.pages[0], layout.size).texels(0, layout.size.height)) {
        const glm::vec3 held = to_tangent_space(mesh, tangents, texel.point, at(world, texel));
        EXPECT_LT(glm::distance(at(tangent, texel), held), 1e-4f) << texel.x << " " << texel.y;
    }
    EXPECT_NE(joined.values, world.values);
}

// A valley and its mirror image on the same texels.
TEST(MapSeams, HaveNoJumpWhereHalvesAreMirrored)
{
    const Mesh mesh = make_mesh(scenes::height_field(
        24, [](double x, double y) { return 1.2 * std::pow(x - 0.5, 2.0) + 0.2 * y * y; }));
    const MapLayout layout = laid_out(mesh.scene, {64, 64}, 1, [](glm::dvec3 p, glm::dvec3) {
        return Spot{0, {0.1 + 1.5 * std::abs(p.x - 0.5), 0.1 + 0.8 * p.y}};
    });
    const MapBake bake = bake_map(mesh, layout, {}, {}, {});
    EXPECT_GT(bake.overlapping, bake.covered * 9 / 10);
    EXPECT_LT(bake.spread, 0.005);
    EXPECT_EQ(bake.seams, 0u);
}

// Viewers fetch covered texels and the ring around them, which is filled, and no others.
TEST(MapSeams, AreFetchedFromCoveredTexelsAndTheRingAroundThem)
{
    const Mesh mesh = make_mesh(scenes::sphere({0, 0, 0}, 1.0, 9));
    const MapLayout layout = laid_out(mesh.scene, {90, 61}, 1, side_of_cube);
    Map covered(90, 61, 1);
    for (const Texel& texel : MapRaster(mesh.geometry, layout.pages[0], layout.size).texels(0, 61))
        for (const std::uint32_t y : {texel.y - 1, texel.y, texel.y + 1})
            for (const std::uint32_t x : {texel.x - 1, texel.x, texel.x + 1})
                covered.values[covered.index(x, y)] = 1.0f;
    for (const SurfacePoint& point : surface_points(mesh.geometry, 100'000)) {
        const PagePlaces places = places_of(mesh, layout, point);
        ASSERT_EQ(places.count, 1u);
        EXPECT_NEAR(fetch_at(std::span(&covered, 1), places), 1.0f, 1e-6f);
    }
}

}  // namespace
}  // namespace surfelao
