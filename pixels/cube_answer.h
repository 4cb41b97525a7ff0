/// cube_answer.h: a picture answered by cube maps, and its holes.
#pragma once

#include "pixels/cube_projector.h"

#include <cstdint>
#include <vector>

namespace surfelao {

/// One entry per seen pixel of a view.
struct CubeAnswer {
    std::vector<float> occlusion;    ///< 0 in holes until they are solved
    std::vector<std::uint8_t> hole;  ///< 1 where no map answered
    std::vector<float> share;        ///< what maps have in the answer: 0 in holes, 1 but where only
                                     ///< fading maps answer
    std::uint64_t holes = 0;
    double project_s = 0.0;  ///< with reading back
    double holes_s = 0.0;    ///< of solving them

    /// Of the seen pixels, 0 to 1; 1 where nothing is seen.
    [[nodiscard]] double coverage() const;
};

[[nodiscard]] CubeAnswer answer_from_maps(const PixelView& view, CubeProjector& projector,
                                          int most = kNearestMaps);

/// Answers the holes at their own pixels, and the rest of shares. Throws as answer().
void solve_holes(CubeAnswer& answer, const PixelView& view, const CubeWorld& world,
                 const CubeSettings& settings, const Progress& progress = {});

}  // namespace surfelao
