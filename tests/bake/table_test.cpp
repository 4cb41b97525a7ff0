#include "bake/table.h"
#include "surfels/number_text.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

namespace surfelao {
namespace {

TEST(Text, NumbersAreRoundedAndSigned)
{
    EXPECT_EQ(fixed(0.01256, 3), "0.013");
    EXPECT_EQ(fixed(1e300, 0).size(), 301u);
    EXPECT_EQ(signed_fixed(0.0, 2), "+0.00");
    EXPECT_EQ(signed_fixed(-0.5, 1), "-0.5");
}

TEST(Text, ExactNumbersReadBack)
{
    for (const double value : {0.1, 1e-300, 12345.678, std::numeric_limits<double>::denorm_min()})
        EXPECT_EQ(std::strtod(exact(value).c_str(), nullptr), value);
}

TEST(Text, CsvFieldsAreQuotedWhereNeeded)
{
    EXPECT_EQ(csv_field("plain"), "plain");
    EXPECT_EQ(csv_field("64 rays, smoothed"), "\"64 rays, smoothed\"");
    EXPECT_EQ(csv_field("a\"b"), "\"a\"\"b\"");
}

TEST(Text, TablesAlignTextLeftAndNumbersRight)
{
    Table table({"a", "name", "n"});
    table.add({"x", "long name", "1"});
    table.add({"yy", "b", "1000"});
    EXPECT_EQ(table.text(),
              "a   name          n\n"
              "x   long name     1\n"
              "yy  b          1000\n");
}

}  // namespace
}  // namespace surfelao
