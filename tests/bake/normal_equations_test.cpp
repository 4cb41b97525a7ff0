#include "bake/normal_equations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace surfelao {
namespace {

constexpr std::size_t kChainRows = 9000;  // several blocks of rows

/// A chain: each row is 2.5, and -1 beside it, but for the second, which weighs nothing.
NormalEquations chain_matrix()
{
    NormalEquations matrix;
    matrix.begin.push_back(0);
    const auto put = [&](std::size_t column, float value) {
        matrix.columns.push_back(static_cast<std::uint32_t>(column));
        matrix.values.push_back(value);
    };
    for (std::size_t row = 0; row < kChainRows; ++row) {
        if (row > 2)
            put(row - 1, -1.0f);
        put(row, row == 1 ? 0.0f : 2.5f);
        if (row > 1 && row + 1 < kChainRows)
            put(row + 1, -1.0f);
        matrix.begin.push_back(static_cast<std::uint32_t>(matrix.columns.size()));
    }
    return matrix;
}

/// Columns of different sizes, one of zeros.
Eigen::Array4f chain_solution(std::size_t row)
{
    const auto r = static_cast<float>(row);
    return row == 1 ? Eigen::Array4f::Constant(0.75f)
                    : Eigen::Array4f(std::sin(0.01f * r), 0.0f, 1e-3f * std::cos(0.7f * r), 1.0f);
}

/// The largest difference to the solution, over its column's size.
float chain_error(
    const std::function<void(const NormalEquations&, const FourColumns&, FourColumns&)>& solve)
{
    const NormalEquations matrix = chain_matrix();
    FourColumns right(kChainRows), x(kChainRows, Eigen::Array4f::Zero());
    for (std::size_t row = 0; row < kChainRows; ++row) {
        right[row].setZero();
        for (std::uint32_t i = matrix.begin[row]; i < matrix.begin[row + 1]; ++i)
            right[row] += matrix.values[i] * chain_solution(matrix.columns[i]);
    }
    x[1] = chain_solution(1);
    solve(matrix, right, x);
    float error = 0.0f;
    for (std::size_t row = 0; row < kChainRows; ++row) {
        const Eigen::Array4f off = (x[row] - chain_solution(row)).abs();
        error = std::max(error, (off * Eigen::Array4f(1.0f, 1.0f, 1e3f, 1.0f)).maxCoeff());
    }
    return error;
}

// Eigenvalues lie between .5 and 4.5: each step leaves half of the error or less.
TEST(NormalEquations, BothIterationsFindTheSolutionOfEachColumn)
{
    EXPECT_LT(chain_error([](const auto& matrix, const auto& right, auto& x) {
                  conjugate_gradients(matrix, right, 1e-6, 100, x);
              }),
              1e-4f);
    EXPECT_LT(chain_error([](const auto& matrix, const auto& right, auto& x) {
                  chebyshev(matrix, right, 18, 1.0 / 9.0, x);
              }),
              1e-4f);
}

}  // namespace
}  // namespace surfelao
