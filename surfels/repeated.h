/// repeated.h: triangles over the same three positions.
///
/// Internal: for the folders' own sources.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace surfelao {

/// Which triangles may have the same three positions as another one, in any turn, rising: all that
/// do, and by chance some of those that do not. Nearly all meshes have none, so a bit per hash
/// value sifts the others out. welded: Geometry::welded. O(n), all threads.
[[nodiscard]] std::vector<std::uint32_t> maybe_repeated(const std::vector<glm::uvec3>& triangles,
                                                        const std::vector<std::uint32_t>& welded);

/// The positions of a triangle in rising order.
[[nodiscard]] glm::uvec3 positions_of(glm::uvec3 triangle,
                                      const std::vector<std::uint32_t>& welded);

}  // namespace surfelao
