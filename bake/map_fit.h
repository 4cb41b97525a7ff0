/// map_fit.h: texels that show the surface between their centres, too.
///
/// A texel asked at its centre is right there. Where the answer bends within a texel, as at
/// contacts and edges of shadows, what a filter shows beside the centre is off. So such texels are
/// asked at their quarters as well, and the map becomes the x that makes least
///
///     sum over samples s of  w_s (sum over texels k of b_sk x_k - a_s)^2
///         + sum over texels k of  h_k (x_k - x0_k)^2
///
/// a_s: the answer at the sample; b_sk: the bilinear weights with which a viewer fetches it; w_s:
/// the share of a texel that it stands for; x0: the map before, with its padding filled, which
/// moves along. That is vertex_fit.h for a map, where it is worth its samples.
#pragma once

#include "image/map.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// In visibility: texels bend that differ by more from each other within one texel's distance.
/// Displayed RMSE of masks at good without the fit and with it, maps of 1024^2 (20,000 points of
/// 256 rays, whose noise of .007 is taken out), and what is asked more: retroufo .0120, .0106, 43
/// %; FlightHelmet .0290, .0255, 104 %; spot .0033, .0033, 3 %, its jumps at seams .0028, .0014.
inline constexpr float kTexelBend = 0.05f;
/// Of a texel that is sampled all over. With less the map follows single samples, and rings.
inline constexpr double kFitHold = 0.1;

/// Nonzero where one of the texels around is more than kTexelBend off another; texels without a
/// value (known == 0) do not count, and are not marked. Empty where there is none. O(texels).
[[nodiscard]] std::vector<std::uint8_t> texels_that_bend(const Map& visibility,
                                                         std::span<const std::uint8_t> known);

/// What the surface shows at a place of the map.
struct MapSample {
    glm::dvec2 uv{0.0};
    float visibility = 1.0f;
    float share = 1.0f;  ///< of a texel that it stands for
};

/// Fits the texels that samples are fetched from, all of which must have a value; one channel.
/// is_held: nonzero for texels whose own answer counts. No value leaves [0, 1]. By conjugate
/// gradients, in O(samples). Equal input gives equal bytes.
void fit_texels(Map& visibility, std::span<const std::uint8_t> is_held,
                std::span<const MapSample> samples);

}  // namespace surfelao
