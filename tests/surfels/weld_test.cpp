#include "surfels/weld.h"

#include "scenes.h"
#include "surfels/surface.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

using scenes::operator+;

/// Every triangle with corners of its own, as in STL: corner c of triangle t is vertex 3 t + c. All
/// moved by up to `noise` along each axis, either way.
Scene torn(const Scene& scene, double noise = 0.0)
{
    std::mt19937 random(5);
    const auto step = [&] { return noise * (random() / 2147483648.0 - 1.0); };
    Scene result;
    for (const glm::uvec3 t : scene.triangles) {
        const auto first = static_cast<std::uint32_t>(result.positions.size());
        for (int corner = 0; corner < 3; ++corner) {
            const double x = step(), y = step(), z = step();
            result.positions.push_back(scene.positions[t[corner]] + glm::dvec3(x, y, z));
        }
        result.triangles.emplace_back(first, first + 1, first + 2);
    }
    return result;
}

/// Corners are at one place where those of `whole` are one vertex, and only there.
void expect_places_of(const Scene& whole, const std::vector<std::uint32_t>& welded)
{
    std::vector<std::uint32_t> place_of(whole.positions.size(), 0xffffffff);
    std::set<std::uint32_t> places;
    for (std::uint32_t corner = 0; corner < welded.size(); ++corner) {
        std::uint32_t& place = place_of[whole.triangles[corner / 3][static_cast<int>(corner % 3)]];
        if (place == 0xffffffff)
            place = corner;  // the lowest
        ASSERT_EQ(welded[corner], place) << "corner " << corner;
        places.insert(place);
    }
    EXPECT_EQ(places.size(), whole.positions.size());
}

std::size_t count_places(const std::vector<std::uint32_t>& welded)
{
    return std::set(welded.begin(), welded.end()).size();
}

TEST(Weld, NoiseOnATornMeshIsTakenOut)
{
    const Scene whole = scenes::sphere({0, 0, 0}, 1.0, 12);
    const Geometry clean = make_geometry(whole);
    const Surface expected = make_surface(whole, clean);
    const Scene noisy = torn(whole, 3e-7 * clean.frame.diagonal);
    const Geometry geometry = make_geometry(noisy);
    expect_places_of(whole, geometry.welded);
    const Surface found = make_surface(noisy, geometry);
    for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_LT(glm::distance(found.normals[found.corners(geometry)[t][corner]],
                                    expected.normals[expected.corners(clean)[t][corner]]),
                      1e-4f);
    }
}

TEST(Weld, DoesNotDependOnTheOrderOfTheVertices)
{
    const Scene whole = scenes::bumpy_sphere(8);
    Scene noisy = torn(whole, 6e-7);
    Scene reversed = noisy;
    std::ranges::reverse(reversed.positions);
    const auto count = static_cast<std::uint32_t>(noisy.positions.size());
    for (glm::uvec3& t : reversed.triangles)
        t = glm::uvec3(count - 1) - t;
    const std::vector<std::uint32_t> one = weld(noisy, 2.0), other = weld(reversed, 2.0);
    expect_places_of(whole, one);
    for (std::uint32_t a = 0; a < count; ++a)
        EXPECT_EQ(other[count - 1 - a], other[count - 1 - one[a]]);
    EXPECT_EQ(count_places(one), count_places(other));
}

// Cells of 1e-7 diagonals.
TEST(Weld, AClosedMeshStaysAsItIsHoweverFine)
{
    const Scene closed = scenes::sphere({0, 0, 0}, 1.0, 16);
    const std::vector<std::uint32_t> welded = weld(closed, 1e6);
    for (std::uint32_t v = 0; v < welded.size(); ++v)
        EXPECT_EQ(welded[v], v);
}

TEST(Weld, ASmallTornObjectKeepsItsShape)
{
    const Scene whole = scenes::sphere({0.3, 0.2, 0.1}, 1.0, 16);
    expect_places_of(whole, weld(torn(whole), 1e5));
}

TEST(Weld, NeverTakesTheEndsOfAnEdgeForOnePlace)
{
    // open and finer than noise either way; needles; every triangle by itself
    const Scene sheet = scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 10);
    const Scene needles =
        scenes::grid(100, 1, [](double s, double t) { return glm::dvec3(s, 1000.0 * t, 0.0); });
    for (const Scene& scene : {sheet, needles, torn(sheet, 0.03), torn(needles, 0.003)}) {
        for (const double diagonal : {1e3, 1e4, 1e5, 1e7}) {
            const std::vector<std::uint32_t> welded = weld(scene, diagonal);
            for (const glm::uvec3 t : scene.triangles) {
                EXPECT_NE(welded[t.x], welded[t.y]) << diagonal;
                EXPECT_NE(welded[t.y], welded[t.z]) << diagonal;
                EXPECT_NE(welded[t.z], welded[t.x]) << diagonal;
            }
        }
    }
}

TEST(Weld, JoinsWithinItsDistanceAndNotBeyond)
{
    // cells of the search begin anywhere between the two
    for (const double at : {0.0, 0.37, -0.12345678}) {
        for (const auto& [gap, places] : {std::pair(1.9e-6, 5u), {5e-6, 6u}}) {
            const Scene scene =
                scenes::triangle({at, at, at}, {at + 0.1, at, at}, {at, at + 0.1, at}) +
                scenes::triangle({at - gap, at, at}, {at - 0.1, at, at}, {at, at, at + 0.1});
            EXPECT_EQ(count_places(weld(scene, 1.0)), places) << gap << " at " << at;
        }
    }
}

/// Its corner 0 at (x, 0, 0), the others `size` away.
Scene corner_at(double x, double size, double direction)
{
    return scenes::triangle({x, 0, 0}, {x, size, 0}, {x + direction * size, 0, size});
}

TEST(Weld, TheSmallerOfTwoTrianglesSaysWhatIsNoise)
{
    const Scene large = corner_at(0.0, 0.1, -1.0), small = corner_at(1.5e-6, 4e-6, 1.0);
    EXPECT_EQ(count_places(weld(large + small, 1.0)), 6u);
    EXPECT_EQ(count_places(weld(small + large, 1.0)), 6u);
}

TEST(Weld, CornersJoinTheirOwnPlaceOfSeveralNearby)
{
    // 0 and 3 too far apart; 6 beside 0; 9 at exactly 6
    const std::vector<std::uint32_t> welded =
        weld(corner_at(2e-7, 0.1, 1.0) + corner_at(3.4e-6, 0.11, 1.0) + corner_at(4e-7, 0.12, 1.0) +
                 corner_at(4e-7, 0.13, 1.0),
             1.0);
    EXPECT_EQ(welded[3], 3u);
    EXPECT_EQ(welded[6], 0u);
    EXPECT_EQ(welded[9], 0u);
}

// What occludes may be any number of diagonals away; a loop that counts cells there never ends.
TEST(Weld, EndsFarBeyondTheDiagonal)
{
    const Scene far = scenes::triangle({1e28, 0, 0}, {0, 1e28, 0}, {0, 0, -1e300});
    EXPECT_EQ(count_places(weld(far, 1.0)), 3u);
}

TEST(Weld, EqualPositionsAreOnePlaceWhereverTheyStand)
{
    Scene scene = scenes::box({0, 0, 0}, {1, 1, 1}, 1);
    scene.positions.push_back(scene.positions[3]);  // no triangle uses it
    scene.positions.push_back({-0.0, 0.0, 0.0});
    const std::vector<std::uint32_t> welded = weld(scene, 1.0);
    EXPECT_EQ(welded[8], 3u);
    EXPECT_EQ(scene.positions[welded[9]], glm::dvec3(0.0));
    EXPECT_LT(welded[9], 8u);
}

}  // namespace
}  // namespace surfelao
