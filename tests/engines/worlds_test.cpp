// Every engine on every device at every setting: the worlds with known answers, and what must hold
// whatever the answer is. A new engine is one line in rows().
#include "engines/engine.h"

#include "differences.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "tests/engines/worlds.h"
#include "tests/gpu/contexts.h"
#include "tests/vertex_receivers.h"
#include "tree/masks/masks.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

/// What was prepared for one geometry.
using Solver = std::function<std::vector<Occlusion>(std::span<const Receiver>, const Definition&,
                                                    const Progress&)>;

/// One engine at one setting.
struct Row {
    std::string name;
    double Tolerances::*tolerance;
    std::function<Solver(const Geometry&)> prepare;
    /// The table's cosine kernel alone.
    bool knows_bunnell = true;
};

/// Through the door of engines/.
Row row(double Tolerances::*tolerance, const EngineSettings& settings)
{
    const bool on_gpu = settings.device == Device::gpu;
    const std::string name = name_of(settings.engine) + ", " + setting_of(settings) +
                             (settings.instructions == Instructions::avx2 ? ", AVX2" : "");
    return {name, tolerance,
            [settings, on_gpu](const Geometry& geometry) -> Solver {
                EngineChoice choice = settings;
                choice.context = on_gpu ? &test_context() : nullptr;
                const auto prepared = std::make_shared<const Prepared>(prepare(geometry, choice));
                return
                    [settings, prepared](std::span<const Receiver> receivers,
                                         const Definition& definition, const Progress& progress) {
                        SolveSettings asked = settings;
                        asked.definition = definition;
                        return solve(*prepared, receivers, asked, progress).occlusion;
                    };
            },
            knows_kernel(settings.engine, Kernel::bunnell)};
}

/// Masks that draw every triangle, which no door offers.
Row exact_masks()
{
    const auto prepare = [](const Geometry& geometry) -> Solver {
        return [tree = build_mask_tree(geometry)](std::span<const Receiver> receivers,
                                                  const Definition& definition,
                                                  const Progress& progress) {
            return solve_masks(*tree, receivers, {.definition = definition, .exact = true},
                               progress);
        };
    };
    return {"masks, exact", &Tolerances::exact, prepare, false};
}

std::vector<Row> rows()
{
    using T = Tolerances;
    const auto at = [](Engine engine, Device device, float quality) {
        EngineSettings settings;
        settings.engine = engine;
        settings.device = device;
        settings.quality = quality;
        settings.rays = 4096;
        return settings;
    };
    EngineSettings masks_avx2 = at(Engine::masks, Device::cpu, kGood);
    masks_avx2.instructions = Instructions::avx2;
    return {
        row(&T::rays, at(Engine::rays, Device::cpu, kGood)),
        row(&T::draft, at(Engine::masks, Device::cpu, kDraft)),
        row(&T::good, at(Engine::masks, Device::cpu, kGood)),
        row(&T::good, masks_avx2),
        row(&T::best, at(Engine::masks, Device::cpu, kBest)),
        exact_masks(),
        row(&T::disks, at(Engine::disks, Device::cpu, kGood)),
        row(&T::disks_best, at(Engine::disks, Device::cpu, kBest)),
        row(&T::draft, at(Engine::masks, Device::gpu, kDraft)),
        row(&T::good, at(Engine::masks, Device::gpu, kGood)),
        row(&T::disks, at(Engine::disks, Device::gpu, kGood)),
    };
}

// ---- worlds with known answers

/// The world's definition in the unit frame.
Definition unit_definition(const ExactWorld& world, const Geometry& geometry)
{
    Definition definition = world.definition;
    definition.max_distance /= static_cast<float>(geometry.frame.diagonal);
    return definition;
}

std::vector<Receiver> receivers_of(const ExactWorld& world, const Geometry& geometry)
{
    if (world.places.empty())
        return vertex_receivers(geometry);
    std::vector<Receiver> receivers;
    for (const Place& place : world.places) {
        const glm::vec3 normal(glm::normalize(place.normal));
        const glm::vec3 unit((place.position - geometry.frame.centre) / geometry.frame.diagonal);
        receivers.push_back({unit + kVertexOffset * normal, normal, kVertexOffset});
    }
    return receivers;
}

class ExactWorlds : public testing::TestWithParam<ExactWorld> {};

TEST_P(ExactWorlds, EveryEngineKnowsTheAnswer)
{
    const ExactWorld& world = GetParam();
    const Geometry geometry = make_geometry(world.scene);
    const std::vector<Receiver> receivers = receivers_of(world, geometry);
    std::vector<double> expected;
    for (const Receiver& receiver : receivers)
        expected.push_back(world.answer(geometry.frame.centre +
                                        geometry.frame.diagonal * glm::dvec3(receiver.position)));
    for (const Row& engine : rows()) {
        double tolerance = world.tolerances.*engine.tolerance;
        if (tolerance == kAsGood)
            tolerance = world.tolerances.good;
        if (tolerance == kNotAsked)
            continue;
        const std::vector<Occlusion> found =
            engine.prepare(geometry)(receivers, unit_definition(world, geometry), {});
        ASSERT_EQ(found.size(), receivers.size()) << engine.name;
        double mean_error = 0.0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double error = found[i].occlusion - expected[i];
            mean_error += error / static_cast<double>(found.size());
            if (!world.of_mean) {
                EXPECT_LE(std::abs(error), tolerance)
                    << engine.name << ", receiver " << i << ": " << found[i].occlusion
                    << ", and not " << expected[i];
            }
        }
        EXPECT_LE(std::abs(mean_error), tolerance) << engine.name;
    }
}

INSTANTIATE_TEST_SUITE_P(All, ExactWorlds, testing::ValuesIn(exact_worlds()),
                         [](const auto& test) { return test.param.name; });

// ---- what holds whatever the answer is

TEST(EveryEngine, OpenPlanesAndClosedBoxesHaveTheNormalAsBentNormal)
{
    const Geometry plane = make_geometry(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 20));
    const Geometry room = make_geometry(scenes::room({0, 0, 0}, {1, 1, 1}, 2));
    const std::vector<Receiver> inside = {{{0, 0, 0}, {0, 0, 1}}, {{-0.28f, 0, 0.28f}, {0, 0, 1}}};
    for (const Row& engine : rows()) {
        const Solver over_plane = engine.prepare(plane);
        for (const Occlusion& o : over_plane(vertex_receivers(plane), {}, {}))
            EXPECT_GT(o.bent_normal.z, 0.9999f) << engine.name;
        if (engine.tolerance != &Tolerances::rays && engine.tolerance != &Tolerances::exact)
            continue;  // the others leave cracks and sums below 1
        for (const Occlusion& o : engine.prepare(room)(inside, {}, {}))
            EXPECT_EQ(o.bent_normal, glm::vec3(0, 0, 1)) << engine.name;
    }
}

TEST(EveryEngine, NothingToSeeIsOpenNoNormalIsZeroAndNobodyToAskIsNothing)
{
    Scene flat;  // no triangle with an area
    flat.positions.assign(3, {7, 7, 7});
    flat.triangles = {{0, 1, 2}};
    const Geometry sheet = make_geometry(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2));
    const std::vector<Receiver> receivers = {{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, 0}}};
    for (const Row& engine : rows()) {
        for (const Geometry& empty : {Geometry{}, make_geometry(flat)}) {
            const std::vector<Occlusion> found = engine.prepare(empty)(receivers, {}, {});
            EXPECT_EQ(found[0].occlusion, 0.0f) << engine.name;
            EXPECT_NEAR(found[0].bent_normal.z, 1.0f, 1e-4f) << engine.name;
            EXPECT_EQ(found[1].occlusion, 0.0f) << engine.name;
            EXPECT_EQ(found[1].bent_normal, glm::vec3(0.0f)) << engine.name;
        }
        EXPECT_TRUE(engine.prepare(sheet)({}, {}, {}).empty()) << engine.name;
    }
}

TEST(EveryEngine, OddScenesGiveNumbersInRangeAndUnitBentNormals)
{
    Scene one = scenes::triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    Scene needle = scenes::triangle({0, 0, 0}, {1, 0, 0}, {0.5, 1e-6, 0});
    Scene twice = one;
    twice.triangles.push_back({0, 2, 1});
    twice.parts[0].triangle_count = 2;
    const Scene sliver = scenes::sheet({0, 0, 0}, {1e6, 0, 0}, {0, 1, 0}, 1);
    const Scene box = scenes::box({0, 0, 0}, {1, 1, 1}, 2);
    const Scene folded = box + box + scenes::flipped(box + box);  // coincident faces
    const Scene near = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4) +
                       scenes::sheet({0, 0, 1e-9}, {1, 0, 0}, {0, 1, 0}, 4);
    for (const Scene& scene : {one, needle, twice, one + needle + twice, sliver, box + box, folded,
                               near, scenes::bumpy_sphere(8)}) {
        const Geometry geometry = make_geometry(scene);
        std::vector<Receiver> receivers = vertex_receivers(geometry);
        receivers.push_back({{0.1f, 0.1f, 0.0f}, {0, 0, 1}});  // in the plane of a triangle
        receivers.push_back({{0.1f, 0.1f, 0.0f}, {1, 0, 0}});
        receivers.push_back({geometry.positions[0], {0, 0, 1}});  // at a corner
        receivers.push_back({{0.0f, 0.0f, 0.0f}, {0, 0, 0}});     // no hemisphere
        for (const Row& engine : rows()) {
            const std::vector<Occlusion> answers = engine.prepare(geometry)(receivers, {}, {});
            for (std::size_t i = 0; i < answers.size(); ++i) {
                EXPECT_GE(answers[i].occlusion, 0.0f) << engine.name;
                EXPECT_LE(answers[i].occlusion, 1.0f) << engine.name;
                EXPECT_NEAR(glm::length(answers[i].bent_normal), glm::length(receivers[i].normal),
                            1e-5f)
                    << engine.name;
            }
            EXPECT_EQ(answers.back().occlusion, 0.0f) << engine.name;
        }
    }
}

TEST(EveryEngine, SameBytesForAnyNumberOfThreads)
{
    const Geometry geometry = make_geometry(scenes::bumpy_sphere(12));
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    for (const Row& engine : rows()) {
        std::vector<std::vector<Occlusion>> answers;
        for (const std::size_t threads : {1, 4}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            answers.push_back(engine.prepare(geometry)(receivers, {}, {}));
        }
        EXPECT_TRUE(same_bytes(answers[0], answers[1])) << engine.name;
    }
}

TEST(EveryEngine, ProgressGrowsToTheEndAndFalseCancels)
{
    const Geometry geometry = make_geometry(scenes::bumpy_sphere(12));
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    for (const Row& engine : rows()) {
        const Solver solver = engine.prepare(geometry);
        double last = 0.0;
        static_cast<void>(solver(receivers, {}, [&](double done) {
            EXPECT_GE(done, last) << engine.name;
            last = done;
            return true;
        }));
        EXPECT_GT(last, 0.5) << engine.name;
        EXPECT_THROW(static_cast<void>(solver(receivers, {}, [](double) { return false; })),
                     Cancelled)
            << engine.name;
    }
}

TEST(EveryEngine, RefusesAKernelThatItDoesNotKnow)
{
    const Geometry geometry = make_geometry(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1));
    int refused = 0;
    for (const Row& engine : rows()) {
        if (engine.knows_bunnell)
            continue;
        EXPECT_ANY_THROW(
            static_cast<void>(engine.prepare(geometry)({}, {.kernel = Kernel::bunnell}, {})))
            << engine.name;
        ++refused;
    }
    EXPECT_GE(refused, 1);
}

}  // namespace
}  // namespace surfelao
