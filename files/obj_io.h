/// obj_io.h: Wavefront OBJ.
///
/// Read: `v x y z`, also with w (a weight of rational curves: no part of a position) or with a
/// colour and alpha; `vn x y z` (any numbers, also nan; what else stands on its line is passed
/// over); `vt u v` (v runs up, and is 0 where it is missing; what is no number is nan, what else
/// stands on its line is passed over); `f` and its old name `fo` in the forms v, v/vt, v//vn,
/// v/vt/vn, counted from 1 or backwards from the last vertex, texture coordinate or normal so far;
/// comments, continued lines, any line ends. A face may use vertices, texture coordinates and
/// normals that come later, and have the latter two at some corners only. Points, lines, curves,
/// and unknown statements are no surface and are passed over (a material file need not be there).
/// Names behind `o`, `g` (several on a line: the faces have all of them) and `usemtl` become
/// Scene::labels.
///
/// Passed over and counted in Scene::notes: faces of fewer than three corners (unless the file ends
/// within: it may be cut), normals and texture coordinates of corners that the file does not have,
/// vertices without a finite place that no face uses (mesh_source.h).
#pragma once

#include "files/scene_io.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace surfelao {

/// file_name is what faults are reported of; contents is the file. Vertices are those of the `v`
/// lines, in order; normals and texture coordinates (one set) those of the `vn` and `vt` lines, if
/// a face uses any. Without any face it is a cloud of points, with the normals of `vn` if there are
/// as many as points. Faults name the line, or the vertex and face, counted from 0.
[[nodiscard]] Scene read_obj(const std::string& file_name, std::string contents);

/// The scene as OBJ with colours (vertex_colors.h), `v x y z r g b` with six decimals; `automatic`
/// shades those of the file. They are numbers up to 1, or to 255 where one of the file is above 2;
/// of seven numbers of a vertex the last is alpha, of four a weight, which goes.
///
/// A scene that came from OBJ gives the text of its file with nothing changed but the colours of
/// the `v` lines and, seen from the folder of `path`, the names behind `mtllib`. Where the file's
/// own colours are not kept, they stand in comments behind everything else, `# own R G B`.
/// Any other scene gives coordinates, colours, faces and, where each vertex has one, normals.
/// options.mark: a comment as the first line, in the place of an older one (maker_mark.h).
[[nodiscard]] WrittenFile obj_contents(const std::filesystem::path& path, const Scene& scene,
                                       std::span<const Occlusion> occlusion,
                                       const WriteOptions& options = {});

/// The text of the file that a scene was read from, without anything that a bake has added.
[[nodiscard]] std::string original_obj(const Scene& scene);

/// The scene as OBJ whose materials have the map of map_file_of(path) as map_Ka, and the text of
/// the file that they stand in: map_materials_of(path), which is the only one that the OBJ names.
///
/// A scene that came from OBJ gives the text of its file, its own colours kept. `usemtl` of a plain
/// material stands before faces without one. The materials are those of the file's own libraries
/// (obj_materials.h). With new coordinates (map.uvs) its `vt` lines go and new ones stand before
/// the first face, `f` gets new vt; a polygon whose corners have several places becomes its
/// triangles. Any other scene gives its coordinates, colours and faces, over map.uvs or its own set
/// map.uv_set, with one plain material.
struct ObjWithMap : WrittenFile {
    std::string materials;
};
[[nodiscard]] ObjWithMap obj_contents_with_map(const std::filesystem::path& path,
                                               const Scene& scene, const OcclusionMap& map,
                                               const WriteOptions& options = {});

}  // namespace surfelao
