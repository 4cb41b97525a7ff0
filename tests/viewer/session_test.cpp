#include "viewer/session.h"

#include "bake/bake.h"
#include "differences.h"
#include "scenes.h"
#include "temporary_folder.h"
#include "viewer/solve_model.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

namespace surfelao {
namespace {

/// Draft in hundredths of a second, the finest in many seconds.
constexpr int kSlowCells = 60;
constexpr float kSlowQuality = 4.0f;

class SessionTest : public testing::Test {
protected:
    void SetUp() override { setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1); }

    std::filesystem::path ball(const char* name = "ball.obj", int cells = 6) const
    {
        write_obj(folder_ / name, scenes::bumpy_sphere(cells));
        return folder_ / name;
    }
    TemporaryFolder folder_;
};

SessionSettings of_quality(float quality, Engine engine = Engine::masks)
{
    SessionSettings settings;
    settings.engine.engine = engine;
    settings.engine.quality = quality;
    return settings;
}

/// Updates until the condition holds, which may ask what has changed; at most half a minute.
template <class Condition>
bool wait_for(Session& session, Condition condition)
{
    for (int i = 0; i < 30000; ++i) {
        const Session::Changes changes = session.update();
        if constexpr (std::is_invocable_v<Condition, const Session::Changes&>) {
            if (condition(changes))
                return true;
        } else if (condition()) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

bool wait_for_whole_answer(Session& session)
{
    bool was_idle = false;  // before the update: then nothing is on its way
    return wait_for(session, [&] {
        const bool is_there = was_idle && !session.opening() && session.state().is_solved &&
                              !session.state().is_draft;
        was_idle = !session.solving();
        return is_there;
    });
}

/// As bake() asks.
std::vector<float> vertex_values(const Model& model, const EngineSettings& settings)
{
    const Solution solution =
        solve(prepare(model.geometry(), settings), model.target->receivers(), settings);
    std::vector<float> values;
    for (const Occlusion& value : model.target->values(solution.occlusion))
        values.push_back(value.occlusion);
    return values;
}

std::vector<float> first_values(const std::vector<Occlusion>& occlusion, std::size_t count)
{
    std::vector<float> values;
    for (std::size_t i = 0; i < count; ++i)
        values.push_back(occlusion[i].occlusion);
    return values;
}

TEST_F(SessionTest, ReadsAFileAndSolvesIt)
{
    Session session;
    session.open(ball(), UpAxis::y);
    ASSERT_TRUE(wait_for_whole_answer(session));
    const SessionState& state = session.state();
    EXPECT_EQ(state.model->geometry().positions.size(), scenes::bumpy_sphere(6).positions.size());
    EXPECT_EQ(session.occlusion().size(), state.model->answer_count());
    EXPECT_EQ(first_values(session.occlusion(), state.model->geometry().positions.size()),
              vertex_values(*state.model, {}));
    EXPECT_FALSE(state.error.has_value());
}

// What is saved is what bake() writes for these parts; a pattern that means nothing is told, and
// the model stays.
TEST_F(SessionTest, OtherPartsMakeAnotherModel)
{
    const std::filesystem::path plain = ball();
    const std::filesystem::path input =
        folder_.file("parts.obj", "o ball\n" + contents_of(plain) +
                                      "o lid\nv -9 -9 3\nv 9 -9 3\nv 0 9 3\nf -3 -2 -1\n");
    Session session;
    session.open(input, UpAxis::y);
    ASSERT_TRUE(wait_for_whole_answer(session));
    SessionSettings settings;
    settings.parts.receivers = {"ball"};
    session.solve(settings);
    ASSERT_TRUE(wait_for(session, [](const Session::Changes& changes) { return changes.model; }));
    ASSERT_TRUE(wait_for_whole_answer(session));
    const Model& model = *session.state().model;
    EXPECT_EQ(model.geometry().triangles.size() + 1, model.occluding().triangles.size());
    session.save(folder_ / "saved.ply");
    BakeSettings bake_settings;
    bake_settings.input = input;
    bake_settings.output = folder_ / "baked.ply";
    bake_settings.parts = settings.parts;
    static_cast<void>(bake(bake_settings));
    EXPECT_EQ(contents_of(folder_ / "saved.ply"), contents_of(folder_ / "baked.ply"));

    settings.parts.receivers = {"gone"};
    session.solve(settings);
    EXPECT_TRUE(wait_for(session, [&] { return !session.state().message.empty(); }));
    EXPECT_EQ(session.state().model.get(), &model);
}

// The model that --up z and a ground make, without reading the file again.
TEST_F(SessionTest, AnotherUpAxisMakesTheModelThatItIsOpenedWith)
{
    Session turned, opened;
    SessionSettings settings;
    settings.ground.emplace();
    turned.open(ball(), UpAxis::y, settings);
    ASSERT_TRUE(wait_for_whole_answer(turned));
    turned.set_up(UpAxis::z);
    ASSERT_TRUE(wait_for(
        turned, [](const Session::Changes& changes) { return changes.model && !changes.file; }));
    ASSERT_TRUE(wait_for_whole_answer(turned));
    settings.target.sky = glm::vec3(0, 0, 1);
    settings.ground = GroundPlane{glm::vec3(0, 0, 1)};
    opened.open(ball(), UpAxis::z, settings);
    ASSERT_TRUE(wait_for_whole_answer(opened));
    EXPECT_EQ(turned.state().model->ground.up, glm::vec3(0, 0, 1));
    EXPECT_EQ(turned.settings(), opened.settings());
    EXPECT_EQ(first_values(turned.occlusion(), turned.occlusion().size()),
              first_values(opened.occlusion(), opened.occlusion().size()));
}

TEST_F(SessionTest, EqualSettingsSolveNothing)
{
    Session session;
    session.open(ball(), UpAxis::y);
    ASSERT_TRUE(wait_for_whole_answer(session));
    const std::uint64_t answers = session.state().answer_count;
    for (int frame = 0; frame < 100; ++frame) {
        session.solve(session.settings());
        EXPECT_FALSE(session.solving());
        (void)session.update();
    }
    EXPECT_EQ(session.state().answer_count, answers);
}

TEST_F(SessionTest, AnEngineIsPreparedOncePerModel)
{
    Session session;
    session.open(ball(), UpAxis::y);
    ASSERT_TRUE(wait_for_whole_answer(session));
    EXPECT_TRUE(session.state().build_s.has_value());
    SessionSettings settings = of_quality(1.5f);
    settings.max_distance = {10.0, true};
    session.solve(settings);
    ASSERT_TRUE(wait_for_whole_answer(session));
    EXPECT_FALSE(session.state().build_s.has_value());
    session.solve(of_quality(kGood, Engine::disks));
    ASSERT_TRUE(wait_for_whole_answer(session));
    EXPECT_TRUE(session.state().build_s.has_value());
    session.open(ball("other.obj"), UpAxis::y);
    ASSERT_TRUE(wait_for(session, [&] { return session.state().path.filename() == "other.obj"; }));
    ASSERT_TRUE(wait_for_whole_answer(session));
    EXPECT_TRUE(session.state().build_s.has_value());
}

TEST_F(SessionTest, OtherSettingsReplaceWhatRuns)
{
    Session session;
    session.solve(of_quality(kSlowQuality));
    session.open(ball("slow.obj", kSlowCells), UpAxis::y);
    ASSERT_TRUE(wait_for(session, [&] { return session.state().is_solved; }));
    ASSERT_TRUE(session.state().is_draft);
    session.solve(of_quality(0.5f));
    ASSERT_TRUE(wait_for_whole_answer(session));
    EngineSettings wanted;
    wanted.quality = 0.5f;
    const Model& model = *session.state().model;
    EXPECT_EQ(first_values(session.occlusion(), model.geometry().positions.size()),
              vertex_values(model, wanted));
}

TEST_F(SessionTest, CancelKeepsTheDraftAndItCanBeSolvedAgain)
{
    Session session;
    session.solve(of_quality(kSlowQuality));
    session.open(ball("slow.obj", kSlowCells), UpAxis::y);
    ASSERT_TRUE(wait_for(session, [&] { return session.state().is_solved; }));
    EXPECT_FALSE(session.was_cancelled());
    session.cancel();
    EXPECT_TRUE(session.was_cancelled());
    ASSERT_TRUE(wait_for(session, [&] { return !session.solving(); }));
    EXPECT_TRUE(session.was_cancelled());
    EXPECT_TRUE(session.state().is_draft);
    EXPECT_EQ(session.state().answer_count, 1u);
    session.solve_again();
    EXPECT_FALSE(session.was_cancelled());
    EXPECT_TRUE(wait_for(session, [&] { return session.state().answer_count == 2; }));
    // and it ends while work is running
}

TEST_F(SessionTest, TheReferenceIsTracedMeasuredAgainstAndThenComesFromTheCache)
{
    for (const bool from_cache : {false, true}) {
        Session session;
        session.want_reference(16);
        session.open(ball(), UpAxis::y);
        ASSERT_TRUE(wait_for(session, [&] {
            return session.state().error.has_value() && !session.state().is_draft;
        }));
        EXPECT_EQ(session.state().reference_s.has_value(), !from_cache);
        // a coarse ball: what is seen is worse than what was solved, and hardly than it must be
        const ModelError error = *session.state().error;
        EXPECT_GT(error.solve, 0.0);
        EXPECT_LT(error.solve, error.seen.rmse);
        EXPECT_GT(error.seen.rmse, 0.01);
        EXPECT_LT(error.seen.rmse, 0.1);
        EXPECT_NEAR(error.floor, error.seen.rmse, 0.1 * error.seen.rmse);
        EXPECT_EQ(error.seen.count + error.left_out, kModelPoints);
        session.want_reference(0);
        EXPECT_TRUE(session.state().reference.empty());
        EXPECT_FALSE(session.state().error.has_value());
    }
}

TEST_F(SessionTest, WithoutAreaThereIsNothingToJudge)
{
    Session session;
    session.want_reference(16);
    session.open(folder_.file("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), UpAxis::y);
    ASSERT_TRUE(wait_for_whole_answer(session)) << session.state().message;
    ASSERT_TRUE(wait_for(session, [&] {
        return !session.state().reference.empty() || !session.state().message.empty();
    }));
    EXPECT_EQ(session.state().message, "");
    EXPECT_FALSE(session.state().error.has_value());
}

TEST_F(SessionTest, AFileThatCannotBeReadIsToldAndChangesNothing)
{
    Session session;
    session.open(ball(), UpAxis::y);
    ASSERT_TRUE(wait_for_whole_answer(session));
    const auto model = session.state().model;
    session.open("none.obj", UpAxis::y);
    ASSERT_TRUE(wait_for(session, [&] { return !session.state().message.empty(); }));
    EXPECT_NE(session.state().message.find("none.obj"), std::string::npos);
    EXPECT_EQ(session.state().model, model);
    EXPECT_FALSE(session.opening());
}

TEST_F(SessionTest, OfTwoFilesOpenedAtOnceTheLastIsShown)
{
    Session session;
    session.open(ball("first.obj"), UpAxis::y);
    session.open(ball("second.obj"), UpAxis::y);
    ASSERT_TRUE(wait_for_whole_answer(session));
    EXPECT_EQ(session.state().path.filename(), "second.obj");
}

TEST_F(SessionTest, AnEnginesFailureIsTold)
{
    Session session;
    session.solve(of_quality(kSlowQuality, Engine::disks));
    session.open(ball(), UpAxis::y);
    EXPECT_TRUE(wait_for(session, [&] {
        return session.state().message.find("quality of disks must be") != std::string::npos;
    })) << session.state().message;
}

TEST_F(SessionTest, SolvesOnTheGpuToo)
{
    Session session;
    session.solve(of_quality(kGood, Engine::disks));
    session.open(ball(), UpAxis::y);
    ASSERT_TRUE(wait_for_whole_answer(session));
    const std::vector<Occlusion> by_cpu = session.occlusion();
    SessionSettings settings = session.settings();
    settings.engine.device = Device::gpu;
    session.solve(settings);
    ASSERT_TRUE(wait_for_whole_answer(session)) << session.state().message;
    ASSERT_EQ(session.occlusion().size(), by_cpu.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < by_cpu.size(); ++i)
        sum += std::abs(session.occlusion()[i].occlusion - by_cpu[i].occlusion);
    EXPECT_LT(sum / static_cast<double>(by_cpu.size()), 1e-4);
    EXPECT_GT(sum, 0.0);  // no CPU has answered
}

/// Of what the session saves for these settings, and what bake does.
struct Written {
    std::string by_session, by_bake;
};
Written written_by_both(const TemporaryFolder& folder, const std::filesystem::path& input,
                        const SessionSettings& settings)
{
    Session session;
    session.solve(settings);
    session.open(input, UpAxis::y);
    EXPECT_TRUE(wait_for_whole_answer(session)) << session.state().message;
    session.save(folder / "saved.ply");
    (void)bake({.input = input,
                .output = folder / "baked.ply",
                .engine = settings.engine,
                .max_distance = settings.max_distance,
                .ground = settings.ground,
                .target = settings.target});
    return {contents_of(folder / "saved.ply"), contents_of(folder / "baked.ply")};
}

// The ground's receivers lie among the vertices': solved in one call they would share groups.
TEST_F(SessionTest, SavesTheBytesThatBakeWrites)
{
    const std::filesystem::path input = ball("ball.obj", 12);
    for (const Engine engine : {Engine::masks, Engine::disks}) {
        for (const float quality : {kDraft, kGood}) {
            SessionSettings settings = of_quality(quality, engine);
            settings.max_distance = {40.0, true, Falloff::smooth};
            settings.ground =
                GroundPlane{{0, 1, 0}, quality == kDraft ? std::optional(-1.5) : std::nullopt};
            const Written written = written_by_both(folder_, input, settings);
            EXPECT_EQ(written.by_session, written.by_bake) << name_of(engine) << ", " << quality;
        }
    }
}

TEST_F(SessionTest, AGroundIsSwitchedOnMovedAndSwitchedOff)
{
    Session session;
    session.open(ball(), UpAxis::y);
    ASSERT_TRUE(wait_for_whole_answer(session));
    const std::vector<Occlusion> without = session.occlusion();
    const auto mean_with = [&](const std::optional<GroundPlane>& ground) {
        SessionSettings settings = session.settings();
        settings.ground = ground;
        session.solve(settings);
        EXPECT_TRUE(
            wait_for(session, [&] { return session.state().model->ground_plane == ground; }));
        EXPECT_TRUE(wait_for_whole_answer(session));
        double mean = 0.0;
        for (std::size_t v = 0; v < session.state().model->geometry().positions.size(); ++v)
            mean += session.occlusion()[v].occlusion;
        return mean / static_cast<double>(session.state().model->geometry().positions.size());
    };
    const double low = mean_with(GroundPlane{});
    const double through = mean_with(GroundPlane{.height = 0.0});
    EXPECT_GT(low, mean_with(std::nullopt) + 0.2);
    EXPECT_GT(std::abs(low - through), 0.05);
    EXPECT_TRUE(same_bytes(without, session.occlusion()));
}

/// Two walls that meet at a right angle, each a half of the map.
constexpr const char* kWalls =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\n"
    "vt 0.5 0\nvt 1 0\nvt 1 1\nvt 0.5 1\nvt 0 0\nvt 0 1\n"
    "f 1/1 2/2 3/3 4/4\nf 1/1 4/4 6/6 5/5\n";

TEST_F(SessionTest, AMapIsSolvedComparedWithRaysAndSavedAsBakeWritesIt)
{
    SessionSettings settings;
    settings.texels.emplace().size = 32;
    Session session;
    session.solve(settings);
    session.want_reference(64);
    session.open(folder_.file("walls.obj", kWalls), UpAxis::y);
    const SessionState& state = session.state();
    ASSERT_TRUE(wait_for_whole_answer(session)) << state.message;
    ASSERT_TRUE(wait_for(session, [&] { return state.has_reference(); }));
    ASSERT_TRUE(state.layout && state.map && state.map_reference && state.map_error);
    EXPECT_EQ(state.layout->facts.chart_count, 1u);
    EXPECT_LT(state.map_error->rmse, 0.03);
    for (std::size_t i = 0; i < 32 * 32; ++i)
        EXPECT_NEAR(state.map->visibility[0].values[i],
                    state.map_reference->visibility[0].values[i], 0.1f);
    session.save(folder_ / "saved.png");
    BakeSettings same;
    same.input = state.path;
    same.output = folder_ / "baked.png";
    same.texels = settings.texels;
    (void)bake(same);
    EXPECT_EQ(contents_of(folder_ / "saved.png"), contents_of(folder_ / "baked.png"));

    session.solve({});  // and the vertices again, with their own rays
    ASSERT_TRUE(wait_for(session, [&] { return !state.layout && state.error.has_value(); }));
    EXPECT_FALSE(state.map || state.map_reference || state.map_error);
}

/// One facet of a box, 90 degrees from the next: without vertices of its own.
std::filesystem::path stl_box(const TemporaryFolder& folder)
{
    const Scene box = scenes::box({0, 0, 0}, {1, 1, 1}, 2);
    std::string text = "solid box\n";
    for (const glm::uvec3 triangle : box.triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 p = box.positions[triangle[corner]];
            text += "vertex " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' +
                    std::to_string(p.z) + '\n';
        }
        text += "endloop\nendfacet\n";
    }
    return folder.file("box.stl", text + "endsolid box\n");
}

TargetSettings pointwise()
{
    TargetSettings target;
    target.values = VertexValues::point;
    return target;
}

std::vector<TargetSettings> some_targets()
{
    std::vector<TargetSettings> targets(4);
    targets[1].normals.source = NormalSource::flat;
    targets[2].normals = {NormalSource::smooth, 120.0f};
    targets[3].normals.crease = 10.0f;
    targets[3].offset = Length{0.05, true};
    targets.push_back(pointwise());
    return targets;
}

// Whether the file is opened with them or they are chosen later, in any order: a box of STL has 26
// vertices where it is smooth and 54 where its edges are hard.
TEST_F(SessionTest, OtherTargetsMakeTheModelAnewAndSaveTheBytesThatBakeWrites)
{
    const std::filesystem::path ball_file = ball("ball.obj", 8);
    for (const std::filesystem::path& input : {ball_file, stl_box(folder_)}) {
        Session session;
        session.open(input, UpAxis::z);
        ASSERT_TRUE(wait_for_whole_answer(session));
        for (const TargetSettings& target : some_targets()) {
            SessionSettings settings = session.settings();
            settings.target = target;
            const Written written = written_by_both(folder_, input, settings);
            EXPECT_EQ(written.by_session, written.by_bake) << text_of(target);
            session.solve(settings);
            ASSERT_TRUE(wait_for(session, [&] {
                return session.state().model->settings == target && session.state().is_solved &&
                       !session.state().is_draft && !session.solving();
            })) << text_of(target);
            EXPECT_EQ(session.state().model->up, UpAxis::z);
            session.save(folder_ / "later.ply");
            EXPECT_EQ(contents_of(folder_ / "later.ply"), written.by_bake) << text_of(target);
        }
    }
}

TEST_F(SessionTest, AModelMadeAnewIsNoOtherFileAndOneThatCannotBeMadeChangesNothing)
{
    Session session;
    session.open(ball(), UpAxis::y);
    Session::Changes changes;
    const auto until = [&](auto condition) {
        changes = {};
        return wait_for(session, [&](const Session::Changes& now) {
            changes.file |= now.file;
            changes.model |= now.model;
            return condition();
        });
    };
    ASSERT_TRUE(until([&] { return session.state().is_solved && !session.solving(); }));
    EXPECT_TRUE(changes.file);
    EXPECT_TRUE(changes.model);
    SessionSettings settings = session.settings();
    settings.target.values = VertexValues::point;
    session.solve(settings);
    ASSERT_TRUE(until([&] { return changes.model && session.state().is_solved; }));
    EXPECT_FALSE(changes.file);

    const auto model = session.state().model;
    settings.target.offset = Length{200.0, true};
    session.solve(settings);
    ASSERT_TRUE(until([&] { return !session.state().message.empty(); }));
    EXPECT_NE(session.state().message.find("offset must be smaller"), std::string::npos);
    EXPECT_FALSE(changes.model);
    EXPECT_EQ(session.state().model, model);
}

// While a file is read, and while a model is made.
TEST_F(SessionTest, OfTargetsChosenInARowTheLastCounts)
{
    Session session;
    session.open(ball("ball.obj", 24), UpAxis::y);
    SessionSettings settings;
    for (const TargetSettings& target : some_targets()) {
        settings.target = target;
        session.solve(settings);
    }
    ASSERT_TRUE(wait_for_whole_answer(session));
    EXPECT_EQ(session.state().model->settings, settings.target);
    for (const TargetSettings& target : some_targets()) {
        settings.target = target;
        session.solve(settings);
    }
    session.solve({});
    ASSERT_TRUE(
        wait_for(session, [&] { return session.state().model->settings == TargetSettings(); }));
    ASSERT_TRUE(wait_for_whole_answer(session));
    EXPECT_FALSE(session.opening());
}

// Answers that are three times too dark are wrong where they are solved and where they are seen;
// what vertices can hold is nobody's fault.
TEST(SolveModel, ErrorsAreThoseOfTheSurface)
{
    for (const TargetSettings& target : {TargetSettings(), pointwise()}) {
        const Model model = make_model(make_mesh(scenes::bumpy_sphere(8)), UpAxis::z, target);
        const ModelTruth truth = truth_of(model, {}, 1024);
        const auto error = [&](const EngineSettings& settings) {
            const ModelAnswer answer = solve_model(prepare(model.geometry(), settings), model,
                                                   settings, {.ground = false, .points = true});
            return error_of(model, truth, answer.values, answer.at_points);
        };
        EngineSettings strong_disks;
        strong_disks.engine = Engine::disks;
        strong_disks.strength = 3.0f;
        const ModelError masks = error({});
        const ModelError disks = error(strong_disks);
        EXPECT_LT(masks.solve, 0.02);
        EXPECT_GT(disks.solve, 0.1);
        EXPECT_EQ(masks.floor, disks.floor);
        EXPECT_GT(disks.seen.rmse, masks.seen.rmse + 0.03);
        // the fit also smooths: on so coarse a ball the points themselves may be a little better
        EXPECT_GT(masks.seen.rmse, masks.floor - 0.003);
        EXPECT_EQ(truth.reference.values.size(), model.answer_count());
    }
}

TEST(SolveModel, WithoutTheGroundTheVerticesAreTheSameAndTheGroundIsOpen)
{
    const Model model = make_model(make_mesh(scenes::bumpy_sphere(6)), UpAxis::z);
    const Prepared prepared = prepare(model.geometry());
    const std::size_t vertices = model.geometry().positions.size();
    const std::vector<Occlusion> with = solve_model(prepared, model, {}).values;
    const std::vector<Occlusion> without =
        solve_model(prepared, model, {}, {.ground = false}).values;
    ASSERT_EQ(without.size(), model.answer_count());
    EXPECT_EQ(first_values(without, vertices), first_values(with, vertices));
    EXPECT_GT(with[vertices + kGroundCells * kGroundCells / 2].occlusion, 0.0f);
    EXPECT_EQ(without[vertices + kGroundCells * kGroundCells / 2].occlusion, 0.0f);
}

}  // namespace
}  // namespace surfelao
