/// texel_fit.h: values of texels where the answer changes within one.
///
/// Between texels a viewer shows straight lines. Where parts stand on each other, at creases and in
/// charts of few texels the answer steps, and a texel's own answer says nothing of where:
///
///     answer  ____                texels asked at their centres show a ramp from one to the next,
///                 |               wherever the step lies; those of least squares show the one that
///                 |____           is least wrong over the surface, and beyond the border of a
///        o     o     o     o      chart what continues it
///
/// Around such steps the surface is asked kFitSide * kFitSide times in a texel, and the texels from
/// which these samples are fetched get the values that show them best. All others stay as they are.
#pragma once

#include "image/map.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// A texel and its neighbours that differ by so much have a step between them. At 1,024^2 that is
/// one texel in twenty of engine, in ten of FlightHelmet, in a hundred of retroufo, and their RMSE
/// displayed falls from .0103 to .0093, from .0246 to .0199, from .0123 to .0091. (.1: half as many
/// again are asked, for .0090, .0187, .0098.)
inline constexpr float kFitStep = 0.2f;

/// Samples in a texel, in each direction. (2: .0094, .0206, .0098.)
inline constexpr std::uint32_t kFitSide = 3;

/// A point of the surface, and what a map should show there.
struct TexelSample {
    glm::vec2 uv{0.0f};
    float visibility = 1.0f;
    float share = 1.0f;  ///< of its part of a texel that is covered, 0 to 1
};

/// Nonzero where a texel has a value of its own (known) and differs, or two of its eight neighbours
/// with such values differ, by kFitStep. Empty where there is none. O(texels).
[[nodiscard]] std::vector<std::uint8_t> texels_with_steps(const Map& visibility,
                                                          std::span<const std::uint8_t> known);

/// Changes the texels from which the samples are fetched to the minimum of
///
///     sum_s share_s / kFitSide^2 (shown at s - visibility_s)^2 + sum_k w_k (x_k - x0_k)^2
///
/// x_k and x0_k: texels after and before; w_k: 1 for a texel that is known and not marked, as it
/// is one answer; kFitHold for the others. Values are cut to [0, 1]. By conjugate gradients, one
/// thread; time and memory: O(samples). Equal input gives equal bytes.
void fit_texels(Map& visibility, std::span<const std::uint8_t> known,
                std::span<const std::uint8_t> marked, std::span<const TexelSample> samples);

/// What nothing says of a texel stays as it was. (.02: .0094, .0201, .0098; more holds it back.)
inline constexpr double kFitHold = 0.005;

}  // namespace surfelao
