/// atlas.h: a map's layout made for a surface that brings none: charts, packed.
#pragma once

#include "atlas/layout.h"
#include "surfels/progress.h"
#include "surfels/surface.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace surfelao {

struct AtlasSettings {
    std::uint32_t size = 1024;                   ///< texels of a page's side, 1 to kMostTexels
    std::optional<double> texels_per_unit = {};  ///< instead: texels per unit of the file's length,
                                                 ///< > 0; the smallest size that holds all follows
    std::uint32_t padding = 4;                   ///< texels around each chart, 0 to kMostPadding;
                                                 ///< around narrow ones fewer (packing.h)
    bool blended = false;                        ///< three pages, faded into each other (layout.h)
};

inline constexpr std::uint32_t kMostPadding = 1024;

/// No chart, in Atlas::chart_of.
inline constexpr std::uint32_t kNoChart = 0xffffffff;

struct Atlas {
    MapLayout layout;  ///< one page, or three blended ones
    /// Per page, per triangle of the geometry, its chart there; kNoChart where it has none.
    std::vector<std::vector<std::uint32_t>> chart_of;
    std::uint32_t chart_count = 0;  ///< of all pages

    double texels_per_unit = 0.0;  ///< of the file's length, as a root mean square
    double use = 0.0;              ///< share of the texels that charts touch
    double seam_length = 0.0;      ///< of edges between charts, over the root of the surface's area
    /// How much larger or smaller a triangle is in the map than the mean of all, as a ratio >= 1:
    /// the mean over the surface, and the largest.
    double mean_stretch = 1.0, largest_stretch = 1.0;
};

/// Charts (charts.h), each scaled to the area of its surface, packed (packing.h). Every triangle of
/// the geometry has a place, front up (seen with row 0 at the top, the map shows the surface from
/// outside); no two of a page overlap. Corners at one place in one chart share one value, and only
/// those do.
///
/// Equal input gives equal bytes, on any number of threads. Throws SettingsError where a setting is
/// out of its range or the charts do not fit, and Cancelled (progress.h). Some 3 us a triangle.
[[nodiscard]] Atlas make_atlas(const Mesh& mesh, const AtlasSettings& settings,
                               const Progress& progress = {});

}  // namespace surfelao
