/// packing.h: flat shapes side by side on square pages, as large as they fit.
#pragma once

#include "surfels/progress.h"

#include <glm/vec2.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// Triangles of a plane, with its axes as the map's: x to the right, y down.
struct ChartShape {
    std::vector<std::array<glm::dvec2, 3>> triangles;  ///< at least one; finite
    double width = HUGE_VAL;  ///< of what it is made of, as of a strip: twice area over outline
    std::uint32_t page = 0;
};

/// How a shape lies on its page: turned, scaled and moved, never mirrored.
struct ChartPlacement {
    glm::dvec2 right{1.0, 0.0};  ///< where a step to the right goes, in texels
    glm::dvec2 origin{0.0};      ///< where (0, 0) goes

    [[nodiscard]] glm::dvec2 at(glm::dvec2 place) const
    {
        return {origin.x + place.x * right.x - place.y * right.y,
                origin.y + place.x * right.y + place.y * right.x};
    }
};

struct PackingSettings {
    std::uint32_t size = 1024;    ///< texels of a page's side; unused where the scale is given
    std::optional<double> scale;  ///< texels per unit of the shapes, > 0
    std::uint32_t padding = 4;    ///< texels around each shape that are its own; at least one is,
                                  ///< and around narrow shapes no more than kPaddingOfWidth
    std::uint32_t pages = 1;
};

struct Packing {
    std::uint32_t size = 0;                  ///< of each page
    double scale = 0.0;                      ///< texels per unit, the same for all
    std::vector<ChartPlacement> placements;  ///< per shape
    std::uint64_t covered = 0;               ///< texels that shapes touch, of all pages
};

/// Finds the largest scale at which all shapes fit their pages (within some 0.5 % of use), or, with
/// a given scale, the smallest pages, a multiple of four texels wide, that hold them all.
///
/// Each shape is turned so that the rectangle around it is smallest, and lies at whole texels, in
/// one of four turns. The largest go first, each to the first place from the top where it touches
/// nobody's texels, and padding lies between padding: texels that two shapes touch are at least
/// the sum of their paddings + 1 apart, and padding + 1 from the rim. Large pages are packed in
/// blocks of a thousandth of their side.
///
/// Without shapes pages have the size of the settings. Throws SettingsError where the shapes do not
/// fit: so many that not even their padding does, or at the given scale not on kMostTexels. All
/// cores, the same bytes on any number of them; progress gets `units` in all.
[[nodiscard]] Packing pack(std::span<const ChartShape> shapes, const PackingSettings& settings,
                           ProgressMeter& progress, std::uint64_t units);

/// The padding of a shape in parts of its width, where that is less than what is asked: mip levels
/// in which a strip is less than four texels wide do not show it as it is, however far from others
/// it lies, and thousands of narrow charts would fill the page with padding. Texels of 1,024^2 that
/// charts touch, with this and before: engine 59 % and 30 %, FlightHelmet 63 % and 41 %.
inline constexpr double kPaddingOfWidth = 0.25;

}  // namespace surfelao
