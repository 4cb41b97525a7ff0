#include "atlas/seams.h"

#include "laid_out.h"
#include "scenes.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <functional>
#include <utility>

namespace surfelao {
namespace {

using scenes::operator+;

using Known = std::vector<std::vector<std::uint8_t>>;

/// Maps of what `value` says at the covered texels.
std::vector<Map> maps_of(const Mesh& mesh, const MapLayout& layout,
                         const std::function<float(glm::dvec3)>& value, Known& known)
{
    std::vector<Map> maps;
    known.clear();
    for (const UvSet& page : layout.pages) {
        Map& map = maps.emplace_back(layout.size.width, layout.size.height, 1);
        std::vector<std::uint8_t>& covered = known.emplace_back(map.texels(), 0);
        for (const Texel& texel :
             MapRaster(mesh.geometry, page, layout.size).texels(0, layout.size.height)) {
            const glm::uvec3 t = mesh.geometry.triangles[texel.point.triangle];
            const glm::dvec2 at = texel.point.at;
            map.values[map.index(texel.x, texel.y)] =
                value((1.0 - at.x - at.y) * mesh.scene.positions[t.x] +
                      at.x * mesh.scene.positions[t.y] + at.y * mesh.scene.positions[t.z]);
            covered[map.index(texel.x, texel.y)] = 1;
        }
    }
    return maps;
}

void fill_all(const Mesh& mesh, const MapLayout& layout, const Seams& seams, std::vector<Map>& maps,
              Known& known)
{
    fill_across(mesh, layout, seams, 4, maps, known);
    for (std::size_t page = 0; page < maps.size(); ++page)
        fill_around(maps[page], known[page], 4);
}

TEST(Seams, AreWhereSmoothAndHardEdgesAreCut)
{
    constexpr int kCells = 6;
    const Mesh sphere = make_mesh(scenes::sphere({0, 0, 0}, 1.0, kCells));
    const Mesh cube = make_mesh(scenes::box(glm::dvec3(-1.0), glm::dvec3(1.0), kCells));
    for (const Mesh* mesh : {&sphere, &cube}) {
        const MapLayout layout = laid_out(mesh->scene, {96, 64}, 1, side_of_cube);
        const Seams seams = seams_of(*mesh, layout);
        EXPECT_EQ(seams.list.size(), 12u * kCells);
        EXPECT_EQ(seams.smooth_count(), mesh == &sphere ? 12u * kCells : 0u);
        std::size_t inside = 0;
        for (Side side = 0; side < seams.beside.size(); ++side)
            if (seams.beside[side] != Seams::kNone) {
                EXPECT_EQ(seams.beside[seams.beside[side]], side);
                ++inside;
            }
        EXPECT_EQ(inside + 2 * seams.list.size(), 3 * mesh->scene.triangles.size());
        MapLayout blended = layout;
        blended.is_blended = true;
        EXPECT_TRUE(seams_of(*mesh, blended).list.empty());
    }
}

// What lies on the same texels has no seam, nor what one edge does not join.
TEST(Seams, AreNoneWhereTheMapGoesOn)
{
    const Scene sheet = scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 4);
    const auto mirrored = [](glm::dvec3 p, glm::dvec3) {
        return Spot{0, {0.1 + 0.3 * std::abs(p.x), 0.5 + 0.3 * p.y}};
    };
    const auto whole_maps_away = [](glm::dvec3 p, glm::dvec3 middle) {
        return Spot{0, {0.5 + 0.25 * p.x + (middle.x > 0.0 ? 3.0 : 0.0), 0.5 + 0.25 * p.y}};
    };
    const auto halves = [](glm::dvec3 p, glm::dvec3 middle) {
        return Spot{0, {0.5 + 0.2 * p.x + (middle.x > 0.0 ? 0.1 : 0.0), 0.5 + 0.25 * p.y}};
    };
    // two triangles beside four, and a third sheet at the middle line
    const Scene t_junctions = scenes::sheet({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}, 1) +
                              scenes::sheet({0, -1, 0}, {1, 0, 0}, {0, 2, 0}, 2);
    const Scene fin = sheet + scenes::sheet({0, -1, 0}, {0, 0, 1}, {0, 2, 0}, 4);
    for (const auto& [scene, place, count] :
         {std::tuple<Scene, Placing, std::size_t>{sheet, mirrored, 0},
          {sheet, whole_maps_away, 0},
          {sheet, halves, 4},
          {t_junctions, halves, 0},
          {fin, halves, 0}}) {
        const Mesh mesh = make_mesh(scene);
        EXPECT_EQ(seams_of(mesh, laid_out(scene, {32, 32}, 1, place)).list.size(), count);
    }
}

// A plane cut in two, the halves on one page or two, of different size, one turned: what is linear
// goes on beyond the cut without error.
TEST(Seams, FillsWhatLiesBeyondOnTheUnfoldedSurface)
{
    const auto value = [](glm::dvec3 p) { return static_cast<float>(0.5 + 0.3 * p.x + 0.1 * p.y); };
    const Scene sheet = scenes::sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 6);
    const Mesh mesh = make_mesh(sheet);
    for (const std::uint32_t pages : {1u, 2u}) {
        const auto place = [&](glm::dvec3 p, glm::dvec3 middle) {
            if (middle.x < 0.0)
                return Spot{0, {0.4 + 0.31 * p.x, 0.47 + 0.37 * p.y}};
            return Spot{pages - 1, {0.75 + 0.2 * p.y, 0.2 + 0.53 * p.x}};
        };
        const MapLayout layout = laid_out(sheet, {64, 48}, pages, place);
        const Seams seams = seams_of(mesh, layout);
        Known known;
        std::vector<Map> maps = maps_of(mesh, layout, value, known);
        const Known covered = known;
        fill_across(mesh, layout, seams, 3, maps, known);
        // beyond the cut of the left half, whose rows lie along it
        std::size_t filled = 0;
        for (std::uint32_t y = 0; y < 48; ++y) {
            for (std::uint32_t x = 0; x < 32; ++x) {
                const std::size_t i = maps[0].index(x, y);
                if (covered[0][i] == known[0][i])
                    continue;
                const glm::dvec2 p(((x + 0.5) / 64.0 - 0.4) / 0.31,
                                   ((y + 0.5) / 48.0 - 0.47) / 0.37);
                EXPECT_NEAR(maps[0].values[i], value({p, 0.0}), 1e-5) << x << " " << y;
                ++filled;
            }
        }
        EXPECT_GE(filled, 2u * 33u);
        EXPECT_LE(filled, 3u * 36u);
    }
}

TEST(Seams, ShowTheSameOnBothSidesAfterStitching)
{
    const Mesh mesh = make_mesh(scenes::sphere({0, 0, 0}, 1.0, 12));
    const MapLayout layout = laid_out(mesh.scene, {192, 128}, 1, side_of_cube);
    const Seams seams = seams_of(mesh, layout);
    const auto value = [](glm::dvec3 p) {
        return static_cast<float>(0.5 + 0.4 * std::sin(3.0 * p.x + p.y) * std::cos(2.0 * p.z));
    };
    Known known;
    std::vector<Map> maps = maps_of(mesh, layout, value, known);
    std::vector<Map> around = maps;
    Known around_known = known;
    fill_around(around[0], around_known[0], 4);
    fill_all(mesh, layout, seams, maps, known);
    const std::vector<Map> filled = maps;
    stitch(seams, maps);
    const double before = seam_jump(seams, around).rms, between = seam_jump(seams, filled).rms;
    EXPECT_GT(before, 0.01);
    EXPECT_LT(between, 0.75 * before);
    EXPECT_LT(seam_jump(seams, maps).rms, 0.001);
    EXPECT_LT(seam_jump(seams, maps).most, 0.01);
    for (std::size_t i = 0; i < maps[0].values.size(); ++i)
        EXPECT_NEAR(maps[0].values[i], filled[0].values[i], 0.05);
}

TEST(Seams, LeaveConstantMapsAndHardEdgesAlone)
{
    const Mesh sphere = make_mesh(scenes::sphere({0, 0, 0}, 1.0, 8));
    const Mesh cube = make_mesh(scenes::box(glm::dvec3(-1.0), glm::dvec3(1.0), 4));
    const auto constant = [](glm::dvec3) { return 0.7f; };
    const auto by_side = [](glm::dvec3 p) {
        return static_cast<float>(p.x > 0.999 ? 0.1 : p.y > 0.999 ? 0.4 : 0.9);
    };
    for (const auto& [mesh, value] :
         {std::pair<const Mesh&, std::function<float(glm::dvec3)>>(sphere, constant),
          {cube, by_side}}) {
        const MapLayout layout = laid_out(mesh.scene, {96, 64}, 1, side_of_cube);
        const Seams seams = seams_of(mesh, layout);
        Known known;
        std::vector<Map> maps = maps_of(mesh, layout, value, known);
        Known expected_known = known;
        std::vector<Map> expected = maps;
        fill_around(expected[0], expected_known[0], 4);
        fill_all(mesh, layout, seams, maps, known);
        stitch(seams, maps);
        EXPECT_EQ(maps[0].values, expected[0].values);
        EXPECT_LT(seam_jump(seams, maps).most, 1e-12);
    }
}

}  // namespace
}  // namespace surfelao
