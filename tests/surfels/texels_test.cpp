#include "surfels/texels.h"

#include "scenes.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace surfelao {
namespace {

using Place = std::pair<std::uint32_t, std::uint32_t>;

/// A square of cells * cells quads whose map is `place` of where a point lies in it.
struct Square {
    Square(int cells, const std::function<glm::dvec2(glm::dvec2)>& place)
        : scene(scenes::sheet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells)),
          geometry(make_geometry(scene))
    {
        for (const glm::dvec3 p : scene.positions)
            uvs.values.push_back(place({p.x, p.y}));
    }
    Scene scene;
    Geometry geometry;
    UvSet uvs;
};

glm::dvec2 same(glm::dvec2 p)
{
    return p;
}

/// Where in the square the texel's point lies.
glm::dvec2 point_of(const Square& square, const Texel& texel)
{
    const glm::uvec3 t = square.geometry.triangles[texel.point.triangle];
    const auto& p = square.scene.positions;
    const double b = texel.point.at.x, c = texel.point.at.y;
    return glm::dvec2((1 - b - c) * p[t.x] + b * p[t.y] + c * p[t.z]);
}

std::vector<Texel> all_texels(const Square& square, MapSize size)
{
    return MapRaster(square.geometry, square.uvs, size).texels(0, size.height);
}

// Edges of triangles pass through centres of texels: each is one triangle's, none is nobody's.
TEST(Texels, OfAFullPageAreEachAskedOnceAtTheirCentre)
{
    for (const int cells : {1, 4, 5}) {
        const Square square(cells, same);
        for (const MapSize size : {MapSize{8, 8}, {7, 3}, {1, 1}, {64, 40}}) {
            const std::vector<Texel> texels = all_texels(square, size);
            ASSERT_EQ(texels.size(), size.count()) << cells;
            for (std::size_t i = 0; i < texels.size(); ++i) {
                EXPECT_EQ(texels[i].y * size.width + texels[i].x, i);
                EXPECT_EQ(texels[i].share, 1.0f);
                const glm::dvec2 p = point_of(square, texels[i]);
                EXPECT_NEAR(p.x, (texels[i].x + 0.5) / size.width, 1e-6);
                EXPECT_NEAR(p.y, (texels[i].y + 0.5) / size.height, 1e-6);
            }
        }
    }
}

// A chart from .6 to 2.4 texels: of texels that it covers in part, the middle of that part.
TEST(Texels, AtABorderAreAskedInTheMiddleOfWhatIsCovered)
{
    const Square square(1, [](glm::dvec2 p) { return (0.6 + 1.8 * p) / 4.0; });
    const std::vector<Texel> texels = all_texels(square, {4, 4});
    EXPECT_EQ(texels.size(), 9u);
    for (const Texel& texel : texels) {
        const glm::dvec2 p = 0.6 + 1.8 * point_of(square, texel);
        const bool is_middle = texel.x == 1 && texel.y == 1;
        EXPECT_EQ(texel.share == 1.0f, is_middle);
        EXPECT_LE(texel.share, is_middle ? 1.0f : 0.4f + 1e-6f);
        for (const auto& [at, place] : {std::pair(p.x, texel.x), {p.y, texel.y}}) {
            EXPECT_GT(at, std::max(0.6, double(place)));
            EXPECT_LT(at, std::min(2.4, place + 1.0));
        }
    }
}

// Half turns, mirrors and shifts by whole texels move texels and change nothing else.
TEST(Texels, MoveWithTheirChart)
{
    const MapSize size{32, 32};
    const auto inside = [](glm::dvec2 p) { return 0.125 + 0.5 * p; };
    const auto points = [&](const Square& square, const auto& back) {
        std::map<Place, glm::vec2> found;
        for (const Texel& texel : all_texels(square, size))
            found[back(texel.x, texel.y)] = texel.point.at;
        return found;
    };
    const auto plain =
        points(Square(3, inside), [](std::uint32_t x, std::uint32_t y) { return Place(x, y); });
    EXPECT_EQ(plain.size(), 16u * 16u);
    const auto shifted =
        points(Square(3, [&](glm::dvec2 p) { return inside(p) + glm::dvec2(5, 3) / 32.0; }),
               [](std::uint32_t x, std::uint32_t y) { return Place(x - 5, y - 3); });
    EXPECT_EQ(plain, shifted);
    const auto repeated = points(Square(3, [&](glm::dvec2 p) { return inside(p) + 2.0; }),
                                 [](std::uint32_t x, std::uint32_t y) { return Place(x, y); });
    EXPECT_EQ(plain, repeated);
    const auto mirrored =
        points(Square(3, [&](glm::dvec2 p) { return glm::dvec2(1.0 - inside(p).x, inside(p).y); }),
               [](std::uint32_t x, std::uint32_t y) { return Place(31 - x, y); });
    EXPECT_EQ(plain.size(), mirrored.size());
}

TEST(Texels, OfSheetsOnEachOtherAreAskedOnEach)
{
    // both halves of the square on one place
    Square square(4, [](glm::dvec2 p) { return glm::dvec2(2.0 * std::min(p.x, 1.0 - p.x), p.y); });
    std::map<Place, std::set<int>> halves;
    for (const Texel& texel : all_texels(square, {16, 16}))
        halves[{texel.x, texel.y}].insert(point_of(square, texel).x < 0.5 ? 0 : 1);
    EXPECT_EQ(halves.size(), 256u);
    for (const auto& [place, sides] : halves)
        EXPECT_EQ(sides.size(), 2u);
    // the second half a tile away, where artists put it to be skipped
    UvSet apart;
    for (const glm::uvec3 t : square.scene.triangles) {
        const double middle = (square.scene.positions[t.x].x + square.scene.positions[t.y].x +
                               square.scene.positions[t.z].x) /
                              3.0;
        glm::uvec3 corners;
        for (int k = 0; k < 3; ++k) {
            corners[k] = static_cast<std::uint32_t>(apart.values.size());
            apart.values.push_back(square.uvs.values[t[k]] +
                                   glm::dvec2(middle > 0.5 ? 1.0 : 0.0, 0.0));
        }
        apart.corners.push_back(corners);
    }
    const MapRaster raster(square.geometry, apart, {16, 16});
    EXPECT_EQ(raster.outside_triangles(), 16u);
    const std::vector<Texel> texels = raster.texels(0, 16);
    EXPECT_EQ(texels.size(), 256u);
    for (const Texel& texel : texels)
        EXPECT_LT(point_of(square, texel).x, 0.5);
}

// Triangles far smaller than texels, and none at all of the map.
TEST(Texels, OfAnySizeAreOnesTheyCover)
{
    const Square fine(40, [](glm::dvec2 p) { return 0.25 + 0.5 * p; });
    EXPECT_EQ(all_texels(fine, {8, 8}).size(), 16u);
    const Square dot(4, [](glm::dvec2 p) { return 0.5 + 0.01 * p; });
    const std::vector<Texel> one = all_texels(dot, {8, 8});
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(Place(one[0].x, one[0].y), Place(4, 4));
    const Square flat(2, [](glm::dvec2 p) { return glm::dvec2(p.x, 0.5); });
    const MapRaster none(flat.geometry, flat.uvs, {8, 8});
    EXPECT_EQ(none.flat_triangles(), 8u);
    EXPECT_TRUE(none.texels(0, 8).empty());
    Square odd(2, same);
    odd.uvs.values[0] = {NAN, 0.0};
    odd.uvs.values[8] = {1e9, 0.0};
    EXPECT_EQ(MapRaster(odd.geometry, odd.uvs, {8, 8}).flat_triangles(), 4u);
}

TEST(Texels, AreTheSameHoweverTheRowsAreCut)
{
    const Square square(7, [](glm::dvec2 p) {
        return 0.4 + glm::dvec2(0.3 * p.x - 0.2 * p.y, 0.25 * p.x + 0.31 * p.y);
    });
    const MapRaster raster(square.geometry, square.uvs, {70, 90});
    const std::vector<Texel> whole = raster.texels(0, 90);
    std::vector<Texel> parts;
    for (std::uint32_t first = 0; first < 90; first += 13) {
        const std::vector<Texel> some = raster.texels(first, 13);
        parts.insert(parts.end(), some.begin(), some.end());
    }
    ASSERT_EQ(whole.size(), parts.size());
    double area = 0.0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        EXPECT_EQ(Place(whole[i].x, whole[i].y), Place(parts[i].x, parts[i].y));
        EXPECT_EQ(whole[i].point.at, parts[i].point.at);
        EXPECT_EQ(whole[i].point.triangle, parts[i].point.triangle);
        area += whole[i].share;
    }
    EXPECT_NEAR(area, 70 * 90 * (0.3 * 0.31 + 0.2 * 0.25), 70.0);
}

TEST(Texels, ThatAreWantedAreThoseOfAll)
{
    const Square square(7, [](glm::dvec2 p) {
        return 0.4 + glm::dvec2(0.9 * p.x - 0.2 * p.y, 0.25 * p.x + 0.31 * p.y);  // over the rim
    });
    const MapRaster raster(square.geometry, square.uvs, {72, 90});
    std::vector<std::uint8_t> blocks(std::size_t{24} * 30, 0);
    for (std::size_t i = 0; i < blocks.size(); i += i % 5 + 1)
        blocks[i] = i / 24 % 4 == 1 ? 0 : 1;
    std::vector<Texel> expected = raster.texels(0, 90);
    std::erase_if(expected, [&](const Texel& texel) {
        return blocks[std::size_t{texel.y / 3} * 24 + texel.x / 3] == 0;
    });
    const std::vector<Texel> found = raster.texels(0, 90, {blocks, 3});
    ASSERT_EQ(found.size(), expected.size());
    EXPECT_GT(found.size(), 300u);
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(Place(found[i].x, found[i].y), Place(expected[i].x, expected[i].y));
        EXPECT_EQ(found[i].point.at, expected[i].point.at);
    }
}

TEST(Texels, OfASizeOutOfRangeAreRefused)
{
    const Square square(1, same);
    for (const MapSize size : {MapSize{0, 8}, {8, 0}, {kMostTexels + 1, 8}})
        EXPECT_THROW(MapRaster(square.geometry, square.uvs, size), SettingsError);
}

}  // namespace
}  // namespace surfelao
