#include "surfels/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

namespace surfelao {
namespace {

constexpr std::uint64_t kMillion = 1'000'000;

TEST(Progress, TellsTheEndAndNeverGoesBack)
{
    std::vector<double> told;
    ProgressMeter meter(
        [&](double done) {
            told.push_back(done);
            return true;
        },
        kMillion);
    for (std::uint64_t i = 0; i < kMillion; ++i)
        meter.add(1);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_EQ(told.back(), 1.0);
    EXPECT_LT(told.size(), kMillion / 100);
}

// A unit may take long: who wants to stop is asked after each of them.
TEST(Progress, SlowUnitsAreToldOneByOne)
{
    int calls = 0;
    ProgressMeter meter([&](double) { return ++calls < 3; }, kMillion);
    for (int i = 0; i < 2; ++i) {
        meter.add(1);
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
    EXPECT_THROW(meter.add(1), Cancelled);
    EXPECT_THROW(meter.add(1), Cancelled) << "in every thread";
}

TEST(Progress, NobodyNeedsToListen)
{
    ProgressMeter meter({}, 0);
    EXPECT_NO_THROW(meter.add(1));
}

}  // namespace
}  // namespace surfelao
