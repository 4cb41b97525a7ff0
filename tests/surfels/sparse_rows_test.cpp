#include "surfels/sparse_rows.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace surfelao {
namespace {

// Columns that occur several times in a row, at the first and last of all, and on both sides of a
// word's end.
TEST(SparseRows, MultiplyAsTheDenseMatrix)
{
    constexpr std::size_t kRows = 5000, kColumns = 200;
    using Rows = SparseRows<3>;
    const std::vector<std::uint64_t> used{0, 1, 62, 63, 64, 65, 127, 128, 190, 199};
    std::mt19937 random(7);
    std::vector<Rows::Entry> entries;
    std::vector<std::vector<double>> dense(kRows, std::vector<double>(kColumns, 0.0));
    for (std::size_t i = 0; i < 3 * kRows; ++i) {
        const std::uint64_t column = i < used.size() ? used[i] : used[random() % used.size()];
        const double weight = static_cast<double>(random() % 64) - 20.0;
        entries.push_back({column, weight});
        dense[i / 3][column] += weight;
    }
    const Rows rows(entries, kColumns);
    ASSERT_EQ(rows.columns(), used);
    ASSERT_EQ(rows.row_count(), kRows);
    std::vector<double> of_columns, of_rows;
    for (std::size_t k = 0; k < used.size(); ++k)
        of_columns.push_back(static_cast<double>(k) + 1.0);
    for (std::size_t row = 0; row < kRows; ++row)
        of_rows.push_back(static_cast<double>(row % 17));

    const std::vector<double> product = rows.times(of_columns);
    const std::vector<double> transposed = rows.transposed_times(of_rows);
    for (std::size_t row = 0; row < kRows; ++row) {
        double sum = 0.0;
        for (std::size_t k = 0; k < used.size(); ++k)
            sum += dense[row][used[k]] * of_columns[k];
        EXPECT_EQ(product[row], sum) << row;
    }
    for (std::size_t k = 0; k < used.size(); ++k) {
        double sum = 0.0;
        for (std::size_t row = 0; row < kRows; ++row)
            sum += dense[row][used[k]] * of_rows[row];
        EXPECT_EQ(transposed[k], sum) << used[k];
    }
}

}  // namespace
}  // namespace surfelao
