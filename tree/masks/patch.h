/// patch.h: what several triangles together are as one rectangle.
///
/// A patch is summed up bottom-up, exactly: area, centroid, vector area and second moments of two
/// patches give those of both. The rectangle that a node of the tree shows follows from the sums.
///
/// Internal to the mask engine; masks.h is its door.
#pragma once

#include "tree/masks/tree.h"

#include <cstddef>
#include <limits>
#include <span>

namespace surfelao {

/// Five rows of four floats: they are computed with four at a time.
struct alignas(16) MaskPatch {
    glm::vec3 center;  ///< centroid by area
    float area;        ///< of all triangles
    glm::vec3 vector_area;
    float seen_area;   ///< length of the vector area
    glm::vec3 normal;  ///< unit: along the vector area
    float radius;      ///< no point is farther from the centre
    /// Integral of (x - center)(x - center)^T over the area.
    float xx, xy, xz;
    float thickness;  ///< no point is farther from the plane (center, normal)
    float yy, yz, zz;
    /// Integral of n.(x - center) over the area: positive where the patch bulges to its front.
    float bulge;
};

/// Corners of tiles as twelve columns of `stride` values: x, y and z of the first corners, then of
/// the second, third and fourth. Readable for kSlack values beyond the end, whatever stands there.
struct MaskCorners {
    static constexpr std::size_t kSlack = 3;

    const float* values;
    std::size_t stride;
    std::size_t count;  ///< of tiles

    [[nodiscard]] const float* column(std::size_t corner, std::size_t axis) const
    {
        return values + (3 * corner + axis) * stride;
    }
    [[nodiscard]] glm::vec3 at(std::size_t corner, std::size_t i) const
    {
        return {column(corner, 0)[i], column(corner, 1)[i], column(corner, 2)[i]};
    }
    [[nodiscard]] MaskCorners part(std::size_t begin, std::size_t end) const
    {
        return {values + begin, stride, end - begin};
    }
};

/// Where the tree was cut about a node: planes across axes that a range of keys has in common.
struct MaskCuts {
    glm::mat3 axes = kMaskFrame;  ///< the scene's own, or of what faces one way; mask frame
    bool own = false;             ///< not the scene's
    glm::vec3 low{-std::numeric_limits<float>::infinity()};
    glm::vec3 high{std::numeric_limits<float>::infinity()};
};

/// The room between a patch's centre and the cuts about it.
struct MaskRoom {
    glm::mat3 axes;          ///< across which it was cut: columns, unit, in the mask frame
    glm::vec3 below, above;  ///< along each of them; infinite where nothing was cut
};
[[nodiscard]] MaskRoom room_of(const MaskPatch& patch, const MaskCuts& cuts);

/// A patch and the node that shows it.
struct MaskPatchNode {
    MaskPatch* patch;
    MaskNode* node;
    const MaskRoom* room;  ///< of inner nodes
    bool may_be_whole;     ///< set by show_patches: make_whole is to be asked
};

/// The patches of tiles and their nodes.
void set_tiles(std::span<const MaskPatchNode> nodes, const MaskCorners& corners);

/// The patch of two patches. Radius and thickness are bounds that follow from the children's.
void join(MaskPatch& patch, const MaskPatch& left, const MaskPatch& right);

/// The same, with radius and thickness measured at the corners of all triangles of both.
void join(MaskPatch& patch, const MaskPatch& left, const MaskPatch& right,
          const MaskCorners& corners);

/// Sets inner nodes from their patches and cuts; the children are left out of `links`.
void show_patches(std::span<MaskPatchNode> nodes);

/// Where triangles tile a rectangle, the node is that rectangle, no approximation, and need not
/// ever be opened. For nodes of which show_patches says that they may be whole.
void make_whole(const MaskPatch& patch, const MaskCorners& corners, MaskNode& node);

}  // namespace surfelao
