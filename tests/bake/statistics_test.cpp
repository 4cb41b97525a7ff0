#include "bake/statistics.h"

#include "bake/sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace surfelao {
namespace {

constexpr glm::vec3 kUp{0, 0, 1};

TEST(ErrorStatistics, MatchesAHandCount)
{
    const std::vector<Occlusion> answer = {{0.1f, kUp}, {0.5f, kUp}, {0.9f, {1, 0, 0}}};
    const std::vector<Occlusion> truth = {{0.1f, kUp}, {0.4f, kUp}, {0.7f, kUp}};
    const ErrorStatistics s = error_statistics(answer, truth);
    EXPECT_EQ(s.count, 3u);
    EXPECT_NEAR(s.rmse, std::sqrt((0.01 + 0.04) / 3), 1e-7);
    EXPECT_NEAR(s.bias, 0.1, 1e-7);
    EXPECT_NEAR(s.max, 0.2, 1e-7);
    EXPECT_NEAR(s.p95, 0.2, 1e-7);
    EXPECT_NEAR(s.bent_mean_deg, 90.0 * 0.3 / 1.8, 1e-5);
    EXPECT_NEAR(s.bent_p95_deg, 90.0, 1e-4);
}

// Nearly closed, a bent normal is nobody's: its angle weighs a tenth.
TEST(ErrorStatistics, AnglesWeighAsMuchAsTheReferenceIsOpen)
{
    const std::vector<Occlusion> answer = {{0.1f, kUp}, {0.9f, {1, 0, 0}}, {1.0f, {0, 1, 0}}};
    std::vector<Occlusion> truth = {{0.1f, kUp}, {0.9f, kUp}, {1.0f, kUp}};
    const ErrorStatistics s = error_statistics(answer, truth);
    EXPECT_NEAR(s.bent_mean_deg, 9.0, 1e-4);
    EXPECT_NEAR(s.bent_p95_deg, 90.0, 1e-4);
    truth[1].occlusion = 0.97f;  // below a twentieth of the weight
    EXPECT_NEAR(error_statistics(answer, truth).bent_p95_deg, 0.0, 1e-4);
}

TEST(ErrorStatistics, NoiseOfTheReferenceIsTakenOut)
{
    const std::vector<Occlusion> answer = {{0.5f, kUp}, {0.5f, kUp}};
    const std::vector<Occlusion> truth = {{0.0f, kUp}, {0.0f, kUp}};
    EXPECT_NEAR(error_statistics(answer, truth, 0.3).rmse, 0.4, 1e-7);
    EXPECT_NEAR(error_statistics(answer, truth, 0.3).max, 0.5, 1e-7);
    EXPECT_EQ(error_statistics(answer, truth, 0.6).rmse, 0.0);
}

// Nearest rank: of 100 errors 0.00 to 0.99 the 95th is 0.94.
TEST(ErrorStatistics, PercentileIsTheNearestRank)
{
    std::vector<Occlusion> answer, truth;
    for (int i = 99; i >= 0; --i) {
        answer.push_back({static_cast<float>(i) / 100, kUp});
        truth.push_back({0.0f, kUp});
    }
    EXPECT_NEAR(error_statistics(answer, truth).p95, 0.94, 1e-6);
}

TEST(ErrorStatistics, NothingGivesZeros)
{
    const ErrorStatistics s = error_statistics({}, {});
    EXPECT_EQ(s.count, 0u);
    EXPECT_EQ(s.rmse, 0.0);
    EXPECT_EQ(s.p95, 0.0);
}

// Error = 1 / seconds: a straight line in log-log.
TEST(TimeAt, IsExactOnAPowerLawInsideAndMarkedBeyondIt)
{
    const std::vector<CurvePoint> family = {{1.0, 1.0}, {0.1, 10.0}, {0.01, 100.0}};
    EXPECT_NEAR(time_at(family, 0.1)->seconds, 10.0, 1e-9);
    EXPECT_NEAR(time_at(family, 0.05)->seconds, 20.0, 1e-9);
    EXPECT_NEAR(time_at(family, 0.5)->seconds, 2.0, 1e-9);
    EXPECT_FALSE(time_at(family, 0.01)->extrapolated);
    EXPECT_FALSE(time_at(family, 1.0)->extrapolated);
    EXPECT_NEAR(time_at(family, 0.001)->seconds, 1000.0, 1e-6);
    EXPECT_TRUE(time_at(family, 0.001)->extrapolated);
}

// All points are more exact than asked: nothing in the family costs less than its cheapest.
TEST(TimeAt, AFamilyThatIsMoreExactThanAskedCountsAtItsCheapest)
{
    const std::vector<CurvePoint> family = {{0.3, 2.0}, {1.0, 3.0}, {0.1, 10.0}};
    EXPECT_EQ(time_at(family, 10.0)->seconds, 2.0);
    EXPECT_EQ(time_at(family, 0.5)->seconds, 2.0);  // the coarsest is beaten
    EXPECT_FALSE(time_at(family, 10.0)->extrapolated);
    EXPECT_EQ(time_at({{0.1, 2.0}}, 0.1)->seconds, 2.0);  // one is enough
}

// An error that hardly falls with time: any answer would be a guess.
TEST(TimeAt, ALineThatLeadsAnywhereLeadsNowhere)
{
    EXPECT_FALSE(time_at({{0.0090, 1.0}, {0.0089, 4.0}}, 0.005));
}

TEST(TimeAt, BeatenPointsDoNotCount)
{
    // the second point costs more than the third and is less exact
    const std::vector<CurvePoint> family = {{1.0, 1.0}, {0.3, 50.0}, {0.1, 10.0}};
    EXPECT_NEAR(time_at(family, 0.3)->seconds, std::pow(10.0, -std::log10(0.3)), 1e-9);
    // equal errors: the cheaper one counts
    EXPECT_NEAR(time_at({{1.0, 1.0}, {0.1, 30.0}, {0.1, 10.0}}, 0.1)->seconds, 10.0, 1e-9);
}

TEST(TimeAt, NeedsTwoPointsWithLogarithms)
{
    EXPECT_FALSE(time_at({}, 0.1));
    EXPECT_FALSE(time_at({{0.1, 1.0}}, 0.05));
    EXPECT_FALSE(time_at({{0.1, 1.0}, {0.0, 2.0}}, 0.05));
    EXPECT_FALSE(time_at({{0.1, 1.0}, {0.01, 2.0}}, 0.0));
}

TEST(Quantile, IsStraightBetweenRanks)
{
    EXPECT_EQ(quantile({3, 1, 2}, 0.5), 2.0);
    EXPECT_EQ(quantile({4, 1, 2, 3}, 0.5), 2.5);
    EXPECT_EQ(quantile({4, 1, 2, 3}, 0.0), 1.0);
    EXPECT_EQ(quantile({4, 1, 2, 3}, 1.0), 4.0);
    EXPECT_EQ(quantile({7}, 0.25), 7.0);
}

TEST(Sample, TakesAsManyAsAskedOnceEachAndEvenly)
{
    const std::vector<std::uint32_t> sample = sample_of(1000, 100);
    ASSERT_EQ(sample.size(), 100u);
    for (std::uint32_t i = 0; i < 100; ++i) {
        EXPECT_GE(sample[i], i * 10);
        EXPECT_LT(sample[i], i * 10 + 10);
    }
    std::set<std::uint32_t> phases;
    for (const std::uint32_t i : sample)
        phases.insert(i % 10);
    EXPECT_GT(phases.size(), 5u);  // no comb of every tenth
    EXPECT_EQ(sample_of(5, 0), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
    EXPECT_EQ(sample_of(5, 9), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
    EXPECT_TRUE(sample_of(0, 3).empty());
}

}  // namespace
}  // namespace surfelao
