#include "image/lettering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace surfelao {
namespace {

const glm::vec4 kInk(1.0f);

std::string rows_of(std::string_view text)
{
    Image image(text_width(text), kGlyphHeight, glm::vec4(0.0f));
    draw_text(image, {0, 0}, text, kInk, 1);
    std::string rows;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            rows += image.at(x, y) == kInk ? '#' : '.';
        rows += '\n';
    }
    return rows;
}

TEST(Text, DrawsTheGlyphUpright)
{
    EXPECT_EQ(rows_of("L"),
              "#.....\n"
              "#.....\n"
              "#.....\n"
              "#.....\n"
              "#.....\n"
              "#.....\n"
              "#####.\n"
              "......\n");
}

TEST(Text, LettersAreDrawnAsCapitals)
{
    EXPECT_EQ(rows_of("occlusion"), rows_of("OCCLUSION"));
}

TEST(Text, EveryKnownCharacterHasAGlyphOfItsOwn)
{
    const std::string known = " 0123456789abcdefghijklmnopqrstuvwxyz.,:-+%/()=";
    const std::string unknown = rows_of("\x01");
    for (std::size_t i = 0; i < known.size(); ++i) {
        EXPECT_NE(rows_of(known.substr(i, 1)), unknown) << known[i];
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_NE(rows_of(known.substr(i, 1)), rows_of(known.substr(k, 1)))
                << known[i] << " and " << known[k];
    }
}

TEST(Text, ScalesAndIsCutAtTheEdges)
{
    Image image(8, 8, glm::vec4(0.0f));
    draw_text(image, {-2, -3}, "-----", kInk, 2);  // the dash is row 3: pixel rows 3 and 4 here
    for (int y = 0; y < 8; ++y)
        EXPECT_EQ(image.at(0, y) == kInk, y == 3 || y == 4) << y;
}

}  // namespace
}  // namespace surfelao
