/// limits.h: a distance limit with a falloff as several limits without one.
///
/// Internal to the mask engines; masks.h is their door.
#pragma once

#include "surfels/occlusion.h"

#include <vector>

namespace surfelao {

/// The limits, ascending or not, over which the mean of hard-limited occlusions is that of the
/// definition, to 1/16 of each hit's weight. One limit, maybe infinite, where there is no falloff.
[[nodiscard]] std::vector<float> distance_limits(const Definition& definition);

}  // namespace surfelao
