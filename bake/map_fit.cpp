#include "bake/map_fit.h"

#include "surfels/errors.h"

#include <algorithm>
#include <cstddef>

namespace surfelao {
namespace {

/// Eigenvalues lie between kFitHold and 2: ten steps are enough for a thousandth.
constexpr int kMostSteps = 30;
/// Of the squared residual.
constexpr double kEnough = 1e-6;

/// The samples as rows of a sparse matrix over the texels that occur.
class FitRows {
public:
    FitRows(const Map& map, std::span<const std::uint8_t> is_held,
            std::span<const MapSample> samples)
    {
        constexpr std::uint32_t kNone = 0xffffffff;
        std::vector<std::uint32_t> column_of(map.texels(), kNone);
        for (const MapSample& sample : samples) {
            const Footprint print = footprint(map.width, map.height, sample.uv);
            for (int k = 0; k < 4; ++k) {
                std::uint32_t& column = column_of[print.texels[k]];
                if (column == kNone) {
                    column = static_cast<std::uint32_t>(texels_.size());
                    texels_.push_back(print.texels[k]);
                    holds_.push_back(is_held[print.texels[k]] != 0 ? 1.0 : kFitHold);
                }
                columns_.push_back(column);
                weights_.push_back(static_cast<float>(print.weights[k]));
            }
            shares_.push_back(sample.share);
        }
    }

    [[nodiscard]] const std::vector<std::size_t>& texels() const { return texels_; }
    /// One per texel.
    [[nodiscard]] const std::vector<double>& holds() const { return holds_; }

    /// Calls visit(sample, share, columns, weights): four of each of the last two.
    template <class Visit>
    void for_each(const Visit& visit) const
    {
        for (std::size_t s = 0; s < shares_.size(); ++s)
            visit(s, shares_[s], &columns_[4 * s], &weights_[4 * s]);
    }

    /// holds * x + the sum over the samples of share * weights * (weights . x)
    void normal_product(const std::vector<double>& x, std::vector<double>& product) const
    {
        for (std::size_t i = 0; i < x.size(); ++i)
            product[i] = holds_[i] * x[i];
        for_each([&](std::size_t, float share, const std::uint32_t* columns, const float* weights) {
            double shown = 0.0;
            for (int k = 0; k < 4; ++k)
                shown += weights[k] * x[columns[k]];
            for (int k = 0; k < 4; ++k)
                product[columns[k]] += share * weights[k] * shown;
        });
    }

private:
    std::vector<std::size_t> texels_;
    std::vector<double> holds_;
    std::vector<std::uint32_t> columns_;
    std::vector<float> weights_, shares_;
};

double dot(const std::vector<double>& a, const std::vector<double>& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

}  // namespace

std::vector<std::uint8_t> texels_that_bend(const Map& visibility,
                                           std::span<const std::uint8_t> known)
{
    SURFELAO_CHECK(known.size() == visibility.texels());
    std::vector<std::uint8_t> bends(known.size(), 0);
    bool any = false;
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
        bends[texel] = most - least > kTexelBend ? 1 : 0;
        any |= bends[texel] != 0;
    }
    return any ? bends : std::vector<std::uint8_t>();
}

void fit_texels(Map& visibility, std::span<const std::uint8_t> is_held,
                std::span<const MapSample> samples)
{
    SURFELAO_CHECK(visibility.channels == 1 && is_held.size() == visibility.texels());
    const FitRows rows(visibility, is_held, samples);
    const std::size_t count = rows.texels().size();
    std::vector<double> rest(count, 0.0), diagonal = rows.holds(), change(count, 0.0);
    rows.for_each(
        [&](std::size_t s, float share, const std::uint32_t* columns, const float* weights) {
            double misfit = samples[s].visibility;
            for (int k = 0; k < 4; ++k)
                misfit -= weights[k] * visibility.values[rows.texels()[columns[k]]];
            for (int k = 0; k < 4; ++k) {
                rest[columns[k]] += share * weights[k] * misfit;
                diagonal[columns[k]] += share * weights[k] * weights[k];
            }
        });
    // the diagonal is the preconditioner
    const auto scaled = [&](std::size_t i) { return rest[i] / diagonal[i]; };
    std::vector<double> way(count), image(count);
    for (std::size_t i = 0; i < count; ++i)
        way[i] = scaled(i);
    double length = dot(rest, way);
    const double first = length;
    for (int step = 0; step < kMostSteps && length > kEnough * first; ++step) {
        rows.normal_product(way, image);
        const double along = length / dot(way, image);
        double next = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            change[i] += along * way[i];
            rest[i] -= along * image[i];
            next += rest[i] * scaled(i);
        }
        for (std::size_t i = 0; i < count; ++i)
            way[i] = scaled(i) + next / length * way[i];
        length = next;
    }
    for (std::size_t i = 0; i < count; ++i) {
        float& value = visibility.values[rows.texels()[i]];
        value = static_cast<float>(std::clamp(value + change[i], 0.0, 1.0));
    }
}

}  // namespace surfelao
