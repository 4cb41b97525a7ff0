/// form_factor.h: what one disk, or one cluster as a disk, adds to a receiver's occlusion.
///
/// The formulas of the disk engine, in plain code: brute_force.cpp sums them, tree/disks/gather.cpp
/// holds the same in SIMD and shaders/disks_gather.frag the same on the GPU.
///
/// With R^2 = flat_area / pi, d the distance, x = R^2 / d^2, and the cosines h = m.w at the disk
/// and cR = n.w at the receiver (w = direction from receiver to disk), a disk wholly above the
/// horizon covers exactly (contour integral over its rim)
///
///     F = a (n.m) + b (cR - h (n.m)),    S = sqrt((1 - x)^2 + 4 x h^2),
///     a = 2 x h^2 / (S (S + 1 - x)),     b = 2 x h / (S (S + 1 + x))
///
/// to second order in x, which is what is summed below x = 1/9 (d = 3R; there within 2 %):
///
///     F = x h / (1 + x) * (cR + x (cR (2 - 3 h^2) + h (n.m)))
///
/// Nearer than that a disk is no likeness of the mesh around it. Where it is a triangle's, the
/// triangle is summed (triangle_moment); else the first factor alone, A h cR / (pi d^2 + A), errs
/// less. A disk counts as above the horizon when its centre is: cutting the rim was measured to be
/// worse, since the surface that the disk stands for bends away. Triangles are cut.
///
/// The part of a cluster's area that its mean normal does not explain, area - flat_area, counts as
/// spread over all orientations: it shows a quarter of itself to any side (half when two-sided).
///
/// Based on:
///   Bunnell. Dynamic Ambient Occlusion and Indirect Lighting. GPU Gems 2, ch. 14. 2005
///   Hoberock, Jia. High-Quality Ambient Occlusion. GPU Gems 3, ch. 12. 2007
///   Engleson. Point-based ambient occlusion (report). 2011
///   Baum, Rushmeier, Winget. Improving Radiosity Solutions Through the Use of Analytically
///     Determined Form-Factors. 1989: triangle_moment
///   Hill, Heitz. Real-Time Area Lighting: a Journey from Research to Production. 2016: its arcs
#pragma once

#include "surfels/occlusion.h"
#include "surfels/surfel.h"
#include "tree/ground.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <numbers>

namespace surfelao {

/// Directions are resolved by a linear function: how much of the light that comes in along -w, from
/// far away, reaches the disk's far side. 1 = all.
struct FarVisibility {
    glm::vec3 slope{0.0f};
    float constant = 1.0f;
};
static_assert(sizeof(FarVisibility) == 16);  // one RGBA32F texel

/// A surfel or an octree node, as the formulas see it.
struct DiskShape {
    glm::vec3 center{0.0f};
    glm::vec3 normal{0.0f};  ///< casting normal, unit length or zero (octree.h)
    float flat_area = 0.0f;
    float area = 0.0f;
    bool two_sided = false;
};

/// Beyond this ratio of R^2 to d^2 the second-order term is left out: a disk at d < 3R.
inline constexpr float kNearDisk = 1.0f / 9.0f;

/// Lengths below this are zero, in diagonals: it keeps 1/d^4 finite in float and is far below the
/// offset, and below what floats resolve in a unit frame.
inline constexpr float kTinyLength = 1e-8f;

/// The unweighted form factor in [0, 1 + 1/9]; 0 below the horizon or, one-sided, from in front.
[[nodiscard]] double disk_form_factor(Kernel kernel, const glm::dvec3& receiver,
                                      const glm::dvec3& normal, const DiskShape& disk);

/// Whether the triangle of a surfel, if it has one, is summed instead of its disk. c: from the
/// receiver to its centre.
[[nodiscard]] inline bool is_near_triangle(Kernel kernel, const glm::dvec3& c, const Surfel& surfel)
{
    return kernel == Kernel::cosine && surfel.reach > 0.0f &&
           surfel.area * std::numbers::inv_pi >=
               kNearDisk * (glm::dot(c, c) + double{kTinyLength} * kTinyLength);
}

/// Of the triangle of a surfel, as far as it is above the receiver's horizon: the integral of the
/// direction over its solid angle, by pi, turned to above the horizon; its component along the
/// normal is the form factor. By its edges (Lambert):
///
///     sum over them of  angle between the ends / 2 pi * unit normal of the plane through both
///
/// c: from the receiver to its centre.
[[nodiscard]] glm::dvec3 triangle_moment(const glm::dvec3& c, const glm::dvec3& normal,
                                         const Surfel& surfel);

/// For the same in float: the angle over its sine and 2 pi is, for cosines y >= 0,
/// (k0 + k1 y + k2 y^2) / (k3 + k4 y + y^2) within 4e-5 of itself; for others by reflection.
inline constexpr float kArc[] = {0.8543985f, 0.4965155f, 0.0145206f, 3.4175940f, 4.1616724f};
inline constexpr float kLeastSine2 = 1e-14f;  ///< the reflection's: a float's rounding, squared

/// The share of a disk at this distance that counts: hit_weight of its centre, and without falloff
/// the share of its width that lies within max_distance, so that nothing jumps at the limit. A disk
/// wider than the limit counts as that wide: else the ones around a receiver would never fade.
[[nodiscard]] double distance_weight(const Definition& definition, double distance, double area);

/// The weight that a ground has where a disk of this area stands, `c` from the receiver: what of it
/// lies in the ground's directions, by how far its centre is inside of their edge, half of it at
/// the edge itself, and no more than their cone is wide. The disk adds only what its own weight has
/// more: of both the nearer is the hit.
[[nodiscard]] double ground_weight(const Definition& definition, const GroundSight& sight,
                                   const glm::dvec3& c, double area);

}  // namespace surfelao
