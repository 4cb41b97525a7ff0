#include "tests/random.h"
#include "tests/scenes.h"
#include "tests/stability/cases.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace surfelao::stability {
namespace {

using namespace scenes;

Polygon parallelogram(glm::dvec3 corner, glm::dvec3 u, glm::dvec3 v)
{
    return {corner, corner + u, corner + u + v, corner + v};
}

/// Two unit squares that face each other, `gap` diagonals apart.
World facing_sheets(double gap, float offset)
{
    const double height = gap * std::sqrt(2.0 / (1.0 - gap * gap));
    Scene scene;
    scene += sheet({0, 0, 0}, kX, kY, 12);
    scene += sheet({0, 0, height}, kY, kX, 12);
    return with_polygons(at_vertices(scene, {}, offset),
                         {parallelogram({0, 0, 0}, kX, kY), parallelogram({0, 0, height}, kX, kY)});
}

/// Unit floor under a smaller ceiling that `add_ceiling` puts over [0.25, 0.75]^2 at z = 0.3.
World under_ceiling(const std::function<void(Scene&)>& add_ceiling)
{
    Scene scene;
    scene += sheet({0, 0, 0}, kX, kY, 12);
    add_ceiling(scene);
    return with_polygons(
        at_vertices(scene),
        {parallelogram({0, 0, 0}, kX, kY), parallelogram({0.25, 0.25, 0.3}, 0.5 * kX, 0.5 * kY)});
}

/// The ceiling of under_ceiling, facing down.
void add_ceiling(Scene& scene, int cells)
{
    scene += sheet({0.25, 0.25, 0.3}, 0.5 * kY, 0.5 * kX, cells);
}

/// A valley between two flanks of width 1 along y.
World crease(double angle_deg)
{
    const double half = angle_deg / 360.0 * std::numbers::pi;
    const glm::dvec3 left(-std::sin(half), 0, std::cos(half));
    const glm::dvec3 right(std::sin(half), 0, std::cos(half));
    Scene scene;
    scene += sheet({0, -1, 0}, 2.0 * kY, left, 12);
    scene += sheet({0, -1, 0}, right, 2.0 * kY, 12);
    return with_polygons(at_vertices(scene), {parallelogram({0, -1, 0}, 2.0 * kY, left),
                                              parallelogram({0, -1, 0}, 2.0 * kY, right)});
}

/// The same from outside: nothing occludes.
World ridge(double angle_deg)
{
    const double half = angle_deg / 360.0 * std::numbers::pi;
    Scene scene;
    scene += sheet({0, -1, 0}, 2.0 * kY, {-std::sin(half), 0, -std::cos(half)}, 12);
    scene += sheet({0, -1, 0}, {std::sin(half), 0, -std::cos(half)}, 2.0 * kY, 12);
    return with_constant(at_vertices(scene), 0.0);
}

/// The ceiling cut along x into wide strips with seven slivers of length / width `aspect` between.
void add_slivered_ceiling(Scene& scene, double aspect)
{
    std::vector<double> cuts{0.25};
    for (int i = 1; i < 8; ++i) {
        cuts.push_back(0.25 + i / 16.0);
        cuts.push_back(0.25 + i / 16.0 + 0.5 / aspect);
    }
    cuts.push_back(0.75);
    const int strips = static_cast<int>(cuts.size()) - 1;
    scene += grid(1, strips, [&](double u, double v) {
        return glm::dvec3(cuts[static_cast<std::size_t>(std::lround(v * strips))], 0.25 + 0.5 * u,
                          0.3);
    });
}

/// Floor under one quadrilateral of length 0.5 and width 0.5 / aspect, close above it.
World lone_sliver(double aspect)
{
    const double width = 0.5 / aspect;
    Scene scene;
    scene += sheet({0, 0, 0}, kX, kY, 12);
    const glm::dvec3 corner(0.25, 0.4999, 0.01);
    scene += sheet(corner, width * kY, 0.5 * kX, 1);
    return with_polygons(at_vertices(scene), {parallelogram({0, 0, 0}, kX, kY),
                                              parallelogram(corner, width * kY, 0.5 * kX)});
}

/// A disk of `spokes` needles over the floor: every needle ends in one point.
World needle_fan(int spokes)
{
    Scene scene;
    scene += sheet({0, 0, 0}, kX, kY, 12);
    Polygon rim;
    const glm::dvec3 centre(0.5, 0.5, 0.3);
    for (int i = 0; i < spokes; ++i) {
        const double a = -2.0 * std::numbers::pi * i / spokes;
        rim.push_back(centre + 0.25 * glm::dvec3(std::cos(a), std::sin(a), 0.0));
    }
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.push_back(centre);
    scene.positions.insert(scene.positions.end(), rim.begin(), rim.end());
    const auto count = static_cast<std::uint32_t>(spokes);
    for (std::uint32_t i = 0; i < count; ++i)
        scene.triangles.push_back({first, first + 1 + i, first + 1 + (i + 1) % count});
    return with_polygons(at_vertices(scene), {parallelogram({0, 0, 0}, kX, kY), rim});
}

}  // namespace

void add_sheet_cases(std::vector<Case>& cases)
{
    cases.push_back({"sheets", "lone sheet", [] {
                         Scene scene;
                         scene += sheet({0, 0, 0}, kX, kY, 16);
                         return with_constant(at_vertices(scene), 0.0);
                     }});
    for (const double gap : {1e-1, 1e-2, 1e-3, 2e-4, 1e-4, 5e-5, 1e-5, 1e-6, 1e-7})
        cases.push_back({"sheets", label("facing, %g diagonals apart", gap),
                         [gap] { return facing_sheets(gap, kVertexOffset); }, kOpenMesh});
    cases.push_back({"sheets", "facing, 1e-05 apart, offset 1e-06",
                     [] { return facing_sheets(1e-5, 1e-6f); }, kOpenMesh});

    for (const int copies : {1, 2, 10, 100}) {
        cases.push_back({"coincident", label("%g ceilings in one place", copies),
                         [copies] {
                             return under_ceiling([copies](Scene& scene) {
                                 for (int i = 0; i < copies; ++i)
                                     add_ceiling(scene, 4 + i % 3);
                             });
                         },
                         kLayers});
    }
    cases.push_back({"coincident", "floor and ceiling doubled, same vertices",
                     [] {
                         World world = under_ceiling([](Scene& scene) {
                             add_ceiling(scene, 6);
                             const std::vector<glm::uvec3> once = scene.triangles;
                             scene.triangles.insert(scene.triangles.end(), once.begin(),
                                                    once.end());
                         });
                         return world;
                     },
                     kLayers});
    cases.push_back({"coincident", "opposite faces, same vertices",
                     [] {
                         return under_ceiling([](Scene& scene) {
                             add_ceiling(scene, 6);
                             scene = two_faced(std::move(scene));
                         });
                     },
                     kLayers});
    cases.push_back({"coincident", "opposite faces, own vertices",
                     [] {
                         return under_ceiling([](Scene& scene) {
                             add_ceiling(scene, 6);
                             scene += sheet({0.25, 0.25, 0.3}, 0.5 * kX, 0.5 * kY, 6);
                             scene += sheet({0, 0, 0}, kY, kX, 12);
                         });
                     },
                     kLayers});
    cases.push_back({"coincident", "two triangles and a fine grid in one floor",
                     [] {
                         return under_ceiling([](Scene& scene) {
                             add_ceiling(scene, 6);
                             scene += sheet({0, 0, 0}, kX, kY, 1);
                         });
                     },
                     kLayers});

    for (const double angle : {170.0, 120.0, 90.0, 60.0, 30.0, 10.0, 3.0, 1.0, 0.3, 0.1})
        cases.push_back({"creases", label("valley of %g degrees", angle),
                         [angle] { return crease(angle); }, kOpenMesh});
    for (const double angle : {90.0, 1.0, 0.1})
        cases.push_back({"creases", label("ridge of %g degrees", angle),
                         [angle] { return ridge(angle); }, kThinParts});

    for (const double aspect : {1e3, 1e5, 1e7, 1e9})
        cases.push_back({"slivers", label("ceiling with slivers 1 : %g", aspect),
                         [aspect] {
                             return under_ceiling(
                                 [aspect](Scene& scene) { add_slivered_ceiling(scene, aspect); });
                         },
                         kCoarse});
    for (const double aspect : {1e2, 1e4, 1e6})
        cases.push_back({"slivers", label("lone sliver 1 : %g over a floor", aspect),
                         [aspect] { return lone_sliver(aspect); }, kCoarse});
    cases.push_back({"slivers", "disk of 2000 needles", [] { return needle_fan(2000); }, kCoarse});
}

}  // namespace surfelao::stability
