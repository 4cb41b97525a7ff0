/// ply_io.h: the Stanford polygon format, ascii and binary of both byte orders.
///
/// Read: element `vertex` with scalar properties x, y, z of any type; element `face` with the list
/// `vertex_indices` or `vertex_index`; element `tristrips` (a strip ends at -1, triangles that use
/// a vertex twice only turn the strip and are left out). Other elements and properties are passed
/// over. In ascii files every row stands on a line of its own. Bytes after the last element are
/// ignored. A header line that begins with `Created` is a comment: Blender 2.47 wrote it so.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/scene.h"

#include <span>
#include <string>

namespace surfelao {

/// file_name is what faults are reported of; contents is the file. Faults name the line in the
/// header and in ascii data, and the element and row (counted from 0) in all data.
[[nodiscard]] Scene read_ply(const std::string& file_name, std::string contents);

/// The scene as PLY with the vertex properties `float occlusion`, `float bent_nx bent_ny bent_nz`
/// and `uchar red green blue` (the visibility as grey).
///
/// A scene that came from PLY gives its own file with these properties put behind the others of the
/// vertex (old ones of the same names go) and nothing else changed: same format, order, comments,
/// other properties and elements.
/// Any other scene gives binary_little_endian with the polygons of its source. Coordinates are
/// float, or double where rounding to float would move some vertex by more than kFloatSlack of the
/// bounding box's diagonal (small things far from the origin).
[[nodiscard]] std::string ply_contents(const Scene& scene, std::span<const Occlusion> occlusion);

/// Twice the rounding of a float as a share of the number: half an offset unit would be 1e-4.
inline constexpr double kFloatSlack = 1.2e-7;

}  // namespace surfelao
