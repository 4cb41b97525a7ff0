/// stl_io.h: stereolithography files, ascii and binary. Read only: the format has no place for
/// values at vertices.
///
/// A file is ascii when it begins with the word `solid`, its first kilobyte is text, and its size
/// is not what the count of a binary file says. Ascii files may hold several solids; facet normals
/// and names are passed over. Bytes after the last facet of a binary file are ignored.
#pragma once

#include "surfels/scene.h"

#include <string>

namespace surfelao {

/// file_name is what faults are reported of. Corners at exactly the same position become one
/// vertex, numbered in the order of first use; the scene tells that they are free_vertices. Faults
/// name the line (ascii) or the facet, counted from 0.
[[nodiscard]] Scene read_stl(const std::string& file_name, const std::string& contents);

}  // namespace surfelao
