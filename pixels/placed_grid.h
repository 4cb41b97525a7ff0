/// placed_grid.h: objects with AO grids in a scene, and what they hide together.
///
/// A grid goes where its object goes, turned, mirrored and scaled with it: how much of the sphere
/// is hidden, and where, does not depend on scale.
///
/// Several objects:
///
///     product   1 - occlusion = product of (1 - occlusion_i): in any order the same; too dark
///               where one hides what another one hides already
///     union     their cones are joined, and the joint one is asked. The caps' area is exact
///               (merged_caps), its mean direction that of both less what they share, which is
///               taken as lying between them, nearer to the smaller. Another order gives a little
///               other cones
#pragma once

#include "engines/moving.h"
#include "grid/ao_grid.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

enum class GridMerge { product, caps };
/// "product", "union"
[[nodiscard]] std::string name_of(GridMerge merge);
[[nodiscard]] std::optional<GridMerge> grid_merge_of(std::string_view name);

struct PlacedGrid {
    std::shared_ptr<const AoGrid> grid;
    Placement placement;        ///< from the object's own units to the unit frame
    glm::dvec3 lift{0.0};       ///< lift_of() the object (bake/grid_target.h)
    std::uint32_t surface = 0;  ///< the number of its own surface, where it is not read; 0: none
};

/// Unit frame to the object's own units.
[[nodiscard]] glm::dvec3 in_object(const PlacedGrid& object, glm::vec3 position);

/// m / (4 pi), in directions of the unit frame, and alpha there, with the border.
[[nodiscard]] glm::vec4 moments_at(const PlacedGrid& object, glm::vec3 position);

/// Moments of two cones, joined.
[[nodiscard]] glm::vec4 merged(const glm::vec4& a, const glm::vec4& b);

/// The occlusion by one of them; normal: of unit length.
[[nodiscard]] float occlusion_at(const PlacedGrid& object, glm::vec3 position, glm::vec3 normal);

/// What one object, or all of them joined, takes of the light at a receiver.
struct TakenLight {
    float occlusion = 0.0f;
    glm::vec4 moments{0.0f};  ///< from where: m / (4 pi) and alpha
};
/// The cones that a merge ends with: one of each object that hides anything, or the joint one.
/// surface: whose receiver it is (PlacedGrid::surface); 0: nobody's.
[[nodiscard]] std::vector<TakenLight> taken_at(std::span<const PlacedGrid> objects, GridMerge merge,
                                               glm::vec3 position, glm::vec3 normal,
                                               std::uint32_t surface = 0);

/// The share of the light that all of them leave: the twin of GridPass.
[[nodiscard]] float visibility_at(std::span<const PlacedGrid> objects, GridMerge merge,
                                  glm::vec3 position, glm::vec3 normal, std::uint32_t surface = 0);

}  // namespace surfelao
