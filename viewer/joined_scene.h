/// joined_scene.h: several files as one scene, to be shown and solved together.
#pragma once

#include "surfels/scene.h"

#include <span>

namespace surfelao {

/// join() with texture coordinates, labels and what paints the surfaces: one file's behind the
/// other's. Each file is a node of its name, and so is what it has as parts (part_list.h), so that
/// a list of nodes has all files. Labels of one kind and name are one. Throws as join(), and
/// InputError where one has no triangles.
[[nodiscard]] Scene joined_scene(std::span<const Scene> scenes);

}  // namespace surfelao
