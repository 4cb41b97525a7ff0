/// tree.h: the scene's triangles as a binary tree in which every node is also one rectangle.
///
/// Leaves are single triangles or flat pairs of them, exact. An inner node stands for its triangles
/// as a rectangle across their vector area, with the area of that vector and the axes and aspect of
/// their second moments: what is seen of the patch from straight ahead. It stands about their
/// centroid, deeper where they bulge, and reaches farther where the tree was cut
/// (tree/masks/patch.cpp).
///
/// Internal to the mask engine; masks.h is its door.
#pragma once

#include "surfels/raw_vector.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace surfelao {

/// The unit frame turned so that nothing built along the axes, nor at round angles to them, lies
/// along the rows of the raster: there a whole row of bits would depend on one rounding. Columns:
/// where the axes go; an arbitrary rotation (by 41, 23 and 67 degrees about z, x and z),
/// orthonormal to 1e-7.
inline const glm::mat3 kMaskFrame{-0.26100944f, 0.93067852f,  0.25634268f,
                                  -0.89583014f, -0.33245920f, 0.29488853f,
                                  0.35966990f,  -0.15267081f, 0.92050485f};

/// 16 floats in the order in which the kernels load them.
struct alignas(64) MaskNode {
    glm::vec3 center;  ///< of the quadrilateral
    float radius;      ///< no point of the node is farther from `center`
    glm::vec3 skew;    ///< corners: center + skew +- axis_a, center - skew +- axis_b; of a
                       ///< triangle center + skew + axis_a, - skew + axis_b, + skew - axis_a
    float thickness;   ///< no point is farther from the plane (center, axis_a x axis_b)
    glm::vec3 axis_a;
    float open_radius;  ///< the radius as the opening test sees it: half the diagonal of the
                        ///< box of its second moments, larger where not flat, and at least
                        ///< kMaskRelaxedCluster times the radius; 0 where the node is exact:
                        ///< its triangles tile the quadrilateral; -1 where it is a leaf,
                        ///< which is exact too
    glm::vec3 axis_b;
    std::uint32_t links;  ///< kMaskFirstChild and flags (tree/masks/constants.inc)
};
static_assert(sizeof(MaskNode) == 64);

/// Throws InputError where a tree of so many leaves would have more nodes than a link can count,
/// one sentence with the number of triangles.
void check_mask_tiles(std::uint64_t tiles, std::uint64_t triangles);

/// In the mask frame. nodes[0] is the root; empty where the scene has no triangle.
struct MaskTree {
    RawVector<MaskNode> nodes;
};

}  // namespace surfelao
