#include "atlas/udim.h"

#include "atlas/page_places.h"

#include <cmath>
#include <map>

namespace surfelao {
namespace {

constexpr int kTileColumns = 10;

/// How far left of or below the first tile a triangle's middle may lie: that is rounding, or a
/// border that reaches over a little.
constexpr double kReach = 0.01;

/// The tile of a place in the map; 0 for none. v runs down, rows of tiles up.
std::uint32_t tile_at(glm::dvec2 uv)
{
    const auto whole = [](double x) { return x < 0.0 && x > -kReach ? 0.0 : std::floor(x); };
    const double column = whole(uv.x), row = whole(1.0 - uv.y);
    if (!(column >= 0.0 && column < kTileColumns && row >= 0.0 && row < kMostTileRows))
        return 0;
    return 1001 + static_cast<std::uint32_t>(column) +
           kTileColumns * static_cast<std::uint32_t>(row);
}

}  // namespace

MapLayout udim_layout(const Scene& scene, const UvSet& uvs, MapSize size)
{
    std::map<std::uint32_t, PagePlacesOf> tiles;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const glm::uvec3 corners = corners_in(scene, uvs, t);
        glm::dvec2 middle(0.0);
        bool has_place = true;
        for (int k = 0; k < 3; ++k) {
            has_place = has_place && corners[k] != UvSet::kNone;
            if (has_place)
                middle += uvs.values[corners[k]] / 3.0;
        }
        const std::uint32_t number = has_place ? tile_at(middle) : 0;
        if (number == 0)
            continue;
        const double column = (number - 1001) % kTileColumns;
        const double row = (number - 1001) / kTileColumns;
        tiles.try_emplace(number, scene.triangles.size())
            .first->second.add(t, corners, uvs, {-column, row});
    }
    MapLayout layout{.size = size, .pages = {}};
    for (auto& [number, tile] : tiles) {
        layout.pages.push_back(tile.take());
        layout.tiles.push_back(number);
    }
    return layout;
}

}  // namespace surfelao
