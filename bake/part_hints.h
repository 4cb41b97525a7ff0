/// part_hints.h: parts that a user probably does not want to occlude, told by name or place, each
/// with the option that leaves them out. Sentences: lower case, no full stop.
#pragma once

#include "surfels/surface.h"

#include <string>
#include <vector>

namespace surfelao {

/// Names as engines and exporters give them: collision hulls (UCX_rock, rock_collision, rock-col,
/// RockCollider.001) and, where one thing has several, levels of detail (rock_LOD1, LOD1_rock). Of
/// parts that are baked. Empty where there are none. O(labels).
[[nodiscard]] std::vector<std::string> hints_by_name(const Mesh& mesh);

/// The name of what has all other baked parts inside, as a sky dome has, which may be sunk a little
/// into the ground on one side; empty where nothing has.
/// O(labels + triangles).
[[nodiscard]] std::string name_of_enclosing(const Mesh& mesh);

/// The name of a baked part that is called a sky (SkyDome, BP_Sky_Sphere, skybox.001); empty where
/// none is, and where nothing else is baked. O(labels).
[[nodiscard]] std::string name_of_sky(const Mesh& mesh);

/// As a shell takes it: in quotes where it must be.
[[nodiscard]] std::string shell_word(const std::string& name);

}  // namespace surfelao
