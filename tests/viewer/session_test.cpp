#include "viewer/session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

namespace surfelao {
namespace {

/// One triangle, as an OBJ.
std::filesystem::path triangle_file()
{
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) /
        (std::string("surfelao_session_") +
         testing::UnitTest::GetInstance()->current_test_info()->name() + ".obj");
    std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    return path;
}

/// An engine that answers its quality everywhere; above quality 1.5 only when it is cancelled.
struct Fake {
    std::atomic<int> calls{0};
    std::atomic<bool> was_cancelled{false};

    Services services()
    {
        Services all;
        all.engines = {{.name = "fake", .most_quality = 2.0f}};
        all.solve = [this](const Model& model, const SessionSettings& settings,
                           const Progress& progress) {
            ++calls;
            while (settings.quality > 1.5f) {
                if (!progress(0.5)) {
                    was_cancelled = true;
                    throw Cancelled();
                }
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
            return Solved{std::vector<Occlusion>(model.receivers.size(),
                                                 {settings.quality / 2.0f, {0, 0, 1}})};
        };
        all.measure = [](std::span<const Occlusion> answer, std::span<const Occlusion> reference) {
            return ErrorFigures{.bias = answer[0].occlusion - reference[0].occlusion};
        };
        return all;
    }
};

/// Updates until the condition holds, at most ten seconds.
template <class Condition>
bool wait_for(Session& session, Condition condition)
{
    for (int i = 0; i < 10000; ++i) {
        (void)session.update();
        if (condition())
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

TEST(Session, ReadsAFileAndSolvesItWithADraftFirst)
{
    Fake fake;
    Session session(fake.services());
    session.open(triangle_file(), UpAxis::y);
    ASSERT_TRUE(wait_for(
        session, [&] { return !session.state().occlusion.empty() && !session.state().is_draft; }));
    EXPECT_EQ(session.state().model->geometry.positions.size(), 3u);
    EXPECT_EQ(session.state().occlusion[0].occlusion, 0.5f);
    EXPECT_EQ(fake.calls, 2);  // draft and whole
    EXPECT_FALSE(session.state().error.has_value());
}

TEST(Session, EqualSettingsSolveNothing)
{
    Fake fake;
    Session session(fake.services());
    session.open(triangle_file(), UpAxis::y);
    ASSERT_TRUE(wait_for(session, [&] { return fake.calls == 2 && !session.solving(); }));
    for (int frame = 0; frame < 100; ++frame) {
        session.solve(session.settings());
        (void)session.update();
    }
    EXPECT_EQ(fake.calls, 2);
}

TEST(Session, OtherSettingsReplaceWhatRuns)
{
    Fake fake;
    Session session(fake.services());
    session.solve({.quality = 2.0f});
    session.open(triangle_file(), UpAxis::y);
    // the endless one runs, the draft is shown
    ASSERT_TRUE(wait_for(session, [&] { return fake.calls == 2 && session.state().is_draft; }));
    session.solve({.quality = 0.5f});
    ASSERT_TRUE(wait_for(session, [&] {
        const auto& state = session.state();
        return !state.is_draft && !state.occlusion.empty() && state.occlusion[0].occlusion == 0.25f;
    }));
    EXPECT_TRUE(fake.was_cancelled);
}

TEST(Session, CancelKeepsTheDraft)
{
    Fake fake;
    Session session(fake.services());
    session.solve({.quality = 2.0f});
    session.open(triangle_file(), UpAxis::y);
    ASSERT_TRUE(wait_for(session, [&] { return !session.state().occlusion.empty(); }));
    session.cancel();
    ASSERT_TRUE(wait_for(session, [&] { return !session.solving(); }));
    EXPECT_TRUE(session.state().is_draft);
    EXPECT_EQ(session.state().occlusion[0].occlusion, 0.0f);
}

TEST(Session, WhatWasCancelledCanBeSolvedAgain)
{
    Fake fake;
    Session session(fake.services());
    session.open(triangle_file(), UpAxis::y);
    session.solve({.quality = 2.0f});
    ASSERT_TRUE(wait_for(session, [&] { return session.state().is_draft; }));
    EXPECT_FALSE(session.was_cancelled());
    session.cancel();
    EXPECT_TRUE(session.was_cancelled());
    ASSERT_TRUE(wait_for(session, [&] { return !session.solving(); }));
    EXPECT_TRUE(session.was_cancelled());
    const int before = fake.calls;
    session.solve_again();
    EXPECT_FALSE(session.was_cancelled());
    ASSERT_TRUE(wait_for(session, [&] { return fake.calls == before + 2; }));
}

TEST(Session, TheReferenceIsTracedAndMeasuredAgainst)
{
    Fake fake;
    Session session(fake.services());
    session.want_reference(16);
    session.open(triangle_file(), UpAxis::y);
    ASSERT_TRUE(wait_for(
        session, [&] { return session.state().error.has_value() && !session.state().is_draft; }));
    EXPECT_EQ(session.state().reference[0].occlusion, 0.0f);  // a lone triangle is open
    EXPECT_EQ(session.state().error->bias, 0.5);
    session.want_reference(0);
    EXPECT_TRUE(session.state().reference.empty());
    EXPECT_FALSE(session.state().error.has_value());
}

TEST(Session, AFileThatCannotBeReadIsToldAndChangesNothing)
{
    Fake fake;
    Session session(fake.services());
    session.open(triangle_file(), UpAxis::y);
    ASSERT_TRUE(wait_for(session, [&] { return fake.calls == 2 && !session.solving(); }));
    (void)session.update();
    const auto model = session.state().model;
    session.open("none.obj", UpAxis::y);
    ASSERT_TRUE(wait_for(session, [&] { return !session.state().message.empty(); }));
    EXPECT_NE(session.state().message.find("none.obj"), std::string::npos);
    EXPECT_EQ(session.state().model, model);
    EXPECT_FALSE(session.opening());
}

TEST(Session, OfTwoFilesOpenedAtOnceTheLastIsShown)
{
    Fake fake;
    Session session(fake.services());
    const std::filesystem::path first = triangle_file();
    const std::filesystem::path second = std::filesystem::path(first).replace_extension(".2.obj");
    std::filesystem::copy_file(first, second, std::filesystem::copy_options::overwrite_existing);
    session.open(first, UpAxis::y);
    session.open(second, UpAxis::y);
    ASSERT_TRUE(wait_for(session,
                         [&] { return !session.state().occlusion.empty() && !session.solving(); }));
    EXPECT_EQ(session.state().path, second);
}

TEST(Session, AnEnginesFailureIsTold)
{
    Fake fake;
    Services services = fake.services();
    services.solve = [](const Model&, const SessionSettings&, const Progress&) -> Solved {
        throw std::runtime_error("the device is gone");
    };
    Session session(std::move(services));
    session.open(triangle_file(), UpAxis::y);
    EXPECT_TRUE(wait_for(session, [&] { return session.state().message == "the device is gone"; }));
}

TEST(Session, EndsWhileWorkIsRunning)
{
    Fake fake;
    {
        Session session(fake.services());
        session.solve({.quality = 2.0f});
        session.open(triangle_file(), UpAxis::y);
        ASSERT_TRUE(wait_for(session, [&] { return fake.calls == 2; }));
    }
    EXPECT_TRUE(fake.was_cancelled);
}

TEST(DefinitionOf, ADistanceOfZeroIsNoLimit)
{
    EXPECT_TRUE(std::isinf(definition_of(SessionSettings{}).max_distance));
    const Definition limited =
        definition_of(SessionSettings{.max_distance_percent = 10.0f, .smooth_falloff = true});
    EXPECT_FLOAT_EQ(limited.max_distance, 0.1f);
    EXPECT_EQ(limited.falloff, Falloff::smooth);
}

}  // namespace
}  // namespace surfelao
