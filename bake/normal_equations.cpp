#include "bake/normal_equations.h"

#include "surfels/for_all.h"

#include <algorithm>
#include <cmath>

namespace surfelao {
namespace {

constexpr std::size_t kRowsEach = 4096;
constexpr int kColumns = 4;

/// Calls body(row) for all rows.
template <class Body>
void for_rows(std::size_t count, const Body& body)
{
    const auto block = [&](std::size_t index) {
        const std::size_t end = std::min(count, (index + 1) * kRowsEach);
        for (std::size_t row = index * kRowsEach; row < end; ++row)
            body(row);
    };
    const std::size_t blocks = (count + kRowsEach - 1) / kRowsEach;
    if (blocks <= 1)  // no thread is woken for it
        block(0);
    else
        for_tasks(blocks, block);
}

/// Per column: r.r and r.z of a residual r and of z, which the preconditioner makes of it.
using Residual = Eigen::Array<double, kColumns, 2>;

/// The sum of term(row) over all rows, in an order that does not depend on threads.
template <class Sum, class Term>
Sum sum_over_rows(std::size_t count, const Term& term)
{
    std::vector<Sum> sums((count + kRowsEach - 1) / kRowsEach, Sum::Zero());
    for_rows(count, [&](std::size_t row) { term(row, sums[row / kRowsEach]); });
    Sum whole = Sum::Zero();
    for (const Sum& sum : sums)
        whole += sum;
    return whole;
}

Eigen::Array4f row_times(const NormalEquations& matrix, std::size_t row, const FourColumns& x)
{
    Eigen::Array4f sum = Eigen::Array4f::Zero();
    for (std::uint32_t i = matrix.begin[row]; i < matrix.begin[row + 1]; ++i)
        sum += matrix.values[i] * x[matrix.columns[i]];
    return sum;
}

Eigen::Array4d product(const Eigen::Array4f& a, const Eigen::Array4f& b)
{
    return (a * b).cast<double>();
}

/// a / b, 0 where there is nothing left to divide.
Eigen::Array4f quotient(const Eigen::Array4d& a, const Eigen::Array4d& b)
{
    return (b > 0.0).select(a / b, 0.0).cast<float>();
}

/// Of the diagonal; 0 in rows that weigh nothing, whose values stay.
std::vector<float> inverse_diagonal(const NormalEquations& matrix)
{
    std::vector<float> inverse(matrix.size());
    for_rows(matrix.size(), [&](std::size_t row) {
        const auto* const columns = matrix.columns.data();
        const auto* const found =
            std::lower_bound(columns + matrix.begin[row], columns + matrix.begin[row + 1], row);
        const float diagonal = matrix.values[static_cast<std::size_t>(found - columns)];
        inverse[row] = std::isnormal(diagonal) ? 1.0f / diagonal : 0.0f;
    });
    return inverse;
}

}  // namespace

void conjugate_gradients(const NormalEquations& matrix, const FourColumns& right, double tolerance,
                         int most_steps, FourColumns& x)
{
    const std::size_t count = matrix.size();
    const std::vector<float> inverse = inverse_diagonal(matrix);
    FourColumns rest(count), step(count), image(count);
    const auto add_residual = [&](std::size_t row, Residual& sum) {
        sum.col(0) += product(rest[row], rest[row]);
        sum.col(1) += product(rest[row], inverse[row] * rest[row]);
    };
    const Eigen::Array4d enough =
        tolerance * tolerance *
        sum_over_rows<Eigen::Array4d>(count, [&](std::size_t row, Eigen::Array4d& sum) {
            sum += product(right[row], right[row]);
        });
    Residual residual = sum_over_rows<Residual>(count, [&](std::size_t row, Residual& sum) {
        rest[row] = right[row] - row_times(matrix, row, x);
        step[row] = inverse[row] * rest[row];
        add_residual(row, sum);
    });
    for (int i = 0; i < most_steps && (residual.col(0) > enough).any(); ++i) {
        const auto bend =
            sum_over_rows<Eigen::Array4d>(count, [&](std::size_t row, Eigen::Array4d& sum) {
                image[row] = row_times(matrix, row, step);
                sum += product(step[row], image[row]);
            });
        const Eigen::Array4f length = quotient(residual.col(1), bend);
        const auto next = sum_over_rows<Residual>(count, [&](std::size_t row, Residual& sum) {
            x[row] += length * step[row];
            rest[row] -= length * image[row];
            add_residual(row, sum);
        });
        const Eigen::Array4f turn = quotient(next.col(1), residual.col(1));
        for_rows(count,
                 [&](std::size_t row) { step[row] = inverse[row] * rest[row] + turn * step[row]; });
        residual = next;
    }
}

void chebyshev(const NormalEquations& matrix, const FourColumns& right, int steps, double spectrum,
               FourColumns& x)
{
    const std::size_t count = matrix.size();
    const std::vector<float> inverse = inverse_diagonal(matrix);
    // rows over their diagonal: the sums of their entries bound all eigenvalues (Gershgorin)
    double largest = 0.0;
    for (std::size_t row = 0; row < count; ++row) {
        double sum = 0.0;
        for (std::uint32_t i = matrix.begin[row]; i < matrix.begin[row + 1]; ++i)
            sum += std::abs(static_cast<double>(matrix.values[i]));
        largest = std::max(largest, sum * static_cast<double>(inverse[row]));
    }
    const double middle = 0.5 * largest * (1.0 + spectrum);
    const double half = 0.5 * largest * (1.0 - spectrum);
    FourColumns rest(count), step(count);
    for_rows(count, [&](std::size_t row) {
        rest[row] = right[row] - row_times(matrix, row, x);
        step[row] = static_cast<float>(1.0 / middle) * inverse[row] * rest[row];
    });
    double rho = half / middle;
    for (int i = 1;; ++i) {
        for_rows(count, [&](std::size_t row) { x[row] += step[row]; });
        if (i == steps)
            return;
        for_rows(count, [&](std::size_t row) { rest[row] -= row_times(matrix, row, step); });
        const double next = 1.0 / (2.0 * middle / half - rho);
        const auto kept = static_cast<float>(next * rho),
                   added = static_cast<float>(2.0 * next / half);
        for_rows(count, [&](std::size_t row) {
            step[row] = kept * step[row] + added * inverse[row] * rest[row];
        });
        rho = next;
    }
}

}  // namespace surfelao
