#include "grid/cone.h"

#include "random.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace surfelao {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;

/// Of directions even over the sphere, how many of a million: a standard error of .0005 at most.
template <class Visit>
void for_each_direction(const Visit& visit)
{
    Random random(7);
    for (int k = 0; k < 1'000'000; ++k)
        visit(random.direction());
}

TEST(Cone, AnOpenCapHidesItsSineSquared)
{
    EXPECT_NEAR(clipped_cap(std::cos(30.0 * kDegree), 1.0), 0.25, 1e-12);
    EXPECT_NEAR(clipped_cap(std::cos(20.0 * kDegree), std::cos(60.0 * kDegree)),
                std::pow(std::sin(20.0 * kDegree), 2.0) * 0.5, 1e-12);
    EXPECT_EQ(clipped_cap(std::cos(20.0 * kDegree), std::cos(111.0 * kDegree)), 0.0);
}

TEST(Cone, HalfASphereHidesHalfOfOneMoreTheCosine)
{
    for (int b = 0; b <= 180; b += 10)
        EXPECT_NEAR(clipped_cap(0.0, std::cos(b * kDegree)), 0.5 * (1.0 + std::cos(b * kDegree)),
                    1e-12)
            << b;
}

TEST(Cone, TheWholeSphereHidesAll)
{
    EXPECT_EQ(clipped_cap(-1.0, 0.3), 1.0);
    EXPECT_EQ(clipped_cap(1.0, 0.3), 0.0);
}

TEST(Cone, ACapHidesLessTheFartherItIsFromTheNormal)
{
    for (double cos_half = -0.95; cos_half < 1.0; cos_half += 0.05) {
        double last = 1.0;
        for (int b = 0; b <= 180; ++b) {
            const double share = clipped_cap(cos_half, std::cos(b * kDegree));
            EXPECT_LE(share, last + 1e-12) << cos_half << " " << b;
            last = share;
        }
        EXPECT_GE(last, 0.0);
    }
}

TEST(Cone, ClippedCapsAreTheirIntegrals)
{
    constexpr double kCases[][2] = {{40, 20}, {40, 80}, {40, 110}, {75, 60}, {110, 40}, {150, 170}};
    double sums[6] = {};
    for_each_direction([&](glm::dvec3 w) {
        for (int k = 0; k < 6; ++k) {
            const double b = kCases[k][1] * kDegree;
            const bool in_cap =
                w.x * std::sin(b) + w.z * std::cos(b) > std::cos(kCases[k][0] * kDegree);
            sums[k] += in_cap && w.z > 0.0 ? 4e-6 * w.z : 0.0;
        }
    });
    for (int k = 0; k < 6; ++k)
        EXPECT_NEAR(clipped_cap(std::cos(kCases[k][0] * kDegree), std::cos(kCases[k][1] * kDegree)),
                    sums[k], 0.004)
            << k;
}

/// The share of the sphere in a cap.
double share_of(double half_degrees)
{
    return 0.5 * (1.0 - std::cos(half_degrees * kDegree));
}

TEST(Cone, CapsTogetherHideTheirSumOrTheLarger)
{
    const double small = share_of(20), large = share_of(50);
    EXPECT_NEAR(merged_caps(small, large, std::cos(80 * kDegree)), small + large, 1e-12);
    EXPECT_NEAR(merged_caps(small, large, std::cos(25 * kDegree)), large, 1e-12);
    EXPECT_NEAR(merged_caps(share_of(120), share_of(100), -1.0), 1.0, 1e-12);
    EXPECT_NEAR(merged_caps(small, large, 0.6), merged_caps(large, small, 0.6), 1e-12);
    EXPECT_NEAR(merged_caps(0.0, large, 0.6), large, 1e-12);
}

TEST(Cone, CapsTogetherHideTheirUnion)
{
    constexpr double kCases[][3] = {{40, 30, 50}, {60, 60, 60}, {100, 50, 90}, {120, 100, 130}};
    double sums[4] = {};
    for_each_direction([&](glm::dvec3 w) {
        for (int k = 0; k < 4; ++k) {
            const double d = kCases[k][2] * kDegree;
            const bool in_first = w.z > std::cos(kCases[k][0] * kDegree);
            const bool in_second =
                w.x * std::sin(d) + w.z * std::cos(d) > std::cos(kCases[k][1] * kDegree);
            sums[k] += in_first || in_second ? 1e-6 : 0.0;
        }
    });
    for (int k = 0; k < 4; ++k)
        EXPECT_NEAR(merged_caps(share_of(kCases[k][0]), share_of(kCases[k][1]),
                                std::cos(kCases[k][2] * kDegree)),
                    sums[k], 0.002)
            << k;
}

/// The moments of a cap hidden to a share, along z.
glm::vec4 moments_of_cap(double half_degrees, float cover)
{
    const double sine = std::sin(half_degrees * kDegree);
    const auto mean = static_cast<float>(0.25 * sine * sine);
    return cover * glm::vec4(0.0f, 0.0f, mean, static_cast<float>(share_of(half_degrees)));
}

TEST(Cone, ACapIsFoundInItsMoments)
{
    for (const double half : {10.0, 60.0, 90.0, 140.0}) {
        for (const float cover : {1.0f, 0.4f}) {
            const Cone cone = cone_of(moments_of_cap(half, cover));
            EXPECT_NEAR(cone.cos_half, std::cos(half * kDegree), 2e-5) << half;
            EXPECT_NEAR(cone.cover, cover, 2e-5) << half;
            EXPECT_NEAR(cone.axis.z, 1.0f, 1e-6f) << half;
        }
    }
}

TEST(Cone, NothingAndEverythingHaveNoDirection)
{
    EXPECT_EQ(occlusion_by(cone_of(glm::vec4(0.0f)), {0, 0, 1}), 0.0f);
    EXPECT_EQ(occlusion_by(cone_of({0, 0, 0, 1}), {0, 0, 1}), 1.0f);
    // more than a direction alone can have, by rounding
    EXPECT_NEAR(occlusion_by(cone_of({0, 0, 0.011f, 0.01f}), {0, 0, 1}), 0.0396f, 1e-5f);
}

TEST(Harmonics, AreOrthonormal)
{
    double sums[kHarmonics][kHarmonics] = {};
    for_each_direction([&](glm::dvec3 w) {
        const Harmonics y = harmonics_along(glm::vec3(w));
        for (std::size_t i = 0; i < kHarmonics; ++i)
            for (std::size_t j = 0; j < kHarmonics; ++j)
                sums[i][j] += 4e-6 * pi * y[i] * y[j];
    });
    for (std::size_t i = 0; i < kHarmonics; ++i)
        for (std::size_t j = 0; j < kHarmonics; ++j)
            EXPECT_NEAR(sums[i][j], i == j ? 1.0 : 0.0, 0.006) << i << " " << j;
}

TEST(Harmonics, OfHalfASphereTellItsMomentsAndItsCosine)
{
    Harmonics half{};
    for_each_direction([&](glm::dvec3 w) {
        const Harmonics y = harmonics_along(glm::vec3(w));
        for (std::size_t i = 0; i < kHarmonics && w.x > 0.0; ++i)
            half[i] += static_cast<float>(4e-6 * pi) * y[i];
    });
    const glm::vec4 moments = moments_of(GridStore::sh, half.data());
    EXPECT_NEAR(moments.w, 0.5f, 0.002f);
    EXPECT_NEAR(moments.x, 0.25f, 0.002f);
    EXPECT_NEAR(moments.y, 0.0f, 0.002f);
    for (const double b : {0.0, 45.0, 90.0, 180.0}) {
        const glm::vec3 normal(std::cos(b * kDegree), std::sin(b * kDegree), 0.0);
        EXPECT_NEAR(occlusion_of(GridStore::sh, half.data(), normal),
                    0.5 * (1.0 + std::cos(b * kDegree)), 0.004)
            << b;
    }
}

}  // namespace
}  // namespace surfelao
