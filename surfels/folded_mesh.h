/// folded_mesh.h: a mesh that takes less room while nobody looks at parts of it.
#pragma once

#include "surfels/surface.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace surfelao {

/// Of a mesh whose geometry is asked for a while, but not its scene: the scene's triangles are gone
/// where the geometry has the same, and its positions are floats where they are no more than that,
/// as most files have them. 18 bytes a triangle of large scans, while engines need the memory.
class FoldedScene {
public:
    /// The mesh must outlive it. Until unfold() nobody looks at its scene's triangles and
    /// positions. O(n), all threads.
    explicit FoldedScene(Mesh& mesh);

    /// As it was, to the last bit. Once.
    void unfold();

private:
    Mesh& mesh_;
    bool is_in_geometry_;               ///< the triangles
    std::vector<glm::vec3> positions_;  ///< empty: the scene has them still
};

/// The same of Surface::corners(), where vertices have several wedges: a byte tells which of its
/// vertex' wedges a corner has.
class FoldedCorners {
public:
    /// Until unfold() nobody asks for the corners. O(n), all threads.
    explicit FoldedCorners(Mesh& mesh);

    void unfold();

private:
    Mesh& mesh_;
    std::vector<std::array<std::uint8_t, 3>> ranks_;  ///< 0: the vertex' own wedge, 1: its next
};

}  // namespace surfelao
