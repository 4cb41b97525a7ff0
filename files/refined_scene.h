/// refined_scene.h: a scene whose triangles are cut, with the file that it would have been read
/// from.
///
/// The file's own vertices come first and in their order, the new ones behind them (glTF: in each
/// mesh; there each use of a mesh gets one of its own, as for values at vertices). All that
/// vertices and corners have is interpolated and rounded as the file's numbers are: coordinates,
/// colours, texture coordinates, morph targets, whatever scalars there are; normals and the
/// directions of tangents keep the lengths of those at the ends. Polygons become the pieces of
/// their triangles where one of these is cut, each with all that the polygon had; others stay as
/// they are, and so does the rest of the file: groups, materials, comments, elements.
///
///   .ply        lists of vertices are those of the first end; `texcoord` of faces is interpolated.
///               Triangle strips: only coordinates and colours are kept, a note says so
///   .obj        coordinates, texture coordinates and normals that the file has behind its first
///               face come before it, so that no face uses what comes later; numbers of corners
///               that count backwards become those that count from 1
///   .off        what stands behind a face's corners stands behind those of its pieces
///   .gltf .glb  positions that are whole numbers become floats, which hold the middles. Strips and
///               fans become lists. `_FEATURE_ID_n` is that of the first end. What was there before
///               the cut stays in the file, unused
///   others      (.stl, scenes made in code) have no asset afterwards
///
/// A file may get normals with the cut, where it gives none: PLY nx ny nz and OFF's N only where it
/// has none at all, glTF's NORMAL in meshes whose vertices get any, OBJ's vn at corners without.
#pragma once

#include "surfels/refinement.h"
#include "surfels/scene.h"

#include <glm/vec3.hpp>

#include <span>

namespace surfelao {

/// Throws InputError for a scene whose vertices follow joints: weights are not interpolated.
void check_refinable(const Scene& scene);

/// The triangles of the result are the pieces, in their order. Notes are those of the scene. O(n);
/// the file is written anew in memory and read again. normals: those that the file gets, one per
/// vertex of the result in the refinement's numbers (the old ones, then the new), in world space,
/// of unit length or zero: none. Of glTF only for a scene without normals. Empty: it gets none.
/// Throws as check_refinable(), and InputError where an attribute of a glTF has not one element for
/// each vertex.
[[nodiscard]] Scene refined_scene(const Scene& scene, const Refinement& refinement,
                                  std::span<const glm::vec3> normals = {});

}  // namespace surfelao
