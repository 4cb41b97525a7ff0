// What lies on the pixels of a cell in place of values of its own: cube maps, AO grids, methods
// that know the picture alone.

#include "viewer/cell_view.h"

#include "../gpu/contexts.h"
#include "../pixels/looks.h"
#include "bake/grid_target.h"
#include "scenes.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <vector>

namespace surfelao {
namespace {

constexpr PictureSize kSmall{72, 48};  // all are asked by rays: less than kErrorPixels

/// A cell's view of a ball in a file of its own.
class Layers : public testing::Test {
protected:
    Layers()
    {
        write_obj(folder_ / "ball.obj", scenes::bumpy_sphere(12));
        view_.session().open(folder_ / "ball.obj", UpAxis::y, cell_.settings);
    }

    /// A frame for each time that the condition does not hold; at most half a minute.
    bool look_until(auto condition)
    {
        for (int i = 0; i < 30000; ++i) {
            static_cast<void>(view_.update());
            view_.session().solve(cell_.settings);
            if (view_.session().state().model) {
                camera_ = camera_.value_or(frame_points(view_.model()->seen, UpAxis::y, 1.5f));
                static_cast<void>(view_.look(cell_, *camera_, kSmall, rays_));
            }
            if (view_.session().state().is_solved && condition())
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }

    Look look(int guard = 0) const
    {
        return {*view_.model()->mesh, view_of(*camera_, kSmall.width, kSmall.height), kSmall,
                guard};
    }

    /// The largest difference to these values of seen pixels.
    float farthest_from(const SeenPixels& seen, std::span<const Occlusion> values) const
    {
        float farthest = 0.0f;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const auto pixel = static_cast<int>(seen.pixels[i]);
            const std::optional<float> told =
                view_.told_by_picture({pixel % kSmall.width, pixel / kSmall.width});
            farthest = std::max(farthest, std::abs(told.value_or(-1.0f) - values[i].occlusion));
        }
        return farthest;
    }

    TemporaryFolder folder_;
    Cell cell_;
    std::optional<Camera> camera_;
    PixelRays rays_;
    CellView view_{test_context()};
};

// A camera so near that the ball goes beyond all edges; what stands there changes what is told.
TEST_F(Layers, AGuardShowsWhatTheMethodTellsOfALargerPicture)
{
    cell_.at_pixels = true;
    cell_.screen = screen_settings(ScreenMethod::gtao, 8);
    ASSERT_TRUE(look_until([] { return true; }));
    zoom(*camera_, 0.4f);
    Occluders nobody(view_.model()->occluding());
    ScreenSpace screen(test_context());
    for (const int guard : {0, 12}) {
        cell_.guard = static_cast<float>(guard) / static_cast<float>(kSmall.height);
        ASSERT_TRUE(look_until([&] { return view_.has_pixels(); }));
        for (const int other : {0, 12}) {
            const Look seen = look(other);
            const std::vector<Occlusion> expected =
                answer(seen.pixels, nobody, screen, *cell_.screen, {}).values;
            const float farthest = farthest_from(seen.pixels.seen(), expected);
            if (other == guard)
                EXPECT_EQ(farthest, 0.0f) << guard;
            else
                EXPECT_GT(farthest, 0.05f) << guard;
        }
    }
    // and that is what is drawn
    const Look seen = look(12);
    EngineSettings rays;
    rays.engine = Engine::rays;
    rays.rays = rays_.rays = 16;
    ASSERT_TRUE(look_until([&] { return view_.pixel_error().has_value(); }));
    const ErrorStatistics expected =
        error_statistics(answer(seen.pixels, nobody, screen, *cell_.screen, {}).values,
                         answer(seen.pixels, nobody, screen, rays, {}).values);
    EXPECT_NEAR(view_.pixel_error()->found.bias, expected.bias, 1e-4);
    EXPECT_NEAR(view_.pixel_error()->found.rmse, expected.rmse, 1e-4);
}

TEST_F(Layers, AGridIsThatOfABakeAndTellsWhatAPictureOfItShows)
{
    GridSettings settings;
    settings.resolution = 8;
    set_where(cell_, Where::grid, {.texels = {}, .grid = settings});
    ASSERT_TRUE(look_until([&] { return view_.has_pixels(); }));
    const Geometry& object = view_.model()->occluding();
    const auto grid = std::make_shared<const AoGrid>(bake_grid(object, settings, {}, 0).grid);
    EXPECT_EQ(view_.grid().grids().front()->grid.values, grid->values);
    const double scale = 1.0 / object.frame.diagonal;
    const PlacedGrid placed{grid,
                            *placement_of(glm::scale(glm::dmat4(1.0), glm::dvec3(scale)) *
                                          glm::translate(glm::dmat4(1.0), -object.frame.centre))};
    GridPixels pixels;
    pixels.world = std::make_shared<GridWorld>(std::vector<PlacedGrid>{placed},
                                               std::make_shared<const Geometry>());
    GridPass pass(test_context());
    const auto expect_told = [&] {
        const Look seen = look();
        const std::vector<Occlusion> expected = answer(seen.pixels, pass, pixels, {}).values;
        EXPECT_LT(farthest_from(seen.pixels.seen(), expected), 1e-5f);
    };
    expect_told();
    orbit(*camera_, 70.0f, 0.0f);  // nothing is solved for another camera
    EXPECT_TRUE(view_.look(cell_, *camera_, kSmall, {}));
    expect_told();

    settings.store = GridStore::sh;
    set_where(cell_, Where::grid, {.texels = {}, .grid = settings});
    // the old grid is shown until the new one is there
    ASSERT_TRUE(
        look_until([&] { return view_.grid().grids().front()->grid.store == GridStore::sh; }));
    set_where(cell_, Where::vertices, {});
    EXPECT_TRUE(view_.look(cell_, *camera_, kSmall, {}));
    EXPECT_FALSE(view_.has_pixels());
}

// Disks of no strength tell nothing, horizons of the same place something.
TEST_F(Layers, MapsArePlacedAndSolvedByWhoeverIsAsked)
{
    cell_.settings.engine.engine = Engine::disks;
    cell_.settings.engine.strength = 0.0f;
    set_where(cell_, Where::cube_maps, {});
    ASSERT_TRUE(look_until([] { return true; }));
    view_.place_maps();
    const auto darkest_told = [&] {
        float darkest = 0.0f;
        for (int x = 0; x < kSmall.width; ++x)
            darkest =
                std::max(darkest, view_.told_by_picture({x, kSmall.height / 2}).value_or(0.0f));
        return darkest;
    };
    ASSERT_TRUE(look_until([&] { return view_.has_pixels(); }));
    EXPECT_GT(view_.cubes().count(), 1u);
    EXPECT_EQ(darkest_told(), 0.0f);
    cell_.screen = cube_horizon();
    ASSERT_TRUE(look_until([&] { return view_.has_pixels() && darkest_told() > 0.05f; }));
}

}  // namespace
}  // namespace surfelao
