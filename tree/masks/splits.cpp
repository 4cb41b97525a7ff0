#include "tree/masks/splits.h"

#include "tree/lanes.h"
#include "tree/masks/constants.h"
#include "tree/part.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace surfelao {
namespace {

struct Extent {
    /// Of `at`; what follows it in a key is carried along and of no meaning.
    std::array<Float4, 2> low, high;

    Extent()
    {
        low.fill(all_lanes(std::numeric_limits<float>::max()));
        high.fill(all_lanes(-std::numeric_limits<float>::max()));
    }
    explicit Extent(std::span<const MaskKey> keys) : Extent()
    {
        for (const MaskKey& key : keys) {
            const auto at = std::bit_cast<std::array<Float4, 2>>(key);
            add({at, at});
        }
    }
    Extent(const std::array<Float4, 2>& lowest, const std::array<Float4, 2>& highest)
        : low(lowest), high(highest)
    {
    }
    void add(const Extent& other)
    {
        for (std::size_t i = 0; i < 2; ++i) {
            low[i] = least(low[i], other.low[i]);
            high[i] = most(high[i], other.high[i]);
        }
    }
};

Extent extent_of(std::span<const MaskKey> keys)
{
    if (keys.size() < kPartMany)
        return Extent(keys);
    std::vector<Extent> extents(keys.size() / kPartBlock + 1);
    for_blocks(keys,
               [&](std::span<const MaskKey> block, std::size_t i) { extents[i] = Extent(block); });
    Extent extent;
    for (const Extent& one : extents)
        extent.add(one);
    return extent;
}

/// Whether all keys lie at the one or the other end of an extent. Smooth surfaces are told after a
/// few keys.
bool at_ends(std::span<const MaskKey> keys, std::size_t axis, float low, float high)
{
    const float margin = kMaskEdgeEnds * (high - low);
    return std::all_of(keys.begin(), keys.end(), [=](const MaskKey& key) {
        return key.at[axis] < low + margin || key.at[axis] > high - margin;
    });
}

/// An edge of a tile that is a rectangle or half of one: cells of a grid lie along it. Zero of
/// others.
glm::vec3 edge_of(const MaskTile& tile, std::span<const glm::vec3> positions)
{
    const int corners = tile.corners.z != tile.corners.w ? 4 : 3;
    glm::vec3 best(0.0f);
    int right_angles = 0;
    for (int i = 0; i < corners; ++i) {
        const glm::vec3 at = positions[tile.corners[i]];
        const glm::vec3 before = positions[tile.corners[(i + corners - 1) % corners]] - at;
        const glm::vec3 after = positions[tile.corners[(i + 1) % corners]] - at;
        if (std::abs(glm::dot(before, after)) <
            kMaskOneWay * glm::length(before) * glm::length(after)) {
            ++right_angles;
            best = after;
        }
    }
    return corners == 3 || right_angles == 4 ? best : glm::vec3(0.0f);
}

/// Whether all normals are one.
bool face_one_way(const std::array<float, 8>& low, const std::array<float, 8>& high)
{
    return high[3] - low[3] < kMaskOneWay && high[4] - low[4] < kMaskOneWay &&
           high[5] - low[5] < kMaskOneWay;
}

/// Turns places to the edge of the first tile. The cuts before ran across other axes and are
/// forgotten. Nothing where that tile is no rectangle.
void turn_to_edges(std::span<MaskKey> keys, std::span<const MaskTile> tiles,
                   std::span<const glm::vec3> positions, MaskCuts& cuts)
{
    const auto& at = keys.front().at;
    const glm::vec3 normal(at[3], at[4], at[5]);
    const glm::vec3 edge = edge_of(tiles[keys.front().tile], positions);
    const glm::vec3 across = glm::cross(normal, edge);
    const float length = glm::length(across);
    if (!(length > 0.0f))
        return;
    const glm::vec3 v = across / length;
    const glm::mat3 own(glm::cross(v, normal), v, normal);
    for_blocks(keys, [&](std::span<MaskKey> block, std::size_t) {
        for (MaskKey& key : block) {
            const glm::vec3 place = glm::vec3(key.at[0], key.at[1], key.at[2]) * own;
            for (std::size_t axis = 0; axis < 3; ++axis)
                key.at[axis] = place[static_cast<int>(axis)];
        }
    });
    cuts = {kMaskFrame * own, true};
}

}  // namespace

MaskPlane split_plane(std::span<MaskKey> keys, std::span<const MaskTile> tiles,
                      std::span<const glm::vec3> positions, MaskCuts& cuts)
{
    Extent extent = extent_of(keys);
    auto low = std::bit_cast<std::array<float, 8>>(extent.low);
    auto high = std::bit_cast<std::array<float, 8>>(extent.high);
    if (!cuts.own && face_one_way(low, high)) {
        turn_to_edges(keys, tiles, positions, cuts);
        extent = extent_of(keys);
        low = std::bit_cast<std::array<float, 8>>(extent.low);
        high = std::bit_cast<std::array<float, 8>>(extent.high);
    }
    std::array<float, 6> square;
    for (std::size_t i = 0; i < 6; ++i)
        square[i] = (high[i] - low[i]) * (high[i] - low[i]);
    const float unit = kMaskNormalExtent * kMaskNormalExtent * (square[0] + square[1] + square[2]);
    std::size_t axis = 0;
    float longest = square[0];
    for (std::size_t i = 1; i < 6; ++i) {
        const float here = i < 3 ? square[i] : unit * square[i];
        axis = here > longest ? i : axis;
        longest = here > longest ? here : longest;
    }
    if (axis < 3) {
        std::size_t turned = 3;
        for (std::size_t i = 4; i < 6; ++i)
            turned = square[i] > square[turned] ? i : turned;
        if (square[turned] > kMaskEdgeExtent * kMaskEdgeExtent &&
            at_ends(keys, turned, low[turned], high[turned]))
            axis = turned;
    }
    return {axis, 0.5f * (low[axis] + high[axis])};
}

void cut(const MaskPlane& plane, MaskCuts& left, MaskCuts& right)
{
    if (plane.axis < 3) {
        left.high[static_cast<int>(plane.axis)] = plane.at;
        right.low[static_cast<int>(plane.axis)] = plane.at;
    }
}

}  // namespace surfelao
