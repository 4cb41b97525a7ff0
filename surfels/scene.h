/// scene.h: what a file holds, as triangles in world space.
///
/// A scene is everything in the file: all nodes and instances occlude each other. It is flat: a
/// mesh used by three nodes stands here three times, because each use gets occlusion of its own.
///
/// Invariants (read_scene guarantees them; nothing behind it checks again): every coordinate is
/// finite, every index is in range, the parts cover all vertices and triangles in order and without
/// overlap, and there is at least one triangle.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace surfelao {

/// One use of one mesh: a consecutive range of vertices and triangles.
struct Part {
    std::string name;  ///< for messages and tables: may be empty, long ones are cut
    std::uint32_t first_vertex = 0;
    std::uint32_t vertex_count = 0;
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
    std::int32_t node = -1;  ///< glTF: node, mesh and primitive that this part is; else -1
    std::int32_t mesh = -1;
    std::int32_t primitive = -1;
};

/// The file as its writer needs it to hand it back untouched; opaque to everyone else.
class SourceAsset {
public:
    virtual ~SourceAsset() = default;
};

struct Scene {
    std::string name;                   ///< the file's name without folder, for messages
    std::vector<glm::dvec3> positions;  ///< world space, in the file's own order and number
    std::vector<glm::uvec3> triangles;  ///< into positions; polygons are already cut up
    std::vector<Part> parts;
    std::shared_ptr<const SourceAsset> asset;  ///< null for scenes made in code
};

}  // namespace surfelao
