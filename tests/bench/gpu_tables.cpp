// gpu_tables: the disk engine on the GPU against the CPU, side by side in one run.
//
//   gpu_tables [--backend egl|osmesa] [--largest N] [MODEL...]
//
// Without models: grids of 81 to 16,641 vertices as in Engleson's report (Point-based ambient
// occlusion, 2011, tables 1 and 2), by brute force and by the tree, then generated bodies of 10^4
// to N (10^6) vertices. With models: each of them on both, and the largest difference. Every time
// is the better of two alternating runs of the whole solve, upload and read-back included.

#include "gpu/context.h"
#include "gpu/gpu_disks.h"
#include "scenes.h"
#include "surfels/scene_io.h"
#include "surfels/topology.h"
#include "tree/disks.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {
namespace {

struct World {
    std::vector<Receiver> receivers;
    Octree octree;

    explicit World(const Scene& scene)
    {
        const Geometry geometry = make_geometry(scene);
        receivers = receivers_at_vertices(geometry, Definition{}.offset);
        const Topology topology = analyse_topology(geometry);
        std::vector<OccluderSide> sides;
        for (std::size_t v = 0; v < geometry.areas.size(); ++v) {
            if (geometry.areas[v] > 0.0f)
                sides.push_back(topology.sides[v]);
        }
        octree = build_octree(surfels_at_vertices(geometry), sides);
    }
};

struct Timing {
    double cpu_s = 0.0, gpu_s = 0.0;
    double largest_difference = 0.0;
    double rms_difference = 0.0;
};

template <typename Work>
double seconds_of(const Work& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Alternating; the better of two each. The first run of all makes the shaders and does not count.
Timing compare(const GlContext& context, const World& world, const DiskOptions& options)
{
    Timing best{1e30, 1e30};
    DiskResult cpu, gpu;
    static_cast<void>(
        solve_disks_gpu(context, world.octree, std::span(world.receivers).first(1), options));
    for (int run = 0; run < 2; ++run) {
        best.cpu_s = std::min(best.cpu_s, seconds_of([&] {
                                  cpu = solve_disks(world.octree, world.receivers, options);
                              }));
        best.gpu_s =
            std::min(best.gpu_s, seconds_of([&] {
                         gpu = solve_disks_gpu(context, world.octree, world.receivers, options);
                     }));
    }
    double squares = 0.0;
    for (std::size_t i = 0; i < cpu.occlusion.size(); ++i) {
        const double difference =
            std::abs(double{cpu.occlusion[i].occlusion} - double{gpu.occlusion[i].occlusion});
        best.largest_difference = std::max(best.largest_difference, difference);
        squares += difference * difference;
    }
    best.rms_difference = std::sqrt(squares / static_cast<double>(cpu.occlusion.size()));
    return best;
}

void print_grids(const GlContext& context)
{
    std::printf(
        "\nGrids, one pass (plain sum), solves per second; the report computes the sum anew in "
        "each frame,\non a GeForce GTX 460M, by brute force (its table 1, triangles).\n\n"
        "| vertices | report, frames/s | GPU brute force | GPU tree | CPU brute force | CPU "
        "tree | GPU: tree / brute force | tree: GPU / CPU |\n"
        "|---|---|---|---|---|---|---|---|\n");
    const double report[] = {200, 142, 36, 6, 0.48};
    for (int k = 0; k < 5; ++k) {
        const int cells = 8 << k;
        const World world(scenes::height_field(cells, [](double x, double y) {
            return 0.1 * std::sin(12.0 * x) * std::cos(9.0 * y);
        }));
        const Timing brute = compare(context, world, {.opening = 0.0f, .passes = 1});
        const Timing tree = compare(context, world, {.passes = 1});
        std::printf("| %zu | %g | %.3g | %.3g | %.3g | %.3g | %.3g | %.2f |\n",
                    world.receivers.size(), report[k], 1.0 / brute.gpu_s, 1.0 / tree.gpu_s,
                    1.0 / brute.cpu_s, 1.0 / tree.cpu_s, brute.gpu_s / tree.gpu_s,
                    tree.cpu_s / tree.gpu_s);
        std::fflush(stdout);
    }
}

void print_row(const std::string& name, const World& world, const Timing& timing)
{
    const double n = static_cast<double>(world.receivers.size());
    std::printf("| %s | %zu | %.3g | %.3g | %.2f | %.2f | %.2f | %.1e | %.1e |\n", name.c_str(),
                world.receivers.size(), timing.gpu_s, timing.cpu_s, 1e6 * timing.gpu_s / n,
                1e6 * timing.cpu_s / n, timing.cpu_s / timing.gpu_s, timing.rms_difference,
                timing.largest_difference);
    std::fflush(stdout);
}

void print_head(const char* title)
{
    std::printf(
        "\n%s\n\n| scene | vertices | GPU s | CPU s | GPU us/vertex | CPU us/vertex | speed GPU "
        "/ CPU | RMS difference | largest |\n|---|---|---|---|---|---|---|---|---|\n",
        title);
}

void run(GlBackend backend, double largest, const std::vector<std::string>& models)
{
    const GlContext context = GlContext::create(backend);
    std::printf("GPU: %s, %s (%s)%s\n", context.info().renderer.c_str(),
                context.info().version.c_str(), context.info().platform.c_str(),
                context.info().software ? ": software, on the same cores as the CPU column" : "");
    if (!models.empty()) {
        print_head("Models, disks, good, 2 passes");
        for (const std::string& path : models) {
            const World world(read_scene(path));
            print_row(path.substr(path.find_last_of('/') + 1), world, compare(context, world, {}));
        }
        return;
    }
    print_grids(context);
    print_head("Generated bodies, disks, good, 2 passes");
    for (double n = 1e4; n <= largest; n *= std::sqrt(10.0)) {
        const World world(scenes::bumpy_sphere(static_cast<int>(std::lround(std::sqrt(n / 6.0)))));
        print_row("bumpy sphere", world, compare(context, world, {}));
    }
}

}  // namespace
}  // namespace surfelao

int main(int argc, char** argv)
{
    surfelao::GlBackend backend = surfelao::GlBackend::automatic;
    double largest = 1.1e6;
    std::vector<std::string> models;
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        if (argument == "--backend" && i + 1 < argc)
            backend = std::string_view(argv[++i]) == "osmesa" ? surfelao::GlBackend::osmesa
                                                              : surfelao::GlBackend::egl;
        else if (argument == "--largest" && i + 1 < argc)
            largest = std::atof(argv[++i]);
        else
            models.emplace_back(argument);
    }
    try {
        surfelao::run(backend, largest, models);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "gpu_tables: %s\n", error.what());
        return 1;
    }
    return 0;
}
