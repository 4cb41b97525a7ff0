#include "bake/high_to_low.h"

#include "bake/map_bake.h"
#include "scenes.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

namespace surfelao {
namespace {

/// A map over a sphere by longitude and height.
UvSet around(const Scene& scene)
{
    UvSet uvs;
    for (const glm::uvec3 triangle : scene.triangles) {
        glm::dvec2 corners[3];
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 p = glm::normalize(scene.positions[triangle[k]]);
            corners[k] = {std::atan2(p.y, p.x) / 6.283185307 + 0.5, 0.5 + 0.49 * p.z};
        }
        for (glm::dvec2& corner : corners)
            if (corner.x - corners[0].x > 0.5)
                corner.x -= 1.0;
            else if (corner.x - corners[0].x < -0.5)
                corner.x += 1.0;
        uvs.corners.emplace_back(static_cast<std::uint32_t>(uvs.values.size()) +
                                 glm::uvec3(0, 1, 2));
        for (const glm::dvec2 corner : corners)
            uvs.values.push_back(corner);
    }
    return uvs;
}

double height_at(glm::dvec3 p)
{
    return 1.0 + 0.05 * std::sin(9.0 * p.x) * std::sin(8.0 * p.y);
}

Mesh bumps(glm::dvec3 centre)
{
    Scene scene = scenes::sphere({0, 0, 0}, 1.0, 48);
    for (glm::dvec3& p : scene.positions)
        p = height_at(p) * p + centre;
    return make_mesh(std::move(scene));
}

std::vector<SurfacePoint> some_points(const Geometry& geometry)
{
    std::vector<SurfacePoint> points;
    for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t)
        for (const glm::vec2 at : {glm::vec2(0.3f, 0.3f), glm::vec2(0.05f, 0.9f)})
            points.push_back({t, at});
    return points;
}

glm::dvec3 in_world(const Frame& frame, glm::vec3 unit)
{
    return frame.centre + frame.diagonal * glm::dvec3(unit);
}

/// A plain sphere below bumps of a twentieth: every point of it meets the bumps, along its normal.
TEST(HighToLow, MeetsWhatLiesOverIt)
{
    const Mesh low = make_mesh(scenes::sphere({3, 0, 0}, 1.0, 8));
    const Mesh high = bumps({3, 0, 0});
    const HighDetail detail(low, high, 0.15);
    std::uint64_t misses = 0;
    const std::vector<SurfacePoint> points = some_points(low.geometry);
    const std::vector<Receiver> met = detail.receivers(points, {}, &misses);
    EXPECT_EQ(misses, 0u);
    const std::vector<Receiver> from = receivers_at(low.geometry, low.surface, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 place = in_world(high.geometry.frame, met[i].position);
        const glm::dvec3 start = in_world(low.geometry.frame, from[i].position);
        const glm::dvec3 p = glm::normalize(place - glm::dvec3(3, 0, 0));
        EXPECT_NEAR(glm::distance(place, {3, 0, 0}), height_at(p), 0.004);
        EXPECT_LT(glm::length(glm::cross(place - start, glm::dvec3(from[i].normal))), 2e-4);
        EXPECT_GT(glm::dot(met[i].normal, from[i].normal), 0.5f);
    }
}

/// Two sheets above each other, the upper one without a partner: by name the lower one is met.
TEST(HighToLow, MatchesPartsByName)
{
    const auto sheet = [](double z, const char* name) {
        Scene scene = scenes::sheet({0, 0, z}, {1, 0, 0}, {0, 1, 0}, 2);
        scene.parts[0].name = name;
        return scene;
    };
    const std::vector<Scene> sheets = {sheet(0.1, "Lid_high"), sheet(0.05, "Body_HIGH_2")};
    const Mesh high = make_mesh(join(sheets));
    for (const auto& [name, height] :
         {std::pair("body_low", 0.05), {"lid_low", 0.1}, {"other_low", 0.1}, {"body", 0.1}}) {
        const Mesh low = make_mesh(sheet(0.0, name));
        const HighDetail detail(low, high, 0.2);
        EXPECT_EQ(detail.matched_parts(),
                  std::string(name) == "other_low" || std::string(name) == "body" ? 0u : 1u);
        for (const Receiver& receiver : detail.receivers(some_points(low.geometry), {}))
            EXPECT_NEAR(in_world(high.geometry.frame, receiver.position).z, height, 1e-3) << name;
    }
}

/// Beyond the high sheet nothing is met: the low point itself is asked. Back sides are passed over
/// where a front lies behind them, else turned round.
TEST(HighToLow, CountsMissesAndTurnsBackSides)
{
    const Mesh low = make_mesh(scenes::sheet({0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 2));
    const auto up = scenes::sheet({0, 0, 0.05}, {1, 0, 0}, {0, 1, 0}, 2);
    const auto down = scenes::sheet({0, 0, 0.1}, {0, 1, 0}, {1, 0, 0}, 2);
    for (const bool with_front : {false, true}) {
        std::vector<Scene> scenes = {down};
        if (with_front)
            scenes.push_back(up);
        const Mesh high = make_mesh(join(scenes));
        const HighDetail detail(low, high, 0.2);
        std::uint64_t misses = 0;
        const std::vector<SurfacePoint> points = some_points(low.geometry);
        const std::vector<Receiver> met = detail.receivers(points, 0.001f, &misses);
        std::uint64_t beyond = 0;
        for (const Receiver& receiver : met) {
            const glm::dvec3 place = in_world(high.geometry.frame, receiver.position);
            EXPECT_GT(receiver.normal.z, 0.99f);
            beyond += place.x > 1.0 ? 1 : 0;
            EXPECT_NEAR(place.z, place.x > 1.0 ? 0.0 : with_front ? 0.05 : 0.1, 0.003);
            EXPECT_GT(place.z, place.x > 1.0 ? 0.0 : with_front ? 0.05 : 0.1);
        }
        EXPECT_EQ(misses, beyond);
        EXPECT_GT(misses, 0u);
    }
    EXPECT_THROW(HighDetail(low, low, 0.0), SettingsError);
}

/// The map of a bumpy sphere on a plain one is true where the bumps are seen: its own statement,
/// traced at the high surface, holds.
TEST(HighToLow, MapIsThatOfTheHighSurface)
{
    Scene plain = scenes::sphere({0, 0, 0}, 1.0, 16);
    plain.uvs.push_back(around(plain));
    const Mesh low = make_mesh(std::move(plain));
    const Mesh high = bumps({0, 0, 0});
    const HighDetail detail(low, high, 0.15);
    EngineSettings engine;
    const MapBake bake = bake_map(low, {.size = {256, 128}, .pages = {low.scene.uvs[0]}},
                                  {.check = 1000}, engine, {}, {}, &detail);
    EXPECT_EQ(bake.misses, 0u);
    EXPECT_GT(bake.mean_occlusion, 0.002);
    EXPECT_LT(bake.error->rmse, 0.002);
    const MapBake alone =
        bake_map(low, {.size = {256, 128}, .pages = {low.scene.uvs[0]}}, {}, engine, {});
    EXPECT_LT(alone.mean_occlusion, 0.0002);
}

}  // namespace
}  // namespace surfelao
