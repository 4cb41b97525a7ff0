#include "pixels/grid_sources.h"

#include "files/scene_io.h"
#include "looks.h"
#include "pixels/pixel_picture.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+=;

const std::string kRobot = std::string(SURFELAO_DATA_FOLDER) + "/robot.glb";

/// A scene whose objects have grids of their own.
struct GridScene {
    GridScene(Scene rest, const std::vector<Scene>& objects, const GridSettings& settings = {})
    {
        Scene all = std::move(rest);
        std::vector<std::size_t> firsts;
        for (const Scene& object : objects) {
            firsts.push_back(all.triangles.size());
            all += object;
        }
        for (std::size_t i = 0; i < objects.size(); ++i) {
            std::vector<bool> own(all.triangles.size(), false);
            std::fill_n(own.begin() + static_cast<std::ptrdiff_t>(firsts[i]),
                        objects[i].triangles.size(), true);
            GridBake baked = bake_grid(make_geometry(objects[i]), settings, {}, 0);
            sources.grids.push_back(
                {"object", std::make_shared<const AoGrid>(std::move(baked.grid)), std::move(own)});
        }
        mesh = make_mesh(std::move(all));
        pixels.world = grid_world_of(mesh, {}, {}, sources);
    }

    GridSources sources;
    Mesh mesh;
    GridPixels pixels;
};

/// Answers less rays.
struct Found {
    double rmse = 0.0, bias = 0.0, rays = 0.0;  ///< rays: their mean
};

Found compared(const GridScene& scene, GridMerge merge, std::span<const Receiver> receivers)
{
    GridPixels pixels = scene.pixels;
    pixels.merge = merge;
    const std::vector<Occlusion> found = solve_with_grids(pixels, receivers);
    const EngineSettings rays{{.engine = Engine::rays}, {.rays = 1024}};
    const std::vector<Occlusion> truth =
        solve(prepare(scene.mesh.geometry, rays), receivers, rays).occlusion;
    Found sums;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double off = static_cast<double>(found[i].occlusion - truth[i].occlusion);
        sums.rmse += off * off;
        sums.bias += off;
        sums.rays += static_cast<double>(truth[i].occlusion);
    }
    const auto count = static_cast<double>(found.size());
    return {std::sqrt(sums.rmse / count), sums.bias / count, sums.rays / count};
}

/// What a camera straight above sees of the floor z = 0, as receivers.
std::vector<Receiver> floor_receivers(const Mesh& mesh, double low, double high)
{
    constexpr int kSide = 40;
    std::vector<Receiver> receivers;
    const Frame& frame = mesh.geometry.frame;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const glm::dvec3 place(low + (high - low) * (x + 0.5) / kSide,
                                   low + (high - low) * (y + 0.5) / kSide, 1e-4);
            receivers.push_back(
                {glm::vec3((place - frame.centre) / frame.diagonal), {0, 0, 1}, 1e-5f});
        }
    }
    return receivers;
}

Scene floor_below()
{
    return scenes::sheet({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 1);
}

TEST(GridWorld, TheFloorUnderAnObjectIsRightSlow)
{
    const Scene object = scenes::moved(
        scenes::bumpy_sphere(10), [](glm::dvec3 p) { return 0.5 * p + glm::dvec3(0, 0, 0.65); });
    for (const GridStore store : {GridStore::cone, GridStore::sh}) {
        const GridScene scene(floor_below(), {object}, {.store = store});
        const Found found =
            compared(scene, GridMerge::product, floor_receivers(scene.mesh, -1.5, 1.5));
        EXPECT_LE(found.rmse, 0.01) << name_of(store);
        EXPECT_GT(found.rays, 0.05);
    }
}

// The grids reach so far that what their borders cut off is no matter.
TEST(GridWorld, BoxesFarApartMultiplySlow)
{
    const GridScene scene(floor_below(),
                          {scenes::box({-1.3, -0.3, 0.3}, {-0.7, 0.3, 0.9}, 4),
                           scenes::box({0.7, -0.3, 0.3}, {1.3, 0.3, 0.9}, 4)},
                          {.resolution = 48, .extent = 0.01});
    for (const GridMerge merge : {GridMerge::product, GridMerge::caps}) {
        const Found found = compared(scene, merge, floor_receivers(scene.mesh, -1.5, 1.5));
        EXPECT_LE(found.rmse, 0.01) << name_of(merge);
    }
}

// Of two boxes one above the other the floor sees the lower one: the product counts both, joined
// cones do so in part (their caps are round, the boxes are not).
TEST(GridWorld, ABoxBehindAnotherIsTooDarkByProductMoreThanByUnion)
{
    const GridScene stacked(floor_below(),
                            {scenes::box({-0.5, -0.5, 0.2}, {0.5, 0.5, 0.4}, 4),
                             scenes::box({-0.5, -0.5, 0.45}, {0.5, 0.5, 0.65}, 4)},
                            {.resolution = 32});
    const std::vector<Receiver> below = floor_receivers(stacked.mesh, -0.6, 0.6);
    const Found product = compared(stacked, GridMerge::product, below);
    const Found joined = compared(stacked, GridMerge::caps, below);
    EXPECT_GT(product.bias, 0.1);
    EXPECT_GT(joined.bias, 0.0);
    EXPECT_LT(joined.bias, 0.9 * product.bias);
}

TEST(GridWorld, GridsFollowTheirNodes)
{
    const GridSettings coarse{.resolution = 12};
    const ReadOptions then{.moment = Moment{0.3, "walk"}};
    const GridSources sources = bake_moving_grids(kRobot, then, coarse, {});
    ASSERT_EQ(sources.grids.size(), 11u);
    const Mesh posed = make_mesh(read_scene(kRobot, then));
    const std::shared_ptr<GridWorld> world = grid_world_of(posed, {}, {}, sources, then.moment);
    ASSERT_EQ(world->objects().size(), 11u);
    EXPECT_EQ(world->rest().triangles.size(), 2u);
    const Mesh rest = make_mesh(read_scene(kRobot));
    for (std::size_t i = 0; i < 11; ++i) {
        const auto& own = sources.grids[i].triangles;
        const auto first = static_cast<std::size_t>(std::ranges::find(own, true) - own.begin());
        const std::uint32_t vertex = rest.scene.triangles[first].x;
        const PlacedGrid& object = world->objects()[i];
        const glm::dvec3 back = in_object(object, posed.geometry.positions[vertex]);
        EXPECT_LT(glm::distance(back, rest.scene.positions[vertex]), 1e-5) << i;
    }
}

// The picture asks the pass, and its extra receivers the twin.
TEST(GridWorld, APictureShowsIt)
{
    const GridScene scene(floor_below(), {scenes::box({-0.5, -0.5, 0.3}, {0.5, 0.5, 1.3}, 4)},
                          {.resolution = 12});
    const PixelPictureSettings settings{.size = {48, 32}, .samples = 4, .engine = scene.pixels};
    Camera camera;
    camera.up = {0, 0, 1};
    camera.eye = {0.0f, -0.35f, 0.15f};
    const View view = view_of(camera, 48, 32);
    const DrawnMesh drawn(test_context(), scene.mesh.geometry, scene.mesh.surface);
    Occluders occluders(scene.mesh.geometry);
    double shown = 0.0, expected = 0.0;
    const PixelPaint paint{[&](const AnsweredPixel& pixel) {
        EXPECT_EQ(pixel.grids->world, scene.pixels.world);
        const std::vector<Occlusion> twin =
            solve_with_grids(scene.pixels, {&pixel.receiver, 1}, {&pixel.surface, 1});
        return glm::vec3(pixel.value.occlusion, twin.front().occlusion, 0.0f);
    }};
    const PixelPicture picture =
        pixel_picture(test_context(), scene.mesh, drawn, occluders, view, settings, paint);
    for (const glm::vec4& pixel : picture.image.pixels) {
        shown += static_cast<double>(pixel.r) / 1536.0;
        expected += static_cast<double>(pixel.g) / 1536.0;
    }
    EXPECT_GT(picture.extras, 0u);
    EXPECT_GT(expected, 0.03);
    EXPECT_NEAR(shown, expected, 0.002);
}

// Hollows that 8 cells do not tell.
TEST(GridWorld, AnObjectHidesFromItsOwnSurfaceWhatItsEngineSays)
{
    const Scene hills = scenes::height_field(
        24, [](double x, double y) { return 0.15 * std::sin(9.0 * x) * std::cos(8.0 * y); });
    const Scene elsewhere = scenes::moved(hills, [](glm::dvec3 p) { return p + 40.0; });
    for (const GridMerge merge : {GridMerge::product, GridMerge::caps}) {
        GridScene scene({}, {hills, elsewhere}, {.resolution = 8});
        scene.pixels.merge = merge;
        std::vector<SurfacePoint> points;
        for (std::uint32_t t = 0; t < hills.triangles.size(); ++t)
            points.push_back({t, {0.3f, 0.3f}});
        const std::vector<std::uint32_t> own = scene.pixels.world->surfaces_at(points);
        EXPECT_EQ(std::ranges::count(own, 1u), std::ssize(own));
        const std::vector<Receiver> receivers =
            receivers_at(scene.mesh.geometry, scene.mesh.surface, points);
        const std::vector<Occlusion> found = solve_with_grids(scene.pixels, receivers, own);
        const Geometry geometry = make_geometry(hills, {.frame = scene.mesh.geometry.frame});
        const std::vector<Occlusion> expected =
            solve(prepare(geometry, {}), receivers, {}).occlusion;
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_NEAR(found[i].occlusion, expected[i].occlusion, 1e-3f) << i;
            EXPECT_GT(glm::dot(found[i].bent_normal, expected[i].bent_normal), 0.999f) << i;
        }
    }
}

// What is found among parts that are left out is found part by part.
TEST(GridWorld, SurfacesAreTheSameHoweverTheyAreFound)
{
    Scene scene = floor_below();
    scene += scenes::box({-0.5, -0.5, 0.3}, {0.5, 0.5, 1.3}, 2);
    std::vector<bool> own(scene.triangles.size(), true);
    own[0] = own[1] = false;
    const auto grid = std::make_shared<const AoGrid>(
        bake_grid(make_geometry(scenes::box({0, 0, 0}, {1, 1, 1}, 1)), {.resolution = 4}, {}, 0)
            .grid);
    const GridSources sources{{{"object", grid, own}}, nullptr};
    Mesh mesh = make_mesh(scene);
    const SurfacePoint top{2, {0.3f, 0.3f}};
    const std::vector<Receiver> inside{{{0.0f, 0.0f, 0.01f}, {1, 0, 0}, 0.0f},
                                       {{0.0f, 0.0f, 0.1f}, {0, 0, -1}, 0.0f}};
    const auto answers = [&] {
        const auto world = grid_world_of(mesh, {}, {}, sources);
        EXPECT_EQ(world->surfaces_at({&top, 1}).front(), 1u);
        return world->solve(inside, std::vector<std::uint32_t>{1, 1}, {});
    };
    const std::vector<Occlusion> whole = answers();
    mesh.occluders = std::make_shared<const Geometry>(mesh.geometry);
    const std::vector<Occlusion> by_part = answers();
    EXPECT_NEAR(whole[0].occlusion, 1.0f, 0.01f);
    for (std::size_t i = 0; i < whole.size(); ++i)
        EXPECT_EQ(whole[i].occlusion, by_part[i].occlusion) << i;
}

TEST(GridWorld, SaysWhatIsWrong)
{
    const Mesh robot = make_mesh(read_scene(kRobot));
    const auto grid = std::make_shared<const AoGrid>(
        bake_grid(make_geometry(scenes::box({0, 0, 0}, {1, 1, 1}, 1)), {.resolution = 4}, {}, 0)
            .grid);
    const ReadOptions then{.moment = Moment{0.3, "walk"}};
    const auto fault = [&](const std::vector<NodeGrid>& grids) {
        GridSources sources{grids, std::make_shared<const Motion>(robot.scene, "walk")};
        try {
            static_cast<void>(grid_world_of(robot, {}, {}, sources, Moment{0.3, "walk"}));
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(fault({{"head", grid}}), "");
    EXPECT_NE(fault({{"haed", grid}}).find("no part is called haed"), std::string::npos);
    EXPECT_NE(fault({{"head", grid}, {"torso joint", grid}}).find("two grids"), std::string::npos);
    EXPECT_NE(fault({{"torso joint", grid}}).find("does not move as one piece"), std::string::npos);
    EXPECT_THROW(static_cast<void>(bake_moving_grids(
                     std::string(SURFELAO_DATA_FOLDER) + "/leaves.glb", {}, {}, {})),
                 InputError);
}

}  // namespace
}  // namespace surfelao
