// grid_pictures: what pictures of objects with AO grids cost and how right they are.
//
//   grid_pictures         JSON
//
// A box over the whole picture, in cones and harmonics, and over parts of it; objects on a floor,
// whole frames of them. Times are medians, the device waited for. On software OpenGL.

#include "../pixels/sphere_grid.h"
#include "gpu/g_buffer.h"
#include "pixels/camera.h"
#include "pixels/grid_pass.h"
#include "pixels/seen.h"
#include "scenes.h"
#include "surfels/stopwatch.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace surfelao {
namespace {

constexpr int kRounds = 15;
constexpr int kCells = 32;

double median_of(std::vector<double> seconds)
{
    std::ranges::sort(seconds);
    return seconds[seconds.size() / 2];
}

/// Median seconds of what is drawn, after a first time that makes the shaders.
double seconds_of(const GlContext& context, const std::function<void()>& drawing)
{
    drawing();
    context.finish("drawing");
    std::vector<double> seconds;
    for (int round = 0; round < kRounds; ++round) {
        Stopwatch watch;
        drawing();
        context.finish("drawing");
        seconds.push_back(watch.lap());
    }
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
        const double seconds = seconds_of(context, [&] {
            pass.draw(seen, std::span<const PlacedGrid>(&object, 1), merge, target);
        });
        const std::vector<float> found = target.read_red(target.rect());
        const auto open = std::ranges::count(found, 1.0f);
        std::printf(
            "{\"width\": %d, \"height\": %d, \"store\": \"%s\", \"merge\": \"%s\", \"covered\": "
            "%.3f, \"ms\": %.3f}",
            size.width, size.height, name_of(store).c_str(), name_of(merge).c_str(),
            1.0 - static_cast<double>(open) / static_cast<double>(found.size()), 1e3 * seconds);
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

int run()
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
    std::printf("]}\n");
    return 0;
}

}  // namespace
}  // namespace surfelao

int main()
{
    try {
        return surfelao::run();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "grid_pictures: %s\n", error.what());
        return 1;
    }
}
