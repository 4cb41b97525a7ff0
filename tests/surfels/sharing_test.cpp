// What threads fill together: each thing's items in order, each set's lowest member its name.
#include "surfels/buckets.h"
#include "surfels/for_all.h"
#include "surfels/union_find.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

namespace surfelao {
namespace {

constexpr std::uint32_t kMany = 100'000;

TEST(Sharing, ItemsOfAnOwnerStandInTheOrderInWhichTheyWerePut)
{
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 4);
    constexpr std::uint32_t kOwners = 9000;
    const Buckets<std::uint32_t> buckets(kOwners, [](const auto& put) {
        for (std::uint32_t item = 0; item < kMany; ++item)
            put(item * 7 % kOwners, item);
    });
    std::size_t count = 0;
    for (std::uint32_t owner = 0; owner < kOwners; ++owner) {
        EXPECT_TRUE(std::ranges::is_sorted(buckets[owner]));
        for (const std::uint32_t item : buckets[owner])
            EXPECT_EQ(item * 7 % kOwners, owner);
        count += buckets[owner].size();
    }
    EXPECT_EQ(count, kMany);
}

// Chains of equal remainder, joined from both ends at once.
TEST(Sharing, SetsThatAllThreadsJoinAreNamedByTheirLowest)
{
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 4);
    constexpr std::uint32_t kSets = 3;
    UnionFind sets(kMany);
    for_all(kMany - kSets, [&](std::size_t i) {
        const std::size_t at = i % 2 == 0 ? i : kMany - kSets - 1 - i;
        const auto member = static_cast<std::uint32_t>(at);
        sets.join(member, member + kSets);
    });
    for (std::uint32_t i = 0; i < kMany; ++i)
        ASSERT_EQ(sets.root(i), i % kSets);
}

}  // namespace
}  // namespace surfelao
