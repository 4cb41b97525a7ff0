#include "atlas/atlas.h"

#include "family.h"
#include "random.h"
#include "scenes.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

namespace surfelao {
namespace {

using scenes::operator+;
using scenes::operator+=;

/// The charts of a page, as they are drawn: of each texel, the last chart that touches it.
struct Drawn {
    Drawn(const Mesh& mesh, const Atlas& atlas, std::size_t page, std::uint32_t magnified = 1)
        : side(magnified * atlas.layout.size.width), chart(std::size_t{side} * side, kNoChart)
    {
        const MapRaster raster(mesh.geometry, atlas.layout.pages[page], {side, side});
        for (const Texel& texel : raster.texels(0, side)) {
            std::uint32_t& there = chart[std::size_t{texel.y} * side + texel.x];
            twice += there == kNoChart ? 0 : 1;
            there = atlas.chart_of[page][texel.point.triangle];
        }
    }

    std::uint32_t side;
    std::vector<std::uint32_t> chart;
    std::uint64_t twice = 0;  ///< texels in which two triangles contain the same place
};

/// Twice its area in texels, v up.
double doubled_in_map(const Mesh& mesh, const Atlas& atlas, std::size_t page, std::uint32_t t)
{
    const UvSet& uvs = atlas.layout.pages[page];
    const glm::uvec3 corners = uvs.corners[mesh.geometry.scene_triangle(t)];
    const glm::dvec2 b = uvs.values[corners.y] - uvs.values[corners.x];
    const glm::dvec2 c = uvs.values[corners.z] - uvs.values[corners.x];
    return -(b.x * c.y - b.y * c.x) * static_cast<double>(atlas.layout.size.count());
}

/// Of each chart of a page how much padding it is due (packing.h): as much as asked, but no more
/// than a quarter of its width.
std::vector<int> paddings_of(const Mesh& mesh, const Atlas& atlas, std::size_t page, int asked)
{
    const UvSet& uvs = atlas.layout.pages[page];
    std::vector<double> areas(atlas.chart_count, 0.0), outlines(atlas.chart_count, 0.0);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, std::uint32_t>> edges;
    for (std::uint32_t t = 0; t < mesh.geometry.triangles.size(); ++t) {
        const std::uint32_t chart = atlas.chart_of[page][t];
        if (chart == kNoChart)
            continue;
        areas[chart] += doubled_in_map(mesh, atlas, page, t) / 2.0;
        const glm::uvec3 corners = uvs.corners[mesh.geometry.scene_triangle(t)];
        for (int k = 0; k < 3; ++k) {
            auto& edge = edges[std::minmax(corners[k], corners[(k + 1) % 3])];
            edge = {edge.first + 1, chart};
        }
    }
    for (const auto& [ends, edge] : edges)
        if (edge.first == 1)
            outlines[edge.second] +=
                glm::distance(uvs.values[ends.first], uvs.values[ends.second]) *
                atlas.layout.size.width;
    std::vector<int> paddings;
    for (std::uint32_t c = 0; c < atlas.chart_count; ++c) {
        const double width = outlines[c] > 0.0 ? 2.0 * areas[c] / outlines[c] : 0.0;
        // a thousandth less: no difference of rounding makes a texel
        paddings.push_back(
            std::clamp(static_cast<int>(std::round(0.25 * width - 1e-3)), 1, std::max(1, asked)));
    }
    return paddings;
}

/// Charts whose texels are nearer to each other, or to the rim, than their paddings allow.
std::uint64_t crowded_texels(const Drawn& drawn, const std::vector<int>& paddings)
{
    const int side = static_cast<int>(drawn.side), most = std::ranges::max(paddings);
    const auto at = [&](int x, int y) {
        return drawn.chart[static_cast<std::size_t>(y) * drawn.side + static_cast<std::size_t>(x)];
    };
    std::uint64_t crowded = 0;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            if (at(x, y) == kNoChart)
                continue;
            const int own = paddings[at(x, y)];
            crowded += std::min({x, y, side - 1 - x, side - 1 - y}) < own ? 1 : 0;
            const int reach = own + most;
            for (int j = std::max(0, y - reach); j <= std::min(side - 1, y + reach); ++j) {
                for (int i = std::max(0, x - reach); i <= std::min(side - 1, x + reach); ++i) {
                    const int away = std::max(std::abs(i - x), std::abs(j - y));
                    crowded += at(i, j) != kNoChart && at(i, j) != at(x, y) &&
                                       away <= own + paddings[at(i, j)]
                                   ? 1
                                   : 0;
                }
            }
        }
    }
    return crowded;
}

/// What must hold of every atlas: each triangle has a place, front up, of its own, with padding.
void expect_sound(const Mesh& mesh, const AtlasSettings& settings, const std::string& what)
{
    SCOPED_TRACE(what);
    const Atlas atlas = make_atlas(mesh, settings);
    const std::size_t count = mesh.geometry.triangles.size();
    std::vector<int> places(count, 0);
    for (std::size_t page = 0; page < atlas.layout.pages.size(); ++page) {
        const UvSet& uvs = atlas.layout.pages[page];
        std::uint64_t wrong = 0;
        double doubled = 0.0;
        for (std::uint32_t t = 0; t < count; ++t) {
            const glm::uvec3 corners = uvs.corners[mesh.geometry.scene_triangle(t)];
            const bool has_place = atlas.chart_of[page][t] != kNoChart;
            wrong += has_place != (corners.x != UvSet::kNone) ? 1 : 0;
            if (!has_place)
                continue;
            ++places[t];
            const double area = doubled_in_map(mesh, atlas, page, t);
            wrong += area > 0.0 ? 0 : 1;
            doubled += area;
        }
        EXPECT_EQ(wrong, 0u);
        EXPECT_LE(doubled / 2.0, static_cast<double>(atlas.layout.size.count()));
        EXPECT_EQ(Drawn(mesh, atlas, page, 4).twice, 0u);
        const std::vector<int> paddings =
            paddings_of(mesh, atlas, page, static_cast<int>(settings.padding));
        EXPECT_EQ(crowded_texels(Drawn(mesh, atlas, page), paddings), 0u);
    }
    EXPECT_GE(std::ranges::min(places), 1);
    EXPECT_LE(std::ranges::max(places), settings.blended ? 3 : 1);
    EXPECT_GE(atlas.mean_stretch, 1.0);
    EXPECT_LE(atlas.mean_stretch, 1.5);
    EXPECT_LE(atlas.largest_stretch, 12.0);  // 1 / cos 85 degrees
}

Scene scene_of(std::vector<glm::dvec3> positions, std::vector<glm::uvec3> triangles)
{
    return make_scene(positions, triangles);
}

TEST(Atlas, IsSoundOnEveryKindOfSceneSlow)
{
    for (std::uint32_t i = 0; i < scenes::kFamilyKindCount; ++i) {
        const Mesh mesh = make_mesh(scenes::family_scene(i));
        expect_sound(mesh, {.size = 256, .padding = i % 3}, scenes::family_kind(i));
    }
}

TEST(Atlas, BlendedIsSoundOnEveryKindOfSceneSlow)
{
    for (std::uint32_t i = 0; i < scenes::kFamilyKindCount; i += 4) {
        const Mesh mesh = make_mesh(scenes::family_scene(i));
        expect_sound(mesh, {.size = 256, .padding = 1, .blended = true}, scenes::family_kind(i));
    }
}

TEST(Atlas, IsSoundOnOddSurfaces)
{
    Scene moebius;  // 20 quads round, the last joins the first upside down
    for (std::uint32_t i = 0; i < 20; ++i) {
        const double round = 2 * std::numbers::pi * i / 20;
        for (const double across : {-0.3, 0.3}) {
            const double r = 1.0 + across * std::cos(round / 2);
            moebius.positions.push_back(
                {r * std::cos(round), r * std::sin(round), across * std::sin(round / 2)});
        }
        const std::uint32_t a = 2 * i, b = a + 1, turned = i == 19 ? 1 : 0;
        const std::uint32_t c = (a + 2) % 40 + turned, d = (a + 3) % 40 - turned;
        moebius.triangles.insert(moebius.triangles.end(), {{a, b, c}, {b, d, c}});
    }
    Scene fan;  // 7 triangles at one edge
    fan.positions = {{0, 0, 0}, {0, 0, 1}};
    for (std::uint32_t i = 0; i < 7; ++i) {
        fan.positions.push_back({std::cos(i), std::sin(i), 0.5});
        fan.triangles.push_back({0, 1, 2 + i});
    }
    const Scene sheet = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8);
    Scene spiral = scenes::grid(400, 2, [](double s, double t) {  // four times over itself
        const double round = 8 * std::numbers::pi * s;
        return glm::dvec3((1 + t) * std::cos(round), (1 + t) * std::sin(round), s);
    });
    expect_sound(make_mesh(scenes::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})), {.size = 64}, "one");
    expect_sound(make_mesh(scenes::triangle({0, 0, 0}, {1, 0, 0}, {0.5, 1e-6, 0})), {.size = 64},
                 "sliver");
    expect_sound(make_mesh(scene_of(moebius.positions, moebius.triangles)), {.size = 128},
                 "moebius");
    expect_sound(make_mesh(scene_of(fan.positions, fan.triangles)), {.size = 64}, "fan");
    expect_sound(make_mesh(sheet + sheet + scenes::flipped(sheet)), {.size = 128}, "doubled");
    expect_sound(make_mesh(spiral), {.size = 128}, "spiral");
    const Mesh nothing = make_mesh(scenes::triangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0}));
    EXPECT_EQ(make_atlas(nothing, {.size = 64}).chart_count, 0u);
}

/// A second sheet over the same edges is a chart too, not a heap of triangles.
TEST(Atlas, ChartsAreFewWhereTheSurfaceAllows)
{
    const Scene sheet = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8);
    const auto charts = [](const Scene& scene) {
        return make_atlas(make_mesh(scene), {.size = 512}).chart_count;
    };
    EXPECT_EQ(charts(sheet), 1u);
    EXPECT_EQ(charts(sheet + sheet + scenes::flipped(sheet)), 3u);
    EXPECT_EQ(charts(scenes::box({0, 0, 0}, {1, 2, 3}, 4)), 6u);
    const Scene disc = scenes::grid(2000, 1, [](double s, double t) {  // one vertex has 2000
        const double round = 2 * std::numbers::pi * s;
        return glm::dvec3(t * std::cos(round), -t * std::sin(round), 0);
    });
    EXPECT_LE(charts(disc), 4u);
}

/// No filter fetches another chart: all that is around any point is its chart's, or nobody's.
TEST(Atlas, FootprintsKeepToTheirCharts)
{
    const Mesh mesh = make_mesh(scenes::bumpy_sphere(24));
    const Atlas atlas = make_atlas(mesh, {.size = 256, .padding = 0});
    const Drawn drawn(mesh, atlas, 0);
    Random random(1);
    std::uint64_t strange = 0, nothing = 0;
    for (int i = 0; i < 100000; ++i) {
        const auto t = static_cast<std::uint32_t>(random.bits() % mesh.geometry.triangles.size());
        const double root = std::sqrt(random.share()), share = random.share();
        const SurfacePoint point{t, {root * (1 - share), root * share}};
        const glm::dvec2 at =
            *uv_at(mesh.geometry, atlas.layout.pages[0], point) * static_cast<double>(drawn.side) -
            0.5;
        bool has_own = false;
        for (std::uint32_t corner = 0; corner < 4; ++corner) {
            const auto x = static_cast<std::size_t>(at.x) + (corner & 1);
            const auto y = static_cast<std::size_t>(at.y) + (corner >> 1);
            ASSERT_LT(std::max(x, y), drawn.side);
            const std::uint32_t there = drawn.chart[y * drawn.side + x];
            has_own |= there == atlas.chart_of[0][t];
            strange += there != kNoChart && there != atlas.chart_of[0][t] ? 1 : 0;
        }
        nothing += has_own ? 0 : 1;
    }
    EXPECT_EQ(strange, 0u);
    EXPECT_EQ(nothing, 0u);
}

/// Corners have one value if, and only if, they are one place in one chart: writers cut vertices
/// where values differ.
TEST(Atlas, CornersOfAPlaceInAChartShareAValue)
{
    const Mesh mesh = make_mesh(scenes::sphere({0, 0, 0}, 1, 8));
    const Atlas atlas = make_atlas(mesh, {.size = 128});
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> values;
    for (std::uint32_t t = 0; t < mesh.geometry.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t place = mesh.geometry.welded[mesh.geometry.triangles[t][k]];
            const std::uint32_t value = atlas.layout.pages[0].corners[t][k];
            EXPECT_EQ(values.try_emplace({atlas.chart_of[0][t], place}, value).first->second,
                      value);
        }
    }
    EXPECT_EQ(values.size(), atlas.layout.pages[0].values.size());
}

TEST(Atlas, SizeFollowsFromTexelsPerUnit)
{
    const Mesh mesh = make_mesh(scenes::box({10, 0, 0}, {12, 1, 1}, 2));  // area 10
    const Atlas atlas = make_atlas(mesh, {.texels_per_unit = 100.0, .padding = 2});
    EXPECT_EQ(atlas.layout.size.width % 4, 0u);
    EXPECT_EQ(atlas.layout.size.height, atlas.layout.size.width);
    EXPECT_NEAR(atlas.texels_per_unit, 100.0, 1e-9);
    EXPECT_NEAR(atlas.use * static_cast<double>(atlas.layout.size.count()), 100000.0, 3000.0);
    EXPECT_LE(atlas.layout.size.width, 412u);  // two sides of 2 and padding
    EXPECT_THROW((void)make_atlas(mesh, {.texels_per_unit = 20000.0}), SettingsError);
}

TEST(Atlas, SettingsOutOfRangeAreRefused)
{
    const Mesh mesh = make_mesh(scenes::box({0, 0, 0}, {1, 1, 1}, 1));
    for (const AtlasSettings& settings :
         {AtlasSettings{.size = 0}, AtlasSettings{.size = kMostTexels + 1},
          AtlasSettings{.texels_per_unit = 0.0}, AtlasSettings{.texels_per_unit = HUGE_VAL},
          AtlasSettings{.padding = kMostPadding + 1}})
        EXPECT_THROW((void)make_atlas(mesh, settings), SettingsError);
}

/// Leaves that touch nowhere: not even as single texels do they fit.
TEST(Atlas, ChartsThatDoNotFitAreRefusedInASentence)
{
    Scene leaves;
    for (int i = 0; i < 400; ++i)
        leaves += scenes::sheet({2.0 * i, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
    const Mesh mesh = make_mesh(leaves);
    const Mesh leaf = make_mesh(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1));
    const auto fault_of = [](const Mesh& of, const AtlasSettings& settings) -> std::string {
        try {
            (void)make_atlas(of, settings);
        } catch (const SettingsError& error) {
            return error.what();
        }
        return "it fits";
    };
    EXPECT_EQ(fault_of(mesh, {.size = 16}),
              "no room for 400 charts in a map of 16 texels a side with a padding of 4");
    EXPECT_EQ(fault_of(leaf, {.size = 1}),
              "no room for 1 chart in a map of 1 texels a side with a padding of 4");
    EXPECT_EQ(fault_of(leaf, {.size = 16, .padding = 20}),
              "no room for 1 chart in a map of 16 texels a side with a padding of 20");
    EXPECT_EQ(fault_of(leaf, {.size = 16}), "it fits");
    expect_sound(mesh, {.size = 64}, "on 64 texels");
}

TEST(Atlas, HasTheSameBytesOnAnyNumberOfThreads)
{
    const Mesh mesh = make_mesh(scenes::bumpy_sphere(16));
    std::vector<Atlas> atlases;
    for (const std::size_t threads : {1, 2, 3}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        atlases.push_back(make_atlas(mesh, {.size = 256}));
    }
    for (const Atlas& atlas : atlases) {
        EXPECT_EQ(atlas.layout.pages[0].values, atlases[0].layout.pages[0].values);
        EXPECT_EQ(atlas.layout.pages[0].corners, atlases[0].layout.pages[0].corners);
        EXPECT_EQ(atlas.chart_of, atlases[0].chart_of);
    }
}

TEST(Atlas, TellsHowFarItIsAndStops)
{
    const Mesh mesh = make_mesh(scenes::bumpy_sphere(16));
    double last = 0.0;
    (void)make_atlas(mesh, {.size = 128}, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
        return true;
    });
    EXPECT_EQ(last, 1.0);
    EXPECT_THROW((void)make_atlas(mesh, {.size = 128}, [](double done) { return done < 0.7; }),
                 Cancelled);
}

}  // namespace
}  // namespace surfelao
