/// splits.h: where the tree is cut.
///
/// Internal to the mask engine; masks.h is its door.
#pragma once

#include "tree/masks/patch.h"
#include "tree/masks/tiles.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace surfelao {

/// Where the splits look: centroid and unit normal of one tile, in the scene's own axes: what is
/// built along them is cut along them. What faces one way has turned its centroids to axes of its
/// own.
struct alignas(16) MaskKey {
    std::array<float, 6> at;
    std::uint32_t tile;
    std::uint32_t padding;
};

/// Parts the keys below `at` on one of the six axes from the others.
struct MaskPlane {
    std::size_t axis;
    float at;

    bool operator()(const MaskKey& key) const { return key.at[axis] < at; }
};

/// The middle of the longest of the six extents; walls that meet in an edge are parted first. Keys
/// that all face one way are turned, once, to the edges of their first tile if it is a rectangle or
/// half of one, and the cuts with them.
[[nodiscard]] MaskPlane split_plane(std::span<MaskKey> keys, std::span<const MaskTile> tiles,
                                    std::span<const glm::vec3> positions, MaskCuts& cuts);

/// To either side of a plane. What looks elsewhere need not be beside what it was parted from.
void cut(const MaskPlane& plane, MaskCuts& left, MaskCuts& right);

}  // namespace surfelao
