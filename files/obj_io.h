/// obj_io.h: Wavefront OBJ.
///
/// Read: `v x y z`, also with w (a weight of rational curves: no part of a position) and with a
/// colour; `vn x y z` (any numbers, also nan; what else stands on its line is passed over); `f` and
/// its old name `fo` in the forms v, v/vt, v//vn, v/vt/vn, counted from 1 or backwards from the
/// last vertex or normal so far; comments, continued lines, any line ends. A face may use vertices
/// and normals that come later, and have normals at some corners only. Texture indices must be
/// numbers and are not looked up; points, lines, curves, groups, materials and unknown statements
/// are no surface and are passed over (a material file need not be there).
///
/// Passed over and counted in Scene::notes: faces of fewer than three corners (unless the file ends
/// within: it may be cut), normals of corners that the file does not have, vertices without a
/// finite place that no face uses (mesh_source.h).
#pragma once

#include "surfels/occlusion.h"
#include "surfels/scene.h"

#include <span>
#include <string>
#include <string_view>

namespace surfelao {

/// file_name is what faults are reported of; contents is the file. Vertices are those of the `v`
/// lines, in order; normals those of the `vn` lines, if a face uses any. Faults name the line, or
/// the vertex and face, counted from 0.
[[nodiscard]] Scene read_obj(const std::string& file_name, std::string contents);

/// The scene as OBJ with the visibility as the grey colour of each vertex (`v x y z grey grey
/// grey`, six decimals). A scene that came from OBJ gives the text of its file with nothing changed
/// but the `v` lines, whose coordinates stay as they are written (w and former colours go).
/// mark: a comment as the first line, in the place of an older one (maker_mark.h); empty: none.
[[nodiscard]] std::string obj_contents(const Scene& scene, std::span<const Occlusion> occlusion,
                                       std::string_view mark = {});

}  // namespace surfelao
