/// subdivide_job.h: a mesh subdivided (subdivide.h) for a job that bakes it at its vertices.
#pragma once

#include "bake/error_search.h"
#include "bake/occluders.h"
#include "bake/vertex_target.h"
#include "engines/engine.h"
#include "surfels/refinement.h"
#include "surfels/surface.h"

#include <cstdint>

namespace surfelao {

/// The refined scene as a mesh in the frame of the old one: with its normals, interpolated, without
/// those triangles that it left out, and with what occludes it. scene: refined_scene() of
/// mesh.scene.
[[nodiscard]] Mesh refined_mesh(const Mesh& mesh, const Refinement& refinement, Scene scene);

/// Their errors look like bends. Without kPieceMargin, with a quality of 1, 2, 3, 4 a second run
/// over the result cuts 27, 9, 3 and 2 % of the room (data/) anew, and 4, .3, 0 and 0 % of the
/// Cornell box.
inline constexpr float kAskedQuality = 3.0f;

/// What became of a mesh that a job subdivided.
struct SubdivisionReport {
    std::uint64_t old_vertices = 0;
    std::uint64_t old_triangles = 0;
    std::uint64_t asked = 0;
    int rounds = 0;
    double seconds = 0.0;
};

/// The mesh subdivided, with the file that it would have been read from, for a job by these
/// settings. First its vertices part where their corners have different normals, and the file gets
/// normals where it gives none, so that it holds the surface that is asked: copies come behind the
/// file's vertices, before those of edges; a vertex itself has the normal of the first of its
/// triangles. Files with one normal for each vertex stay as they are. Masks at kAskedQuality are
/// asked, whoever bakes, so that all bake the same mesh and no noise of rays is taken for a bend;
/// for a kernel that they do not know, the job's engine. occluders: in the mesh's frame. Says
/// "subdivide" to progress. Throws as subdivide() and refined_scene().
[[nodiscard]] Mesh subdivided(const Mesh& mesh, double tolerance, const TargetSettings& target,
                              const EngineSettings& engine, Occluders& occluders,
                              const StageProgress& progress, SubdivisionReport& report);

}  // namespace surfelao
