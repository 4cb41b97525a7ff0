#include "gpu/screen_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace surfelao {
namespace {

constexpr int kSquares = 512;  // a side, of the grid that measures cells: volumes to three digits

/// Steps of the best-spread sequences of one and of two numbers: Roberts, "The Unreasonable
/// Effectiveness of Quasirandom Sequences", 2018.
constexpr double kGolden = 0.6180339887498949;
constexpr double kPlastic = 0.7548776662466927;
constexpr double kPlasticSquared = 0.5698402909980532;

double fraction(double x)
{
    return x - std::floor(x);
}

/// The k-th of n of a sunflower: area r^2 in equal steps, turned by the golden angle.
glm::dvec2 in_sunflower(int k, int n)
{
    const double radius = std::sqrt((k + 0.5) / n);
    const double angle = 2.0 * std::numbers::pi * fraction(k * kGolden);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// of(k, n) for each sample, or for each first of a pair with its opposite behind it.
template <class Of>
std::vector<glm::vec4> samples_of(int count, bool paired, const Of& of)
{
    std::vector<glm::vec4> samples;
    const int n = paired ? count / 2 : count;
    for (int k = 0; k < n; ++k) {
        const glm::vec4 sample(of(k, n));
        samples.push_back(sample);
        if (paired)
            samples.push_back(-sample);
    }
    return samples;
}

/// What of the ball lies over each sample's cell, as shares.
std::vector<double> volumes_of(const std::vector<glm::vec4>& samples)
{
    std::vector<double> volumes(samples.size(), 0.0);
    double all = 0.0;
    for (int row = 0; row < kSquares; ++row) {
        for (int column = 0; column < kSquares; ++column) {
            const double x = (2 * column + 1.0) / kSquares - 1.0;
            const double y = (2 * row + 1.0) / kSquares - 1.0;
            const double height = 1.0 - x * x - y * y;
            if (height <= 0.0)
                continue;
            std::size_t nearest = 0;
            double least = 5.0;  // beyond the square of any distance in the disk
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const double dx = samples[i].x - x, dy = samples[i].y - y;
                const double square = dx * dx + dy * dy;
                if (square < least) {
                    least = square;
                    nearest = i;
                }
            }
            volumes[nearest] += std::sqrt(height);
            all += std::sqrt(height);
        }
    }
    for (double& volume : volumes)
        volume /= all;
    return volumes;
}

}  // namespace

std::vector<glm::vec4> ball_samples(int count, bool paired)
{
    return samples_of(count, paired, [](int k, int n) {
        const double radius = std::cbrt((k + 0.5) / n);
        const double z = 1.0 - 2.0 * fraction((k + 0.5) * kPlastic);
        const double angle = 2.0 * std::numbers::pi * fraction((k + 0.5) * kPlasticSquared);
        const double across = radius * std::sqrt(1.0 - z * z);
        return glm::dvec4(across * std::cos(angle), across * std::sin(angle), radius * z, 0.0);
    });
}

std::vector<glm::vec4> disk_samples(int count, bool paired)
{
    return samples_of(count, paired,
                      [](int k, int n) { return glm::dvec4(in_sunflower(k, n), 0.0, 0.0); });
}

std::vector<glm::vec4> line_samples(int count, bool paired)
{
    std::vector<glm::vec4> samples = disk_samples(count, paired);
    const std::vector<double> volumes = volumes_of(samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        glm::vec4& sample = samples[i];
        sample.z = std::sqrt(1.0f - sample.x * sample.x - sample.y * sample.y);
        sample.w = static_cast<float>(volumes[i]);
    }
    return samples;
}

std::vector<glm::vec2> probe_offsets(int count)
{
    std::vector<glm::vec2> offsets;
    for (int k = count - 1; k >= 0; --k)
        offsets.emplace_back(in_sunflower(k, count));
    return offsets;
}

std::vector<glm::vec2> noise_pairs()
{
    std::vector<glm::vec2> pairs;
    for (std::uint64_t i = 0; i < kNoiseSide * kNoiseSide; ++i) {
        std::uint64_t bits = (i + 1) * 0x9E3779B97F4A7C15u;  // SplitMix64
        bits = (bits ^ bits >> 30) * 0xBF58476D1CE4E5B9u;
        bits = (bits ^ bits >> 27) * 0x94D049BB133111EBu;
        bits ^= bits >> 31;
        pairs.emplace_back(static_cast<float>(bits >> 40) * 0x1p-24f,
                           static_cast<float>(bits >> 8 & 0xffffffu) * 0x1p-24f);
    }
    pairs[0] = {0.37f, 0.62f};
    return pairs;
}

}  // namespace surfelao
