/// notes.h: where a bake disappoints, in sentences: lower case, no full stop.
#pragma once

#include "bake/vertex_target.h"
#include "surfels/occlusion.h"
#include "surfels/surface.h"
#include "surfels/topology.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// A mesh and what became of it. Nothing is owned.
struct Baked {
    const Mesh& mesh;
    const Topology& topology;  ///< of the mesh
    const Definition& definition;
    std::span<const Occlusion> values;  ///< one per vertex
    std::optional<Misfit> misfit;
};

/// What the file holds and nobody honours (Scene::notes), then what the user should know of the
/// result: normals of the file that were replaced, pieces that face inward, triangles too large for
/// values at vertices, vertices that lie inside other parts (without a ground), parts that are
/// better left out (part_hints.h), an interior without a maximum distance, nothing but triangles
/// without area. Each only where it is notable, by the figures below. O(n), small beside any
/// solving.
[[nodiscard]] std::vector<std::string> notes_of(const Baked& baked);

/// Triangles are too large where the misfit is above both. Over shared, package and data models the
/// share is at most .0003 on scans, and at least .015 where walls or floors are a few triangles.
inline constexpr double kNotableMisfit = 0.015;
inline constexpr double kNotableShare = 0.01;  ///< of the area
/// A vertex above this occlusion is closed on all sides: what lies on a wide floor is not. The
/// masks leave some vertices inside of coarse pieces up to .013 open: those are not counted.
inline constexpr float kClosed = 0.995f;
inline constexpr double kNotableClosed = 0.01;  ///< of the vertices
/// Above this mean occlusion a scene is an interior, and shades differ too little to be seen.
inline constexpr double kInteriorMean = 0.9;
/// What is recommended for interiors: longer limits still get the hint. In diagonals.
inline constexpr float kInteriorDistance = 0.1f;

/// Of the scene's vertices that something baked or nothing at all uses. O(n).
[[nodiscard]] std::uint64_t vertices_without_normal(const Mesh& mesh);

/// Over the vertices with a normal; 0 where there are none.
[[nodiscard]] double mean_occlusion_of(const Surface& surface, std::span<const Occlusion> values);

}  // namespace surfelao
