/// movables.h: what a user can take hold of in a scene and move as one.
#pragma once

#include "surfels/surface.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace surfelao {

struct Movable {
    std::string name;  ///< of the file; "piece 3" where it has none
    std::uint64_t triangles = 0;
    glm::vec3 low{0.0f}, high{0.0f};  ///< its box as it was read; unit frame
    glm::vec3 middle() const { return 0.5f * (low + high); }
};

/// In the order of their first triangles.
struct Movables {
    static constexpr std::uint32_t kNone = 0xffffffff;
    std::vector<Movable> list;
    std::vector<std::uint32_t> of_vertex;  ///< one per scene vertex; kNone: it moves with nothing
};

/// Of a glTF of several nodes with meshes its nodes. Else the innermost labels of the kind that
/// tells most parts apart (objects, groups, materials). Else connected pieces: triangles that share
/// a place. What shares vertices is one. Parts without a triangle that has an area are none. Empty
/// for clouds. O(n).
[[nodiscard]] Movables movables_of(const Mesh& mesh);

}  // namespace surfelao
