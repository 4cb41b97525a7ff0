/// well_defined.h: which receivers have an answer at all.
///
/// The definition (surfels/occlusion.h) puts the receiver an offset above the surface (its own one:
/// Receiver::offset). Where another
/// surface is about as near as that, or the receiver stands exactly in another surface's plane, the
/// answer belongs to the offset or to the last bit of a float, not to the scene: no method can be
/// right or wrong there. One rule finds these receivers, and every error figure leaves them out,
/// for every engine and for rays alike, and says how many they are.
///
/// The rule: rays are traced from five places, at half the offset, at twice the offset, and from
/// the receiver moved sideways by kSidestep in three directions 120 degrees apart (any plane that
/// contains the normal has two of them on different sides). The receiver is ill-defined when the
/// five answers spread over more than kIllDefined, or when more than that share of its own rays
/// hits something within kSidestep: it stands on another surface. There the five may agree, as in
/// nearly closed places, while the receiver itself is inside of the surface for a ray tracer that
/// counts hits at distance zero, and on one or the other side of it for all others.
#pragma once

#include "reference/rays.h"
#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// In occlusion. Five times the noise of the rays, and a tenth of what a sheet that comes or goes
/// in front of half the hemisphere changes.
inline constexpr float kIllDefined = 0.05f;

/// In diagonals: eight roundings of a float at the rim of the unit frame (2^-24 each).
inline constexpr float kSidestep = 5e-7f;

/// For each receiver the largest minus the smallest occlusion over the five places, or the share of
/// its rays that hit within kSidestep if that is more; it is ill-defined when that is above
/// kIllDefined. 0 for receivers without a normal.
///
/// scene: a robust one. The five places share their directions, so that their noise mostly
/// cancels. Costs five times `rays` a receiver, and as many very short ones. Throws Cancelled.
[[nodiscard]] std::vector<float> placement_change(const RayScene& scene,
                                                  std::span<const Receiver> receivers,
                                                  const Definition& definition,
                                                  const Progress& progress = {},
                                                  std::uint32_t rays = 256);

}  // namespace surfelao
