// Several threads of one program use the library at once: on scenes of their own, on one tree, on
// one file. Everything must come out as if each had been alone.
//
// Run by the preset tsan as well. TBB is not built for the thread sanitizer, which would take its
// hand-over of work to its own threads for races; so each thread here works in an arena of its own
// that has no place for others (kAlone), and every access is seen. The same on all cores is left to
// the plain build.
#include "bake/bake.h"
#include "files/scene_io.h"
#include "reference/rays.h"
#include "surfels/topology.h"
#include "tests/differences.h"
#include "tests/scenes.h"
#include "tests/stability/engines.h"
#include "tests/temporary_folder.h"
#include "tests/vertex_receivers.h"
#include "tree/disks/disks.h"
#include "tree/masks/masks.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <filesystem>
#include <thread>

namespace surfelao::stability {
namespace {

namespace fs = std::filesystem;

constexpr int kAlone = 1;

#if defined(__SANITIZE_THREAD__)
constexpr int kPlaces[] = {kAlone};
const tbb::global_control no_workers(tbb::global_control::max_allowed_parallelism, 1);
#else
constexpr int kPlaces[] = {kAlone, tbb::task_arena::automatic};
#endif

/// work(0) to work(count - 1), all at once.
void at_once(int count, int places, const std::function<void(int)>& work)
{
    std::vector<std::thread> threads;
    for (int i = 0; i < count; ++i)
        threads.emplace_back([&work, i, places] {
            tbb::task_arena arena(places);
            arena.execute([&] { work(i); });
        });
    for (std::thread& thread : threads)
        thread.join();
}

std::vector<Occlusion> solved(const Engine& engine, const Scene& scene)
{
    const World world = at_vertices(scene);
    return engine.prepare(world.geometry)(world.receivers, engine.settings);
}

std::vector<Scene> three_scenes()
{
    return {scenes::bumpy_sphere(7), scenes::nested_shells(3, 0.1, 4),
            scenes::room({0, 0, 0}, {1, 1, 1}, 6)};
}

TEST(Concurrency, ThreadsOnScenesOfTheirOwnGetTheirOwnAnswers)
{
    const std::vector<Scene> scenes = three_scenes();
    const auto count = static_cast<int>(scenes.size());
    for (const Engine& engine : all_engines()) {
#if defined(__SANITIZE_THREAD__)
        if (engine.name.starts_with("GPU"))
            continue;  // the driver's own threads are not built for the sanitizer
#endif
        std::vector<std::vector<Occlusion>> alone;
        for (const Scene& scene : scenes)
            alone.push_back(solved(engine, scene));
        for (const int places : kPlaces) {
            std::vector<std::vector<Occlusion>> together(scenes.size());
            at_once(count, places, [&](int i) { together[i] = solved(engine, scenes[i]); });
            for (int i = 0; i < count; ++i)
                EXPECT_TRUE(same_bytes(alone[i], together[i])) << engine.name << ", scene " << i;
        }
    }
}

TEST(Concurrency, ThreadsMayReadOneTree)
{
    const Geometry geometry = make_geometry(scenes::bumpy_sphere(8));
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    const RayScene rays(geometry, RayScene::Build::fast);
    const std::shared_ptr<const MaskTree> masks = build_mask_tree(geometry);
    const Octree octree = build_octree(surfels_at_vertices(geometry));
    const std::function<std::vector<Occlusion>()> solvers[] = {
        [&] { return trace_occlusion(rays, receivers, {}); },
        [&] { return solve_masks(*masks, receivers, {}); },
        [&] { return solve_disks(octree, receivers, {}).occlusion; },
    };
    for (const auto& solve : solvers) {
        const std::vector<Occlusion> alone = solve();
        for (const int places : kPlaces) {
            std::vector<std::vector<Occlusion>> together(4);
            at_once(4, places, [&](int i) { together[i] = solve(); });
            for (const std::vector<Occlusion>& each : together)
                EXPECT_TRUE(same_bytes(alone, each));
        }
    }
}

BakeSettings settings_for(const fs::path& input, const fs::path& output, int variant)
{
    BakeSettings settings;
    settings.input = input;
    settings.output = output;
    settings.engine.engine = surfelao::Engine::rays;
    settings.engine.rays = 16u << variant;
    return settings;
}

// Each bake writes another answer to the same name. Whoever looks at it, at any time, finds one of
// the answers, whole.
TEST(Concurrency, BakesIntoOneFileLeaveOneOfTheAnswersWhole)
{
    const TemporaryFolder folder;
    const fs::path input = folder / "in.ply", output = folder / "out.ply";
    const Scene scene = scenes::bumpy_sphere(6);
    write_scene(input, scene, std::vector<Occlusion>(scene.positions.size()));

    constexpr int kBakes = 4;
    std::vector<std::string> answers;
    for (int i = 0; i < kBakes; ++i) {
        (void)bake(settings_for(input, output, i));
        answers.push_back(contents_of(output));
    }
    ASSERT_NE(answers[0], answers[1]);
    const auto is_whole = [&](const std::string& bytes) {
        return std::find(answers.begin(), answers.end(), bytes) != answers.end();
    };

    std::atomic<bool> finished{false};
    std::atomic<int> broken{0};
    std::thread watcher([&] {
        while (!finished)
            broken += is_whole(contents_of(output)) ? 0 : 1;
    });
    at_once(kBakes, kAlone, [&](int i) {
        for (int round = 0; round < 5; ++round)
            (void)bake(settings_for(input, output, i));
    });
    finished = true;
    watcher.join();

    EXPECT_EQ(broken, 0);
    EXPECT_TRUE(is_whole(contents_of(output)));
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
        EXPECT_TRUE(entry.path() == input || entry.path() == output) << entry.path();
}

}  // namespace
}  // namespace surfelao::stability
