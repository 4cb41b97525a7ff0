/// tangents.h: the frames in which maps of tangent space hold directions.
///
/// A direction (x, y, z) of the map means x t + y b + z n, normalised: n is the shading normal, t
/// goes along u, both interpolated as they are, without another normalisation, and b = sign * (n x
/// t) of each pixel. Along b v grows as OBJ counts it, upward: a UvSet's v shrinks. It is how
/// glTF's viewers, Blender and Unreal decode normal maps ("+y"; DirectX's way, "-y", turns y
/// round).
///
/// Tangents are those that MikkTSpace makes, by definition and not by its code. Corners share one
/// where position, normal and place in the map are the same, and the triangles around hang together
/// over edges and are not mirrored to each other: it is the mean of the triangles' directions of u,
/// each in the plane of the normal, weighted by the triangle's angle there.
///
/// Based on:
///   Mikkelsen. Simulation of Wrinkled Surfaces Revisited. Master's thesis, Copenhagen. 2008
#pragma once

#include "surfels/surface.h"
#include "surfels/texels.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// Per corner (3 * triangle + corner of the Geometry) the direction of u, of unit length, and in w
/// the sign, 1 or -1. All 0 for triangles without area in the map, of which no texel is.
using Tangents = std::vector<glm::vec4>;

/// uvs: of mesh.scene. of_vertices: what the file gives, one per vertex of the scene (glTF's
/// TANGENT), or none; triangles that have one of some length at each corner take it, whatever uvs
/// say: viewers do. O(n); edges of more than kMostTangentSides triangles part them. Equal input
/// gives equal bytes.
[[nodiscard]] Tangents make_tangents(const Mesh& mesh, const UvSet& uvs,
                                     std::span<const glm::vec4> of_vertices = {});

inline constexpr std::size_t kMostTangentSides = 16;

/// What a map holds at a point for a direction in the world, of unit length; green_down: DirectX's
/// way. Zero for a zero direction, and for points without a frame.
[[nodiscard]] glm::vec3 to_tangent_space(const Mesh& mesh, const Tangents& tangents,
                                         const SurfacePoint& point, glm::vec3 direction,
                                         bool green_down = false);

}  // namespace surfelao
