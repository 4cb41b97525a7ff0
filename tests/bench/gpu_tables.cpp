// gpu_tables: the engines on the GPU against the CPU, side by side in one run.
//
//   gpu_tables [--backend egl|osmesa] [--largest N] [--largest-masks N] [MODEL...]
//
// Without models: grids of 81 to 16,641 vertices as in Engleson's report (Point-based ambient
// occlusion, 2011, tables 1 and 2), by brute force and by the tree, then generated bodies of 10^4
// to N (10^6) vertices, disks and masks. With models: each of them on both devices, and how much
// they differ. Every time is the better of two alternating runs of the whole solve, upload and
// read-back included.

#include "files/scene_io.h"
#include "gpu/answers.h"
#include "gpu/context.h"
#include "gpu/gpu_disks.h"
#include "gpu/gpu_masks.h"
#include "scenes.h"
#include "surfels/stopwatch.h"
#include "surfels/topology.h"
#include "tests/vertex_receivers.h"
#include "tree/disks/disks.h"
#include "tree/masks/masks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {
namespace {

struct World {
    std::vector<Receiver> receivers;
    Octree octree;
    std::shared_ptr<const MaskTree> masks;

    explicit World(const Scene& scene)
    {
        const Geometry geometry = make_geometry(scene);
        receivers = vertex_receivers(geometry);
        const SurfelCloud cloud = surfels_of(geometry);
        octree = build_octree(cloud.surfels, sides_of(cloud, analyse_topology(geometry)));
        masks = build_mask_tree(geometry);
    }
};

struct Timing {
    double cpu_s = 1e30, gpu_s = 1e30;
    double largest_difference = 0.0;
    double rms_difference = 0.0;
};

template <typename Work>
double seconds_of(const Work& work)
{
    Stopwatch watch;
    work();
    return watch.lap();
}

/// Alternating; the better of two each. Both take receivers and give occlusion. The first run of
/// all makes the shaders and does not count.
template <typename Cpu, typename Gpu>
Timing compare(const World& world, const Cpu& solve_on_cpu, const Gpu& solve_on_gpu)
{
    const std::span<const Receiver> receivers = world.receivers;
    Timing best;
    std::vector<Occlusion> cpu, gpu;
    static_cast<void>(solve_on_gpu(receivers.first(1)));
    for (int run = 0; run < 2; ++run) {
        best.cpu_s = std::min(best.cpu_s, seconds_of([&] { cpu = solve_on_cpu(receivers); }));
        best.gpu_s = std::min(best.gpu_s, seconds_of([&] { gpu = solve_on_gpu(receivers); }));
    }
    double squares = 0.0;
    for (std::size_t i = 0; i < cpu.size(); ++i) {
        const double difference = std::abs(double{cpu[i].occlusion} - double{gpu[i].occlusion});
        best.largest_difference = std::max(best.largest_difference, difference);
        squares += difference * difference;
    }
    best.rms_difference = std::sqrt(squares / static_cast<double>(cpu.size()));
    return best;
}

Timing compare_disks(const GlContext& context, const World& world, const DiskOptions& options)
{
    // a second solve would start from what the first has corrected; the CPU's does not
    return compare(
        world,
        [&](std::span<const Receiver> receivers) {
            return solve_disks(world.octree, receivers, options).occlusion;
        },
        [&](std::span<const Receiver> receivers) {
            const GpuDisks scene(context, world.octree);
            return read_answers(scene.solve(receivers, options).answers, receivers.size());
        });
}

Timing compare_masks(const GlContext& context, const World& world, const MaskOptions& options)
{
    const GpuMasks scene(context, *world.masks);
    return compare(
        world,
        [&](std::span<const Receiver> receivers) {
            return solve_masks(*world.masks, receivers, options);
        },
        [&](std::span<const Receiver> receivers) {
            return read_answers(scene.solve(receivers, options), receivers.size());
        });
}

void print_grids(const GlContext& context)
{
    std::printf(
        "\nGrids, one pass of disks (plain sum), solves per second; the report computes the sum "
        "anew in each frame,\non a GeForce GTX 460M, by brute force (its table 1, triangles).\n\n"
        "| vertices | report, frames/s | GPU brute force | GPU tree | CPU brute force | CPU "
        "tree | GPU: tree / brute force | tree: GPU / CPU |\n"
        "|---|---|---|---|---|---|---|---|\n");
    const double report[] = {200, 142, 36, 6, 0.48};
    for (int k = 0; k < 5; ++k) {
        const int cells = 8 << k;
        const World world(scenes::height_field(cells, [](double x, double y) {
            return 0.1 * std::sin(12.0 * x) * std::cos(9.0 * y);
        }));
        const Timing brute = compare_disks(context, world, {.opening = 0.0f, .passes = 1});
        const Timing tree = compare_disks(context, world, {.passes = 1});
        std::printf("| %zu | %g | %.3g | %.3g | %.3g | %.3g | %.3g | %.2f |\n",
                    world.receivers.size(), report[k], 1.0 / brute.gpu_s, 1.0 / tree.gpu_s,
                    1.0 / brute.cpu_s, 1.0 / tree.cpu_s, brute.gpu_s / tree.gpu_s,
                    tree.cpu_s / tree.gpu_s);
        std::fflush(stdout);
    }
}

void print_row(const std::string& name, const char* engine, const World& world,
               const Timing& timing)
{
    const double n = static_cast<double>(world.receivers.size());
    std::printf("| %s | %zu | %s | %.3g | %.3g | %.2f | %.2f | %.3f | %.1e | %.1e |\n",
                name.c_str(), world.receivers.size(), engine, timing.gpu_s, timing.cpu_s,
                1e6 * timing.gpu_s / n, 1e6 * timing.cpu_s / n, timing.cpu_s / timing.gpu_s,
                timing.rms_difference, timing.largest_difference);
    std::fflush(stdout);
}

void print_head(const char* title)
{
    std::printf(
        "\n%s: disks good with 2 passes, masks good\n\n| scene | vertices | engine | GPU s "
        "| CPU s | GPU us/vertex | CPU us/vertex | speed GPU / CPU | RMS difference | "
        "largest |\n|---|---|---|---|---|---|---|---|---|---|\n",
        title);
}

struct Arguments {
    GlBackend backend = GlBackend::automatic;
    double largest = 1.1e6;
    double largest_masks = 1.1e6;
    std::vector<std::string> models;
};

void run(const Arguments& arguments)
{
    const GlContext context = GlContext::create(arguments.backend);
    std::printf("GPU: %s, %s (%s)%s\n", context.info().renderer.c_str(),
                context.info().version.c_str(), context.info().platform.c_str(),
                context.info().software ? ": software, on the same cores as the CPU column" : "");
    const auto rows = [&](const std::string& name, const Scene& scene) {
        const World world(scene);
        print_row(name, "disks", world, compare_disks(context, world, {}));
        if (static_cast<double>(world.receivers.size()) <= arguments.largest_masks)
            print_row(name, "masks", world, compare_masks(context, world, {}));
    };
    if (!arguments.models.empty()) {
        print_head("Models");
        for (const std::string& path : arguments.models)
            rows(path.substr(path.find_last_of('/') + 1), read_scene(path));
        return;
    }
    print_grids(context);
    print_head("Generated bodies");
    for (double n = 1e4; n <= arguments.largest; n *= std::sqrt(10.0))
        rows("bumpy sphere",
             scenes::bumpy_sphere(static_cast<int>(std::lround(std::sqrt(n / 6.0)))));
}

}  // namespace
}  // namespace surfelao

int main(int count, char** texts)
{
    surfelao::Arguments arguments;
    for (int i = 1; i < count; ++i) {
        const std::string_view argument = texts[i];
        if (argument == "--backend" && i + 1 < count)
            arguments.backend = std::string_view(texts[++i]) == "osmesa"
                                    ? surfelao::GlBackend::osmesa
                                    : surfelao::GlBackend::egl;
        else if (argument == "--largest" && i + 1 < count)
            arguments.largest = std::atof(texts[++i]);
        else if (argument == "--largest-masks" && i + 1 < count)
            arguments.largest_masks = std::atof(texts[++i]);
        else
            arguments.models.emplace_back(argument);
    }
    try {
        surfelao::run(arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "gpu_tables: %s\n", error.what());
        return 1;
    }
    return 0;
}
