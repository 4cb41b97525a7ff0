/// normal_equations.h: a sparse symmetric matrix, solved for four right sides at once.
///
/// Internal to vertex_fit.h. Bent vector and occlusion of a vertex stand side by side: what of the
/// matrix comes from memory then serves all four, in the lanes of one vector. Single precision,
/// sums in double: values of answers need no more.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace surfelao {

/// One entry per unknown.
using FourColumns = std::vector<Eigen::Array4f>;

/// Positive definite, by rows, columns rising in each; every row has its diagonal.
struct NormalEquations {
    std::vector<std::uint32_t> begin;  ///< of each row's entries; and one more, where they end
    std::vector<std::uint32_t> columns;
    std::vector<float> values;

    [[nodiscard]] std::size_t size() const { return begin.size() - 1; }
};

/// By conjugate gradients, from x on, with the diagonal as preconditioner (Hestenes, Stiefel.
/// Methods of Conjugate Gradients for Solving Linear Systems. 1952): until each column's residual
/// is below `tolerance` of its right side, or for so many steps. All cores, same bytes for any
/// number of threads.
void conjugate_gradients(const NormalEquations& matrix, const FourColumns& right, double tolerance,
                         int most_steps, FourColumns& x);

/// By `steps` of the Chebyshev iteration, from x on, for eigenvalues of the matrix over its
/// diagonal that are above `spectrum` of the largest: a row's value depends on what stands within
/// so many steps of the matrix's graph alone.
void chebyshev(const NormalEquations& matrix, const FourColumns& right, int steps, double spectrum,
               FourColumns& x);

}  // namespace surfelao
