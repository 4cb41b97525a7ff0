/// layout_facts.h: the charts of a layout, and how dense its texels lie on the surface.
#pragma once

#include "atlas/layout.h"

#include <cstdint>
#include <vector>

namespace surfelao {

/// Of each triangle of the geometry, for each page of the layout.
struct LayoutFacts {
    /// Its chart: triangles that meet at a place of the surface (Geometry::welded) and of the page
    /// are of one. Numbered over all pages, by their first triangles; kNone where the triangle is
    /// not on the page.
    std::vector<std::vector<std::uint32_t>> charts;
    std::uint32_t chart_count = 0;
    /// Texels per unit of length in the file: the root of its area in texels over that on the
    /// surface. 0 where it is not on the page.
    std::vector<std::vector<float>> densities;
    float median_density = 0.0f;  ///< half of what lies in the map, by area, is less dense

    static constexpr std::uint32_t kNone = UvSet::kNone;
};

/// O(n log n) a page.
[[nodiscard]] LayoutFacts facts_of(const Mesh& mesh, const MapLayout& layout);

}  // namespace surfelao
