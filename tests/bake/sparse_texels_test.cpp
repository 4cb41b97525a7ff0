#include "bake/sparse_texels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <utility>

namespace surfelao {
namespace {

/// Texels of a square, a unit of space each, of which some are asked with what occlusion there is.
struct AskedSquare {
    static constexpr std::uint32_t kColumns = 37, kFirstRow = 6, kEndRow = 30;

    AskedSquare()
    {
        for (std::uint32_t y = kFirstRow; y < kEndRow; ++y)
            for (std::uint32_t x = 0; x < kColumns; ++x)
                add(x, y);
    }
    void add(std::uint32_t x, std::uint32_t y)
    {
        texels.push_back({x, y, {}, 1.0f});
        receivers.push_back({{x, y, 0}, {0, 0, 1}});
    }
    /// By texel; what is expected at all of them lies within `tolerance`.
    void ask(const std::function<float(glm::vec3)>& occlusion, float tolerance)
    {
        asked.clear();
        const std::vector<Occlusion> answers =
            sparse_answers(texels, receivers, kColumns, [&](std::span<const Receiver> some) {
                std::vector<Occlusion> of_some;
                for (const Receiver& receiver : some) {
                    asked.emplace(receiver.position.x, receiver.position.y);
                    of_some.push_back({occlusion(receiver.position), receiver.normal});
                }
                return of_some;
            });
        ASSERT_EQ(answers.size(), texels.size());
        for (std::size_t i = 0; i < texels.size(); ++i) {
            EXPECT_NEAR(answers[i].occlusion, occlusion(receivers[i].position), tolerance)
                << texels[i].x << " " << texels[i].y;
            EXPECT_NEAR(glm::dot(answers[i].bent_normal, receivers[i].normal), 1.0f, 0.001f);
        }
    }
    [[nodiscard]] bool is_asked(float x, float y) const { return asked.contains({x, y}); }

    std::vector<Texel> texels;
    std::vector<Receiver> receivers;
    std::set<std::pair<float, float>> asked;
};

float ramp(glm::vec3 p)
{
    return 0.1f + 0.006f * p.x + 0.003f * p.y;  // .018 over two texels of both directions
}

TEST(SparseTexels, TakeTheMeanWhereOcclusionHardlyChanges)
{
    AskedSquare square;
    square.ask(ramp, 1e-6f);
    // one in four, and the last row, which nothing lies beyond
    EXPECT_TRUE(square.is_asked(32, 24));
    EXPECT_LT(square.asked.size(), square.texels.size() / 3);
    square.ask([](glm::vec3 p) { return 0.0101f * p.x; }, 1e-6f);
    EXPECT_GT(square.asked.size(), square.texels.size() / 2);
}

TEST(SparseTexels, AreAskedBesideAStep)
{
    AskedSquare square;
    square.ask([](glm::vec3 p) { return p.x < 18.0f ? 0.2f : 0.2f + 1.01f * kSparseStep; }, 1e-6f);
    for (std::uint32_t y = AskedSquare::kFirstRow; y < AskedSquare::kEndRow - 1; ++y) {
        EXPECT_TRUE(square.is_asked(17, y)) << y;
        EXPECT_FALSE(square.is_asked(15, y)) << y;
    }
}

TEST(SparseTexels, AreAskedWhereTheSurfaceIsNotAmidWhatSurroundsIt)
{
    AskedSquare bent, aside, twice, part;
    for (std::size_t i = 0; i < bent.texels.size(); ++i) {
        const glm::vec3 p = bent.receivers[i].position;
        if (p.x >= 18.0f)  // a fold of 30 degrees
            bent.receivers[i].normal = {0.5f, 0.0f, std::sqrt(0.75f)};
        if (p.x == 17.0f)  // a rib
            aside.receivers[i].position.z = 1.0f;
        if (p.x == 17.0f)
            part.texels[i].share = 0.7f;
    }
    twice = {};
    twice.texels.clear();
    twice.receivers.clear();
    for (std::uint32_t y = AskedSquare::kFirstRow; y < AskedSquare::kEndRow; ++y)
        for (std::uint32_t x = 0; x < AskedSquare::kColumns; ++x)
            for (int sheet = 0; sheet < (x == 17 ? 2 : 1); ++sheet)
                twice.add(x, y);
    for (AskedSquare* square : {&bent, &aside, &twice, &part}) {
        square->ask(ramp, 1e-6f);
        for (std::uint32_t y = AskedSquare::kFirstRow; y < AskedSquare::kEndRow; ++y) {
            EXPECT_TRUE(square->is_asked(17, static_cast<float>(y))) << y;
            EXPECT_EQ(square->is_asked(13, static_cast<float>(y)), y == AskedSquare::kEndRow - 1)
                << y;
        }
    }
}

}  // namespace
}  // namespace surfelao
