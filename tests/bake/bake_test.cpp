#include "bake/bake.h"

#include "bake/info.h"
#include "engines/threads.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <limits>

namespace surfelao {
namespace {

using scenes::operator+;

namespace fs = std::filesystem;
using Json = nlohmann::json;

BakeSettings settings_for(const fs::path& input, const fs::path& output)
{
    BakeSettings settings;
    settings.input = input;
    settings.output = output;
    settings.engine.rays = 16;
    return settings;
}

TEST(Bake, WritesTheFileAndReportsEveryStage)
{
    const TemporaryFolder folder;
    write_obj(folder / "in.obj", scenes::bumpy_sphere(8));
    for (const Engine engine : {Engine::masks, Engine::disks, Engine::rays}) {
        BakeSettings settings = settings_for(folder / "in.obj", folder / "out.ply");
        settings.engine.engine = engine;
        std::vector<std::string> stages;
        const BakeReport report = bake(settings, [&](std::string_view stage, double done) {
            EXPECT_GE(done, 0.0);
            EXPECT_LE(done, 1.0);
            if (stages.empty() || stages.back() != stage)
                stages.emplace_back(stage);
            return true;
        });
        EXPECT_TRUE(fs::exists(folder / "out.ply"));
        EXPECT_EQ(report.vertices, 6u * 64 + 2);
        EXPECT_EQ(report.triangles, 12u * 64);
        EXPECT_GT(report.mean_occlusion, 0.01);
        EXPECT_LT(report.mean_occlusion, 0.3);
        EXPECT_EQ(stages,
                  (std::vector<std::string>{"read", "build", "solve", "fit", "check", "write"}));
        EXPECT_GE(report.seconds.total, report.seconds.read + report.seconds.solve);
        EXPECT_GT(report.seconds.fit, 0.0);
        EXPECT_GT(report.receivers, report.triangles);
        ASSERT_TRUE(report.misfit.has_value());
        EXPECT_GT(report.misfit->rms, 0.0);
        ASSERT_TRUE(report.error.has_value());
        EXPECT_GT(report.error->rmse, 0.0);
        EXPECT_GT(report.seconds.check, 0.0);
        EXPECT_GT(report.peak_rss_bytes, 1u << 20);
        EXPECT_EQ(report.residual.has_value(), engine == Engine::disks);
    }
}

// Each side of a hard edge has values of its own, which the PLY's shared vertices have not.
TEST(Bake, AMeshBecomesGltf)
{
    const TemporaryFolder folder;
    std::ofstream(folder / "in.off") << "OFF\n6 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 0 1\n1 1 1\n"
                                        "4 0 1 2 3\n4 1 4 5 2\n";
    EXPECT_EQ(bake(settings_for(folder / "in.off", folder / "out.ply")).vertices, 6u);
    EXPECT_EQ(bake(settings_for(folder / "in.off", folder / "out.glb")).vertices, 8u);
    EXPECT_EQ(bake(settings_for(folder / "out.glb", folder / "again.glb")).vertices, 8u);
    EXPECT_EQ(contents_of(folder / "out.glb"), contents_of(folder / "again.glb"));
}

TEST(Bake, CancelledAtAnyStageLeavesTheOldFile)
{
    const TemporaryFolder folder;
    write_obj(folder / "in.obj", scenes::bumpy_sphere(8));
    std::ofstream(folder / "out.ply") << "old";
    for (const std::string stop : {"read", "build", "solve", "fit", "check", "write"}) {
        EXPECT_THROW(
            static_cast<void>(bake(settings_for(folder / "in.obj", folder / "out.ply"),
                                   [&](std::string_view stage, double) { return stage != stop; })),
            Cancelled)
            << stop;
        EXPECT_EQ(contents_of(folder / "out.ply"), "old");
        EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2) << stop;
    }
}

TEST(Bake, OutputThatCannotBeIsRefusedBeforeReading)
{
    const TemporaryFolder folder;
    std::ofstream(folder / "in.obj") << "not a mesh";
    for (const char* output : {"missing/out.ply", "out.abc", "out.stl", "."}) {
        bool read = false;
        EXPECT_THROW(static_cast<void>(bake(settings_for(folder / "in.obj", folder / output),
                                            [&](std::string_view, double) {
                                                read = true;
                                                return true;
                                            })),
                     InputError)
            << output;
        EXPECT_FALSE(read) << output;
    }
}

TEST(Bake, JsonHasAllKeysAndNullForWhatIsNotThere)
{
    const TemporaryFolder folder;
    write_obj(folder / "in.obj", scenes::bumpy_sphere(4));
    BakeSettings settings = settings_for(folder / "in.obj", folder / "out.ply");
    settings.engine.engine = Engine::rays;
    BatchEntry done{settings.input, settings.output, bake(settings), ""};
    const Json json = Json::parse(json_of({&done, 1}));
    for (const char* key : {"input", "output", "vertices", "triangles", "dropped_triangles",
                            "vertices_without_normal", "surfels", "engine", "settings", "seconds",
                            "peak_rss_bytes", "residual", "mean_occlusion", "receivers",
                            "corners_from_file", "replaced_corners", "misfit", "notes"})
        EXPECT_TRUE(json.contains(key)) << key;
    for (const char* key : {"read", "surfels", "tree", "solve", "fit", "write", "total"})
        EXPECT_TRUE(json["seconds"].contains(key)) << key;
    EXPECT_EQ(json["engine"], "rays");
    EXPECT_EQ(json["settings"]["rays"], 16);
    EXPECT_TRUE(json["residual"].is_null());
    EXPECT_TRUE(json["settings"]["max_distance"].is_null());
    EXPECT_EQ(json["settings"]["normals"], "auto");
    EXPECT_EQ(json["settings"]["crease"], 40);
    EXPECT_EQ(json["settings"]["values"], "fit");
    EXPECT_TRUE(json["settings"]["offset"].is_null());
    EXPECT_TRUE(json["misfit"].contains("share"));
    EXPECT_TRUE(json["notes"].is_array());

    const BatchEntry entries[] = {done, {"a.obj", "a.ply", {}, "a.obj: bad"}, {"b", "c", {}, ""}};
    const Json list = Json::parse(json_of(entries));
    ASSERT_EQ(list.size(), 3u);
    EXPECT_EQ(list[1]["error"], "a.obj: bad");
    EXPECT_EQ(list[2]["skipped"], true);
}

TEST(Definition, LimitIsInTheFilesUnitsOrPercentOfTheDiagonal)
{
    const Frame frame{{0, 0, 0}, 200.0};
    EXPECT_FLOAT_EQ(definition_of({50.0, false, Falloff::none}, Kernel::cosine, frame).max_distance,
                    0.25f);
    EXPECT_FLOAT_EQ(definition_of({50.0, true, Falloff::none}, Kernel::cosine, frame).max_distance,
                    0.5f);
    EXPECT_EQ(definition_of({}, Kernel::cosine, frame).max_distance,
              std::numeric_limits<float>::infinity());
    EXPECT_THROW(
        static_cast<void>(definition_of({1e-60, false, Falloff::none}, Kernel::cosine, frame)),
        InputError);
    // beyond a float's range: nothing is that far, so there is no limit and no falloff
    const Definition far = definition_of({1e60, false, Falloff::smooth}, Kernel::cosine, frame);
    EXPECT_TRUE(std::isinf(far.max_distance));
    EXPECT_EQ(far.falloff, Falloff::none);
}

TEST(Batch, ResultsHaveTheirInputsNames)
{
    EXPECT_EQ(output_in_folder("x/a.obj", "out"), fs::path("out/a.obj"));
    EXPECT_EQ(output_in_folder("x/a.STL", "out"), fs::path("out/a.ply"));
    EXPECT_EQ(output_in_folder("x/a.glb", "out"), fs::path("out/a.glb"));
}

TEST(Batch, FinishedMeansThereNotOlderAndMadeWithTheSameSettings)
{
    const TemporaryFolder folder;
    write_obj(folder / "in.obj", scenes::bumpy_sphere(4));
    for (const char* name : {"out.ply", "out.obj", "out.off"}) {
        BakeSettings settings = settings_for(folder / "in.obj", folder / name);
        EXPECT_FALSE(is_finished(settings)) << name;
        static_cast<void>(bake(settings));
        EXPECT_TRUE(is_finished(settings)) << name;

        BakeSettings other = settings;
        other.engine.quality = kBest;
        EXPECT_FALSE(is_finished(other)) << name;
        other = settings;
        other.max_distance = {10.0, true, Falloff::smooth};
        EXPECT_FALSE(is_finished(other)) << name;
        TargetSettings flat, creased, point, lifted;
        flat.normals.source = NormalSource::flat;
        creased.normals.crease = 41.0f;
        point.values = VertexValues::point;
        lifted.offset = Length{0.1, true};
        for (const TargetSettings& target : {flat, creased, point, lifted}) {
            other = settings;
            other.target = target;
            EXPECT_FALSE(is_finished(other)) << name << ' ' << text_of(target);
        }

        const auto made = fs::last_write_time(folder / name);
        fs::last_write_time(folder / "in.obj", made + std::chrono::seconds(10));
        EXPECT_FALSE(is_finished(settings)) << name;
        fs::last_write_time(folder / "in.obj", made - std::chrono::seconds(10));
    }
    EXPECT_FALSE(is_finished(settings_for(folder / "none.obj", folder / "out.obj")));
}

TEST(Batch, MarksNameTheSettingsOfTheEngineAtHand)
{
    BakeSettings settings = settings_for("in.obj", "out.obj");
    EXPECT_NE(mark_of(settings).find(" bake: engine=masks device=cpu quality=1 kernel=cosine "
                                     "max_distance=none falloff=none normals=auto crease=40 "
                                     "values=fit colors=auto encoding=auto"),
              std::string::npos)
        << mark_of(settings);
    settings.engine.engine = Engine::disks;
    settings.engine.device = Device::gpu;
    settings.engine.quality = 0.1f;
    settings.kernel = Kernel::bunnell;
    settings.max_distance = {12.5, true, Falloff::smooth};
    settings.target = {.normals = {NormalSource::smooth, 30},
                       .values = VertexValues::point,
                       .offset = Length{0.5, true}};
    settings.colors = VertexColors::shaded;
    EXPECT_NE(mark_of(settings).find(
                  "engine=disks device=gpu quality=0.1 passes=3 strength=1 "
                  "kernel=bunnell max_distance=12.5% falloff=smooth "
                  "normals=smooth crease=30 values=point offset=0.5% colors=shaded encoding=auto"),
              std::string::npos)
        << mark_of(settings);
    settings.engine.engine = Engine::rays;
    EXPECT_NE(mark_of(settings).find("engine=rays device=gpu rays=16 kernel"), std::string::npos);
    settings.error = 0.01;  // which then says who answers
    EXPECT_NE(mark_of(settings).find(" bake: error=0.01 check=400 kernel="), std::string::npos)
        << mark_of(settings);
}

TEST(Threads, TheLimitLivesAsLongAsItsObject)
{
    const int before = thread_count();
    {
        const ThreadLimit limit(1);
        EXPECT_EQ(thread_count(), 1);
    }
    EXPECT_EQ(thread_count(), before);
}

TEST(Info, CountsWhatIsThereAndWhatIsOdd)
{
    const TemporaryFolder folder;
    Scene scene = scenes::box({0, 0, 0}, {1, 2, 2}, 2);
    const std::uint64_t used = scene.positions.size();
    scene.positions.push_back({9, 9, 9});
    scene.triangles.push_back(scene.triangles.front());
    scene.triangles.push_back({0, 0, 1});
    write_obj(folder / "in.obj", scene);
    const Info info = inspect(folder / "in.obj");
    EXPECT_EQ(info.vertices, used + 1);
    EXPECT_EQ(info.unused_vertices, 1u);
    EXPECT_EQ(info.vertices_without_normal, 1u);
    EXPECT_EQ(info.dropped_triangles, 1u);
    EXPECT_EQ(info.topology.duplicate_triangle_count, 1u);
    EXPECT_EQ(info.low, glm::dvec3(0, 0, 0));
    EXPECT_EQ(info.high, glm::dvec3(1, 2, 2));
    EXPECT_NEAR(info.diagonal, 3.0, 1e-12);
    EXPECT_NEAR(info.area, 16.0, 1e-4) << "the repeated triangle counts once";
    const std::string text = text_of(info);
    for (const char* words : {"1 triangle without area", "1 triangle repeated", "1 vertex in no",
                              "1 vertex without a normal"})
        EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
    const Json json = Json::parse(json_of(info));
    EXPECT_EQ(json["dropped_triangles"], 1);
    EXPECT_EQ(json["parts"].size(), info.parts.size());
    EXPECT_EQ(json["normals_in_file"], false);
    EXPECT_EQ(json["receivers"], info.receivers);
    EXPECT_EQ(json["inward_pieces"], 0);
    EXPECT_TRUE(json["notes"].is_array());
}

TEST(Info, ACleanBoxHasNothingOdd)
{
    const TemporaryFolder folder;
    write_obj(folder / "in.obj", scenes::box({0, 0, 0}, {1, 1, 1}, 2));
    const std::string text = text_of(inspect(folder / "in.obj"));
    EXPECT_NE(text.find("nothing odd"), std::string::npos) << text;
    EXPECT_NE(text.find("1 connected piece, 1 of them closed"), std::string::npos) << text;
}

TEST(Info, CountsThePlacesWithoutAnAnswerAmongThoseWhereABakeAsks)
{
    const TemporaryFolder folder;
    // over half of the floor a lid, above the receivers, but below those at twice their offset
    const double height = 1.5 * kMostOffset * std::sqrt(5.0);
    write_obj(folder / "in.obj", scenes::sheet({0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 8) +
                                     scenes::sheet({0, 0, height}, {1, 0, 0}, {0, 1, 0}, 4));
    const Info info = inspect(folder / "in.obj");
    EXPECT_EQ(info.examined, info.receivers);
    EXPECT_GT(info.receivers, info.vertices);
    EXPECT_NEAR(static_cast<double>(info.ill_defined), static_cast<double>(info.examined) / 3,
                0.1 * static_cast<double>(info.examined));
    EXPECT_NE(text_of(info).find("places where occlusion is asked have no answer of their own"),
              std::string::npos);
}

}  // namespace
}  // namespace surfelao
