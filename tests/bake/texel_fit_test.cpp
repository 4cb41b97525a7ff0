#include "bake/texel_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace surfelao {
namespace {

constexpr std::uint32_t kWide = 12, kHigh = 5;

/// Samples of the columns begin to end, three times three a texel, of a function of x in texels.
std::vector<TexelSample> samples_of(const std::function<double(double)>& seen, double begin,
                                    double end)
{
    std::vector<TexelSample> samples;
    for (int row = 0; row < 3 * static_cast<int>(kHigh); ++row)
        for (double x = begin + 1.0 / 6.0; x < end; x += 1.0 / 3.0)
            samples.push_back(
                {{x / kWide, (row + 0.5) / (3.0 * kHigh)}, static_cast<float>(seen(x)), 1.0f});
    return samples;
}

double squared_error(const Map& map, const std::vector<TexelSample>& samples)
{
    double sum = 0.0;
    for (const TexelSample& sample : samples)
        sum += std::pow(fetch(map, 0, glm::dvec2(sample.uv)) - double{sample.visibility}, 2.0);
    return sum / static_cast<double>(samples.size());
}

/// Asked at the centres of its texels, of which some are known.
struct AskedMap {
    AskedMap(const std::function<double(double)>& seen, std::uint32_t known_end)
        : map(kWide, kHigh, 1), known(map.texels(), 0)
    {
        for (std::size_t i = 0; i < map.texels(); ++i) {
            known[i] = i % kWide < known_end ? 1 : 0;
            map.values[i] =
                static_cast<float>(seen(std::min<double>(i % kWide, known_end - 1.0) + 0.5));
        }
    }
    Map map;
    std::vector<std::uint8_t> known;
};

TEST(TexelFit, MarksKnownTexelsBesideSteps)
{
    AskedMap asked([](double x) { return x < 4.0 ? 0.3 : 0.3 + 1.01 * kFitStep; }, 8);
    const std::vector<std::uint8_t> marked = texels_with_steps(asked.map, asked.known);
    ASSERT_EQ(marked.size(), asked.map.texels());
    for (std::size_t i = 0; i < marked.size(); ++i)
        EXPECT_EQ(marked[i], i % kWide == 3 || i % kWide == 4 ? 1 : 0) << i;
    // what fills a texel that nothing covers makes no step
    asked.known.assign(asked.known.size(), 1);
    for (std::size_t i = 4; i < asked.known.size(); i += kWide)
        asked.known[i] = 0;
    EXPECT_TRUE(texels_with_steps(asked.map, asked.known).empty());
    const AskedMap ramp([](double x) { return 0.06 * x; }, kWide);
    EXPECT_TRUE(texels_with_steps(ramp.map, ramp.known).empty());
}

// Wherever in a texel a step lies: of the squared error a fifth goes at least, though only texels
// beside the step may move; those far from it stay.
TEST(TexelFit, ShowsAStepWhereItLies)
{
    double before = 0.0, after = 0.0;
    for (int i = 0; i < 8; ++i) {
        const double step = 5.5 + i / 8.0;
        const auto seen = [&](double x) { return x < step ? 0.1 : 0.8; };
        AskedMap asked(seen, kWide);
        const std::vector<TexelSample> all = samples_of(seen, 1.0, kWide - 1.0);
        before += squared_error(asked.map, all);
        const std::vector<std::uint8_t> marked = texels_with_steps(asked.map, asked.known);
        ASSERT_FALSE(marked.empty());
        const Map old = asked.map;
        fit_texels(asked.map, asked.known, marked, samples_of(seen, 5.0, 7.0));
        after += squared_error(asked.map, all);
        for (std::size_t row = 0; row < kHigh; ++row)
            for (const std::size_t x : {0u, 1u, 2u, 3u, 8u, 9u, 10u, 11u})
                EXPECT_EQ(asked.map.values[row * kWide + x], old.values[row * kWide + x]) << x;
    }
    EXPECT_LT(after, 0.8 * before);
}

// A chart that ends amid a texel: beyond its border goes on what is seen before it, whatever
// stood there.
TEST(TexelFit, ContinuesASlopeBeyondTheBorder)
{
    const auto seen = [](double x) { return 0.05 + 0.24 * (x - 4.0); };
    AskedMap asked([](double) { return 0.4; }, 7);
    const std::vector<std::uint8_t> marked(asked.known.begin(), asked.known.end());
    const std::vector<TexelSample> slope = samples_of(seen, 4.0, 7.0);
    fit_texels(asked.map, asked.known, marked, slope);
    EXPECT_LT(std::sqrt(squared_error(asked.map, slope)), 0.01);
}

}  // namespace
}  // namespace surfelao
