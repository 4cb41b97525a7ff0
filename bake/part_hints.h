/// part_hints.h: parts that a user probably does not want to occlude, told by name or place, each
/// with the option that leaves them out. Sentences: lower case, no full stop.
#pragma once

#include "surfels/surface.h"

#include <string>
#include <vector>

namespace surfelao {

/// Names as engines and exporters give them: collision hulls (UCX_rock, rock_collision, rock-col)
/// and, where one thing has several, levels of detail (rock_LOD1). Of parts that are baked. Empty
/// where there are none. O(labels).
[[nodiscard]] std::vector<std::string> hints_by_name(const Mesh& mesh);

/// The name of what has all other baked parts inside, as a sky dome has; empty where nothing has.
/// O(labels + triangles).
[[nodiscard]] std::string name_of_enclosing(const Mesh& mesh);

/// As a shell takes it: in quotes where it must be.
[[nodiscard]] std::string shell_word(const std::string& name);

}  // namespace surfelao
