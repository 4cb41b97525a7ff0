#include "bake/texel_fit.h"

#include "surfels/conjugate_gradients.h"
#include "surfels/errors.h"
#include "surfels/for_all.h"
#include "surfels/sparse_rows.h"

#include <algorithm>

namespace surfelao {
namespace {

constexpr GradientLimits kTexelLimits{.residual = 1e-3, .steps = 40};

/// What samples fetch of the texels that occur.
using TexelRows = SparseRows<4>;

TexelRows rows_of(const Map& map, std::span<const TexelSample> samples)
{
    std::vector<TexelRows::Entry> entries(4 * samples.size());
    for_all(samples.size(), [&](std::size_t s) {
        const Footprint print = footprint(map.width, map.height, glm::dvec2(samples[s].uv));
        for (std::size_t k = 0; k < 4; ++k)
            entries[4 * s + k] = {print.texels[k], print.weights[k]};
    });
    return {entries, map.texels()};
}

}  // namespace

std::vector<std::uint8_t> texels_with_steps(const Map& visibility,
                                            std::span<const std::uint8_t> known)
{
    SURFELAO_CHECK(known.size() == visibility.texels());
    std::vector<std::uint8_t> marked(known.size(), 0);
    for_all(known.size(), [&](std::size_t texel) {
        if (known[texel] == 0)
            return;
        float least = 1.0f, most = 0.0f;
        for_each_around(visibility, texel, [&](std::size_t other) {
            if (known[other] == 0)
                return;
            least = std::min(least, visibility.values[other]);
            most = std::max(most, visibility.values[other]);
        });
        marked[texel] = most - least >= kFitStep ? 1 : 0;
    });
    return std::ranges::find(marked, 1) != marked.end() ? marked : std::vector<std::uint8_t>{};
}

void fit_texels(Map& visibility, std::span<const std::uint8_t> known,
                std::span<const std::uint8_t> marked, std::span<const TexelSample> samples)
{
    const TexelRows rows = rows_of(visibility, samples);
    const std::vector<std::uint64_t>& texels = rows.columns();
    std::vector<double> values, held;
    for (const std::uint64_t texel : texels) {
        values.push_back(visibility.values[texel]);
        held.push_back(known[texel] != 0 && marked[texel] == 0 ? 1.0 : kFitHold);
    }
    std::vector<double> weights;
    for (const TexelSample& sample : samples)
        weights.push_back(double{sample.share} / (kFitSide * kFitSide));
    std::vector<double> residuals = rows.times(values);
    for (std::size_t s = 0; s < samples.size(); ++s)
        residuals[s] = weights[s] * (double{samples[s].visibility} - residuals[s]);
    std::vector<double> diagonal = rows.squares(weights);
    for (std::size_t k = 0; k < diagonal.size(); ++k)
        diagonal[k] += held[k];
    const std::vector<double> change = conjugate_gradients(
        [&](const std::vector<double>& of) {
            std::vector<double> shown = rows.times(of);
            for (std::size_t s = 0; s < shown.size(); ++s)
                shown[s] *= weights[s];
            std::vector<double> sums = rows.transposed_times(shown);
            for (std::size_t k = 0; k < sums.size(); ++k)
                sums[k] += held[k] * of[k];
            return sums;
        },
        diagonal, rows.transposed_times(residuals), kTexelLimits);
    for (std::size_t k = 0; k < texels.size(); ++k)
        visibility.values[texels[k]] =
            static_cast<float>(std::clamp(values[k] + change[k], 0.0, 1.0));
}

}  // namespace surfelao
