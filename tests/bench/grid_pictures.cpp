// grid_pictures: what pictures of objects with AO grids cost and how right they are.
//
//   grid_pictures ROBOT   JSON; ROBOT: data/robot.glb
//
// A box over the whole picture, in cones and harmonics, and over parts of it; objects on a floor,
// whole frames of them; the floor under an object and two boxes against rays; the robot's walk.
// Times are medians, the device waited for. On software OpenGL.

#include "../pixels/sphere_grid.h"
#include "files/scene_io.h"
#include "gpu/g_buffer.h"
#include "pixels/camera.h"
#include "pixels/grid_pass.h"
#include "pixels/grid_sources.h"
#include "pixels/pixel_engine.h"
#include "pixels/seen.h"
#include "scenes.h"
#include "surfels/stopwatch.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+=;

constexpr int kRounds = 15;
constexpr int kCells = 32;
constexpr std::uint32_t kRays = 1024;
constexpr PictureSize kSmall{240, 180};  // of errors

double median_of(std::vector<double> seconds)
{
    std::ranges::sort(seconds);
    return seconds[seconds.size() / 2];
}

/// Of the processor, all threads; other programs change it less than the clock on the wall.
double processor_seconds()
{
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Median seconds of what is drawn, after a first time that makes the shaders. processor: mean
/// seconds of the processor.
double seconds_of(const GlContext& context, const std::function<void()>& drawing,
                  double* processor = nullptr)
{
    drawing();
    context.finish("drawing");
    std::vector<double> seconds;
    const double start = processor_seconds();
    for (int round = 0; round < kRounds; ++round) {
        Stopwatch watch;
        drawing();
        context.finish("drawing");
        seconds.push_back(watch.lap());
    }
    if (processor != nullptr)
        *processor = (processor_seconds() - start) / kRounds;
    return median_of(seconds);
}

std::shared_ptr<const AoGrid> ball(GridStore store)
{
    return std::make_shared<const AoGrid>(sphere_grid(1.0, 3.0, kCells, store, GridBorder::fade));
}

PlacedGrid placed_ball(std::shared_ptr<const AoGrid> grid, glm::dvec3 place, double radius)
{
    PlacedGrid object{std::move(grid), {}};
    object.placement.scale = radius;
    object.placement.translation = place;
    return object;
}

/// Straight down on a floor that fills the picture; boxes whose middle layer it is.
void print_box_costs(const GlContext& context)
{
    const Mesh mesh = make_mesh(scenes::sheet({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 8));
    const DrawnMesh drawn(context, mesh.geometry, mesh.surface);
    GridPass pass(context);
    Camera camera;
    camera.eye = {0.0f, 0.0f, 0.3f};
    camera.fovy_deg = 30.0f;
    const auto time = [&](PictureSize size, GridStore store, GridMerge merge, double radius) {
        GBuffer seen(context, size.width, size.height);
        seen.draw(drawn, view_of(camera, size.width, size.height));
        const Framebuffer target = pass.make_target(size.width, size.height);
        const PlacedGrid object = placed_ball(ball(store), {0.0, 0.0, 0.02}, radius);
        double processor = 0.0;
        const double seconds = seconds_of(
            context,
            [&] { pass.draw(seen, std::span<const PlacedGrid>(&object, 1), merge, target); },
            &processor);
        const std::vector<float> found = target.read_red(target.rect());
        const auto open = std::ranges::count(found, 1.0f);
        std::printf(
            "{\"width\": %d, \"height\": %d, \"store\": \"%s\", \"merge\": \"%s\", \"covered\": "
            "%.3f, \"ms\": %.3f, \"cpu_ms\": %.3f}",
            size.width, size.height, name_of(store).c_str(), name_of(merge).c_str(),
            1.0 - static_cast<double>(open) / static_cast<double>(found.size()), 1e3 * seconds,
            1e3 * processor);
    };
    std::printf("\"boxes\": [\n  ");
    time({1280, 720}, GridStore::cone, GridMerge::product, 0.2);
    std::printf(",\n  ");
    time({1280, 720}, GridStore::sh, GridMerge::product, 0.2);
    std::printf(",\n  ");
    time({1280, 720}, GridStore::cone, GridMerge::caps, 0.2);
    for (const double radius : {0.2, 0.02, 0.01}) {
        std::printf(",\n  ");
        time({800, 600}, GridStore::cone, GridMerge::product, radius);
    }
    std::printf("],\n");
}

/// Frames of balls on a floor that rise and sink: the G-buffer anew, and a pass for each.
void print_crowd(const GlContext& context, int count)
{
    constexpr PictureSize kPicture{800, 600};
    constexpr double kRadius = 0.02;
    Scene scene = scenes::sheet({-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0}, 1);
    std::vector<glm::dvec3> places;
    const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
    for (int i = 0; i < count; ++i) {
        places.emplace_back(0.8 * ((i % columns + 0.5) / columns - 0.5),
                            0.8 * ((i / columns + 0.5) / columns - 0.5), 0.025);
        scene += scenes::sphere(places.back(), kRadius, 8);
    }
    const Mesh mesh = make_mesh(scene);
    const Frame& frame = mesh.geometry.frame;
    const DrawnMesh drawn(context, mesh.geometry, mesh.surface);
    const auto grid = ball(GridStore::cone);
    std::vector<PlacedGrid> objects;
    for (const glm::dvec3& place : places)
        objects.push_back(
            placed_ball(grid, (place - frame.centre) / frame.diagonal, kRadius / frame.diagonal));
    Camera camera;
    camera.up = {0, 0, 1};
    camera.eye = {0.0f, -0.6f, 0.45f};
    GridPass pass(context);
    GBuffer seen(context, kPicture.width, kPicture.height);
    const Framebuffer target = pass.make_target(kPicture.width, kPicture.height);
    const View view = view_of(camera, kPicture.width, kPicture.height);
    const double see = seconds_of(context, [&] { seen.draw(drawn, view); });
    const double product = seconds_of(context, [&] {
        seen.draw(drawn, view);
        pass.draw(seen, objects, GridMerge::product, target);
    });
    const double joined = seconds_of(context, [&] {
        seen.draw(drawn, view);
        pass.draw(seen, objects, GridMerge::caps, target);
    });
    std::printf(
        "{\"objects\": %d, \"triangles\": %zu, \"see_ms\": %.2f, \"frame_ms\": %.2f, \"fps\": "
        "%.1f, \"union_ms\": %.2f}",
        count, mesh.geometry.triangles.size(), 1e3 * see, 1e3 * product, 1.0 / product,
        1e3 * joined);
}

/// RMSE, mean and largest difference of answers to rays.
struct GridError {
    double rmse = 0.0, bias = 0.0, max = 0.0;
};

GridError error_against_rays(std::span<const Occlusion> found, const Geometry& all,
                             std::span<const Receiver> receivers)
{
    const EngineSettings rays{{.engine = Engine::rays}, {.rays = kRays}};
    const std::vector<Occlusion> truth = solve(prepare(all, rays), receivers, rays).occlusion;
    GridError error;
    const auto count = static_cast<double>(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double off = static_cast<double>(found[i].occlusion - truth[i].occlusion);
        error.rmse += off * off / count;
        error.bias += off / count;
        error.max = std::max(error.max, std::abs(off));
    }
    error.rmse = std::sqrt(error.rmse);
    return error;
}

/// Objects over a floor, each with a grid of its own.
struct FloorScene {
    FloorScene(const std::vector<Scene>& objects, const GridSettings& settings)
    {
        Scene all = scenes::sheet({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 1);
        for (const Scene& object : objects) {
            const std::size_t first = all.triangles.size();
            all += object;
            sources.grids.push_back({"object",
                                     std::make_shared<const AoGrid>(
                                         bake_grid(make_geometry(object), settings, {}, 0).grid),
                                     std::vector<bool>(first, false)});
        }
        for (std::size_t i = 0; i < objects.size(); ++i) {
            std::vector<bool>& own = sources.grids[i].triangles;
            own.resize(own.size() + objects[i].triangles.size(), true);
            own.resize(all.triangles.size(), false);
        }
        mesh = make_mesh(std::move(all));
        world = grid_world_of(mesh, {}, {}, sources);
    }
    /// Of the floor, seen from above; places from -half to half.
    [[nodiscard]] GridError error(GridMerge merge, double half) const
    {
        constexpr int kSide = 100;
        std::vector<Receiver> receivers;
        for (int i = 0; i < kSide * kSide; ++i) {
            const glm::dvec3 place(half * (2.0 * (i % kSide + 0.5) / kSide - 1.0),
                                   half * (2.0 * (i / kSide + 0.5) / kSide - 1.0), 1e-4);
            receivers.push_back(
                {glm::vec3((place - mesh.geometry.frame.centre) / mesh.geometry.frame.diagonal),
                 {0, 0, 1},
                 1e-5f});
        }
        const GridPixels pixels{merge, {}, world};
        return error_against_rays(solve_with_grids(pixels, receivers), mesh.geometry, receivers);
    }

    GridSources sources;
    Mesh mesh;
    std::shared_ptr<GridWorld> world;
};

void print_error(const GridError& error)
{
    std::printf("\"rmse\": %.5f, \"bias\": %.5f, \"max\": %.4f}", error.rmse, error.bias,
                error.max);
}

void print_floors()
{
    const Scene ball = scenes::moved(scenes::bumpy_sphere(20),
                                     [](glm::dvec3 p) { return 0.5 * p + glm::dvec3(0, 0, 0.65); });
    const char* separator = "\"floors\": [\n  ";
    for (const auto& [store, border, extent] : {std::tuple{GridStore::sh, GridBorder::fade, 0.03},
                                                {GridStore::cone, GridBorder::fade, 0.03},
                                                {GridStore::cone, GridBorder::rescale, 0.1}}) {
        const FloorScene scene({ball}, {.extent = extent,
                                        .uniform = border == GridBorder::rescale,
                                        .store = store,
                                        .border = border});
        std::printf("%s{\"store\": \"%s\", \"border\": \"%s\", \"extent\": %.2f, ", separator,
                    name_of(store).c_str(), name_of(border).c_str(), extent);
        print_error(scene.error(GridMerge::product, 1.5));
        separator = ",\n  ";
    }
    std::printf("],\n");
}

void print_pairs()
{
    const auto box = [](glm::dvec3 low, glm::dvec3 high) { return scenes::box(low, high, 4); };
    const std::tuple<const char*, std::vector<Scene>, double> pairs[] = {
        {"far apart",
         {box({-1.3, -0.3, 0.3}, {-0.7, 0.3, 0.9}), box({0.7, -0.3, 0.3}, {1.3, 0.3, 0.9})},
         1.5},
        {"one above the other",
         {box({-0.5, -0.5, 0.2}, {0.5, 0.5, 0.4}), box({-0.5, -0.5, 0.45}, {0.5, 0.5, 0.65})},
         0.6},
        {"one within the other",
         {box({-0.5, -0.3, 0.2}, {0.2, 0.3, 0.8}), box({-0.2, -0.3, 0.2}, {0.5, 0.3, 0.8})},
         0.6},
        {"side by side",
         {box({-0.8, -0.2, 0.2}, {0.0, 0.2, 1.0}), box({0.0, -0.2, 0.2}, {0.8, 0.2, 1.0})},
         0.4}};
    const char* separator = "\"pairs\": [\n  ";
    for (const auto& [name, objects, half] : pairs) {
        const FloorScene scene(objects, {.resolution = 48, .extent = 0.01});
        for (const GridMerge merge : {GridMerge::product, GridMerge::caps}) {
            std::printf("%s{\"boxes\": \"%s\", \"merge\": \"%s\", ", separator, name,
                        name_of(merge).c_str());
            print_error(scene.error(merge, half));
            separator = ",\n  ";
        }
    }
    std::printf("],\n");
}

/// The walk: grids baked once, then frames of masks for the floor and a pass for each part.
void print_robot(const GlContext& context, const char* file)
{
    constexpr PictureSize kPicture{800, 600};
    const ReadOptions first{.moment = Moment{0.0, ""}};
    Stopwatch watch;
    const GridSources sources = bake_moving_grids(file, first, {}, {});
    const double bake_s = watch.lap();
    std::printf("\"robot\": {\"parts\": %zu, \"bake_s\": %.3f, \"frames\": [\n  ",
                sources.grids.size(), bake_s);
    GridPass pass(context);
    const char* separator = "";
    for (const double seconds : {0.0, 0.25, 0.5, 0.75}) {
        const ReadOptions then{.moment = Moment{seconds, ""}};
        const Mesh mesh = make_mesh(read_scene(file, then));
        const auto world = grid_world_of(mesh, {}, {}, sources, then.moment);
        const DrawnMesh drawn(context, mesh.geometry, mesh.surface);
        Camera camera;
        camera.eye = {0.5f, 0.25f, 0.7f};
        const View view = view_of(camera, kPicture.width, kPicture.height);
        GBuffer seen(context, kPicture.width, kPicture.height);
        const Framebuffer target = pass.make_target(kPicture.width, kPicture.height);
        const double see = seconds_of(context, [&] { seen.draw(drawn, view); });
        const double passes = seconds_of(
            context, [&] { pass.draw(seen, world->objects(), GridMerge::product, target); });
        const PixelView pixels(context, mesh, drawn, view, kSmall);
        const GridPixels settings{GridMerge::product, {}, world};
        const GridError error = error_against_rays(answer(pixels, pass, settings, {}).values,
                                                   mesh.geometry, pixels.seen().receivers);
        std::printf("%s{\"seconds\": %.2f, \"see_ms\": %.2f, \"pass_ms\": %.2f, ", separator,
                    seconds, 1e3 * see, 1e3 * passes);
        print_error(error);
        separator = ",\n  ";
    }
    std::printf("]}\n");
}

int run(const char* robot)
{
    const GlContext context = GlContext::create(GlBackend::osmesa);
    std::printf("{\"renderer\": \"%s\",\n", context.info().renderer.c_str());
    print_box_costs(context);
    std::printf("\"crowds\": [\n  ");
    print_crowd(context, 1);
    for (const int count : {10, 40}) {
        std::printf(",\n  ");
        print_crowd(context, count);
    }
    std::printf("],\n");
    print_floors();
    print_pairs();
    print_robot(context, robot);
    std::printf("}\n");
    return 0;
}

}  // namespace
}  // namespace surfelao

int main(int count, char** words)
{
    if (count != 2) {
        std::fprintf(stderr, "usage: grid_pictures ROBOT\n");
        return 2;
    }
    try {
        return surfelao::run(words[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "grid_pictures: %s\n", error.what());
        return 1;
    }
}
