/// receiver_group.h: what engines need to know about receivers that stand close together.
///
/// Plain data and no library code: kernels that are compiled per instruction set include it (see
/// tree/masks/kernel.h). receiver_groups.h makes such groups.
#pragma once

#include <cstdint>

namespace surfelao {

/// Neighbouring receivers: all points within `radius` of `center`, all normals within the cone, no
/// receiver's tangent plane passes more than `rise` below the parallel plane through the centre.
struct ReceiverGroup {
    float center[3];
    float radius;
    float axis[3];
    float cone_cos, cone_sin;   ///< of the cone's half angle; that may be more than a right angle
    float rise;                 ///< may be negative
    std::uint32_t begin, end;   ///< receivers, in the order of the tree
    std::uint32_t first_child;  ///< two, side by side; 0 = leaf
};

}  // namespace surfelao
