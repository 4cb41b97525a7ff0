// The text of the kernels, compiled once more for this test, so that its parts can be asked alone.
#define SURFELAO_MASK_ISA mask_under_test
#define SURFELAO_MASK_ISA_NAME "under test"
#include "tree/masks/kernel_body.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace surfelao::mask_under_test {
namespace {

const MaskRaster* const kRasters[] = {&mask_raster(), &mask_raster(kMaskCoarseRows)};

glm::dvec3 direction_of(const MaskRaster& raster, int face, int y, int x)
{
    const double u = (x + double(raster.row_shift[y])) / 16.0 - 1.0;
    const int axis = face / 2;
    glm::dvec3 d;
    d[axis] = face % 2 == 0 ? 1.0 : -1.0;
    d[(axis + 1) % 3] = u;
    d[(axis + 2) % 3] = raster.row_v[y];
    return d;
}

/// Sine of the angle by which a direction lies inside of all edges; negative: outside.
double inside_by(const std::vector<glm::dvec3>& corner, glm::dvec3 direction)
{
    const double turn = glm::dot(glm::cross(corner[0], corner[1]), corner[2]) < 0.0 ? -1.0 : 1.0;
    double least = 1.0;
    for (std::size_t i = 0; i < corner.size(); ++i) {
        const glm::dvec3 n = glm::cross(corner[i], corner[(i + 1) % corner.size()]);
        least = std::min(least, turn * glm::dot(glm::normalize(n), glm::normalize(direction)));
    }
    return least;
}

/// The bits within each of the limits.
template <int kCorners>
std::vector<std::vector<std::uint32_t>> drawn_within(const MaskRaster& raster,
                                                     const std::vector<glm::dvec3>& corner,
                                                     const MaskLimits& limits)
{
    alignas(64) float columns[3 * kCorners][kLanes] = {};
    alignas(64) std::uint32_t target[kLanes] = {};
    for (int i = 0; i < kCorners; ++i) {
        for (int k = 0; k < 3; ++k)
            columns[3 * i + k][0] = static_cast<float>(corner[static_cast<std::size_t>(i)][k]);
    }
    alignas(64) std::uint32_t mask[kMaskMostLimits * kMaskPairWords] = {};
    draw<kCorners, kLanes, false>(raster, limits, columns[0], target, 1, mask);
    std::vector<std::vector<std::uint32_t>> within;
    for (unsigned k = 0; k < limits.count; ++k) {
        std::vector<std::uint32_t> bits(mask + k * kMaskPairWords,
                                        mask + k * kMaskPairWords + kMaskWords);
        for (std::size_t w = 0; k > 0 && w < bits.size(); ++w)
            bits[w] |= within.back()[w];
        within.push_back(bits);
    }
    return within;
}

template <int kCorners>
std::vector<std::uint32_t> drawn(const MaskRaster& raster, const std::vector<glm::dvec3>& corner,
                                 float limit = std::numeric_limits<float>::infinity())
{
    return drawn_within<kCorners>(raster, corner, {1, {limit}, {1.0f}, 0.0f}).front();
}

template <int kCorners>
void expect_point_in_polygon(const MaskRaster& raster, const std::vector<glm::dvec3>& corner)
{
    const std::vector<std::uint32_t> mask = drawn<kCorners>(raster, corner);
    for (int face = 0; face < kMaskFaces; ++face) {
        for (int y = 0; y < raster.rows; ++y) {
            for (int x = 0; x < 32; ++x) {
                const double depth = inside_by(corner, direction_of(raster, face, y, x));
                // nearer than this to an edge, rounding decides
                if (std::abs(depth) < 1e-5)
                    continue;
                const bool set = mask[static_cast<std::size_t>(raster.rows * face + y)] >> x & 1u;
                ASSERT_EQ(set, depth > 0.0) << "face " << face << " row " << y << " column " << x;
            }
        }
    }
}

TEST(MaskRaster, TrianglesAreTheirPoints)
{
    std::mt19937 random(3);
    const auto number = [&] { return random() / 2147483648.0 - 1.0; };
    for (int i = 0; i < 400; ++i) {
        const double size = std::pow(10.0, number() - 0.5);
        const glm::dvec3 center(number(), number(), number());
        std::vector<glm::dvec3> corner;
        for (int k = 0; k < 3; ++k)
            corner.push_back(center + size * glm::dvec3(number(), number(), number()));
        expect_point_in_polygon<3>(*kRasters[i % 2], corner);
    }
}

TEST(MaskRaster, RectanglesAreTheirPoints)
{
    std::mt19937 random(4);
    const auto number = [&] { return random() / 2147483648.0 - 1.0; };
    for (int i = 0; i < 400; ++i) {
        const glm::dvec3 center(number(), number(), number());
        const glm::dvec3 a = 0.4 * glm::dvec3(number(), number(), number());
        const glm::dvec3 b = 0.2 * glm::cross(a, glm::dvec3(number(), number(), number()));
        expect_point_in_polygon<4>(
            *kRasters[i % 2], {center + a + b, center - a + b, center - a - b, center + a - b});
    }
}

// Only what is nearer than the limit: the plane's distance along the direction decides.
/// Products of corners that are next to each other are rounding; what they enclose could be half of
/// all directions.
TEST(MaskRaster, SpecksAndSliversDrawNextToNothing)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
    const auto point = [&] {
        return glm::dvec3(anywhere(random), anywhere(random), anywhere(random));
    };
    const auto count = [](const std::vector<std::uint32_t>& mask) {
        int bits = 0;
        for (const std::uint32_t word : mask)
            bits += std::popcount(word);
        return bits;
    };
    for (int round = 0; round < 1000; ++round) {
        const glm::dvec3 at = point();
        EXPECT_EQ(count(drawn<4>(mask_raster(), {at, at, at, at})), 0);
        EXPECT_EQ(count(drawn<3>(mask_raster(), {at, at, at})), 0);
        for (const double size : {1e-3, 1e-5, 1e-6, 1e-7}) {
            const glm::dvec3 u = size * point();
            const glm::dvec3 v = 1e-3 * size * point();
            EXPECT_LE(
                count(drawn<4>(mask_raster(), {at + u + v, at - u + v, at - u - v, at + u - v})),
                4);
            EXPECT_LE(count(drawn<3>(mask_raster(), {at + u, at + v, at - u - v})), 4);
        }
    }
}

TEST(MaskRaster, ALimitCutsWherePlanesAreTooFar)
{
    std::mt19937 random(5);
    const auto number = [&] { return random() / 2147483648.0 - 1.0; };
    int cut = 0;
    for (int i = 0; i < 400; ++i) {
        std::vector<glm::dvec3> corner;
        for (int k = 0; k < 3; ++k)
            corner.push_back({number(), number(), number()});
        const double limit = 0.2 + 0.5 * (number() + 1.0);
        const MaskRaster& raster = *kRasters[i % 2];
        const std::vector<std::uint32_t> mask = drawn<3>(raster, corner, static_cast<float>(limit));
        const glm::dvec3 n =
            glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
        for (int face = 0; face < kMaskFaces; ++face) {
            for (int y = 0; y < raster.rows; ++y) {
                for (int x = 0; x < 32; ++x) {
                    const glm::dvec3 direction = glm::normalize(direction_of(raster, face, y, x));
                    const double depth = inside_by(corner, direction);
                    const double distance = glm::dot(n, corner[0]) / glm::dot(n, direction);
                    if (std::abs(depth) < 1e-5 || std::abs(distance - limit) < 1e-3 * limit)
                        continue;
                    const bool set =
                        mask[static_cast<std::size_t>(raster.rows * face + y)] >> x & 1u;
                    ASSERT_EQ(set, depth > 0.0 && distance < limit)
                        << "triangle " << i << " face " << face << " row " << y << " column " << x;
                    cut += depth > 0.0 && distance > limit;
                }
            }
        }
    }
    EXPECT_GT(cut, 1000);
}

// One drawing for all limits.
TEST(MaskRaster, WithinEachOfSeveralLimitsIsWhatOneAloneDraws)
{
    std::mt19937 random(5);
    const auto number = [&] { return random() / 2147483648.0 - 1.0; };
    const MaskLimits limits{3, {0.3f, 0.6f, 1.1f}, {0.2f, 0.3f, 0.5f}, 0.0f};
    for (int i = 0; i < 400; ++i) {
        std::vector<glm::dvec3> corner;
        for (int k = 0; k < 3; ++k)
            corner.push_back({number(), number(), number()});
        const auto within = drawn_within<3>(*kRasters[i % 2], corner, limits);
        for (unsigned k = 0; k < limits.count; ++k)
            ASSERT_EQ(within[k], drawn<3>(*kRasters[i % 2], corner, limits.distance[k]))
                << i << " within " << k;
    }
}

/// Moments of half-spaces cut by another, against sums over the bits' own directions.
TEST(MaskRaster, MomentsAreSumsOverBits)
{
    std::mt19937 random(7);
    const auto number = [&] { return random() / 2147483648.0 - 1.0; };
    double most_first = 0.0;
    double most_second = 0.0;
    for (int i = 0; i < 200; ++i) {
        const MaskRaster& raster = *kRasters[i % 2];
        alignas(64) std::uint32_t above[kMaskWords] = {};
        alignas(64) std::uint32_t open[kMaskWords] = {};
        const float n[3] = {float(number()), float(number()), float(number())};
        const float cut[3] = {float(number()), float(number()), float(number())};
        horizon(raster, n, above);
        horizon(raster, cut, open);
        glm::dvec3 first(0.0);
        glm::dmat3 second(0.0);
        for (int face = 0; face < kMaskFaces; ++face) {
            for (int y = 0; y < raster.rows; ++y) {
                open[raster.rows * face + y] &= above[raster.rows * face + y];
                for (int x = 0; x < 32; ++x) {
                    if (!(open[raster.rows * face + y] >> x & 1u))
                        continue;
                    const glm::dvec3 d = direction_of(raster, face, y, x);
                    const double length = glm::length(d);
                    const double v = raster.row_v[y];
                    const double solid_angle = (1.0 + v * v) / std::pow(length, 3.0);
                    first += 127.0 * solid_angle * d / length;
                    second += 127.0 * solid_angle / (length * length) * glm::outerProduct(d, d);
                }
            }
        }
        First of_open, of_above;
        first_moments(raster, open, above, of_open, of_above);
        const Second of_second = second_moments(raster, open);
        for (int k = 0; k < 3; ++k) {
            // of so much of a hemisphere
            const double all = 127.0 * 500.0 * raster.rows / kMaskRows;
            most_first = std::max(most_first, std::abs(of_open.at[k] - first[k]) / all);
            most_second = std::max({most_second, std::abs(of_second.at[k] - second[k][k]) / all,
                                    std::abs(of_second.at[3 + k] - second[k][(k + 1) % 3]) / all});
        }
        First of_none, again;
        alignas(64) const std::uint32_t none[kMaskWords] = {};
        first_moments(raster, none, above, of_none, again);
        EXPECT_EQ(of_none.along(n), 0.0f);
        EXPECT_EQ(again.along(n), of_above.along(n));
    }
    // means over two bits and over four
    EXPECT_LT(most_first, 0.002);
    EXPECT_LT(most_second, 0.005);
}

// No half-plane is changed by the filling, whichever way its edge runs; a hole of one bit is
// closed.
TEST(MaskRaster, FillingKeepsHalfPlanes)
{
    std::mt19937 random(6);
    const auto number = [&] { return random() / 2147483648.0 - 1.0; };
    for (int i = 0; i < 2000; ++i) {
        const MaskRaster& raster = *kRasters[i % 2];
        const float normal[3] = {float(number()), float(number()), float(number())};
        alignas(64) std::uint32_t above[kMaskWords] = {};
        horizon(raster, normal, above);
        for (int w = 0; w < raster.words; w += kLanes) {
            alignas(64) std::uint32_t filled[kLanes];
            store(filled, fill(raster, load(above + w), load(above + w)));
            for (int y = 0; y < kLanes; ++y)
                ASSERT_EQ(filled[y], above[w + y]) << "half-plane " << i << " row " << y;
            store(filled, close(raster, load(above + w), load(above + w)));
            for (int y = 0; y < kLanes; ++y)
                ASSERT_EQ(filled[y], above[w + y]) << "half-plane " << i << " row " << y;
        }
    }
    const MaskRaster& raster = mask_raster();
    alignas(64) std::uint32_t hole[kLanes];
    std::fill(hole, hole + kLanes, ~0u);
    hole[7] = ~(1u << 13);
    alignas(64) std::uint32_t filled[kLanes];
    store(filled, fill(raster, load(hole), all(~0u)));
    EXPECT_EQ(filled[7], ~0u);
    store(filled, fill(raster, load(hole), all(0u)));
    EXPECT_EQ(filled[7], hole[7]) << "no sheet beside it";
}

// Two cracks of one bit that filling closes: one by itself, one that ends in an opening.
TEST(MaskRaster, ANotchInTheRimOfAnOpeningIsNoCrack)
{
    const MaskRaster& raster = mask_raster();
    alignas(64) std::uint32_t mask[kLanes];
    std::fill(mask, mask + kLanes, ~0u);
    mask[3] = ~(1u << 20);
    for (int y = 8; y < 12; ++y)
        mask[y] = ~(0xffu << 4);
    mask[12] = ~(1u << 8);
    alignas(64) std::uint32_t filled[kLanes];
    store(filled, fill(raster, load(mask), all(~0u)));
    EXPECT_EQ(filled[3], ~0u);
    EXPECT_EQ(filled[12], ~0u);

    alignas(64) std::uint32_t open[kLanes];
    store(open, openings(raster, ~load(mask), load(filled)));
    for (int y = 0; y < kLanes; ++y)
        EXPECT_EQ(open[y], y == 3 ? 0u : ~mask[y]) << "row " << y;
}

TEST(MaskRaster, APlaceIsClosedWithoutOpenBitsOrWithVeryFew)
{
    const MaskRaster& raster = mask_raster();
    for (int face = 0; face < kMaskFaces; ++face) {
        float n[3] = {0.1f, 0.2f, 0.3f};
        n[face / 2] = face % 2 == 0 ? 1.0f : -1.0f;
        for (int open_face = 0; open_face < kMaskFaces; ++open_face) {
            alignas(64) std::uint32_t pair[kMaskPairWords];
            std::fill(pair, pair + kMaskWords, ~0u);
            std::fill(pair + kMaskWords, pair + kMaskPairWords, 0u);
            std::uint32_t* row = pair + kMaskFaceWords * open_face;
            EXPECT_TRUE(is_closed(raster, pair, n));
            row[5] = row[9] = ~0x00010010u;
            EXPECT_TRUE(is_closed(raster, pair, n)) << "four bits of face " << open_face;
            row[12] = ~0x00000400u;
            EXPECT_FALSE(is_closed(raster, pair, n)) << "five bits of face " << open_face;
            std::fill(pair + kMaskWords, pair + kMaskPairWords, ~0u);
            EXPECT_TRUE(is_closed(raster, pair, n)) << "cracks between sheets";
            row[5] = row[6] = row[7] = row[8] = ~0x000ff000u;
            EXPECT_FALSE(is_closed(raster, pair, n)) << "a hole between sheets";
        }
    }
}

// A fan right above, off by one rounding: edges through a face's centre, all but upright.
TEST(MaskRaster, SlicesThatMeetOverhead)
{
    for (const double away : {0.0, 1e-9, 1e-8, 1e-3}) {
        for (int i = 0; i < 128; ++i) {
            const auto rim = [](int k) {
                const double angle = 2.0 * 3.14159265358979 * k / 128.0;
                return glm::dvec3(float(0.35 * std::cos(angle)), float(0.35 * std::sin(angle)),
                                  0.07f);
            };
            expect_point_in_polygon<3>(
                mask_raster(),
                {glm::dvec3(float(away), float(0.7 * away), 0.07f), rim(i + 1), rim(i)});
        }
    }
}

}  // namespace
}  // namespace surfelao::mask_under_test
