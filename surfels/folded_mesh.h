/// folded_mesh.h: a mesh that takes less room while nobody looks at parts of it.
#pragma once

#include "surfels/surface.h"

#include <glm/vec3.hpp>

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

/// The same of Surface::corners(): of what is rough here and there most are the triangles' own.
class FoldedCorners {
public:
    /// Until unfold() nobody asks for the corners. O(n).
    explicit FoldedCorners(Mesh& mesh);

    void unfold();

private:
    struct Split {
        std::uint32_t triangle;
        glm::uvec3 wedges;
    };
    Mesh& mesh_;
    std::vector<Split> splits_;  ///< empty: the surface has its corners still
};

}  // namespace surfelao
