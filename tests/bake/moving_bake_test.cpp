// Sequences of an animated glTF: as each moment by itself, steady where nothing changes.
#include "bake/moving_bake.h"

#include "bake/moving_compare.h"
#include "bake/moving_solver.h"
#include "bake/moving_world.h"
#include "bake/played_scene.h"
#include "temporary_folder.h"
#include "tests/files/gltf_maker.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace surfelao {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::GltfMaker;

constexpr int kSquares = 60;  ///< of the floor, each way, of side 1

/// A floor from (0, 0, 0) to (60, 0, 60); a box of side 2 that moves away from its corner and back
/// between seconds 0, 1 and 2; another that is stretched meanwhile.
GltfMaker floor_and_boxes()
{
    GltfMaker maker;
    std::string places, indices;
    for (int z = 0; z <= kSquares; ++z)
        for (int x = 0; x <= kSquares; ++x)
            places += bytes_of<float>({static_cast<float>(x), 0, static_cast<float>(z)});
    for (std::uint32_t z = 0; z < kSquares; ++z) {
        for (std::uint32_t x = 0; x < kSquares; ++x) {
            const std::uint32_t a = z * (kSquares + 1) + x, b = a + kSquares + 1;
            indices += bytes_of<std::uint32_t>({a, b, a + 1, a + 1, b, b + 1});
        }
    }
    const auto add_mesh = [&](int position, int index) {
        return maker.add(
            "meshes",
            {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"indices", index}}}}});
    };
    const int floor = add_mesh(
        maker.add_accessor(maker.add_view(places), 5126, "VEC3", (kSquares + 1) * (kSquares + 1)),
        maker.add_accessor(maker.add_view(indices), 5125, "SCALAR", 6 * kSquares * kSquares));
    const int box = add_mesh(
        maker.add_vectors<float>(
            {0, 0, 0, 2, 0, 0, 0, 2, 0, 2, 2, 0, 0, 0, 2, 2, 0, 2, 0, 2, 2, 2, 2, 2}),
        maker.add_indices<std::uint16_t>({0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 4, 2, 2, 4, 6,
                                          1, 3, 5, 3, 7, 5, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7}));
    maker.document["nodes"] = {
        {{"mesh", floor}}, {{"mesh", box}}, {{"mesh", box}, {"translation", {12, .5, 4}}}};
    maker.document["scenes"][0]["nodes"] = {0, 1, 2};
    const int times =
        maker.add_accessor(maker.add_view(bytes_of<float>({0, 1, 2})), 5126, "SCALAR", 3);
    const int way = maker.add_vectors<float>({1, .5f, 1, 5, .25f, 3, 1, .5f, 1});
    const int scales = maker.add_vectors<float>({1, 1, 1, 1, 2, 1, 1, 1, 1});
    maker.document["animations"] = {
        {{"samplers",
          {{{"input", times}, {"output", way}}, {{"input", times}, {"output", scales}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
           {{"sampler", 1}, {"target", {{"node", 2}, {"path", "scale"}}}}}}}};
    return maker;
}

class MovingBake : public testing::Test {
protected:
    void SetUp() override
    {
        std::ofstream(folder_ / "boxes.glb", std::ios::binary) << floor_and_boxes().glb();
    }

    /// Frames at 0, 1/2, 1, ... 2 seconds. Rays that reach 2: what is farther off changes nothing.
    std::vector<BakeSettings> frames(const std::string& name) const
    {
        std::vector<BakeSettings> all;
        for (int frame = 0; frame < 5; ++frame) {
            BakeSettings& settings = all.emplace_back();
            settings.input = folder_ / "boxes.glb";
            settings.output = folder_ / (name + std::to_string(frame) + ".ply");
            settings.engine.engine = Engine::rays;
            settings.engine.rays = 64;
            settings.max_distance = {.value = 2.0};
            settings.check = 0;
            settings.reading.moment = Moment{0.5 * frame, {}};
        }
        return all;
    }
    TemporaryFolder folder_;
};

/// Values of a sequence, frame by frame.
std::vector<std::vector<Occlusion>> values_of(const std::vector<BakeSettings>& frames,
                                              MovingWorld& world)
{
    EngineSettings engine = frames.front().engine;
    engine.definition = world.definition_for(frames.front().max_distance, Kernel::cosine, {}, 0);
    MovingSolver solver(world, engine);
    std::vector<std::vector<Occlusion>> all;
    for (const BakeSettings& frame : frames) {
        world.pose(frame.reading.moment->seconds);
        solver.place();
        solver.solve();
        all.push_back(solver.values_of(solver.answers()));
    }
    return all;
}

MovingWorld world_of(const std::vector<BakeSettings>& frames)
{
    const double seconds[] = {0.0, 0.5, 1.0, 1.5, 2.0};
    return MovingWorld(frames.front().input, seconds, {}, {}, {});
}

// Read once, it stands at each moment as the file does, also back at an earlier one.
TEST_F(MovingBake, APlayedSceneIsTheFileAtEachMoment)
{
    const fs::path file = folder_ / "boxes.glb";
    PlayedScene played(file, {});
    const double seconds[] = {0.0, 1.0, 0.5};
    const Box all = played.box_at(seconds, {}, {});
    EXPECT_EQ(all.low, glm::dvec3(0.0));
    EXPECT_EQ(all.high, glm::dvec3(kSquares, 4.5, kSquares));
    for (const double moment : seconds) {
        const Scene then = read_scene(file, {.moment = Moment{moment, {}}});
        const Scene& now = played.at(moment);
        EXPECT_EQ(now.triangles, then.triangles);
        EXPECT_EQ(now.notes, then.notes);
        ASSERT_EQ(now.positions.size(), then.positions.size());
        for (std::size_t v = 0; v < then.positions.size(); ++v)
            ASSERT_LT(glm::distance(now.positions[v], then.positions[v]), 1e-12) << moment;
    }
}

// The floor, and both boxes as they stand after a second.
TEST_F(MovingBake, MisfitIsThatOfAllBodies)
{
    MovingWorld world = world_of(frames("x"));
    world.pose(1.0);
    const std::vector<Occlusion> answers(world.receiver_count(), Occlusion{.occlusion = 0.3f});
    const std::vector<Occlusion> open(world.scene().positions.size());
    const std::optional<Misfit> misfit = world.misfit(answers, open);
    ASSERT_TRUE(misfit.has_value());
    EXPECT_NEAR(misfit->rms, 0.3, 1e-6);
    const double unit = world.frame().diagonal * world.frame().diagonal;
    EXPECT_NEAR(misfit->area * unit, 3600 + 24 + 40, 0.01);
}

// The way there and back shows each frame's bytes again, and the floor farther from the boxes than
// rays and the fit reach never changes.
TEST_F(MovingBake, ChangesOnlyWhatChanges)
{
    const std::vector<BakeSettings> asked = frames("f");
    MovingWorld world = world_of(asked);
    EXPECT_EQ(world.body_count(), 3u);
    const auto values = values_of(asked, world);
    EXPECT_EQ(values[0], values[4]);
    EXPECT_EQ(values[1], values[3]);
    EXPECT_NE(values[0], values[2]);
    const std::vector<glm::dvec3>& places = world.scene().positions;
    std::size_t far = 0, changed_far = 0, changed = 0;
    for (std::size_t v = 0; v < places.size(); ++v) {
        const bool is_far = std::max(places[v].x - 14.0, places[v].z - 6.0) > kLocalSteps + 4.0;
        const bool is_changed = values[2][v] != values[0][v];
        far += is_far ? 1 : 0;
        changed += is_changed ? 1 : 0;
        changed_far += is_changed && is_far ? 1 : 0;
    }
    EXPECT_GT(far, 2000u);     // of 3721
    EXPECT_GT(changed, 100u);  // the floor under both boxes
    EXPECT_EQ(changed_far, 0u);
}

/// A square, and above it a triangle with normals that moves, beside one with neither normals nor
/// area, and a vertex of no triangle.
GltfMaker square_and_flaws()
{
    GltfMaker maker = test::square();
    const int places =
        maker.add_vectors<float>({0, 0, 4, 1, 0, 4, 2, 0, 4, 0, 0, 4, 1, 0, 4, 0, 1, 4, 9, 9, 9});
    const int normals =
        maker.add_vectors<float>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    const int mesh = maker.add(
        "meshes", {{"primitives",
                    {{{"attributes", {{"POSITION", places}, {"NORMAL", normals}}},
                      {"indices", maker.add_indices<std::uint16_t>({0, 1, 2, 3, 4, 5})}}}}});
    maker.add("nodes", {{"mesh", mesh}});
    maker.document["scenes"][0]["nodes"] = {0, 1};
    const int times =
        maker.add_accessor(maker.add_view(bytes_of<float>({0, 1})), 5126, "SCALAR", 2);
    const int way = maker.add_vectors<float>({0, 0, 0, 0, 0, -3});
    maker.document["animations"] = {
        {{"samplers", {{{"input", times}, {"output", way}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
    return maker;
}

// A report says of a frame what a bake of that moment alone says.
TEST_F(MovingBake, ReportsAsABakeOfTheMoment)
{
    std::ofstream(folder_ / "boxes.glb", std::ios::binary) << square_and_flaws().glb();
    const std::vector<BakeSettings> asked = frames("f");
    std::vector<BakeReport> reports;
    bake_frames({asked.data(), 1}, false, [&](std::size_t, std::optional<BakeReport> report) {
        reports.push_back(std::move(report.value()));
    });
    BakeSettings alone = asked.front();
    alone.output = folder_ / "alone.ply";
    const BakeReport single = bake(alone);
    ASSERT_EQ(reports.size(), 1u);
    EXPECT_EQ(single.dropped_triangles, 1u);
    EXPECT_EQ(reports[0].dropped_triangles, single.dropped_triangles);
    EXPECT_EQ(single.vertices_without_normal, 1u);
    EXPECT_EQ(reports[0].vertices_without_normal, single.vertices_without_normal);
    EXPECT_GT(single.corners_from_file, 0u);
    EXPECT_EQ(reports[0].corners_from_file, single.corners_from_file);
    EXPECT_EQ(reports[0].notes.size(), single.notes.size());
}

/// RMS difference of occlusion.
double difference(const std::vector<Occlusion>& a, const std::vector<Occlusion>& b)
{
    double squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        squares += std::pow(static_cast<double>(a[i].occlusion) - b[i].occlusion, 2);
    return std::sqrt(squares / static_cast<double>(a.size()));
}

TEST_F(MovingBake, IsWhatEachMomentIsByItself)
{
    std::vector<BakeSettings> asked = frames("f");
    for (BakeSettings& frame : asked)
        frame.engine.rays = 512;
    MovingWorld world = world_of(asked);
    const auto values = values_of(asked, world);
    for (const std::size_t frame : {0u, 2u}) {
        ReadOptions reading = asked[frame].reading;
        const auto mesh = std::make_shared<const Mesh>(
            mesh_of(read_scene(asked[frame].input, reading), {}, {}, {}, world.frame()));
        const VertexTarget target(mesh, {});
        EngineSettings engine = asked[frame].engine;
        engine.definition = definition_of(asked[frame].max_distance, Kernel::cosine, world.frame());
        const VertexBake alone = bake_vertices(*mesh, target, engine, {}, 0);
        // the boxes' 16 vertices have other samples then
        EXPECT_LT(difference(values[frame], alone.values), 0.004) << frame;
    }
}

TEST_F(MovingBake, WhatIsCancelledLeavesWholeFrames)
{
    const std::vector<BakeSettings> asked = frames("f");
    std::size_t done = 0;
    const FrameDone count = [&](std::size_t, const std::optional<BakeReport>&) { ++done; };
    EXPECT_THROW(
        bake_frames(asked, false, count,
                    [&](std::string_view stage, double) { return stage != "solve" || done < 2; }),
        Cancelled);
    EXPECT_EQ(done, 2u);
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
        files += entry.path().extension() != ".glb" ? 1 : 0;
    EXPECT_EQ(files, 2u);
    EXPECT_EQ(read_scene(asked[1].output).positions.size(), 61u * 61u + 16u);

    std::vector<bool> was_there;
    bake_frames(asked, true, [&](std::size_t, const std::optional<BakeReport>& report) {
        was_there.push_back(!report);
    });
    EXPECT_EQ(was_there, (std::vector<bool>{true, true, false, false, false}));
}

TEST_F(MovingBake, EnginesAreComparedOverFrames)
{
    MovingCompareSettings settings;
    settings.input = folder_ / "boxes.glb";
    settings.seconds = {0.0, 1.0};
    settings.max_distance = {.value = 2.0};
    settings.sample = 200;
    settings.reference_rays = 256;
    const MovingComparison found = compare_frames(settings);
    ASSERT_EQ(found.rows.size(), 3u);  // rays, smoothed, and four times as many
    EXPECT_TRUE(found.rows[1].is_smoothed);
    EXPECT_LT(found.rows[2].rmse, found.rows[0].rmse);
    EXPECT_EQ(found.rows[0].rmse_by_frame.size(), 2u);
    EXPECT_GT(found.untouched, 100u);
    EXPECT_EQ(found.rows[0].untouched_max, 0.0);
    EXPECT_NE(table_of(found).find("rays smoothed"), std::string::npos);
}

}  // namespace
}  // namespace surfelao
