#include "bake/grid_target.h"

#include "bake/cone_fit.h"
#include "bake/grid_fit.h"
#include "engines/threads.h"
#include "grid/cone.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "surfels/geometry.h"

#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <cmath>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

GridSettings grid_settings_for(GridStore store, int resolution = 12)
{
    return {.resolution = resolution, .store = store};
}

GridBake grid_baked(const Scene& scene, const GridSettings& settings, std::uint32_t check = 0)
{
    return bake_grid(make_geometry(scene), settings, {}, check);
}

template <class Visit>
void for_each_grid_cell(const AoGrid& grid, const Visit& visit)
{
    for (int z = 0; z < grid.cells.z; ++z)
        for (int y = 0; y < grid.cells.y; ++y)
            for (int x = 0; x < grid.cells.x; ++x)
                visit(glm::ivec3(x, y, z));
}

const float* grid_values_at(const AoGrid& grid, glm::ivec3 cell)
{
    return &grid.values[grid.index_of(cell) * channels_of(grid.store)];
}

/// What a ball of radius 1 about the origin hides: alpha = (1 - sqrt(1 - s^2)) / 2, m = pi s^2
/// towards it, of a receiver that sees all of it s^2 cos; s: its radius over the distance. At any
/// quality sh reads up to 0.020 less close to the ball, whose cap has an edge.
TEST(GridTarget, ABallHidesItsCap)
{
    for (const GridStore store : {GridStore::cone, GridStore::sh}) {
        const AoGrid grid =
            grid_baked(scenes::sphere({0, 0, 0}, 1.0, 40), grid_settings_for(store)).grid;
        double moments = 0.0, read = 0.0;
        for_each_grid_cell(grid, [&](glm::ivec3 cell) {
            const glm::dvec3 place = place_of(grid, cell);
            const double distance = glm::length(place);
            if (distance < 1.3)
                return;
            const double square = 1.0 / (distance * distance);
            const glm::vec4 found = moments_of(store, grid_values_at(grid, cell));
            const glm::vec3 mean(-0.25 * square * place / distance);
            moments = std::max({moments, std::abs(found.w - 0.5 * (1.0 - std::sqrt(1.0 - square))),
                                double{glm::distance(glm::vec3(found), mean)}});
            const float towards =
                occlusion_of(store, grid_values_at(grid, cell), glm::vec3(-place / distance));
            read = std::max(read, std::abs(towards - square));
        });
        EXPECT_LT(moments, 0.006) << name_of(store);
        EXPECT_LT(read, 0.023) << name_of(store);
    }
}

/// What two caps hide, half a radian apart, is no cone; what one hides is.
TEST(ConeFit, ComesNearerToWhatReceiversSee)
{
    std::vector<glm::vec3> normals;
    for (int i = 0; i < 16; ++i) {
        const float z = 1.0f - (2.0f * static_cast<float>(i) + 1.0f) / 16.0f;
        const float r = std::sqrt(1.0f - z * z), turn = 2.4f * static_cast<float>(i);
        normals.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
    }
    const auto moments_of_cap = [](glm::vec3 axis, float alpha) {
        return glm::vec4(alpha * (1.0f - alpha) * axis, alpha);
    };
    const glm::vec4 first = moments_of_cap({0.0f, 0.0f, 1.0f}, 0.1f);
    const glm::vec4 second = moments_of_cap({std::sin(0.5f), 0.0f, std::cos(0.5f)}, 0.15f);
    std::vector<Occlusion> of_first, of_both;
    for (const glm::vec3 normal : normals) {
        of_first.push_back({occlusion_by(cone_of(first), normal)});
        of_both.push_back({of_first.back().occlusion + occlusion_by(cone_of(second), normal)});
    }
    const auto error_of = [&](glm::vec4 moments) {
        double sum = 0.0;
        for (std::size_t k = 0; k < normals.size(); ++k) {
            const double off =
                double{occlusion_by(cone_of(moments), normals[k]) - of_both[k].occlusion};
            sum += off * off;
        }
        return std::sqrt(sum / 16.0);
    };
    EXPECT_LT(glm::distance(fit_cone(first, normals, of_first), first), 1e-5f);
    const glm::vec4 both = first + second;
    const double before = error_of(both), after = error_of(fit_cone(both, normals, of_both));
    EXPECT_GT(before, 0.005);
    EXPECT_LT(after, 0.97 * before) << before << ' ' << after;
}

/// A sheet from close above: half of all directions.
TEST(GridTarget, ASheetHidesHalfOfAll)
{
    const Geometry sheet =
        make_geometry(scenes::sheet({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, 20));
    GridSettings settings = grid_settings_for(GridStore::sh, 13);
    const AoGrid grid = bake_grid(sheet, settings, {}, 0).grid;
    const glm::ivec3 above(6, 6, 7);
    const glm::dvec3 place = place_of(grid, above);
    ASSERT_GT(place.z, 0.0);
    ASSERT_LT(place.z, 1.0);
    const glm::vec4 moments = moments_of(grid.store, grid_values_at(grid, above));
    EXPECT_NEAR(moments.w, 0.5f, 0.02f);
    EXPECT_NEAR(-4.0f * moments.z, 1.0f, 0.03f);  // |m| = pi
    EXPECT_NEAR(occlusion_of(grid.store, grid_values_at(grid, above), {0, 0, -1}), 1.0f, 0.03f);
    EXPECT_NEAR(occlusion_of(grid.store, grid_values_at(grid, above), {0, 0, 1}), 0.0f, 0.03f);
}

/// In the middle between two layers of cells, or in one.
TEST(GridTarget, ASheetHidesNothingFromItsOwnSides)
{
    const Geometry sheet = make_geometry(scenes::sheet({-1, -1, 3}, {2, 0, 0}, {0, 2, 0}, 8));
    for (const int cells : {12, 13}) {
        const GridBake bake = bake_grid(sheet, grid_settings_for(GridStore::cone, cells), {}, 0);
        EXPECT_EQ(glm::dvec2(bake.lift), glm::dvec2(0.0));
        EXPECT_LT(bake.lift.z, 0.01);
        for (const float side : {-1.0f, 1.0f}) {
            const glm::vec3 normal(0, 0, side);
            const glm::dvec3 read = glm::dvec3(0.1, 0.2, 3.0) + bake.lift * glm::dvec3(normal);
            EXPECT_LT(occlusion_at(bake.grid, read, normal), 0.02f) << cells << ' ' << side;
            EXPECT_GT(occlusion_at(bake.grid, read, -normal), 0.95f) << cells << ' ' << side;
        }
    }
    EXPECT_EQ(bake_grid(make_geometry(scenes::box({0, 0, 0}, {1, 1, 0.1}, 2)),
                        grid_settings_for(GridStore::cone, 8), {}, 0)
                  .lift,
              glm::dvec3(0.0));
}

TEST(GridTarget, TheBoxOfACubeReachesAsFarAsEpsSays)
{
    GridSettings settings;
    settings.extent = 0.1;
    const AoGrid grid = empty_grid({{-1, -1, -1}, {1, 1, 1}}, settings);
    EXPECT_NEAR(grid.high.x, 2.784, 0.001);
    EXPECT_EQ(grid.low, -grid.high);
    settings.extent = 0.03;
    EXPECT_NEAR(empty_grid({{-1, -1, -1}, {1, 1, 1}}, settings).high.z, 4.257, 0.001);
}

TEST(GridTarget, CellsStandAtTheBendOfTheWarp)
{
    for (const int cells : {4, 5, 24, 32, 33}) {
        GridSettings settings;
        settings.resolution = cells;
        const AoGrid grid = empty_grid({{0, 0, 0}, {1, 2, 3}}, settings);
        const float cell = 0.5f * (grid.inner_share + 1.0f) * static_cast<float>(cells - 1);
        EXPECT_NEAR(cell, std::round(cell), 1e-4f) << cells;
        EXPECT_LT(grid.inner_share, 1.0f) << cells;
    }
}

TEST(GridTarget, ASheetHasABoxAndUniformCellsAreEven)
{
    GridSettings settings;
    settings.extent = kMostExtent;
    const AoGrid flat = empty_grid({{0, 0, 5}, {1, 1, 5}}, settings);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LT(flat.low[axis], flat.high[axis]);
        EXPECT_GT(flat.inner[axis], 0.0f);
        EXPECT_LT(flat.inner[axis], 1.0f);
    }
    settings.uniform = true;
    const AoGrid even = empty_grid({{0, 0, 0}, {1, 2, 3}}, settings);
    const glm::dvec3 step = (even.high - even.low) / 31.0;
    EXPECT_LT(glm::distance(place_of(even, {7, 8, 9}), even.low + glm::dvec3(7, 8, 9) * step),
              1e-5);
}

TEST(GridTarget, CellsInABodyAreMovedOutOfIt)
{
    const GridBake bake =
        grid_baked(scenes::sphere({0, 0, 0}, 1.0, 20), grid_settings_for(GridStore::cone, 32));
    std::uint64_t in_ball = 0;
    float most = 0.0f;
    for_each_grid_cell(bake.grid, [&](glm::ivec3 cell) {
        const glm::dvec3 place = place_of(bake.grid, cell);
        in_ball += glm::length(place) < 1.0;
        float beside[4];
        read_values(bake.grid, 1.01 * glm::normalize(place), beside);
        most = std::max(most, beside[3]);
    });
    EXPECT_NEAR(static_cast<double>(bake.inside), static_cast<double>(in_ball),
                0.01 * static_cast<double>(in_ball));
    EXPECT_LT(most, 0.55f);  // just out of a ball half is hidden
}

/// Of values that are linear in the place, all blends are right once the cells inside continue
/// them.
TEST(GridFit, CellsInsideContinueWhatIsRightOutside)
{
    AoGrid grid = empty_grid({{-1, -1, -1}, {1, 1, 1}}, grid_settings_for(GridStore::cone));
    const auto right_at = [](glm::dvec3 p) {
        return 0.1f * glm::vec4(glm::vec3(p), 2.0f * static_cast<float>(p.x));
    };
    const auto is_in = [](glm::dvec3 p) { return glm::length(p) < 1.3; };
    std::vector<std::uint8_t> is_inside;
    for_each_grid_cell(grid, [&](glm::ivec3 cell) {
        const glm::dvec3 place = place_of(grid, cell);
        is_inside.push_back(is_in(place) ? 1 : 0);
        for (int c = 0; c < 4; ++c)
            grid.values.push_back(is_in(place) ? 0.0f : right_at(place)[c]);
    });
    std::vector<glm::dvec3> places = places_beside(grid, is_inside);
    std::erase_if(places, is_in);
    ASSERT_GT(places.size(), 100u);
    std::vector<float> values;
    for (const glm::dvec3 place : places)
        for (int c = 0; c < 4; ++c)
            values.push_back(right_at(place)[c]);
    const auto error = [&] {
        double square = 0.0;
        for (const glm::dvec3 place : places) {
            glm::vec4 found;
            read_values(grid, place, &found.x);
            const glm::vec4 off = found - right_at(place);
            square += glm::dot(off, off);
        }
        return std::sqrt(square / static_cast<double>(places.size()));
    };
    const double before = error();
    EXPECT_GT(before, 0.05);
    fit_inside(grid, is_inside, places, values);
    EXPECT_LT(error(), 0.7 * before);  // the rest is the weight of their own values
}

TEST(GridTarget, SameBytesForAnyNumberOfThreads)
{
    std::vector<std::vector<float>> values;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        values.push_back(
            grid_baked(scenes::bumpy_sphere(8), grid_settings_for(GridStore::sh)).grid.values);
    }
    EXPECT_EQ(values[0], values[1]);
}

/// The cells about an object that is turned about z are those of the other, turned: as exactly as
/// the masks and the directions, which do not turn with it.
TEST(GridTarget, ATurnedObjectHasATurnedGrid)
{
    const Scene scene = scenes::box({-1, -2, -1}, {1, 2, 0.5}, 6);
    const AoGrid grid = grid_baked(scene, grid_settings_for(GridStore::cone)).grid;
    const AoGrid turned =
        grid_baked(scenes::moved(scene, [](glm::dvec3 p) { return glm::dvec3(-p.y, p.x, p.z); }),
                   grid_settings_for(GridStore::cone))
            .grid;
    double square = 0.0;
    for_each_grid_cell(grid, [&](glm::ivec3 cell) {
        const glm::dvec3 from_middle = glm::abs(place_of(grid, cell) - glm::dvec3(0, 0, -0.25));
        if (glm::all(glm::lessThan(from_middle, glm::dvec3(1, 2, 0.75))))
            return;
        const float* here = grid_values_at(grid, cell);
        const float* there = grid_values_at(turned, {grid.cells.y - 1 - cell.y, cell.x, cell.z});
        const glm::vec4 expected(-here[1], here[0], here[2], here[3]);
        square += glm::dot(expected - glm::vec4(there[0], there[1], there[2], there[3]),
                           expected - glm::vec4(there[0], there[1], there[2], there[3]));
    });
    EXPECT_LT(std::sqrt(square / static_cast<double>(grid.cell_count())), 0.006);
}

TEST(GridTarget, TheBordersLargestValueIsNothingAfterRescaling)
{
    const Scene scene = scenes::box({-1, -1, -1}, {1, 1, 1}, 4);
    GridSettings settings = grid_settings_for(GridStore::cone);
    settings.border = GridBorder::rescale;
    const AoGrid grid = grid_baked(scene, settings).grid;
    float most = 0.0f, alpha_there = 0.0f;
    for_each_grid_cell(grid, [&](glm::ivec3 cell) {
        const bool on_face =
            glm::any(glm::equal(cell, glm::ivec3(0))) || glm::any(glm::equal(cell, grid.cells - 1));
        const float alpha = grid_values_at(grid, cell)[3];
        if (!on_face)
            return;
        alpha_there = std::max(alpha_there, alpha);
        most = std::max(most, alpha * border_weight(grid, place_of(grid, cell), alpha));
    });
    EXPECT_EQ(most, 0.0f);
    EXPECT_EQ(alpha_there, grid.border_value);
    EXPECT_GT(grid.border_value, 0.01f);
    EXPECT_LT(grid.border_value, 0.05f);
}

TEST(GridTarget, StatesItsError)
{
    const GridBake bake =
        grid_baked(scenes::bumpy_sphere(16), grid_settings_for(GridStore::sh, 16), 400);
    ASSERT_TRUE(bake.error.has_value());
    EXPECT_EQ(bake.error->points, 400u);
    EXPECT_GT(bake.error->rmse, 0.001);
    EXPECT_LT(bake.error->rmse, 0.03);
    EXPECT_LE(bake.error->low, bake.error->rmse);
    EXPECT_GE(bake.error->high, bake.error->rmse);
}

/// What both boxes hide from a floor's point, from their own grids: the product of what each leaves
/// is right where one of them hides next to nothing. Where both hide a and b, one beside the other,
/// it leaves a b too much; where they overlap it counts twice what both hide (too dark).
TEST(GridTarget, GridsOfSeveralBodiesMultiplyWhereTheyAreApart)
{
    const Scene box = scenes::box({-1, -1, -1}, {1, 1, 1}, 6);
    GridSettings settings = grid_settings_for(GridStore::sh, 32);
    const AoGrid grid = grid_baked(box, settings).grid;
    const auto both = [&](double apart, glm::dvec3 place) {
        const float first = occlusion_at(grid, place, {0, 1, 0});
        const float second = occlusion_at(grid, place - glm::dvec3(apart, 0, 0), {0, 1, 0});
        return 1.0f - (1.0f - first) * (1.0f - second);
    };
    const auto truth = [&](double apart, glm::dvec3 place) {
        const Geometry pair = make_geometry(
            box + scenes::moved(box, [&](glm::dvec3 p) { return p + glm::dvec3(apart, 0, 0); }));
        const Receiver receiver{glm::vec3((place - pair.frame.centre) / pair.frame.diagonal),
                                {0, 1, 0}};
        return trace_occlusion(RayScene(pair, RayScene::Build::robust), {&receiver, 1},
                               {.rays = 4096})[0]
            .occlusion;
    };
    for (const double x : {-1.5, 0.0, 0.5})
        EXPECT_NEAR(both(5.0, {x, -2.2, 0}), truth(5.0, {x, -2.2, 0}), 0.01) << x;
    const float middle = occlusion_at(grid, {2.5, -2.2, 0}, {0, 1, 0});
    EXPECT_NEAR(both(5.0, {2.5, -2.2, 0}) + middle * middle, truth(5.0, {2.5, -2.2, 0}), 0.01);
    EXPECT_GT(both(0.5, {0, -1.6, 0}), truth(0.5, {0, -1.6, 0}) + 0.05f);
}

TEST(GridTarget, WhatCannotBeIsRefused)
{
    const Geometry box = make_geometry(scenes::box({-1, -1, -1}, {1, 1, 1}, 1));
    for (const GridSettings& wrong :
         {GridSettings{.resolution = 3}, GridSettings{.resolution = 257},
          GridSettings{.extent = 0.0}, GridSettings{.extent = 0.6},
          GridSettings{.depth = MapDepth::whole}})
        EXPECT_THROW(static_cast<void>(bake_grid(box, wrong, {}, 0)), SettingsError);
    EngineSettings bunnell;
    bunnell.engine = Engine::rays;
    bunnell.definition.kernel = Kernel::bunnell;
    EXPECT_THROW(static_cast<void>(bake_grid(box, {}, bunnell, 0)), SettingsError);
    EXPECT_THROW(static_cast<void>(bake_grid(make_geometry(Scene{}), {}, {}, 0)), InputError);
    const StageProgress stop = [](std::string_view stage, double) { return stage != "repair"; };
    EXPECT_THROW(static_cast<void>(bake_grid(box, {.resolution = 4}, {}, 0, stop)), Cancelled);
}

}  // namespace
}  // namespace surfelao
