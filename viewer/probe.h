/// probe.h: what is known of a place that a picture shows.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/surface.h"
#include "viewer/cell.h"
#include "viewer/cell_view.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace surfelao {

/// Values are those that were found, where they lie: at the nearest corner of the triangle, in the
/// map as it is fetched, at the pixel. Those of methods of the picture and of cube maps have a bent
/// normal of zero.
struct Reading {
    SurfacePoint point;
    glm::vec3 place{0.0f};     ///< the corner or the point, as it is shown; unit frame
    glm::dvec3 position{0.0};  ///< the same in the file's units
    glm::vec3 normal{0.0f};    ///< of the shading there
    std::uint32_t vertex = 0;  ///< the nearest corner; of the scene
    std::size_t triangle = 0;  ///< of the scene
    std::string part;          ///< innermost label of the file; empty where it has none
    std::optional<Occlusion> own, reference;
};

/// point: of the model that the view shows; cell: the view's. pixel: of a picture that the last
/// look() was for, from its lower left corner.
[[nodiscard]] Reading read_at(const CellView& view, const Cell& cell, const SurfacePoint& point,
                              glm::ivec2 pixel);

/// Line by line, with units.
[[nodiscard]] std::string text_of(const Reading& reading);

}  // namespace surfelao
