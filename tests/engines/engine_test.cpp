#include "engines/engine.h"

#include "differences.h"
#include "engines/device_solution.h"
#include "gpu/answers.h"
#include "gpu/context.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "tests/gpu/contexts.h"

#include <gtest/gtest.h>

#include <array>
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
    std::array<std::vector<Receiver>, 2> receivers = {receivers_at_vertices(geometry, 1e-4f),
                                                      receivers_at_vertices(geometry, 1e-2f)};
    World() { receivers[1].resize(receivers[1].size() / 3); }
};

const SolveSettings kSettings[] = {{.quality = kDraft, .rays = 16},
                                   {.definition = {.max_distance = 0.4f, .offset = 2e-4f},
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

TEST(Engines, AnswersThatStayOnTheDeviceAreTheSame)
{
    const World world;
    const GlContext window = GlContext::create(GlBackend::osmesa);
    for (const Engine engine : {Engine::masks, Engine::disks}) {
        // as a window does it: solved in a thread and a context of its own
        const GlContext worker = GlContext::create_shared(window);
        worker.release();
        std::optional<Prepared> prepared;
        std::optional<DeviceSolution> found;
        std::vector<Occlusion> expected;
        std::thread([&] {
            prepared.emplace(prepare(
                world.geometry, {.engine = engine, .device = Device::gpu, .context = &worker}));
            expected = solve(*prepared, world.receivers[0], kSettings[1]).occlusion;
            found.emplace(solve_on_device(*prepared, world.receivers[0], kSettings[1]));
            prepared.reset();
            worker.release();
        }).join();
        window.make_current();
        ASSERT_EQ(found->count, world.receivers[0].size());
        EXPECT_TRUE(same_bytes(read_answers(found->answers, found->count), expected))
            << name_of(engine);
    }
}

TEST(Engines, AnswersStayOnADeviceThatIsTheGpu)
{
    const World world;
    const Prepared prepared = prepare(world.geometry);
    EXPECT_THROW(static_cast<void>(solve_on_device(prepared, world.receivers[0])), SettingsError);
}

}  // namespace
}  // namespace surfelao
