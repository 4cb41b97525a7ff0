#include "tests/random.h"
#include "tests/scenes.h"
#include "tests/stability/cases.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace surfelao::stability {
namespace {

using namespace scenes;

World nothing_occludes(const Scene& scene)
{
    return with_constant(at_vertices(scene), 0.0);
}

/// A sphere that is occluded by a sheet, for what must leave it as it is.
Scene ball_under_sheet()
{
    Scene scene;
    scene += sphere({0, 0, 0}, 0.5, 8);
    scene += sheet({-0.7, -0.7, 0.75}, {0, 1.4, 0}, {1.4, 0, 0}, 6);
    return scene;
}

/// `count` points that no triangle with area uses, collinear in threes if `collinear`.
void add_flat_triangles(Scene& scene, int count, bool collinear)
{
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 a(0.01 * i, 0.02 * i, 0.03), step(0.001, 0.002, 0.003);
        scene += triangle(a, collinear ? a + step : a, collinear ? a + 2.5 * step : a);
    }
}

}  // namespace

// long: a table
void add_degenerate_cases(std::vector<Case>& cases)
{
    const auto add = [&](const std::string& name, const std::function<World()>& make,
                         const std::string& excused = {}) {
        cases.push_back({"degenerate", name, make, excused});
    };
    add("one triangle", [] {
        Scene scene;
        scene += triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        return nothing_occludes(scene);
    });
    add("one needle 1 : 1e+06", [] {
        Scene scene;
        scene += triangle({0, 0, 0}, {1, 0, 0}, {0.5, 1e-6, 0});
        return nothing_occludes(scene);
    });
    add("one triangle and its back", [] {
        Scene scene;
        scene += triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        scene.triangles.push_back({0, 2, 1});
        return nothing_occludes(scene);
    });
    add(
        "two triangles face to face",
        [] {
            Scene scene;
            const glm::dvec3 lift(0, 0, 0.4);
            const Polygon low{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
            const Polygon high{lift, glm::dvec3(0, 1, 0) + lift, glm::dvec3(1, 0, 0) + lift};
            scene += triangle(low[0], low[1], low[2]);
            scene += triangle(high[0], high[1], high[2]);
            return with_polygons(at_vertices(scene), {low, high});
        },
        kCoarse);
    add("all vertices equal", [] {
        Scene scene;
        scene.positions.assign(300, {3, 4, 5});
        for (std::uint32_t i = 0; i < 100; ++i)
            scene.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        return nothing_occludes(scene);
    });
    add("all vertices on one line", [] {
        Scene scene;
        add_flat_triangles(scene, 100, true);
        return nothing_occludes(scene);
    });
    add("triangles that are points and lines beside a ball", [] {
        Scene scene = ball_under_sheet();
        add_flat_triangles(scene, 50, true);
        add_flat_triangles(scene, 50, false);
        const auto kept = static_cast<std::uint32_t>(ball_under_sheet().positions.size());
        World world = at_vertices(scene);
        world.receivers.resize(kept);
        return with_like(std::move(world), at_vertices(ball_under_sheet()));
    });
    add("isolated vertices, near and far", [] {
        Scene scene = ball_under_sheet();
        const auto kept = scene.positions.size();
        Random random(3);
        for (int i = 0; i < 200; ++i)
            scene.positions.push_back(1e6 * (random.in_cube() - 0.5));
        World world = at_vertices(scene);
        world.receivers.resize(kept);
        return with_like(std::move(world), at_vertices(ball_under_sheet()));
    });
    add("isolated vertices have no hemisphere", [] {
        Scene scene = ball_under_sheet();
        const auto kept = scene.positions.size();
        Random random(3);
        for (int i = 0; i < 200; ++i)
            scene.positions.push_back(random.in_cube() - 0.5);
        World world = at_vertices(scene);
        world.receivers.erase(world.receivers.begin(),
                              world.receivers.begin() + static_cast<std::ptrdiff_t>(kept));
        return with_constant(std::move(world), 0.0);
    });
    add(
        "a fan of 10^4 triangles around one vertex",
        [] {
            Scene scene;
            scene += sphere({0, 0, 0.4}, 0.2, 8);
            const auto kept = scene.positions.size();
            constexpr std::uint32_t kCount = 10000;
            const auto first = static_cast<std::uint32_t>(kept);
            scene.positions.push_back({0, 0, 0});
            for (std::uint32_t i = 0; i < kCount; ++i) {
                const double a = 2.0 * std::numbers::pi * i / kCount;
                scene.positions.push_back({std::cos(a), std::sin(a), 0});
            }
            for (std::uint32_t i = 0; i < kCount; ++i)
                scene.triangles.push_back({first, first + 1 + i, first + 1 + (i + 1) % kCount});
            World world = at_vertices(scene);
            world.receivers.resize(kept + 1);
            return world;
        },
        kCoarse);
    add(
        "three sheets at one edge",
        [] {
            Scene scene;
            for (int i = 0; i < 3; ++i) {
                const double a = 2.0 * std::numbers::pi * (i + 0.1) / 3;
                scene += sheet({0, -1, 0}, {0, 2, 0}, {std::cos(a), 0, std::sin(a)}, 10);
            }
            return at_vertices(scene);
        },
        kOpenMesh);
    add(
        "Moebius strip",
        [] {
            Scene scene;
            scene += grid(4, 60, [](double u, double v) {
                const double a = 2.0 * std::numbers::pi * v, w = 0.6 * (u - 0.5);
                return glm::dvec3((1 + w * std::cos(a / 2)) * std::cos(a),
                                  (1 + w * std::cos(a / 2)) * std::sin(a), w * std::sin(a / 2));
            });
            return at_vertices(scene);
        },
        kOpenMesh);
    add(
        "two cones tip to tip",
        [] {
            Scene scene;
            scene += grid(24, 12, [](double u, double v) {
                const double a = 2.0 * std::numbers::pi * u, r = v - 0.5;
                return glm::dvec3(r * std::cos(a), r * std::sin(a),
                                  2.0 * std::abs(r) * (r < 0 ? -1 : 1));
            });
            return at_vertices(scene);
        },
        kOpenMesh);
    add(
        "half of the faces turned round",
        [] {
            Scene scene = ball_under_sheet();
            for (std::size_t t = 0; t < scene.triangles.size(); t += 2)
                std::swap(scene.triangles[t].y, scene.triangles[t].z);
            return at_vertices(scene);
        },
        kOpenMesh);
}

}  // namespace surfelao::stability
