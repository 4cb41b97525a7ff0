#include "image/map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace surfelao {
namespace {

TEST(Maps, AreFetchedAsViewersDo)
{
    Map map(4, 2, 2);
    std::iota(map.values.begin(), map.values.end(), 0.0f);
    EXPECT_EQ(fetch(map, 0, {0.125, 0.25}), 0.0f);   // the centre of the first texel
    EXPECT_EQ(fetch(map, 1, {0.375, 0.75}), 11.0f);  // of the second in the second row
    EXPECT_FLOAT_EQ(fetch(map, 0, {0.25, 0.25}), 1.0f);
    EXPECT_FLOAT_EQ(fetch(map, 0, {0.125, 0.5}), 4.0f);
    EXPECT_FLOAT_EQ(fetch(map, 0, {1.0, 0.25}), 3.0f);  // between the last and the first
    EXPECT_FLOAT_EQ(fetch(map, 0, {-0.875, 2.25}), 0.0f);
}

TEST(Maps, HaveTheirEmptyTexelsFilledFromTheRimOutwards)
{
    Map map(9, 9, 1);
    std::vector<std::uint8_t> known(map.texels(), 0);
    map.values[map.index(4, 4)] = 1.0f;
    map.values[map.index(5, 4)] = 0.5f;
    known[map.index(4, 4)] = known[map.index(5, 4)] = 1;
    fill_around(map, known, 2);
    EXPECT_EQ(std::count(known.begin(), known.end(), 1), 81);
    EXPECT_EQ(map.values[map.index(4, 4)], 1.0f);
    EXPECT_EQ(map.values[map.index(3, 4)], 1.0f);   // beside the first alone
    EXPECT_EQ(map.values[map.index(4, 3)], 0.75f);  // above both
    EXPECT_EQ(map.values[map.index(6, 5)], 0.5f);
    EXPECT_EQ(map.values[map.index(2, 4)], 1.0f);   // the second ring, of the first
    EXPECT_EQ(map.values[map.index(0, 0)], 0.75f);  // the mean of what was known

    std::vector<std::uint8_t> none(map.texels(), 0);
    const Map before = map;
    fill_around(map, none, 3);
    EXPECT_EQ(map.values, before.values);
}

}  // namespace
}  // namespace surfelao
