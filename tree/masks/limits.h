/// limits.h: a distance limit with a falloff as several limits without one.
///
/// Internal to the mask engines; masks.h is their door.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/receiver.h"
#include "tree/masks/kernel.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// The limits over which the weighted mean of hard-limited occlusions is nearly that of the
/// definition (kMaskFalloffSteps). One limit, maybe infinite, where there is no falloff.
[[nodiscard]] MaskLimits distance_limits(const Definition& definition);

/// What a ground leaves of the hemispheres of receivers, cosine-weighted, within each of the
/// limits: exact, and with a falloff scaled so that the weighted mean over the limits is.
class MaskSkies {
public:
    /// O(receivers), all cores; nothing without a ground. The receivers must outlive it.
    MaskSkies(const Definition& definition, std::span<const Receiver> receivers);

    struct Sky {
        float share = 1.0f;  ///< of the hemisphere; 1 without a ground
        float above = 0.0f;  ///< signed height over the ground, in diagonals
    };
    [[nodiscard]] Sky at(float limit, std::size_t receiver) const;

private:
    std::optional<Ground> ground_;
    std::span<const Receiver> receivers_;
    std::vector<float> scales_;  ///< one per receiver; empty without a falloff
};

}  // namespace surfelao
