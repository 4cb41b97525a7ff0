#include "viewer/session.h"

#include "bake/bake.h"
#include "scenes.h"
#include "temporary_folder.h"
#include "viewer/solve_model.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

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

/// Updates until the condition holds, at most half a minute.
template <class Condition>
bool wait_for(Session& session, Condition condition)
{
    for (int i = 0; i < 30000; ++i) {
        (void)session.update();
        if (condition())
            return true;
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
std::vector<float> vertex_answers(const Model& model, const EngineSettings& settings)
{
    const std::vector<Receiver> receivers =
        receivers_at_vertices(model.geometry(), settings.definition.offset);
    std::vector<float> values;
    for (const Occlusion& value :
         solve(prepare(model.geometry(), settings), receivers, settings).occlusion)
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
    EXPECT_EQ(session.occlusion().size(), state.model->receivers.size());
    EXPECT_EQ(first_values(session.occlusion(), state.model->geometry().positions.size()),
              vertex_answers(*state.model, {}));
    EXPECT_FALSE(state.error.has_value());
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
              vertex_answers(model, wanted));
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
        EXPECT_GT(session.state().error->rmse, 0.0);
        EXPECT_LT(session.state().error->rmse, 0.1);
        session.want_reference(0);
        EXPECT_TRUE(session.state().reference.empty());
        EXPECT_FALSE(session.state().error.has_value());
    }
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

// Without a device that was lent answers come back from one of the session's own.
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
    EXPECT_FALSE(session.state().on_device);
    ASSERT_EQ(session.occlusion().size(), by_cpu.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < by_cpu.size(); ++i)
        sum += std::abs(session.occlusion()[i].occlusion - by_cpu[i].occlusion);
    EXPECT_LT(sum / static_cast<double>(by_cpu.size()), 1e-4);
    EXPECT_GT(sum, 0.0);  // no CPU has answered
}

// The ground's receivers lie among the vertices': solved in one call they would share groups.
TEST_F(SessionTest, SavesTheBytesThatBakeWrites)
{
    const std::filesystem::path input = ball("ball.obj", 12);
    for (const Engine engine : {Engine::masks, Engine::disks}) {
        for (const float quality : {kDraft, kGood}) {
            SessionSettings settings = of_quality(quality, engine);
            settings.max_distance = {40.0, true, Falloff::smooth};
            Session session;
            session.solve(settings);
            session.open(input, UpAxis::y);
            ASSERT_TRUE(wait_for_whole_answer(session));
            session.save(folder_ / "saved.ply");
            (void)bake({.input = input,
                        .output = folder_ / "baked.ply",
                        .engine = settings.engine,
                        .max_distance = settings.max_distance});
            EXPECT_EQ(contents_of(folder_ / "saved.ply"), contents_of(folder_ / "baked.ply"))
                << name_of(engine) << ", " << quality;
        }
    }
}

TEST(SolveModel, WithoutTheGroundTheVerticesAreTheSameAndTheGroundIsOpen)
{
    const Model model = make_model(make_geometry(scenes::bumpy_sphere(6)), UpAxis::z, 1e-4f);
    const Prepared prepared = prepare(model.geometry());
    const std::size_t vertices = model.geometry().positions.size();
    const std::vector<Occlusion> with = solve_model(prepared, model, {}).occlusion;
    const std::vector<Occlusion> without = solve_model(prepared, model, {}, false).occlusion;
    ASSERT_EQ(without.size(), model.receivers.size());
    EXPECT_EQ(first_values(without, vertices), first_values(with, vertices));
    EXPECT_GT(with[vertices + kGroundCells * kGroundCells / 2].occlusion, 0.0f);
    EXPECT_EQ(without[vertices + kGroundCells * kGroundCells / 2].occlusion, 0.0f);
}

}  // namespace
}  // namespace surfelao
