#include "reference/rays.h"

#include "differences.h"
#include "surfels/errors.h"
#include "tests/vertex_receivers.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace surfelao {
namespace {

constexpr glm::vec3 kUp{0, 0, 1};
constexpr std::uint32_t kRays = 4096;

/// Points of a (0,2)-net miss an area by what the cells on its rim get wrong: about sqrt(n) cells
/// of 1/n, each off by a random part of itself, so n^-3/4 RMS. Five times that for tests of one
/// value.
double tolerance(std::uint32_t rays)
{
    return 5.0 * std::pow(rays, -0.75);
}

/// A surface z = height(u, v) and the like: a grid over [0, 1]^2.
Scene grid(int cells, const std::function<glm::dvec3(double, double)>& point)
{
    Scene scene;
    for (int y = 0; y <= cells; ++y) {
        for (int x = 0; x <= cells; ++x)
            scene.positions.push_back(point(double(x) / cells, double(y) / cells));
    }
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (cells + 1) + x); };
    for (int y = 0; y < cells; ++y) {
        for (int x = 0; x < cells; ++x) {
            scene.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
            scene.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
        }
    }
    return scene;
}

/// A disk of radius r at height h over the origin.
Scene disk(double radius, double height)
{
    return grid(96, [=](double u, double v) {
        const double a = 2.0 * std::numbers::pi * u;
        return glm::dvec3(v * radius * std::cos(a), v * radius * std::sin(a), height);
    });
}

Scene box()
{
    Scene scene;
    for (unsigned i = 0; i < 8; ++i)
        scene.positions.push_back({i & 1, i >> 1 & 1, i >> 2 & 1});
    scene.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return scene;
}

/// What one receiver at a world position sees.
Occlusion look(const Scene& scene, glm::dvec3 position, glm::vec3 normal,
               std::uint32_t rays = kRays)
{
    const Geometry geometry = make_geometry(scene);
    const Receiver receiver{glm::vec3((position - geometry.frame.centre) / geometry.frame.diagonal),
                            normal};
    const RayScene ray_scene(geometry, RayScene::Build::robust);
    RayOptions options;
    options.rays = rays;
    return trace_occlusion(ray_scene, {&receiver, 1}, options)[0];
}

std::vector<Occlusion> at_vertices(const Scene& scene, const RayOptions& options = {})
{
    const Geometry geometry = make_geometry(scene);
    return trace_occlusion(RayScene(geometry, RayScene::Build::robust), vertex_receivers(geometry),
                           options);
}

/// A bumpy sheet: every vertex is partly occluded.
Scene hills()
{
    return grid(24, [](double u, double v) {
        return glm::dvec3(u, v, 0.1 * std::sin(20 * u) * std::cos(17 * v));
    });
}

// The whole half of the hemisphere on the wall's side is closed.
TEST(Rays, AtTheFootOfAnEndlessWallHalfIsClosed)
{
    const Scene wall =
        grid(2, [](double u, double v) { return glm::dvec3(0, (2 * u - 1) * 1e3, v * 1e3); });
    const Occlusion o = look(wall, {0.01, 0, 0.0}, kUp);
    EXPECT_NEAR(o.occlusion, 0.5, tolerance(kRays));
    // the open quarter-space's cosine-weighted mean direction: (4/(3 pi), 0, 2/3) / 2
    const glm::vec3 expected =
        glm::normalize(glm::vec3(4 / (3 * std::numbers::pi_v<float>), 0, 2.0f / 3));
    EXPECT_GT(glm::dot(o.bent_normal, expected), std::cos(0.01f));
}

TEST(Rays, BothSidesOfASurfaceOcclude)
{
    Scene flipped = disk(1, 1);
    for (glm::uvec3& triangle : flipped.triangles)
        std::swap(triangle.x, triangle.y);
    EXPECT_EQ(look(flipped, {0, 0, 0}, kUp).occlusion, look(disk(1, 1), {0, 0, 0}, kUp).occlusion);
}

TEST(Rays, CoincidentSheetsCountOnce)
{
    Scene twice = disk(1, 1);
    const std::vector<glm::uvec3> triangles = twice.triangles;
    twice.triangles.insert(twice.triangles.end(), triangles.begin(), triangles.end());
    EXPECT_EQ(look(twice, {0, 0, 0}, kUp).occlusion, look(disk(1, 1), {0, 0, 0}, kUp).occlusion);
}

TEST(Rays, NoiseFallsFasterThanWithRandomRays)
{
    const Scene scene = hills();
    const std::vector<Occlusion> truth = at_vertices(scene, {.rays = 16384, .seed = 9});
    double last = 1.0;
    for (std::uint32_t rays : {1u, 4u, 16u, 64u, 256u, 1024u}) {
        const double error = rms_difference(at_vertices(scene, {.rays = rays}), truth);
        EXPECT_LT(error, 0.5 * last) << rays << " rays";  // random rays would halve it at best
        last = error;
    }
    EXPECT_LT(last, std::pow(1024, -0.73));
}

TEST(Rays, CountsThatFillNoPacketAreAsRight)
{
    for (std::uint32_t rays : {2u, 3u, 7u, 15u, 17u, 100u, 1000u}) {
        EXPECT_EQ(look(box(), glm::dvec3(0.5), kUp, rays).occlusion, 1.0f) << rays;
        EXPECT_NEAR(look(disk(1, 1), {0, 0, 0}, kUp, rays).occlusion, 0.5,
                    4 * std::sqrt(0.25 / rays))
            << rays;
    }
}

TEST(Rays, SameBytesForAnyNumberOfThreads)
{
    const Scene scene = hills();
    for (std::uint32_t rays : {3u, 40u}) {
        for (Falloff falloff : {Falloff::none, Falloff::smooth}) {
            RayOptions options;
            options.rays = rays;
            options.definition.falloff = falloff;
            options.definition.max_distance = 0.5f;
            std::vector<std::vector<Occlusion>> results;
            for (std::size_t threads : {1u, 2u, 5u}) {
                const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                                threads);
                results.push_back(at_vertices(scene, options));
            }
            EXPECT_TRUE(same_bytes(results[0], results[1]));
            EXPECT_TRUE(same_bytes(results[0], results[2]));
        }
    }
}

TEST(Rays, FastAndRobustAndAvx2AgreeWithinAFewRays)
{
    const Geometry geometry = make_geometry(hills());
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    const auto trace = [&](RayScene::Build build, RayScene::Isa isa) {
        return trace_occlusion(RayScene(geometry, build, isa), receivers, {});
    };
    const auto robust = trace(RayScene::Build::robust, RayScene::Isa::best);
    EXPECT_LT(rms_difference(trace(RayScene::Build::fast, RayScene::Isa::best), robust), 1e-3);
    EXPECT_LT(rms_difference(trace(RayScene::Build::fast, RayScene::Isa::avx2), robust), 1e-3);
}

TEST(Rays, ScaleAndOffsetDoNotMatter)
{
    const std::vector<Occlusion> plain = at_vertices(hills());
    for (double scale : {1e-6, 1e6}) {
        Scene scene = hills();
        for (glm::dvec3& p : scene.positions)
            p = p * scale + glm::dvec3(1e3 * scale);
        // the frame's rounding moves a few rays of 256 across an edge
        EXPECT_LT(rms_difference(at_vertices(scene), plain), 1e-3) << "scale " << scale;
    }
}

TEST(Rays, NoTrianglesMeansOpenAndNoNormalMeansZero)
{
    Scene scene;
    scene.positions.assign(3, {7, 7, 7});
    scene.triangles = {{0, 1, 2}};
    for (std::uint32_t rays : {4u, 64u}) {
        for (const Occlusion& o : at_vertices(scene, {.rays = rays})) {
            EXPECT_EQ(o.occlusion, 0.0f);
            EXPECT_EQ(o.bent_normal, glm::vec3(0.0f));
        }
    }
    EXPECT_EQ(look(scene, {0, 0, 0}, kUp).occlusion, 0.0f);
    EXPECT_TRUE(
        trace_occlusion(RayScene(make_geometry(scene), RayScene::Build::fast), {}, {}).empty());
}

TEST(Rays, BadOptionsAreRefused)
{
    const Geometry geometry = make_geometry(hills());
    const RayScene scene(geometry, RayScene::Build::fast);
    for (const std::uint32_t rays : {0u, kMostRays + 1})
        EXPECT_THROW(static_cast<void>(trace_occlusion(scene, {}, {.rays = rays})), SettingsError);
    EXPECT_THROW(
        static_cast<void>(trace_occlusion(scene, {}, {.definition = {.max_distance = -1.0f}})),
        SettingsError);
}

}  // namespace
}  // namespace surfelao
