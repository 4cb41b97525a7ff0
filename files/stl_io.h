/// stl_io.h: stereolithography files, ascii and binary. Read only: the format has no place for
/// values at vertices.
///
/// A file is ascii when its first kilobyte has no zero byte and its size is not what the count of a
/// binary file says: binary files that begin with `solid` are known by that. Ascii files may hold
/// several solids, in capitals or not, whose names become Scene::labels; facet normals are passed
/// over.
///
/// Let pass and counted in Scene::notes: `end loop` for `endloop` and the like; lines outside
/// of solids and lines of comment (`#`) between facets; ascii facets of fewer than three vertices;
/// bytes behind the last facet of a binary file. Refused as in doubt: a solid that does not end,
/// and a binary file that holds more whole facets than it says.
#pragma once

#include "surfels/scene.h"

#include <string>

namespace surfelao {

/// file_name is what faults are reported of. Corners at exactly the same position become one
/// vertex, numbered in the order of first use; the scene tells that they are free_vertices. Faults
/// name the line (ascii) or the facet, counted from 0.
[[nodiscard]] Scene read_stl(const std::string& file_name, const std::string& contents);

}  // namespace surfelao
