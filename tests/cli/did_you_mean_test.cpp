#include "cli/did_you_mean.h"

#include <gtest/gtest.h>

#include <vector>

namespace surfelao {
namespace {

TEST(EditDistance, CountsWhatIsInsertedDroppedChangedAndSwapped)
{
    EXPECT_EQ(edit_distance("", "abc"), 3u);
    EXPECT_EQ(edit_distance("abc", ""), 3u);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
    EXPECT_EQ(edit_distance("qualtiy", "quality"), 1u);
    EXPECT_EQ(edit_distance("vertex", "vertices"), 3u);
    EXPECT_EQ(edit_distance("ca", "abc"), 3u) << "what was swapped is not changed again";
}

TEST(NearestWord, IsNearEnoughToBeMeant)
{
    const std::vector<std::string> words = {"vertices", "texels", "pixels", "draft"};
    EXPECT_EQ(nearest_word("vertex", words), "vertices");
    EXPECT_EQ(nearest_word("PIXELS", words), "pixels");
    EXPECT_EQ(nearest_word("pexels", words), "texels") << "the first of two that are as near";
    EXPECT_EQ(nearest_word("superb", words), "");
    EXPECT_EQ(nearest_word("", words), "");
    EXPECT_EQ(nearest_word("vertex", {}), "");
}

}  // namespace
}  // namespace surfelao
