// Blended maps show no step where charts end (layout.h).
#include "atlas/atlas.h"

#include "image/map.h"
#include "scenes.h"
#include "surfels/half_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace surfelao {
namespace {

using scenes::operator+;

/// Smooth, from 0 to 1, over bodies of about the size of 1.
double known_value(glm::dvec3 p)
{
    return 0.5 + 0.5 * std::sin(2.0 * p.x + 1.0) * std::cos(1.5 * p.y - p.z);
}

glm::dvec3 position_at(const Mesh& mesh, const SurfacePoint& point)
{
    const glm::uvec3 corners = mesh.scene.triangles[mesh.geometry.scene_triangle(point.triangle)];
    return double{1.0f - point.at.x - point.at.y} * mesh.scene.positions[corners.x] +
           double{point.at.x} * mesh.scene.positions[corners.y] +
           double{point.at.y} * mesh.scene.positions[corners.z];
}

/// Maps that hold the known value at every texel of a layout, each page with an error of its own:
/// where one page ends, the others must have all the weight already.
std::vector<Map> known_maps(const Mesh& mesh, const MapLayout& layout)
{
    std::vector<Map> maps;
    double error = 0.0;
    for (const UvSet& page : layout.pages) {
        Map map(layout.size.width, layout.size.height, 1);
        std::vector<std::uint8_t> known(map.texels(), 0);
        for (const Texel& texel :
             MapRaster(mesh.geometry, page, layout.size).texels(0, layout.size.height)) {
            map.values[map.index(texel.x, texel.y)] =
                static_cast<float>(known_value(position_at(mesh, texel.point)) + error);
            known[map.index(texel.x, texel.y)] = 1;
        }
        fill_around(map, known, 4);
        maps.push_back(std::move(map));
        error += 0.05;
    }
    return maps;
}

struct Steps {
    double largest = 0.0;            ///< between what both triangles show at one place of an edge
    std::uint64_t border_edges = 0;  ///< with different charts on the two sides, on some page
};

Steps steps_over_edges(const Mesh& mesh, const Atlas& atlas)
{
    const std::vector<Map> maps = known_maps(mesh, atlas.layout);
    const std::vector<Neighbours> neighbours = neighbours_of(mesh.geometry);
    const auto corner_at = [&](std::uint32_t t, std::uint32_t place) {
        const glm::uvec3 corners = mesh.geometry.triangles[t];
        return mesh.geometry.welded[corners.x] == place   ? glm::vec2(0, 0)
               : mesh.geometry.welded[corners.y] == place ? glm::vec2(1, 0)
                                                          : glm::vec2(0, 1);
    };
    Steps steps;
    for (std::uint32_t t = 0; t < neighbours.size(); ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t other = neighbours[t][k];
            if (other == kNoTriangle || other < t)
                continue;
            bool is_border = false;
            for (const std::vector<std::uint32_t>& charts : atlas.chart_of)
                is_border |= charts[t] != charts[other];
            steps.border_edges += is_border ? 1 : 0;
            const glm::uvec3 corners = mesh.geometry.triangles[t];
            const std::uint32_t a = mesh.geometry.welded[corners[static_cast<int>(k)]];
            const std::uint32_t b = mesh.geometry.welded[corners[static_cast<int>((k + 1) % 3)]];
            for (const float along : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
                const auto shown = [&](std::uint32_t triangle) {
                    const glm::vec2 at =
                        (1.0f - along) * corner_at(triangle, a) + along * corner_at(triangle, b);
                    return double{fetch_at(maps, places_of(mesh, atlas.layout, {triangle, at}))};
                };
                steps.largest = std::max(steps.largest, std::abs(shown(t) - shown(other)));
            }
        }
    }
    return steps;
}

/// A body of revolution with a foot, a belly, a lid and a knob, and a handle.
Scene teapot()
{
    const auto turn = [](double share) { return 2 * std::numbers::pi * share; };
    const Scene body = scenes::grid(96, 80, [&](double s, double t) {
        const double r = std::sin(std::numbers::pi * t) * (0.75 + 0.25 * std::cos(turn(1.5 * t)));
        return glm::dvec3(r * std::cos(turn(s)), r * std::sin(turn(s)), -std::cos(turn(t / 2)));
    });
    const Scene handle = scenes::grid(64, 32, [&](double s, double t) {
        const double r = 0.4 + 0.1 * std::cos(turn(t));
        return glm::dvec3(0.7 + r * std::cos(turn(s)), 0.1 * std::sin(turn(t)),
                          r * std::sin(turn(s)));
    });
    return body + handle;
}

constexpr double kOneStep = 1.0 / 255.0;  // what 8 bits tell apart

TEST(Blended, NothingStepsOnTheSphere)
{
    const Mesh mesh = make_mesh(scenes::sphere({0, 0, 0}, 1, 24));
    const Steps blended = steps_over_edges(mesh, make_atlas(mesh, {.size = 512, .blended = true}));
    EXPECT_GT(blended.border_edges, 100u);
    EXPECT_LE(blended.largest, kOneStep);
    const Steps planar = steps_over_edges(mesh, make_atlas(mesh, {.size = 512}));
    EXPECT_GT(planar.largest, 2.0 * blended.largest);
}

TEST(Blended, NothingStepsOnTheTeapotSlow)
{
    const Mesh mesh = make_mesh(teapot());
    const Steps blended = steps_over_edges(mesh, make_atlas(mesh, {.size = 512, .blended = true}));
    EXPECT_GT(blended.border_edges, 100u);
    EXPECT_LE(blended.largest, kOneStep);
}

}  // namespace
}  // namespace surfelao
