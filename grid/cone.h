/// cone.h: what a cone of directions hides from a receiver, what two cones hide together, and what
/// a cell of an AO grid holds as such a cone or as spherical harmonics.
///
/// A cone is a cap of the sphere of directions, half angle h about an axis, of which the share
/// `cover` is hidden, evenly. Angles are told by their cosines.
///
/// Based on:
///   Malmer, Malmer, Assarsson, Holzschuch. Fast Precomputed Ambient Occlusion for Proximity
///   Shadows. JGT 12(2). 2007
///   Ramamoorthi, Hanrahan. An Efficient Representation for Irradiance Environment Maps. 2001
#pragma once

#include "grid/ao_grid.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>

namespace surfelao {

/// Of the whole sphere: less is hidden than a float tells from nothing, and has no direction.
inline constexpr float kNothingHidden = 1e-7f;

struct Cone {
    glm::vec3 axis{0.0f};   ///< unit length; zero where nothing is hidden, or the same all around
    float cos_half = 1.0f;  ///< of the half angle, in [-1, 1]
    float cover = 0.0f;     ///< of the cap, in [0, 1]
};

/// The cone of a cell's moments (moments_of()): R = |m| / (4 pi alpha) is 1 for a single direction
/// and 0 for a whole sphere; a cap has R = (1 + cos h) / 2. The cap of that R, covered in part, or
/// where alpha is more than it can hold the cap of alpha, covered as a whole.
[[nodiscard]] Cone cone_of(glm::vec4 moments);

/// T(h, b): the share of a receiver's light, weighted by the cosine to its normal, that a cap of
/// half angle h hides; b: from the normal to the axis. In [0, 1]. Exact: in the open part of the
/// horizon s^2 max(0, cos b) with s = sin h, cut by it
///
///     x = 1 / tan h,  y = -x / tan b,  q = sin b sqrt(1 - y^2)
///     T = ((cos b acos y - x q) s^2 + atan(q / x)) / pi
///
/// and for h > 90 degrees what the cap of the other directions leaves: 1 - T(180 - h, 180 - b).
[[nodiscard]] double clipped_cap(double cos_half, double cos_between);

/// The occlusion by a cone at a receiver of this normal (unit length). In [0, 1].
[[nodiscard]] float occlusion_by(const Cone& cone, glm::vec3 normal);

/// T_merge: the share of the whole sphere that two caps hide together, whose own shares of it are
/// alpha = (1 - cos h) / 2 and whose axes are cos_between apart: their sum less what they share.
[[nodiscard]] double merged_caps(double alpha_first, double alpha_second, double cos_between);

inline constexpr std::size_t kHarmonics = 9;
using Harmonics = std::array<float, kHarmonics>;

/// Real spherical harmonics of l = 0, 1, 2, m from -l to l, along a unit vector; z is the pole.
[[nodiscard]] Harmonics harmonics_along(glm::vec3 direction);

/// A_l / pi: 1, 2/3, 1/4. What l-th coefficients of V, times the harmonics along a normal, count in
/// its cosine-weighted mean.
[[nodiscard]] float cosine_weight(std::size_t coefficient);

/// m / (4 pi) and alpha of one cell's values, of whatever store.
[[nodiscard]] glm::vec4 moments_of(GridStore store, const float* values);

}  // namespace surfelao
