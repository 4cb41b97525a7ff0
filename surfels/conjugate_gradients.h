/// conjugate_gradients.h: linear equations whose matrix is known by what it makes of a vector.
///
/// Internal: for the folders' own sources.
///
/// Based on:
///   Hestenes, Stiefel. Methods of Conjugate Gradients for Solving Linear Systems. 1952
#pragma once

#include "surfels/errors.h"
#include "surfels/progress.h"

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace surfelao {

/// When enough is done.
struct GradientLimits {
    double residual;  ///< of the right side, in length
    int steps;
};

/// x of A x = right, from 0 on. product: A times a vector, A symmetric and positive definite;
/// diagonal: A's, the preconditioner. A product and three loops over the vector a step. Throws
/// Cancelled.
template <class Product>
[[nodiscard]] std::vector<double> conjugate_gradients(const Product& product,
                                                      const std::vector<double>& diagonal,
                                                      std::vector<double> right,
                                                      const GradientLimits& limits,
                                                      const Progress& progress = {})
{
    const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    };
    const auto length_of = [&](const std::vector<double>& rest) {
        double sum = 0.0;
        for (std::size_t k = 0; k < rest.size(); ++k)
            sum += rest[k] * rest[k] / diagonal[k];
        return sum;
    };
    std::vector<double> x(right.size(), 0.0), rest = std::move(right), way(rest.size());
    for (std::size_t k = 0; k < way.size(); ++k)
        way[k] = rest[k] / diagonal[k];
    const double first = length_of(rest);
    double length = first;
    for (int i = 0; i < limits.steps && length > limits.residual * limits.residual * first; ++i) {
        if (progress && !progress(static_cast<double>(i) / limits.steps))
            throw Cancelled();
        const std::vector<double> image = product(way);
        const double step = length / dot(way, image);
        for (std::size_t k = 0; k < way.size(); ++k) {
            x[k] += step * way[k];
            rest[k] -= step * image[k];
        }
        const double next = length_of(rest);
        for (std::size_t k = 0; k < way.size(); ++k)
            way[k] = rest[k] / diagonal[k] + next / length * way[k];
        length = next;
    }
    return x;
}

}  // namespace surfelao
