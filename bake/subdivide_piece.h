/// subdivide_piece.h: a part of a triangle that is cut. Internal to subdivide.cpp.
#pragma once

#include "bake/subdivide.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace surfelao {

/// Places in a triangle are whole numbers of 1 / kPlaceUnit: edges are halved kMostRounds times.
inline constexpr std::uint16_t kPlaceUnit = 1u << kMostRounds;

/// Weights of the second and third corner of an old triangle; the first has the rest.
using Place = glm::vec<2, std::uint16_t>;

inline glm::vec2 weights_at(const glm::vec2& place)
{
    return place / static_cast<float>(kPlaceUnit);
}

/// A part of an old triangle.
struct Piece {
    glm::uvec3 vertices;
    std::array<Place, 3> places;
    /// By bits: the middle of the edge behind this corner is known not to bend.
    std::uint8_t straight = 0;
};

/// Barycentric weights of a place in a piece, in proportion.
inline glm::vec3 shares(const Piece& piece, const glm::vec2& place)
{
    const auto cross = [](glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; };
    const glm::vec2 a = glm::vec2(piece.places[0]) - place, b = glm::vec2(piece.places[1]) - place,
                    c = glm::vec2(piece.places[2]) - place;
    const glm::vec3 areas(cross(b, c), cross(c, a), cross(a, b));
    return areas / (areas.x + areas.y + areas.z);
}

}  // namespace surfelao
