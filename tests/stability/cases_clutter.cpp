#include "tests/random.h"
#include "tests/scenes.h"
#include "tests/stability/cases.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <cmath>
#include <numbers>

namespace surfelao::stability {
namespace {

using namespace scenes;

/// Square cards in a ball, each with a front and a back over the same vertices.
World foliage(int count, double size)
{
    Scene scene;
    Random random(11);
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 u = random.direction();
        const glm::dvec3 v = glm::normalize(glm::cross(u, random.direction()));
        const glm::dvec3 place = std::cbrt(random.share()) * random.direction();
        scene += two_faced(sheet(place, size * u, size * v, 1));
    }
    return sampled(at_vertices(scene), 400);
}

/// A wall along an Archimedean spiral between floor and ceiling; one corridor leads to the middle.
World spiral()
{
    Scene scene;
    const auto on_wall = [](double v) {
        const double a = 2.0 * std::numbers::pi * 4.0 * v;
        return glm::dvec2(std::cos(a), std::sin(a)) * (0.1 + 0.9 * v);
    };
    scene += grid(4, 160, [&](double u, double v) { return glm::dvec3(on_wall(v), 0.4 * u); });
    scene += sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 16);
    scene += sheet({-1, -1, 0.4}, {0, 2, 0}, {2, 0, 0}, 16);
    return sampled(at_vertices(scene), 600);
}

/// Plates that stand side by side on a floor, `gap` apart, 1 high.
World comb(int plates, double gap)
{
    Scene scene;
    scene += sheet({-0.1, 0, 0}, {plates * gap + 0.1, 0, 0}, {0, 1, 0}, 24);
    for (int i = 0; i < plates; ++i)
        scene += box({i * gap, 0, 0}, {(i + 0.3) * gap, 1, 1}, 5);
    return sampled(at_vertices(scene), 600);
}

/// Single triangles of the given size, anywhere in a cube, each a component of its own.
Scene soup(std::uint32_t count, double size)
{
    Scene scene;
    Random random(5);
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::dvec3 place = random.in_cube();
        scene +=
            triangle(place, place + size * random.direction(), place + size * random.direction());
    }
    return scene;
}

/// A small model on a ground of two triangles 1000 times its size.
World model_on_vast_ground()
{
    Scene scene;
    scene += sheet({-500, -500, 0}, {1000, 0, 0}, {0, 1000, 0}, 1);
    scene += sphere({0.1, 0.2, 0.7}, 0.5, 8);
    scene += box({-0.9, -0.6, 0.05}, {-0.3, 0.2, 0.9}, 4);
    return at_vertices(scene, {}, 1e-6f);
}

/// Specks of a hundred-thousandth of a wall's width before it.
World specks_at_a_wall()
{
    Scene scene;
    scene += sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 16);
    scene += sheet({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 16);
    Random random(9);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 place = glm::dvec3(0.01) + 0.9 * random.in_cube();
        scene +=
            triangle(place, place + 1e-5 * random.direction(), place + 1e-5 * random.direction());
    }
    return at_vertices(scene);
}

/// Ball, box and sheet within a limited distance.
World limited(float max_distance, Falloff falloff)
{
    Scene scene;
    scene += sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 16);
    scene += sphere({0.31, 0.22, 0.47}, 0.3, 8);
    scene += box({-0.6, -0.77, 0.05}, {-0.1, -0.2, 0.4}, 4);
    Definition definition;
    definition.max_distance = max_distance;
    definition.falloff = falloff;
    return at_vertices(scene, definition);
}

}  // namespace

void add_clutter_cases(std::vector<Case>& cases)
{
    const auto add = [&](const std::string& name, const std::function<World()>& make,
                         const std::string& excused = {}, bool slow = false) {
        cases.push_back({"clutter", name, make, excused, slow});
    };
    add(
        "300 foliage cards", [] { return foliage(300, 0.3); }, kOpenMesh);
    // five times as dense for a ray as the 300 (count times size squared)
    add(
        "5000 foliage cards", [] { return foliage(5000, 0.16); }, kOpenMesh);
    add("spiral corridor of four turns", spiral, kRoom);
    add(
        "comb of 20 plates, gaps 1 : 20", [] { return comb(20, 0.05); }, kThinParts);
    add(
        "comb of 20 plates, gaps 1 : 500", [] { return comb(20, 0.002); }, kThinParts);
    add(
        "soup of 10^4 triangles", [] { return sampled(at_vertices(soup(10000, 0.05)), 400); },
        kOpenMesh);
    add(
        "soup of 10^6 components", [] { return sampled(at_vertices(soup(1000000, 0.008)), 400); },
        kOpenMesh, true);
    add("model on a ground 1000 times its size", model_on_vast_ground, kCoarse);
    add("specks of 1e-05 in a corner", specks_at_a_wall, kOpenMesh);

    const auto add_limit = [&](const std::string& name, float distance, Falloff falloff) {
        cases.push_back({"limits", name, [=] { return limited(distance, falloff); }, kOpenMesh});
    };
    add_limit("within 0.2 diagonals", 0.2f, Falloff::none);
    add_limit("within 0.2 diagonals, smooth", 0.2f, Falloff::smooth);
    add_limit("within 0.001 diagonals, smooth", 1e-3f, Falloff::smooth);
    add_limit("within 1e-06 diagonals", 1e-6f, Falloff::none);
}

}  // namespace surfelao::stability
