#include "atlas/atlas.h"

#include "family.h"
#include "random.h"
#include "scenes.h"
#include "surfels/errors.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surfelao {
namespace {

/// Who owns each texel of a page: the chart of what is drawn there. Draws each triangle.
struct Owners {
    Owners(const Mesh& mesh, const Atlas& atlas, std::size_t page, std::uint32_t magnified)
        : side(magnified * atlas.layout.size.width), chart(std::size_t{side} * side, kNoChart)
    {
        const MapRaster raster(mesh.geometry, atlas.layout.pages[page], {side, side});
        for (const Texel& texel : raster.texels(0, side)) {
            std::uint32_t& owner = chart[std::size_t{texel.y} * side + texel.x];
            overlaps += owner == kNoChart ? 0 : 1;
            owner = atlas.chart_of[page][texel.point.triangle];
        }
    }

    /// Texels of other charts within `reach` of (x, y).
    [[nodiscard]] int others_near(std::uint32_t x, std::uint32_t y, std::uint32_t own,
                                  int reach) const
    {
        int others = 0;
        const int end = static_cast<int>(side) - 1;
        const int cx = static_cast<int>(x), cy = static_cast<int>(y);
        for (int j = std::max(0, cy - reach); j <= std::min(end, cy + reach); ++j) {
            for (int i = std::max(0, cx - reach); i <= std::min(end, cx + reach); ++i) {
                const std::uint32_t found =
                    chart[static_cast<std::size_t>(j) * side + static_cast<std::size_t>(i)];
                others += found != kNoChart && found != own ? 1 : 0;
            }
        }
        return others;
    }

    std::uint32_t side;
    std::vector<std::uint32_t> chart;
    std::uint64_t overlaps = 0;  ///< texels drawn more than once
};

double area_in_map(const Mesh& mesh, const UvSet& uvs, std::uint32_t t)
{
    const glm::uvec3 corners = uvs.corners[mesh.geometry.scene_triangle(t)];
    const glm::dvec2 a = uvs.values[corners.x];
    const glm::dvec2 b = uvs.values[corners.y] - a, c = uvs.values[corners.z] - a;
    return 0.5 * (b.x * c.y - b.y * c.x);
}

/// What must hold of every atlas.
void expect_sound(const Mesh& mesh, const AtlasSettings& settings, const std::string& what)
{
    SCOPED_TRACE(what);
    const Atlas atlas = make_atlas(mesh, settings);
    const int padding = static_cast<int>(settings.padding);
    std::vector<int> places(mesh.geometry.triangles.size(), 0);
    for (std::size_t page = 0; page < atlas.layout.pages.size(); ++page) {
        const UvSet& uvs = atlas.layout.pages[page];
        std::uint64_t flipped = 0;
        for (std::uint32_t t = 0; t < places.size(); ++t) {
            const bool has_place = uvs.corners[mesh.geometry.scene_triangle(t)].x != UvSet::kNone;
            EXPECT_EQ(has_place, atlas.chart_of[page][t] != kNoChart);
            places[t] += has_place ? 1 : 0;
            flipped += has_place && !(area_in_map(mesh, uvs, t) < 0.0) ? 1 : 0;  // v runs down
        }
        EXPECT_EQ(flipped, 0u);
        EXPECT_EQ(Owners(mesh, atlas, page, 4).overlaps, 0u);
        const Owners owners(mesh, atlas, page, 1);
        std::uint64_t near = 0, at_rim = 0;
        for (std::uint32_t y = 0; y < owners.side; ++y) {
            for (std::uint32_t x = 0; x < owners.side; ++x) {
                const std::uint32_t own = owners.chart[std::size_t{y} * owners.side + x];
                if (own == kNoChart)
                    continue;
                near += owners.others_near(x, y, own, std::max(1, 2 * padding)) > 0 ? 1 : 0;
                const int rim =
                    static_cast<int>(std::min({x, y, owners.side - 1 - x, owners.side - 1 - y}));
                at_rim += rim < std::max(1, padding) ? 1 : 0;
            }
        }
        EXPECT_EQ(near, 0u);
        EXPECT_EQ(at_rim, 0u);
    }
    EXPECT_GE(std::ranges::min(places), 1);
    EXPECT_LE(std::ranges::max(places), settings.blended ? 3 : 1);
}

TEST(Atlas, IsSoundOnEveryKindOfScene)
{
    for (std::uint32_t i = 0; i < scenes::kFamilyKindCount; ++i) {
        const std::uint32_t index = i + scenes::kFamilyKindCount * (i % 4);
        const Mesh mesh = make_mesh(scenes::family_scene(index));
        expect_sound(mesh, {.size = 512, .padding = i % 4}, scenes::family_kind(index));
    }
}

TEST(Atlas, BlendedIsSoundOnEveryKindOfScene)
{
    for (std::uint32_t i = 0; i < scenes::kFamilyKindCount; i += 3) {
        const Mesh mesh = make_mesh(scenes::family_scene(i));
        expect_sound(mesh, {.size = 512, .padding = 1, .blended = true}, scenes::family_kind(i));
    }
}

}  // namespace
}  // namespace surfelao
