#include "tests/random.h"
#include "tests/scenes.h"
#include "tests/stability/cases.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <numeric>
#include <utility>

namespace surfelao::stability {
namespace {

using namespace scenes;

/// A bit of everything: bumpy ground, a ball and a leaning card above it, a box in it.
Scene mixed_scene()
{
    Scene scene;
    scene += grid(16, 16, [](double u, double v) {
        return glm::dvec3(2 * u - 1, 2 * v - 1, 0.08 * std::sin(9 * u) * std::cos(7 * v));
    });
    scene += sphere({0.31, 0.22, 0.47}, 0.3, 8);
    scene += sheet({-0.8, -0.6, 0.15}, {0.1, 0.9, 0.05}, {0.3, 0.1, 0.6}, 5);
    scene += box({-0.21, -0.77, -0.1}, {0.24, -0.33, 0.37}, 3);
    return scene;
}

/// The mixed scene after `change`, held against itself before.
World changed(const std::function<void(Scene&)>& change)
{
    Scene scene = mixed_scene();
    change(scene);
    return with_like(at_vertices(scene), at_vertices(mixed_scene()));
}

/// The mixed scene as a float file at `place`, `size` wide: what is left of it, by rays.
World in_floats(double size, double place)
{
    Scene scene = mixed_scene();
    scene = moved(std::move(scene),
                  [=](glm::dvec3 p) { return glm::dvec3(glm::vec3(0.5 * size * p + place)); });
    return at_vertices(scene);
}

/// A permutation of 0 .. count - 1.
std::vector<std::uint32_t> shuffled(std::size_t count)
{
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    Random random(7);
    for (std::size_t i = count; i > 1; --i)
        std::swap(order[i - 1], order[random.bits() % i]);
    return order;
}

World with_shuffled_vertices()
{
    const Scene base = mixed_scene();
    const std::vector<std::uint32_t> from = shuffled(base.positions.size());
    std::vector<std::uint32_t> to(from.size());
    Scene scene;
    for (std::uint32_t i = 0; i < from.size(); ++i) {
        scene.positions.push_back(base.positions[from[i]]);
        to[from[i]] = i;
    }
    for (const glm::uvec3 t : base.triangles)
        scene.triangles.push_back({to[t.x], to[t.y], to[t.z]});
    return with_like(at_vertices(scene), at_vertices(base),
                     [&](std::uint32_t receiver) { return from[receiver]; });
}

/// Every triangle with three vertices of its own, as in STL.
World unwelded()
{
    const Scene base = mixed_scene();
    Scene scene;
    std::vector<std::uint32_t> from;
    for (const glm::uvec3 t : base.triangles) {
        scene += triangle(base.positions[t.x], base.positions[t.y], base.positions[t.z]);
        from.insert(from.end(), {t.x, t.y, t.z});
    }
    return with_like(at_vertices(scene), at_vertices(base),
                     [&](std::uint32_t receiver) { return from[receiver]; });
}

/// A table in a corner, all flat faces, cut into cells x cells squares each.
Scene flat_faces(int cells)
{
    Scene scene;
    scene += sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells);
    scene += sheet({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, cells);
    scene += box({0.25, 0.25, 0.5}, {0.75, 0.75, 0.5625}, cells);
    return scene;
}

World subdivided(int cells)
{
    std::vector<glm::dvec3> points;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x)
            points.push_back({(x + 0.47) / 16, (y + 0.53) / 16, 0.0});
    }
    const glm::vec3 up(0, 0, 1);
    return with_like(at_points(flat_faces(cells), points, up),
                     at_points(flat_faces(16), points, up));
}

}  // namespace

void add_invariance_cases(std::vector<Case>& cases)
{
    const auto add = [&](const std::string& name, const std::function<World()>& make,
                         const std::string& excused = {}) {
        cases.push_back({"invariance", name, make, excused});
    };
    add(
        "mixed scene itself, by rays", [] { return at_vertices(mixed_scene()); }, kOpenMesh);
    for (const double scale : {1e-30, 1e-6, 1e6, 1e30})
        add(label("scaled by %g", scale), [scale] {
            return changed([scale](Scene& scene) {
                scene = moved(std::move(scene), [scale](glm::dvec3 p) { return scale * p; });
            });
        });
    for (const double place : {1e6, -1e7})
        add(label("moved by %g, in doubles", place), [place] {
            return changed([place](Scene& scene) {
                scene = moved(std::move(scene), [place](glm::dvec3 p) { return p + place; });
            });
        });
    for (const double place : {1e3, 1e5, 1e7})
        add(
            label("1000 wide at %g, in floats", place),
            [place] { return in_floats(1000.0, place); }, kOpenMesh);
    add("1 wide at 1e+07, in floats: all in one point", [] { return in_floats(1.0, 1e7); });
    add("rotated", [] {
        return changed([](Scene& scene) {
            const glm::dvec3 z = glm::normalize(glm::dvec3(1, 2, 3));
            const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(-2, 1, 0.5)));
            const glm::dmat3 turn(x, glm::cross(z, x), z);  // about no special axis

            scene = moved(std::move(scene), [turn](glm::dvec3 p) { return turn * p; });
        });
    });
    add("mirrored", [] {
        return changed([](Scene& scene) {
            scene =
                moved(std::move(scene), [](glm::dvec3 p) { return glm::dvec3(-p.x, p.y, p.z); });
            scene = flipped(std::move(scene));
        });
    });
    add("triangles in another order", [] {
        return changed([](Scene& scene) {
            const std::vector<glm::uvec3> base = scene.triangles;
            const std::vector<std::uint32_t> order = shuffled(base.size());
            for (std::size_t i = 0; i < base.size(); ++i)
                scene.triangles[i] = {base[order[i]].y, base[order[i]].z, base[order[i]].x};
        });
    });
    add("vertices in another order", with_shuffled_vertices);
    add("every triangle with its own vertices", unwelded);
    add("every triangle twice", [] {
        return changed([](Scene& scene) {
            const std::vector<glm::uvec3> once = scene.triangles;
            scene.triangles.insert(scene.triangles.end(), once.begin(), once.end());
        });
    });
    add("every triangle ten times", [] {
        return changed([](Scene& scene) {
            const std::vector<glm::uvec3> once = scene.triangles;
            for (int i = 0; i < 9; ++i)
                scene.triangles.insert(scene.triangles.end(), once.begin(), once.end());
        });
    });
    for (const int cells : {1, 2, 4, 8})
        add(
            label("flat faces cut into %g squared, against 16", cells),
            [cells] { return subdivided(cells); }, cells < 8 ? kCoarse : "");
}

}  // namespace surfelao::stability
