/// cube_placement.h: where cube maps should be, so that few of them see most of a surface.
///
/// *Candidates* are the middles of the cells of a 12 x 12 x 12 grid over the scene's box, where
/// they are free, and places on a sphere round the scene: what shows a room, and what shows a
/// statue. *Targets* are surface points, uniform by area, each side for itself. A candidate sees a
/// target where a ray reaches it at less than 81 degrees from its normal.
///
/// A target counts as often as it is seen, from the free cells as much as from the sphere, and
/// fully from a twentieth of either: what shows through a crack alone is worth no map. The cover is
/// chosen greedily: always the candidate that adds most, each target weighed by what a map is worth
/// there, the facing, the nearness to a face's middle and to the centre of cube_projector.h.
///
/// Based on:
///   Chvatal. A Greedy Heuristic for the Set-Covering Problem. Mathematics of Operations Research
///   4(3). 1979
#pragma once

#include "surfels/progress.h"
#include "surfels/surface.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace surfelao {

struct CubePlacement {
    std::vector<glm::vec3> centres;  ///< the first one adds most; unit frame
    double covered = 0.0;            ///< of what candidates see, 0 to 1
    std::uint32_t candidates = 0;    ///< free ones
};

/// Maps beyond so many are asked for by name only.
inline constexpr int kMostPlacedMaps = 16;

/// At most `most` maps, fewer where they see 98 % of what candidates see. Equal input gives equal
/// centres: of candidates that add as much the first. Costs candidates x 4,096 rays, some seconds.
[[nodiscard]] CubePlacement place_cube_maps(const Mesh& mesh, int most = kMostPlacedMaps,
                                            const Progress& progress = {});

/// The thesis puts a map at the camera where less of the seen pixels is covered than this.
inline constexpr double kCoveredEnough = 0.75;
/// For a picture whose maps were placed, more.
inline constexpr double kCoveredWell = 0.98;

}  // namespace surfelao
