#include "engines/engine.h"

#include "differences.h"
#include "engines/threads.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "tests/gpu/contexts.h"
#include "tests/vertex_receivers.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace surfelao {
namespace {

/// Every engine on every device where it runs.
std::vector<EngineChoice> all_choices()
{
    std::vector<EngineChoice> choices;
    for (const Engine engine : {Engine::masks, Engine::disks, Engine::rays}) {
        choices.push_back({.engine = engine});
        if (runs_on(engine, Device::gpu))
            choices.push_back(
                {.engine = engine, .device = Device::gpu, .context = &test_context()});
    }
    return choices;
}

std::string words(const EngineChoice& choice)
{
    return name_of(choice.engine) + (choice.device == Device::gpu ? " on the GPU" : "");
}

/// Two sets of receivers of one scene.
struct World {
    Geometry geometry = make_geometry(scenes::nested_shells(2, 0.2, 6));
    std::array<std::vector<Receiver>, 2> receivers = {vertex_receivers(geometry),
                                                      vertex_receivers(geometry, 1e-2f)};
    World() { receivers[1].resize(receivers[1].size() / 3); }
};

const SolveSettings kSettings[] = {{.quality = kDraft, .rays = 16},
                                   {.definition = {.max_distance = 0.4f},
                                    .quality = 1.5f,
                                    .passes = 3,
                                    .strength = 0.8f,
                                    .rays = 50}};

// Nothing of one solve is left over for the next.
TEST(Engines, PreparedOnceAnswersLikePreparedAnew)
{
    const World world;
    for (const EngineChoice& choice : all_choices()) {
        const Prepared prepared = prepare(world.geometry, choice);
        for (const std::vector<Receiver>& receivers : world.receivers) {
            for (const SolveSettings& settings : kSettings) {
                const Solution found = solve(prepared, receivers, settings);
                const Solution anew = solve(prepare(world.geometry, choice), receivers, settings);
                EXPECT_TRUE(same_bytes(found.occlusion, anew.occlusion)) << words(choice);
                EXPECT_EQ(found.residual, anew.residual) << words(choice);
            }
        }
    }
}

TEST(Engines, ItsOwnContextGoesWhereverItIsAsked)
{
    const World world;
    std::optional<Prepared> prepared = prepare(world.geometry, {.device = Device::gpu});
    std::vector<Occlusion> here, there;
    std::thread([&] {
        there = solve(*prepared, world.receivers[1], kSettings[0]).occlusion;
    }).join();
    here = solve(*prepared, world.receivers[1], kSettings[0]).occlusion;
    EXPECT_TRUE(same_bytes(here, there));
    std::thread([&] { prepared.reset(); }).join();
}

TEST(Engines, SolvesAtOnceEqualSolvesOneAfterTheOther)
{
    const World world;
    for (const Engine engine : {Engine::masks, Engine::disks, Engine::rays}) {
        const Prepared prepared = prepare(world.geometry, {.engine = engine});
        // each thread another question
        constexpr std::size_t kThreads = 4;
        std::array<std::vector<Occlusion>, kThreads> alone, together;
        const auto answer = [&](std::size_t i) {
            return solve(prepared, world.receivers[i % 2], kSettings[i / 2]).occlusion;
        };
        for (std::size_t i = 0; i < kThreads; ++i)
            alone[i] = answer(i);
        std::vector<std::thread> threads;
        for (std::size_t i = 0; i < kThreads; ++i)
            threads.emplace_back([&, i] { together[i] = answer(i); });
        for (std::thread& thread : threads)
            thread.join();
        for (std::size_t i = 0; i < kThreads; ++i)
            EXPECT_TRUE(same_bytes(alone[i], together[i])) << name_of(engine) << ", thread " << i;
    }
}

/// What solve() says of the settings; empty: nothing.
std::string refusal(const Prepared& prepared, const SolveSettings& settings)
{
    try {
        static_cast<void>(solve(prepared, {}, settings));
    } catch (const SettingsError& error) {
        return error.what();
    }
    return {};
}

struct BadSettings {
    std::string name;  ///< of the setting, as the refusal must say it
    std::vector<EngineChoice> asked;
    SolveSettings settings;
};

TEST(Engines, EveryBadSettingIsRefusedByItsName)
{
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    const EngineChoice masks = {.engine = Engine::masks}, disks = {.engine = Engine::disks},
                       rays = {.engine = Engine::rays};
    const EngineChoice gpu = {
        .engine = Engine::disks, .device = Device::gpu, .context = &test_context()};
    const std::vector<EngineChoice> all = {masks, disks, rays, gpu};
    const BadSettings bad[] = {
        {"max_distance", all, {.definition = {.max_distance = 0.0f}}},
        {"max_distance", all, {.definition = {.max_distance = kNan}}},
        {"falloff", all, {.definition = {.falloff = Falloff::smooth}}},
        {"kernel", {masks}, {.definition = {.kernel = Kernel::bunnell}}},
        {"quality", {masks, disks, gpu}, {.quality = 9.0f}},
        {"quality", {masks, disks, gpu}, {.quality = kNan}},
        {"quality", {disks}, {.quality = -0.5f}},
        {"passes", {disks, gpu}, {.passes = 0}},
        {"strength", {disks, gpu}, {.strength = -1.0f}},
        {"strength", {disks, gpu}, {.strength = kInfinite}},
        {"rays", {rays}, {.rays = 0}},
        {"rays", {rays}, {.rays = (1u << 20) + 1}},
    };
    const World world;
    for (const BadSettings& item : bad) {
        for (const EngineChoice& choice : item.asked) {
            const std::string said = refusal(prepare(world.geometry, choice), item.settings);
            EXPECT_NE(said.find(item.name), std::string::npos)
                << words(choice) << " with a bad " << item.name << ": '" << said << "'";
        }
    }
    EXPECT_EQ(refusal(prepare(world.geometry), {}), "");
    EXPECT_THROW(
        static_cast<void>(prepare(world.geometry, {.engine = Engine::rays, .device = Device::gpu})),
        SettingsError);
    EXPECT_THROW(static_cast<void>(prepare(world.geometry, {.engine = static_cast<Engine>(7)})),
                 SettingsError);
    EXPECT_THROW(ThreadLimit(0), SettingsError);
}

TEST(Engines, DistanceLimitsOfAUserAreRefusedByName)
{
    const Frame frame = {.diagonal = 2.0};
    EXPECT_EQ(definition_of({.value = 1.0}, Kernel::cosine, frame).max_distance, 0.5f);
    for (const double value : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(static_cast<void>(definition_of({.value = value}, Kernel::cosine, frame)),
                     SettingsError);
    EXPECT_THROW(
        static_cast<void>(definition_of({.falloff = Falloff::smooth}, Kernel::cosine, frame)),
        SettingsError);
    EXPECT_THROW(static_cast<void>(definition_of({.value = 1e-60}, Kernel::cosine, frame)),
                 InputError);
}

TEST(Engines, AGroundOfAUserLiesWhereItWasAskedForOrBelowAll)
{
    // lowest along z: 3
    const Geometry box = make_geometry(scenes::box({1, 2, 3}, {2, 4, 6}, 1));
    const double diagonal = box.frame.diagonal;
    const float offset = 1e-3f;
    const auto height_of = [&](std::optional<double> height) {
        const auto ground = ground_of(GroundPlane{{0, 0, 1}, height}, {box}, offset);
        return (*plane_of(*ground, box.frame).height - 3.0) / diagonal;
    };
    EXPECT_FALSE(ground_of(std::nullopt, {box}, offset).has_value());
    // what stands on a ground does not stand in it
    for (const std::optional<double> touching :
         {std::optional<double>(), {3.0}, {3.0 + diagonal * 1.9e-3}, {3.0 - diagonal * 1.9e-3}})
        EXPECT_NEAR(height_of(touching), -2e-3, 1e-6);
    for (const double asked : {3.0 - diagonal * 2.1e-3, 4.5, -30.0})
        EXPECT_NEAR(height_of(asked), (asked - 3.0) / diagonal, 1e-6);
    EXPECT_THROW(static_cast<void>(height_of(1e30)), InputError);
    EXPECT_EQ(text_of(GroundPlane{{0, 0, 1}, 0.1}), "z:0.1");
    EXPECT_EQ(text_of(*ground_of(GroundPlane{{0, 0, 1}, 0.1}, {box}, offset), box.frame),
              "z = 0.1");
}

TEST(Engines, ReceiversThatNoEngineCanAnswerAreRefusedByTheirNumber)
{
    const World world;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Receiver wrong[] = {{{0, nan, 0}, {0, 0, 1}},
                              {{0, 0, 2e6f}, {0, 0, 1}},
                              {{0, 0, 0}, {0, 0, 3}},
                              {{0, 0, 0}, {0.1f, 0, 0}},
                              {{0, 0, 0}, {0, nan, 0}}};
    for (const EngineChoice& choice : all_choices()) {
        const Prepared prepared = prepare(world.geometry, choice);
        for (const Receiver& receiver : wrong) {
            std::vector<Receiver> receivers = world.receivers[0];
            receivers[5] = receiver;
            try {
                static_cast<void>(solve(prepared, receivers));
                ADD_FAILURE() << words(choice) << " took it";
            } catch (const InputError& error) {
                EXPECT_EQ(std::string(error.what()).substr(0, 11), "receiver 5:");
            }
        }
    }
}

// As far out as a receiver may stand, answers are numbers still: all is open.
TEST(Engines, ReceiversFarOutSeeNothing)
{
    const World world;
    const Receiver far = {{-kFarthestReceiver, kFarthestReceiver, kFarthestReceiver}, {0, 0, 1}};
    for (const EngineChoice& choice : all_choices()) {
        const Occlusion found =
            solve(prepare(world.geometry, choice), std::vector(1, far)).occlusion[0];
        EXPECT_NEAR(found.occlusion, 0.0f, 1e-6f) << words(choice);
        EXPECT_NEAR(found.bent_normal.z, 1.0f, 0.02f) << words(choice);
    }
}

}  // namespace
}  // namespace surfelao
