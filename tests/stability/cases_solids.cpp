#include "tests/random.h"
#include "tests/scenes.h"
#include "tests/stability/cases.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace surfelao::stability {
namespace {

using namespace scenes;

World convex(const std::function<void(Scene&)>& add)
{
    Scene scene;
    add(scene);
    return with_constant(at_vertices(scene), 0.0);
}

/// A square shaft of width 1, open at the top.
World pit(double depth)
{
    Scene scene;
    scene += box({0, 0, 0}, {1, 1, depth}, 8);
    scene.triangles.resize(scene.triangles.size() - 2 * 8 * 8);  // the lid is the last face
    scene = flipped(std::move(scene));
    World world = where(at_vertices(scene), [depth](glm::dvec3 p) { return p.z < depth - 0.01; });
    return with_openings(std::move(world),
                         {{{0, 0, depth}, {1, 0, depth}, {1, 1, depth}, {0, 1, depth}}});
}

/// A room 2 x 1 x 1 whose wall at x = 2 has a square window of the given width in its middle.
World room(double window)
{
    Scene scene;
    scene += sheet({0, 0, 0}, 2.0 * kX, kY, 8);
    scene += sheet({0, 0, 1}, kY, 2.0 * kX, 8);
    scene += sheet({0, 0, 0}, kZ, 2.0 * kX, 8);
    scene += sheet({0, 1, 0}, 2.0 * kX, kZ, 8);
    scene += sheet({0, 0, 0}, kY, kZ, 8);
    const double low = 0.5 - 0.5 * window, high = 0.5 + 0.5 * window;
    const double cuts[] = {0.0, low, high, 1.0};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            if (row == 1 && column == 1 && window > 0.0)
                continue;
            scene += sheet({2, cuts[column], cuts[row]}, {0, 0, cuts[row + 1] - cuts[row]},
                           {0, cuts[column + 1] - cuts[column], 0}, 3);
        }
    }
    World world = where(at_vertices(scene), [](glm::dvec3 p) { return p.x < 1.99; });
    return with_openings(std::move(world),
                         {{{2, low, low}, {2, high, low}, {2, high, high}, {2, low, high}}});
}

/// Three closed spheres, each `gap` diagonals inside the next.
World nested_shells(double gap)
{
    const double step = gap * 2.0 * std::sqrt(3.0);
    Scene scene;
    for (int shell = 0; shell < 3; ++shell)
        scene += sphere({0, 0, 0}, 1.0 - shell * step, 8);
    World world = at_vertices(scene);
    const double outer = 1.0 / world.geometry.frame.diagonal;
    world.answer = [outer](const Receiver& receiver) {
        return glm::length(glm::dvec3(receiver.position)) < outer ? 1.0 : 0.0;
    };
    return world;
}

/// Floor of two triangles under a sphere of 10^5; receivers on both.
World floor_under_sphere()
{
    Scene scene;
    const glm::dvec3 centre(0.5, 0.5, 0.4);
    const double radius = 0.3;
    scene += sphere(centre, radius, 91);
    scene += sheet({0, 0, 0}, kX, kY, 1);
    World world = sampled(at_vertices(scene), 300);
    std::vector<glm::dvec3> points;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x)
            points.push_back({(x + 0.5) / 16, (y + 0.5) / 16, 0.0});
    }
    const World on_floor = at_points(scene, points, {0, 0, 1});
    world.receivers.insert(world.receivers.end(), on_floor.receivers.begin(),
                           on_floor.receivers.end());
    const double floor_z = world.to_unit({0, 0, 0}).z + 2e-4;
    const Polygon floor = world.to_unit({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    const glm::dvec3 unit_centre = world.to_unit(centre);
    const double unit_radius = radius / world.geometry.frame.diagonal;
    world.answer = [=](const Receiver& receiver) {
        return receiver.position.z < floor_z
                   ? sphere_form_factor(receiver, unit_centre, unit_radius)
                   : form_factor(receiver, floor);
    };
    return world;
}

}  // namespace

void add_solid_cases(std::vector<Case>& cases)
{
    cases.push_back({"solids", "box", [] {
                         return convex([](Scene& scene) { scene += box({0, 0, 0}, {1, 1, 1}, 8); });
                     }});
    cases.push_back({"solids", "sphere", [] {
                         return convex([](Scene& scene) { scene += sphere({0, 0, 0}, 1, 16); });
                     }});
    for (const double thickness : {1e-2, 1e-4, 1e-6, 1e-8})
        cases.push_back({"solids", label("slab %g thick", thickness),
                         [thickness] {
                             return convex([thickness](Scene& scene) {
                                 scene += box({0, 0, 0}, {1, 1, thickness}, 8);
                             });
                         },
                         kThinParts});
    cases.push_back({"solids", "box turned inside out",
                     [] {
                         Scene scene;
                         scene += box({0, 0, 0}, {1, 1, 1}, 8);
                         scene = flipped(std::move(scene));
                         return with_constant(at_vertices(scene), 1.0);
                     },
                     kRoom});
    cases.push_back({"solids", "sphere turned inside out",
                     [] {
                         Scene scene;
                         scene += sphere({0, 0, 0}, 1, 16);
                         scene = flipped(std::move(scene));
                         return with_constant(at_vertices(scene), 1.0);
                     },
                     kRoom});
    for (const double gap : {5e-2, 1e-2, 1e-3, 1e-4, 1e-5})
        cases.push_back({"shells", label("three shells %g diagonals apart", gap),
                         [gap] { return nested_shells(gap); }, kLayers});
    for (const double depth : {0.5, 2.0, 10.0, 50.0})
        cases.push_back(
            {"hollows", label("pit %g widths deep", depth), [depth] { return pit(depth); }, kRoom});
    for (const double window : {0.4, 0.1, 0.01, 0.0})
        cases.push_back({"hollows", label("room with a window %g wide", window),
                         [window] { return room(window); }, kRoom});
    cases.push_back({"solids", "floor of 2 triangles under 10^5", floor_under_sphere, kCoarse});

    cases.push_back({"crossing", "two boxes through each other",
                     [] {
                         Scene scene;
                         scene += box({0, 0, 0}, {1, 1, 1}, 8);
                         scene += box({0.4, 0.3, 0.2}, {1.6, 0.7, 0.6}, 8);
                         return at_vertices(scene);
                     },
                     kLayers});
    cases.push_back({"crossing", "sphere through a floor",
                     [] {
                         Scene scene;
                         scene += sheet({-1, -1, 0}, 2.0 * kX, 2.0 * kY, 16);
                         scene += sphere({0.03, 0.02, 0.11}, 0.5, 8);
                         return at_vertices(scene);
                     },
                     kLayers});
    cases.push_back({"crossing", "box standing in the floor's plane",
                     [] {
                         Scene scene;
                         scene += sheet({-1, -1, 0}, 2.0 * kX, 2.0 * kY, 16);
                         scene += box({-0.5, -0.5, 0}, {0.25, 0.25, 0.5}, 5);
                         return at_vertices(scene);
                     },
                     kLayers});
    cases.push_back({"crossing", "two boxes with one face in common",
                     [] {
                         Scene scene;
                         scene += box({0, 0, 0}, {1, 1, 1}, 6);
                         scene += box({1, 0.25, 0.25}, {1.5, 0.75, 0.75}, 6);
                         return at_vertices(scene);
                     },
                     kLayers});
}

}  // namespace surfelao::stability
