/// layout.h: where a surface lies in a map of one or several pages.
///
/// Four kinds: one page (the file's own texture coordinates, or charts of ours), the tiles of a
/// UDIM set (each triangle on one of them), a page for each material, and blended charts: three
/// pages, one per axis, each with the triangles that face along it. There a triangle lies on up to
/// three pages, and what is shown is their weighted mean (page_weights), so that it fades from one
/// chart into the next where others have a seam.
#pragma once

#include "image/map.h"
#include "surfels/surface.h"
#include "surfels/texels.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

struct MapLayout {
    MapSize size;              ///< of each page
    std::vector<UvSet> pages;  ///< at least one; per scene triangle, kNone for those on other pages
    std::vector<std::uint32_t> tiles = {};  ///< UDIM number of each page: 1001 + column + 10 row;
                                            ///< or empty
    /// Of each page: its material (BaseColors::materials); or empty.
    std::vector<std::uint32_t> materials = {};
    bool is_blended = false;  ///< three pages: by x, y, z
};

/// A point of the surface on a page.
struct PagePlace {
    std::uint32_t page = 0;
    glm::dvec2 uv{0.0};
    float weight = 0.0f;
};

/// All places of a point; the weights sum up to 1.
struct PagePlaces {
    std::array<PagePlace, 3> list;
    std::size_t count = 0;  ///< 0 where its triangle has no place in the map

    [[nodiscard]] std::span<const PagePlace> places() const { return {list.data(), count}; }
};

/// What the three pages of a blended map weigh where the surface has this shading normal (of any
/// length but 0); the sum is 1. The squares of its components, each less kLeastPageWeight, but not
/// below 0, over their sum: a page has no weight any more where its charts end, 60 degrees off its
/// axis, so nothing steps there. Every normal is within 54.74 degrees of an axis.
[[nodiscard]] glm::vec3 page_weights(glm::vec3 normal);

inline constexpr float kLeastPageWeight = 0.25f;

/// O(pages).
[[nodiscard]] PagePlaces places_of(const Mesh& mesh, const MapLayout& layout,
                                   const SurfacePoint& point);

/// What a map shows at places of a layout, one Map per page: fetched (image/map.h) and weighted.
[[nodiscard]] float fetch_at(std::span<const Map> pages, const PagePlaces& places,
                             std::uint32_t channel = 0);

}  // namespace surfelao
