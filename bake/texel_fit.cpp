#include "bake/texel_fit.h"

#include "surfels/conjugate_gradients.h"
#include "surfels/errors.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace surfelao {
namespace {

constexpr GradientLimits kTexelLimits{.residual = 1e-3, .steps = 40};

/// What a sample fetches: indices into the list of unknowns.
struct FitRow {
    std::uint32_t columns[4];
    float weights[4];
    double weight;
};

/// Samples over the texels that occur.
class TexelEquations {
public:
    TexelEquations(const Map& map, std::span<const TexelSample> samples)
    {
        std::vector<Footprint> prints;
        prints.reserve(samples.size());
        texels_.reserve(4 * samples.size());
        for (const TexelSample& sample : samples) {
            prints.push_back(footprint(map.width, map.height, glm::dvec2(sample.uv)));
            texels_.insert(texels_.end(), prints.back().texels, prints.back().texels + 4);
        }
        std::ranges::sort(texels_);
        texels_.erase(std::unique(texels_.begin(), texels_.end()), texels_.end());
        rows_.resize(samples.size());
        for (std::size_t s = 0; s < samples.size(); ++s) {
            rows_[s].weight = double{samples[s].share} / (kFitSide * kFitSide);
            for (int k = 0; k < 4; ++k) {
                const auto found = std::ranges::lower_bound(texels_, prints[s].texels[k]);
                rows_[s].columns[k] = static_cast<std::uint32_t>(found - texels_.begin());
                rows_[s].weights[k] = static_cast<float>(prints[s].weights[k]);
            }
        }
    }

    /// Those that occur, rising.
    [[nodiscard]] const std::vector<std::size_t>& texels() const { return texels_; }

    [[nodiscard]] double shown(std::size_t sample, const std::vector<double>& values) const
    {
        double sum = 0.0;
        for (int k = 0; k < 4; ++k)
            sum += double{rows_[sample].weights[k]} * values[rows_[sample].columns[k]];
        return sum;
    }

    /// Adds to `sums` what a residual of a sample says to its texels.
    void spread(std::size_t sample, double residual, std::vector<double>& sums) const
    {
        const FitRow& row = rows_[sample];
        for (int k = 0; k < 4; ++k)
            sums[row.columns[k]] += row.weight * residual * double{row.weights[k]};
    }

    /// The normal matrix times a vector.
    [[nodiscard]] std::vector<double> product(const std::vector<double>& held,
                                              const std::vector<double>& of) const
    {
        std::vector<double> sums(of.size());
        std::ranges::transform(held, of, sums.begin(), std::multiplies{});
        for (std::size_t s = 0; s < rows_.size(); ++s)
            spread(s, shown(s, of), sums);
        return sums;
    }

private:
    std::vector<std::size_t> texels_;
    std::vector<FitRow> rows_;
};

}  // namespace

std::vector<std::uint8_t> texels_with_steps(const Map& visibility,
                                            std::span<const std::uint8_t> known)
{
    SURFELAO_CHECK(known.size() == visibility.texels());
    std::vector<std::uint8_t> marked(known.size(), 0);
    bool has_any = false;
    for (std::size_t texel = 0; texel < known.size(); ++texel) {
        if (known[texel] == 0)
            continue;
        float least = 1.0f, most = 0.0f;
        for_each_around(visibility, texel, [&](std::size_t other) {
            if (known[other] == 0)
                return;
            least = std::min(least, visibility.values[other]);
            most = std::max(most, visibility.values[other]);
        });
        marked[texel] = most - least >= kFitStep ? 1 : 0;
        has_any = has_any || marked[texel] != 0;
    }
    return has_any ? marked : std::vector<std::uint8_t>{};
}

void fit_texels(Map& visibility, std::span<const std::uint8_t> known,
                std::span<const std::uint8_t> marked, std::span<const TexelSample> samples)
{
    const TexelEquations equations(visibility, samples);
    const std::vector<std::size_t>& texels = equations.texels();
    std::vector<double> values, held;
    for (const std::size_t texel : texels) {
        values.push_back(visibility.values[texel]);
        held.push_back(known[texel] != 0 && marked[texel] == 0 ? 1.0 : kFitHold);
    }
    std::vector<double> rest(texels.size(), 0.0);
    for (std::size_t s = 0; s < samples.size(); ++s)
        equations.spread(s, double{samples[s].visibility} - equations.shown(s, values), rest);
    const std::vector<double> change = conjugate_gradients(
        [&](const std::vector<double>& of) { return equations.product(held, of); }, std::move(rest),
        kTexelLimits);
    for (std::size_t k = 0; k < texels.size(); ++k)
        visibility.values[texels[k]] =
            static_cast<float>(std::clamp(values[k] + change[k], 0.0, 1.0));
}

}  // namespace surfelao
