// An exact ground in every engine on every device: closed forms, and what it leaves alone.
#include "engines/engine.h"

#include "differences.h"
#include "scenes.h"
#include "surfels/errors.h"
#include "tests/gpu/contexts.h"
#include "tests/vertex_receivers.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kExact = 0.002;  ///< whoever answers

std::vector<EngineSettings> engines()
{
    std::vector<EngineSettings> list;
    for (const Device device : {Device::cpu, Device::gpu}) {
        for (const float quality : {kGood, kBest})
            list.push_back({{.engine = Engine::masks, .device = device}, {.quality = quality}});
        list.push_back({{.engine = Engine::disks, .device = device}, {}});
    }
    list.push_back({{.engine = Engine::masks, .instructions = Instructions::avx2}, {}});
    list.push_back({{.engine = Engine::rays}, {.rays = 16384}});
    return list;
}

std::string name_of(const EngineSettings& engine)
{
    return name_of(engine.engine) + ", " + setting_of(engine);
}

std::vector<Occlusion> answers_of(EngineSettings engine, const Geometry& geometry,
                                  std::span<const Receiver> receivers, const Definition& definition)
{
    engine.definition = definition;
    engine.context = engine.device == Device::gpu ? &test_context() : nullptr;
    return solve(prepare(geometry, engine), receivers, engine).occlusion;
}

const glm::vec3 kTilted = glm::normalize(glm::vec3(0.3f, -0.5f, 0.8f));

/// A ground under the geometry, or through it where that is negative.
Ground under(const Geometry& geometry, glm::vec3 up, float gap)
{
    float lowest = std::numeric_limits<float>::max();
    for (const glm::vec3 p : geometry.positions)
        lowest = std::min(lowest, glm::dot(up, p));
    return {up, lowest - gap};
}

using Answer = std::function<double(const Receiver&)>;

/// Every receiver of every engine.
void expect_answers(const Geometry& geometry, std::span<const Receiver> receivers,
                    const Definition& definition, const Answer& answer, double tolerance,
                    const std::string& world)
{
    for (const EngineSettings& engine : engines()) {
        const std::vector<Occlusion> found = answers_of(engine, geometry, receivers, definition);
        double worst = 0.0;
        for (std::size_t i = 0; i < found.size(); ++i)
            worst = std::max(worst, std::abs(found[i].occlusion - answer(receivers[i])));
        EXPECT_LE(worst, tolerance) << world << ": " << name_of(engine);
    }
}

TEST(Ground, ConvexBodiesSeeItBelowTheHorizon)
{
    for (const auto& [name, scene] : {std::pair("box", scenes::box({0, 0, 0}, {1, 1, 1}, 1)),
                                      std::pair("sphere", scenes::sphere({0, 0, 0}, 1.0, 6))}) {
        const Geometry geometry = make_geometry(scene);
        const std::vector<Receiver> receivers = vertex_receivers(geometry);
        for (const glm::vec3 up : {glm::vec3(0, 0, 1), kTilted}) {
            const Definition definition = {.ground = under(geometry, up, 2e-4f)};
            const auto answer = [&](const Receiver& receiver) {
                return 0.5 * (1.0 - glm::dot(receiver.normal, up));
            };
            expect_answers(geometry, receivers, definition, answer, kExact, name);
        }
    }
}

/// What the definition says, summed over directions that are even in the cosine's weight.
Occlusion summed(const Receiver& receiver, const Definition& definition)
{
    constexpr int kSide = 128;
    const Ground& ground = *definition.ground;
    const float height = glm::dot(ground.up, receiver.position) - ground.height;
    const glm::vec3 n = receiver.normal;
    const glm::vec3 x = glm::normalize(
        glm::cross(n, std::abs(n.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 y = glm::cross(n, x);
    double sum = 0.0;
    glm::dvec3 open(0.0);
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            const double ring = std::fmod(j * std::numbers::phi, 1.0);  // not in line
            const double sine = std::sqrt((i + ring) / kSide);
            const double turn = 2.0 * kHalfTurn * (j + 0.5) / kSide;
            const glm::vec3 w = static_cast<float>(sine * std::cos(turn)) * x +
                                static_cast<float>(sine * std::sin(turn)) * y +
                                static_cast<float>(std::sqrt(1.0 - sine * sine)) * n;
            const float rise = glm::dot(ground.up, w);
            const bool meets = height >= 0.0f ? rise < 0.0f : rise > 0.0f;
            const double hit = meets ? hit_weight(definition, -height / rise) : 0.0;
            sum += hit / (kSide * kSide);
            open += (1.0 - hit) * glm::dvec3(w);
        }
    }
    return {static_cast<float>(sum), bent_normal_of(glm::vec3(open), n)};
}

/// Alone in the world: from both sides of it, near and far, facing every way.
std::vector<Receiver> receivers_around(const Ground& ground)
{
    const glm::vec3 side = glm::normalize(glm::cross(ground.up, glm::vec3(0.3f, 0.9f, -0.4f)));
    std::vector<Receiver> receivers;
    for (const float height : {-0.3f, 0.0f, 0.02f, 0.24f, 0.7f}) {
        for (int i = 0; i <= 8; ++i) {
            const float angle = static_cast<float>(kHalfTurn) * static_cast<float>(i) / 8.0f;
            receivers.push_back({(ground.height + height) * ground.up + 0.1f * side,
                                 std::cos(angle) * ground.up + std::sin(angle) * side});
        }
    }
    return receivers;
}

TEST(Ground, AloneItIsTheIntegralWithEveryLimitFromBothSides)
{
    const Definition definitions[] = {{},
                                      {.max_distance = 0.5f},
                                      {.max_distance = 0.5f, .falloff = Falloff::smooth},
                                      {.max_distance = 20.0f}};
    for (Definition definition : definitions) {
        definition.ground = Ground{kTilted, -0.2f};
        const std::vector<Receiver> receivers = receivers_around(*definition.ground);
        std::vector<Occlusion> expected;
        for (const Receiver& receiver : receivers)
            expected.push_back(summed(receiver, definition));
        for (const EngineSettings& engine : engines()) {
            const std::vector<Occlusion> found =
                answers_of(engine, Geometry{}, receivers, definition);
            for (std::size_t i = 0; i < receivers.size(); ++i) {
                EXPECT_NEAR(found[i].occlusion, expected[i].occlusion, kExact)
                    << name_of(engine) << ", " << definition.max_distance << ", " << i;
                // what is open all around, in a ring of few bits, has no direction
                const float straight = glm::dot(found[i].bent_normal, expected[i].bent_normal);
                EXPECT_GE(straight, expected[i].occlusion < 0.7f ? 0.998f : -1.01f)
                    << name_of(engine) << ", " << definition.max_distance << ", " << i;
            }
        }
    }
}

// In the very frame of the body: the quad is no part of the box.
TEST(Ground, AHugeQuadIsTheSame)
{
    const Scene body = scenes::bumpy_sphere(6);
    const Geometry alone = make_geometry(body);
    const double low = alone.frame.centre.z - 0.4 * alone.frame.diagonal;
    const Geometry with_quad =
        make_geometry(body + scenes::sheet({-2e3, -2e3, low}, {4e3, 0, 0}, {0, 4e3, 0}, 1),
                      {.frame = alone.frame});
    const std::vector<Receiver> receivers = vertex_receivers(alone);
    EngineSettings rays;
    rays.engine = Engine::rays;
    rays.rays = 1024;
    for (Definition definition : {Definition{}, Definition{.max_distance = 0.3f},
                                  Definition{.max_distance = 0.6f, .falloff = Falloff::smooth}}) {
        const std::vector<Occlusion> expected = answers_of(rays, with_quad, receivers, definition);
        definition.ground = Ground{{0, 0, 1}, -0.4f};
        // the same rays: those beside the quad, and one or the other at its rim
        EXPECT_LT(rms_difference(expected, answers_of(rays, alone, receivers, definition)), 1e-3);
        for (const EngineSettings& engine : engines())
            EXPECT_LT(rms_difference(expected, answers_of(engine, alone, receivers, definition)),
                      engine.engine == Engine::disks ? 0.03 : 0.012)
                << name_of(engine) << ", " << definition.max_distance;
    }
}

TEST(Ground, BeyondTheLimitItChangesNothing)
{
    const Geometry geometry = make_geometry(scenes::bumpy_sphere(6));
    const std::vector<Receiver> receivers = vertex_receivers(geometry);
    Definition definition = {.max_distance = 0.3f};
    for (const EngineSettings& engine : engines()) {
        definition.ground.reset();
        const std::vector<Occlusion> expected = answers_of(engine, geometry, receivers, definition);
        definition.ground = under(geometry, kTilted, 0.31f);
        EXPECT_TRUE(same_bytes(expected, answers_of(engine, geometry, receivers, definition)))
            << name_of(engine);
    }
}

TEST(Ground, IsRefusedWhereItIsNone)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Definition& wrong : {Definition{.ground = Ground{{0, 0, 2}, 0.0f}},
                                    Definition{.ground = Ground{{0, 0, 1}, nan}},
                                    Definition{.ground = Ground{{nan, 0, 1}, 0.0f}},
                                    Definition{.kernel = Kernel::bunnell, .ground = Ground{}}})
        EXPECT_THROW(check_definition(wrong), SettingsError);
    EXPECT_NO_THROW(check_definition({.ground = Ground{kTilted, -3.0f}}));
}

}  // namespace
}  // namespace surfelao
