/// color_map.h: numbers as colours: the maps that all pictures of the project use.
///
/// Five maps say how large a number is: differences of pictures, levels, the viewer's difference to
/// rays. All but turbo rise evenly in lightness, so that they can be read in grey, in print and by
/// the colour-blind; turbo tells more steps apart and has no such order.
///
///   heat      dark blue over purple, red and orange to a pale yellow, through OKLab, in which
///             equal steps look equal; the default
///   viridis, inferno   as in matplotlib
///   turbo     a smooth rainbow, likewise
///   grey      black to white, of even lightness
///
/// One map says which way an answer is wrong, on meshes, in pictures and reports: white = right,
/// red = too dark, blue = too bright, equally dark at both ends.
///
/// Based on:
///   Ottosson. A perceptual color space for image processing. 2020
///   Smith, van der Walt. A Better Default Colormap for Matplotlib. 2015 (viridis, inferno; CC0)
///   Mikhailov. Turbo, An Improved Rainbow Colormap for Visualization. 2019 (turbo; Apache 2.0)
#pragma once

#include "image/image.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace surfelao {

enum class ColorMap { heat, viridis, inferno, turbo, grey, diverging };

/// Those that people choose among, all but the diverging one, in the order of ColorMap.
inline constexpr std::array<std::pair<std::string_view, ColorMap>, 5> kColorMaps = {{
    {"heat", ColorMap::heat},
    {"viridis", ColorMap::viridis},
    {"inferno", ColorMap::inferno},
    {"turbo", ColorMap::turbo},
    {"grey", ColorMap::grey},
}};

/// An odd number: the diverging map's middle is one of them.
inline constexpr std::size_t kMapSteps = 257;
using MapColors = std::array<glm::vec3, kMapSteps>;

/// Linear RGB at even steps from 0 to 1, for shaders and tables.
[[nodiscard]] const MapColors& colors_of(ColorMap map);

/// Linear RGB for x in [0, 1]; values outside are cut, NaN is not allowed. Of the diverging map 0
/// is blue, 0.5 white and 1 red.
[[nodiscard]] glm::vec3 map_color(ColorMap map, float x);

/// The place of a difference in its map, `full` > 0 being the end: |d| / full, and of the diverging
/// map 0.5 + 0.5 d / full.
[[nodiscard]] float difference_place(ColorMap map, float difference, float full);

/// Linear RGB for things that are only to be told apart, by number: neighbours in the sequence have
/// hues far apart, and none is darker than the others by much.
[[nodiscard]] glm::vec3 label_color(std::uint32_t index);

/// As a screen shows it: 0 to 255 (sRGB).
using Rgb = std::array<std::uint8_t, 3>;

[[nodiscard]] Rgb shown_rgb(glm::vec3 linear);

/// Of an error = answer - truth, of occlusion, in the diverging map. Full colour at `full` > 0 and
/// beyond; NaN is grey: nobody knows.
[[nodiscard]] Rgb error_color(float error, float full);

/// The `full` of all reports.
inline constexpr float kFullColorError = 0.1f;

/// The full scale for differences of which most are below `largest`: that rounded up to 1, 2 or 5
/// times a power of ten, at least 0.0001. largest >= 0 and finite.
[[nodiscard]] float rounded_scale(float largest);

}  // namespace surfelao
