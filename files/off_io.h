/// off_io.h: the Object File Format of Geomview.
///
/// Read: [ST][C][N]OFF in ascii, the keyword may be missing; the counts on the keyword's line, with
/// or without a space before them, or the next; comments anywhere. A vertex takes x y z and, under
/// N, its normal (any numbers; zero for a vertex without) and what else stands on its line (colour,
/// texture coordinates: numbers, not used). Faces of fewer than three corners are passed over and
/// counted in Scene::notes, as are vertices without a finite place that no face uses
/// (mesh_source.h); a face's colour is passed over. The edge count may be missing and is not used.
/// Homogeneous (4), n-dimensional (n) and BINARY files are refused.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/scene.h"

#include <span>
#include <string>
#include <string_view>

namespace surfelao {

/// file_name is what faults are reported of; contents is the file. Faults name the line.
[[nodiscard]] Scene read_off(const std::string& file_name, std::string contents);

/// The scene as COFF: vertices with the visibility as grey (`x y z g g g 255`, g in 0..255), the
/// polygons of its source where it has them. Normals, texture coordinates and face colours of an
/// OFF source are not carried over.
/// mark: a comment as the last line (maker_mark.h); empty: none.
[[nodiscard]] std::string off_contents(const Scene& scene, std::span<const Occlusion> occlusion,
                                       std::string_view mark = {});

}  // namespace surfelao
