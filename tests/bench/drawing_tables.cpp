// drawing_tables: frames per second of triangles and splats, at 1920 x 1080.
//
//   drawing_tables [egl|osmesa] [moving]
//
// moving: milliseconds of each detail that a moving picture of 1.1 million triangles is drawn in
// (viewer/coarse.h), at 1280 x 800, and what making the coarse triangles takes. Else:
//
// Grids of 81 to 16,641 vertices as in Engleson's report (Point-based ambient occlusion, 2011,
// tables 1 and 2) with splats of covering radius, then 10^6 vertices. All ways to draw take turns,
// frame by frame; the median of the frames counts. Occlusion is there already and is not solved
// anew, as the report does in every frame: see gpu_tables for solving.

#include "gpu/context.h"
#include "scenes.h"
#include "surfels/stopwatch.h"
#include "viewer/coarse.h"
#include "viewer/renderer.h"
#include "viewer/sample_sum.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <limits>
#include <string_view>
#include <vector>

namespace surfelao {
namespace {

constexpr int kWidth = 1920, kHeight = 1080;
constexpr int kFrames = 5;
constexpr double kReportSide = 5.2;  // of its grid: what its covering radii divided by ours tell

struct ReportRow {
    int cells;
    const char* triangles;
    const char* covering;
    const char* radius;
};
constexpr ReportRow kRows[] = {
    {8, "200", "30", "0.46"},  {16, "142", "7.3", "0.24"},   {32, "36", "1.7", "0.12"},
    {64, "6", "0.37", "0.06"}, {128, "0.48", "0.1", "0.03"}, {999, "", "", ""},
};

constexpr std::array kSurfaces = {Shape::triangles, Shape::splats, Shape::affine, Shape::points};

/// Frames per second of each surface, in kSurfaces' order.
std::array<double, kSurfaces.size()> frame_rates(const GlContext& context, Renderer& renderer,
                                                 const Framebuffer& target, const Camera& camera)
{
    std::array<std::vector<double>, kSurfaces.size()> seconds;
    for (int frame = -1; frame < kFrames; ++frame) {  // the first one makes the shaders
        for (std::size_t i = 0; i < kSurfaces.size(); ++i) {
            Stopwatch watch;
            renderer.draw_frame(target, camera, {.surface = kSurfaces[i], .ground = false});
            context.finish("drawing");
            const double passed = watch.lap();
            if (frame >= 0)
                seconds[i].push_back(passed);
        }
    }
    std::array<double, kSurfaces.size()> rates{};
    for (std::size_t i = 0; i < rates.size(); ++i) {
        std::ranges::nth_element(seconds[i], seconds[i].begin() + kFrames / 2);
        rates[i] = 1.0 / seconds[i][kFrames / 2];
    }
    return rates;
}

constexpr int kMovingCells = 742;  // each way, of two triangles

/// Milliseconds: the median of the frames, with what puts the picture into the window's. busy: of
/// all processors, which a busy machine does not change much.
struct MovingTime {
    double passed = 0.0, busy = 0.0;
};
MovingTime moving_time(const GlContext& context, Renderer& renderer, const Camera& camera,
                       const Detail& detail)
{
    constexpr int kWide = 1280, kHigh = 800;
    const Framebuffer target =
        renderer.make_target((kWide - 1) / detail.pixel + 1, (kHigh - 1) / detail.pixel + 1);
    SampleSum sum(context, kWide, kHigh);
    std::vector<double> passed, busy;
    for (int frame = -1; frame < kFrames; ++frame) {
        Stopwatch watch;
        const std::clock_t before = std::clock();
        renderer.draw_frame(target, camera, {.coarse = !detail.is_whole});
        sum.clear();
        sum.add(target, detail.pixel);
        context.finish("drawing");
        if (frame < 0)
            continue;
        passed.push_back(1000.0 * watch.lap());
        busy.push_back(1000.0 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
    }
    std::ranges::sort(passed);
    std::ranges::sort(busy);
    return {passed[kFrames / 2], busy[kFrames / 2]};
}

void run_moving(GlBackend backend)
{
    const GlContext context = GlContext::create(backend);
    std::printf("Device: %s (%s)\n\n", context.info().renderer.c_str(),
                context.info().platform.c_str());
    const Model model = make_model(
        make_mesh(scenes::height_field(
            kMovingCells,
            [](double x, double y) { return 0.1 * std::sin(9.0 * x) * std::cos(7.0 * y); })),
        UpAxis::z);
    Renderer renderer(context);
    renderer.set_model(model);
    Stopwatch watch;
    const std::vector<glm::uvec3> coarse =
        coarse_triangles(model.geometry(), model.mesh->surface, kCoarseTriangles);
    renderer.set_coarse(coarse);
    std::printf(
        "%zu triangles, coarse %zu in %.0f ms\n\n| pixels | triangles | ms | ms of all processors "
        "|\n|---|---|---|---|\n",
        model.geometry().triangles.size(), coarse.size(), 1000.0 * watch.lap());
    const Camera camera = frame_points(model.seen, UpAxis::z, 1.6f, {.elevation_deg = 40});
    for (const Detail& detail : kDetails) {
        const MovingTime time = moving_time(context, renderer, camera, detail);
        std::printf("| 1/%d | %s | %.1f | %.1f |\n", detail.pixel,
                    detail.is_whole ? "all" : "coarse", time.passed, time.busy);
    }
}

void run(GlBackend backend)
{
    const GlContext context = GlContext::create(backend);
    std::printf("Device: %s (%s)\n\n", context.info().renderer.c_str(),
                context.info().platform.c_str());
    std::printf(
        "| vertices | triangles | report | splats | report, covering | affine | points | covering "
        "radius | report, radius | pixels a splat is wide "
        "|\n|---|---|---|---|---|---|---|---|---|---|\n");
    Renderer renderer(context);
    const Framebuffer target = renderer.make_target(kWidth, kHeight);
    for (const ReportRow& row : kRows) {
        const Model model = make_model(
            make_mesh(scenes::height_field(row.cells, [](double, double) { return 0.0; })),
            UpAxis::z, {}, std::numeric_limits<float>::infinity());
        renderer.set_model(model);
        const float aspect = static_cast<float>(kWidth) / static_cast<float>(kHeight);
        const Camera camera = frame_points(model.seen, UpAxis::z, aspect, {.elevation_deg = 50});
        const auto rates = frame_rates(context, renderer, target, camera);
        const double width = model.splat_radii[0] * kHeight /
                             std::tan(glm::radians(0.5 * camera.fovy_deg)) /
                             glm::distance(camera.eye, camera.target);
        std::printf("| %zu | %.3g | %s | %.3g | %s | %.3g | %.3g | %.4f | %s | %.1f |\n",
                    model.geometry().positions.size(), rates[0], row.triangles, rates[1],
                    row.covering, rates[2], rates[3],
                    covering_radii(model.geometry())[0] * std::sqrt(2.0) * kReportSide, row.radius,
                    width);
        std::fflush(stdout);
    }
}

}  // namespace
}  // namespace surfelao

int main(int argument_count, char** arguments)
{
    using namespace surfelao;
    const std::string_view name = argument_count > 1 ? arguments[1] : "";
    const std::string_view last = arguments[argument_count - 1];
    const GlBackend backend = name == "egl"      ? GlBackend::egl
                              : name == "osmesa" ? GlBackend::osmesa
                                                 : GlBackend::automatic;
    try {
        last == "moving" ? run_moving(backend) : run(backend);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "drawing_tables: %s\n", error.what());
        return 1;
    }
}
