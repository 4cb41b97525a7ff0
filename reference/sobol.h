/// sobol.h: cosine-weighted directions from Owen-scrambled Sobol points, a packet at a time.
///
/// The first two Sobol dimensions are a (0,2)-sequence in base 2: of 2^k points each dyadic cell of
/// area 2^-k holds exactly one. Owen scrambling moves whole cells, so points that share a cell
/// before scrambling share one after it: the points are sorted into cells once, not once per
/// receiver.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace surfelao {

/// The same points for everyone, before scrambling. Both coordinates are stored with their bits
/// reversed, as the scramble wants them.
struct SobolPoints {
    std::vector<std::uint32_t> reversed_u, reversed_v;
};

/// The first `count` points, ordered so that each aligned run of 2^k of them fills one cell.
[[nodiscard]] SobolPoints sobol_points_by_cell(std::uint32_t count);

/// Where the directions of one receiver point, and how its points are scrambled.
struct Hemisphere {
    glm::vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< orthonormal; z is the receiver's normal
    std::uint32_t scramble_u = 0, scramble_v = 0;
};

/// normal: unit length. Equal (seed, receiver) give equal scrambles, others independent ones.
[[nodiscard]] Hemisphere hemisphere_over(glm::vec3 normal, std::uint32_t seed,
                                         std::uint32_t receiver);

inline constexpr int kPacket = 16;

/// Unit directions as structure of arrays, and their cosine with the hemisphere's axis (>= 0).
struct alignas(64) DirectionPacket {
    float x[kPacket], y[kPacket], z[kPacket], cosine[kPacket];
};

/// Points first to first + 15 of one hemisphere. The tables must reach that far.
void fill_directions(const SobolPoints& points, std::uint32_t first, const Hemisphere& hemisphere,
                     DirectionPacket& packet);

/// Point `index` of 16 hemispheres: one direction each.
void fill_directions_across(const SobolPoints& points, std::uint32_t index,
                            const Hemisphere (&hemispheres)[kPacket], DirectionPacket& packet);

}  // namespace surfelao
