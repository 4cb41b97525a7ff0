// disks_scaling: the disk engine on generated meshes of growing size, against its own brute force.
//
//     disks_scaling [VERTICES...]        default: 10000 100000 1000000
//
// One line per size; times are processor time on one thread, which other work on the machine
// disturbs least. The mesh is a sphere with four octaves of bumps; quality good, two passes. The
// exponent at the end is the slope of log(solve time) over log(vertices): 1 is linear, 2 brute
// force; n log n has about 1.08 over this range.

#include "scenes.h"
#include "surfels/geometry.h"
#include "surfels/receiver.h"
#include "surfels/surfel.h"
#include "tree/brute_force.h"
#include "tree/disk_gather.h"
#include "tree/disks.h"
#include "tree/receiver_group.h"

#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <vector>

namespace {

using namespace surfelao;

/// Seconds of processor time that `work` takes: the least of three runs, or of one where that takes
/// over two seconds.
double seconds(const std::function<void()>& work)
{
    double least = INFINITY;
    for (int run = 0; run < 3; ++run) {
        const std::clock_t start = std::clock();
        work();
        const double taken = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        least = std::min(least, taken);
        if (taken > 2.0)
            break;
    }
    return least;
}

double peak_mebibytes()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Slope of the least-squares line through (log x, log y).
double exponent(const std::vector<double>& x, const std::vector<double>& y)
{
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double u = std::log(x[i]);
        const double v = std::log(y[i]);
        sx += u;
        sy += v;
        sxx += u * u;
        sxy += u * v;
    }
    const double n = static_cast<double>(x.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// Brute force at this many receivers stands for all of them.
constexpr std::size_t kBruteReceivers = 1000;
constexpr std::size_t kBruteVertices = 200000;

}  // namespace

int main(int argument_count, char** arguments)
{
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    std::vector<double> wanted;
    for (int i = 1; i < argument_count; ++i)
        wanted.push_back(std::atof(arguments[i]));
    if (wanted.empty())
        wanted = {1e4, 1e5, 1e6};

    std::printf("%9s %8s %9s %9s %8s %8s %8s %9s %9s\n", "", "build", "solve", "brute, 1", "tested",
                "", "", "", "memory");
    std::printf("%9s %8s %9s %9s %8s %8s %8s %9s %9s\n", "vertices", "us/v", "us/v", "pass us/v",
                "nodes", "nodes", "surfels", "RMS to it", "MiB");
    std::vector<double> sizes, times;
    for (const double vertices : wanted) {
        const int cells = static_cast<int>(std::lround(std::sqrt(vertices / 6.0)));
        const Geometry geometry = make_geometry(scenes::bumpy_sphere(cells));
        const std::vector<Surfel> surfels = surfels_at_vertices(geometry);
        const std::vector<Receiver> receivers =
            receivers_at_vertices(geometry, Definition{}.offset);
        const double n = static_cast<double>(receivers.size());

        Octree octree;
        const double build = seconds([&] { octree = build_octree(surfels); });
        DiskResult result;
        const double solve = seconds([&] { result = solve_disks(octree, receivers, {}); });
        const GatherCount count =
            count_gather(octree, group_receivers(receivers), {.opening = kGoodOpening});
        std::printf("%9.0f %8.3f %9.3f ", n, 1e6 * build / n, 1e6 * solve / n);
        if (receivers.size() <= kBruteVertices) {
            // evenly spread receivers, one pass
            std::vector<Receiver> some;
            for (std::size_t i = 0; i < kBruteReceivers; ++i)
                some.push_back(receivers[i * receivers.size() / kBruteReceivers]);
            const DiskOptions one_pass = {.passes = 1};
            DiskResult brute;
            const double time =
                seconds([&] { brute = solve_disks_brute_force(octree, some, one_pass); });
            const DiskResult tree = solve_disks(octree, some, one_pass);
            double squares = 0.0;
            for (std::size_t i = 0; i < some.size(); ++i)
                squares += std::pow(tree.occlusion[i].occlusion - brute.occlusion[i].occlusion, 2);
            std::printf("%9.1f %8.0f %8.0f %8.0f %9.4f", 1e6 * time / kBruteReceivers,
                        count.tested_nodes, count.nodes, count.surfels,
                        std::sqrt(squares / kBruteReceivers));
        } else {
            std::printf("%9s %8.0f %8.0f %8.0f %9s", "-", count.tested_nodes, count.nodes,
                        count.surfels, "-");
        }
        std::printf(" %9.0f\n", peak_mebibytes());
        std::fflush(stdout);
        sizes.push_back(n);
        times.push_back(solve);
    }
    if (sizes.size() > 1)
        std::printf("solve time grows with vertices^%.3f\n", exponent(sizes, times));
    std::printf(
        "nodes and surfels: per group of %u receivers, once tested, then summed in all lanes\n",
        kGroupSize);
    return 0;
}
