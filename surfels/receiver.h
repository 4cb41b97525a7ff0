/// receiver.h: the points at which occlusion is asked for.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <functional>

namespace surfelao {

/// Any (point, normal): a place on a surface, a texel, a pixel, a grid cell. Results are indexed by
/// receiver. Those on a surface are made by surface.h.
struct Receiver {
    glm::vec3 position{0.0f};  ///< unit frame, already off the surface
    glm::vec3 normal{0.0f};    ///< unit length; zero = no hemisphere: occlusion 0, bent normal zero
    float offset = 0.0f;       ///< how far off the surface, in diagonals. No engine asks; what is
                               ///< asked too near to another surface is told by it
                               ///< (reference/well_defined.h)
};

/// Called with ranges, one behind the other, of receivers at which nobody looks any more: who asks
/// may drop them.
using ForgetReceivers = std::function<void(std::size_t first, std::size_t end)>;

}  // namespace surfelao
