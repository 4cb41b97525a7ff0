// scaling: an engine on generated meshes of growing size, against its own brute force.
//
//     scaling masks|disks [VERTICES...]        default: 10000 100000 1000000
//
// A Markdown table, one line per size; times are processor time on one thread, which other work on
// the machine disturbs least. The mesh is a sphere with four octaves of bumps, two triangles a
// vertex; quality good, disks with three passes. Brute force: every triangle drawn, or every disk
// summed in one pass, for some receivers; beside it the root mean square of what the engine differs
// from that.
//
// Memory is what the process holds at most during the step, beyond what it held before: of the
// build with the tree itself, of the solve with the answers (Linux only; elsewhere zeros).
//
// The exponent at the end is the slope of log(solve time) over log(vertices): 1 is linear, 2 brute
// force; n log n has about 1.08 over this range.

#include "scenes.h"
#include "surfels/geometry.h"
#include "surfels/receiver.h"
#include "surfels/surfel.h"
#include "tests/vertex_receivers.h"
#include "tree/disks/brute_force.h"
#include "tree/disks/disks.h"
#include "tree/disks/gather.h"
#include "tree/masks/masks.h"
#include "tree/receiver_groups.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace {

using namespace surfelao;

using Receivers = std::vector<Receiver>;
using Answers = std::vector<Occlusion>;

/// Brute force at this many receivers stands for all of them, up to so many vertices.
constexpr std::size_t kBruteReceivers = 1000;
constexpr std::size_t kBruteVertices = 200000;

/// One engine and its oracle. `build` comes first.
class Engine {
public:
    virtual ~Engine() = default;
    virtual void build(const Geometry& geometry) = 0;
    virtual Answers solve(const Receivers& receivers) const = 0;
    /// The two to be compared with each other.
    virtual Answers solve_for_brute(const Receivers& receivers) const { return solve(receivers); }
    virtual Answers brute(const Receivers& receivers) const = 0;
    /// A sentence about the work.
    virtual std::string note(const Receivers& receivers) const = 0;
};

class Masks : public Engine {
public:
    void build(const Geometry& geometry) override { tree_ = build_mask_tree(geometry); }
    Answers solve(const Receivers& receivers) const override
    {
        return solve_masks(*tree_, receivers, {});
    }
    Answers brute(const Receivers& receivers) const override
    {
        MaskOptions options;
        options.exact = true;
        return solve_masks(*tree_, receivers, options);
    }
    std::string note(const Receivers&) const override { return {}; }

private:
    std::shared_ptr<const MaskTree> tree_;
};

class Disks : public Engine {
public:
    void build(const Geometry& geometry) override
    {
        octree_ = build_octree(surfels_at_vertices(geometry));
    }
    Answers solve(const Receivers& receivers) const override
    {
        return solve_disks(octree_, receivers, {}).occlusion;
    }
    Answers solve_for_brute(const Receivers& receivers) const override
    {
        return solve_disks(octree_, receivers, one_pass()).occlusion;
    }
    Answers brute(const Receivers& receivers) const override
    {
        return solve_disks_brute_force(octree_, receivers, one_pass()).occlusion;
    }
    std::string note(const Receivers& receivers) const override
    {
        const GatherCount count =
            count_gather(octree_, group_receivers(receivers), {.opening = kGoodOpening});
        char text[120];
        std::snprintf(text, sizeof text,
                      "%.0f nodes tested, %.0f nodes and %.0f surfels summed per group of %u",
                      count.tested_nodes, count.nodes, count.surfels, kGroupSize);
        return text;
    }

private:
    static DiskOptions one_pass()
    {
        DiskOptions options;
        options.passes = 1;
        return options;
    }
    Octree octree_;
};

/// Bytes that the process holds, and has held at most since reset_peak_memory().
struct Memory {
    double now = 0.0, peak = 0.0;
};

Memory memory()
{
    Memory result;
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        double kibibytes = 0.0;
        if (word == "VmRSS:" && status >> kibibytes)
            result.now = 1024.0 * kibibytes;
        if (word == "VmHWM:" && status >> kibibytes)
            result.peak = 1024.0 * kibibytes;
    }
    return result;
}

void reset_peak_memory()
{
#if defined(__GLIBC__)
    malloc_trim(0);  // what earlier steps have given back does not count
#endif
    std::ofstream("/proc/self/clear_refs") << 5;
}

struct Cost {
    double seconds = INFINITY;
    double bytes = 0.0;
};

/// Of processor time: the least of three runs, or of one where that takes over two seconds. Memory
/// of the first run: later ones find the memory of that one.
Cost cost_of(const std::function<void()>& work)
{
    Cost cost;
    for (int run = 0; run < 3; ++run) {
        reset_peak_memory();
        const double before = memory().now;
        const std::clock_t start = std::clock();
        work();
        const double taken = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        if (run == 0)
            cost.bytes = std::max(0.0, memory().peak - before);
        cost.seconds = std::min(cost.seconds, taken);
        if (taken > 2.0)
            break;
    }
    return cost;
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

}  // namespace

int main(int argument_count, char** arguments)
{
    const std::string name = argument_count > 1 ? arguments[1] : "";
    if (name != "masks" && name != "disks") {
        std::fprintf(stderr, "usage: scaling masks|disks [VERTICES...]\n");
        return 2;
    }
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    std::vector<double> wanted;
    for (int i = 2; i < argument_count; ++i)
        wanted.push_back(std::atof(arguments[i]));
    if (wanted.empty())
        wanted = {1e4, 1e5, 1e6};

    std::printf(
        "%s\n\n| vertices | build us/vertex | solve us/vertex | brute force us/vertex | RMS to it "
        "| build peak bytes/triangle | solve peak bytes/vertex | work |\n"
        "|---|---|---|---|---|---|---|---|\n",
        name.c_str());
    std::vector<double> sizes, times;
    for (const double vertices : wanted) {
        const int cells = static_cast<int>(std::lround(std::sqrt(vertices / 6.0)));
        const Geometry geometry = make_geometry(scenes::bumpy_sphere(cells));
        const Receivers receivers = vertex_receivers(geometry);
        const double n = static_cast<double>(receivers.size());

        std::unique_ptr<Engine> engine;
        if (name == "masks")
            engine = std::make_unique<Masks>();
        else
            engine = std::make_unique<Disks>();
        const Cost build = cost_of([&] { engine->build(geometry); });
        Answers answers;
        const Cost solve = cost_of([&] { answers = engine->solve(receivers); });
        std::printf("| %.0f | %.3f | %.3f | ", n, 1e6 * build.seconds / n, 1e6 * solve.seconds / n);
        if (receivers.size() <= kBruteVertices) {
            Receivers some;
            for (std::size_t i = 0; i < kBruteReceivers; ++i)
                some.push_back(receivers[i * receivers.size() / kBruteReceivers]);
            Answers exact;
            const Cost brute = cost_of([&] { exact = engine->brute(some); });
            const Answers fast = engine->solve_for_brute(some);
            double squares = 0.0;
            for (std::size_t i = 0; i < some.size(); ++i)
                squares += std::pow(fast[i].occlusion - exact[i].occlusion, 2);
            std::printf("%.1f | %.4f", 1e6 * brute.seconds / kBruteReceivers,
                        std::sqrt(squares / kBruteReceivers));
        } else {
            std::printf("- | -");
        }
        std::printf(" | %.0f | %.0f | %s |\n",
                    build.bytes / static_cast<double>(geometry.triangles.size()), solve.bytes / n,
                    engine->note(receivers).c_str());
        std::fflush(stdout);
        sizes.push_back(n);
        times.push_back(solve.seconds);
    }
    if (sizes.size() > 1)
        std::printf("\nsolve time grows with vertices^%.3f\n", exponent(sizes, times));
    return 0;
}
