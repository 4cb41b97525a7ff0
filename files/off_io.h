/// off_io.h: the Object File Format of Geomview.
///
/// Read: [ST][C][N]OFF in ascii, the keyword may be missing; the counts on the keyword's line, with
/// or without a space before them, or the next; comments anywhere. A vertex takes x y z and, under
/// N, its normal (any numbers; zero for a vertex without) and what else stands on its line (colour;
/// under ST two texture coordinates as the last, v running up, nan for a vertex without). Faces of
/// fewer than three corners are passed over and counted in Scene::notes, as are vertices without a
/// finite place that no face uses (mesh_source.h); a face's colour is passed over. The edge count
/// may be missing and is not used. Without any face it is a cloud of points. Homogeneous (4),
/// n-dimensional (n) and BINARY files are refused.
#pragma once

#include "files/scene_io.h"

#include <span>
#include <string>
#include <string_view>

namespace surfelao {

/// file_name is what faults are reported of; contents is the file. Faults name the line.
[[nodiscard]] Scene read_off(const std::string& file_name, std::string contents);

/// The scene as OFF with colours (vertex_colors.h), `x y z r g b a` of bytes; `automatic` shades
/// those of the file, which are numbers up to 1, or to 255 where one of the file is above 2.
///
/// A scene that came from OFF gives the text of its file with nothing changed but the keyword and
/// the colours of the vertices (and numbers there that have no meaning: they go). Where the file's
/// own colours are not kept, they stand in comments behind everything else, `# own R G B A`.
/// Any other scene gives coordinates, colours, faces and, where each vertex has one, normals.
/// options.mark: a comment as the last line, in the place of an older one (maker_mark.h).
[[nodiscard]] WrittenFile off_contents(const Scene& scene, std::span<const Occlusion> occlusion,
                                       const WriteOptions& options = {});

/// The text of the file that a scene was read from, without anything that a bake has added.
[[nodiscard]] std::string original_off(const Scene& scene);

}  // namespace surfelao
