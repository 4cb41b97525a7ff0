/// scene.h: what a file holds, as triangles in world space.
///
/// A scene is everything in the file: all nodes and instances occlude each other. It is flat: a
/// mesh used by three nodes stands here three times, because each use gets occlusion of its own.
///
/// A scene without triangles is a cloud of points (point_cloud.h).
///
/// Invariants (read_scene and make_scene guarantee them): every coordinate is finite, every index
/// is in range, the parts cover all vertices and triangles in order and without overlap, and there
/// is at least one vertex. Of the normals only the indices are in range: values may be anything.
/// A vertex whose place is no finite one in the file, and which no triangle uses, stands where a
/// vertex with a triangle stands: it changes no box.
#pragma once

#include "surfels/base_colors.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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
    /// Directions from the part's own space (object space) to the world; the identity where they
    /// are one, and for what joints move.
    glm::dmat3 to_world{1.0};
};

/// What a user may call triangles by.
enum class LabelKind { node, mesh, object, group, material };

/// Triangles that have a name in the file in common. Those of different kinds overlap: a triangle
/// has a node, a mesh and a material, and of nodes (glTF) also all that its node lies below. Labels
/// of one kind and name are one. OBJ has objects (o), groups (g) and materials (usemtl), text STL
/// objects (solid), PLY and OFF nothing (labels.h).
struct Label {
    struct Range {
        std::uint32_t first = 0, count = 0;
        bool operator==(const Range&) const = default;
    };
    LabelKind kind = LabelKind::object;
    std::string name;           ///< as in the file, never empty
    std::vector<Range> ranges;  ///< of scene triangles, rising, apart from each other, not empty
};

/// The normals that a file gives, one per corner of a triangle: many corners may share one.
struct CornerNormals {
    std::vector<glm::vec3> values;  ///< world space, of any length; zero = the file gives none
    /// Per triangle, into values; kNone where a corner has none. Empty: the triangles themselves
    /// are indices into values (one normal per vertex).
    std::vector<glm::uvec3> corners;

    static constexpr std::uint32_t kNone = 0xffffffff;

    [[nodiscard]] bool empty() const { return values.empty(); }
    /// Whether there is one for each vertex.
    [[nodiscard]] bool of_vertices() const { return !values.empty() && corners.empty(); }
};

/// Where the corners of triangles lie in a map: u to the right, v down, the map from 0 to 1.
struct UvSet {
    std::vector<glm::dvec2> values;
    /// Per triangle, into values; kNone where a corner has none. Empty: the triangles themselves
    /// are indices into values (one place per vertex).
    std::vector<glm::uvec3> corners;

    static constexpr std::uint32_t kNone = 0xffffffff;

    [[nodiscard]] bool empty() const { return values.empty(); }
};

/// The file as its writer needs it to hand it back untouched; opaque to everyone else.
class SourceAsset {
public:
    virtual ~SourceAsset() = default;
    /// The file's own colours for a writer of another format: one per scene vertex in linear light
    /// and alpha, 0 to 1, white where a vertex has none; empty where the file has none. O(bytes).
    [[nodiscard]] virtual std::vector<glm::vec4> own_colors() const { return {}; }
    /// What the file paints its surfaces with, vertex colours apart; no materials where it says
    /// nothing of it. What is malformed in it is white. O(bytes).
    [[nodiscard]] virtual BaseColors base_colors() const { return {}; }
    /// Whether any of these materials is not Opacity::solid: known without a look at all triangles.
    [[nodiscard]] virtual bool has_openings() const { return false; }
    /// The number of the texture coordinates (Scene::uvs) over which the file has a map of
    /// occlusion already; of several the first. O(primitives).
    [[nodiscard]] virtual std::optional<std::uint32_t> occlusion_uvs() const { return {}; }
};

struct Scene {
    std::string name;                   ///< the file's name without folder, for messages
    std::vector<glm::dvec3> positions;  ///< world space, in the file's own order and number
    std::vector<glm::uvec3> triangles;  ///< into positions; polygons are already cut up
    std::vector<Part> parts;
    CornerNormals normals;   ///< empty where the file has none
    std::vector<UvSet> uvs;  ///< by number: glTF's TEXCOORD_0, _1 and so on
    /// One per vertex, as the file gives them (glTF's TANGENT): the direction of the world in which
    /// u grows, of unit length, and in w the sign of the third axis, w * cross(normal, tangent).
    /// Zero where a part has none; empty where all parts do. They belong to the texture coordinates
    /// of the material's normalTexture, which are mostly set 0.
    std::vector<glm::vec4> tangents;
    std::vector<Label> labels;  ///< in the order in which their first triangles stand
    /// Clouds: where the scanner stood, in the coordinates of the points.
    std::optional<glm::dvec3> viewpoint;
    /// Clouds: points without a finite place in the file, rising (an organised cloud has them where
    /// the scanner saw nothing). They stand where the first other point stands, occlude nothing and
    /// get occlusion 0.
    std::vector<std::uint32_t> placeless;
    bool free_vertices = false;  ///< the file has none of its own (STL): they may be split
    /// What the file holds and nobody honours, and what in it was let pass: a sentence each.
    std::vector<std::string> notes;
    std::shared_ptr<const SourceAsset> asset;  ///< null for scenes made in code
};

/// A scene of one part from arrays. Throws InputError naming the element where a coordinate is not
/// finite or beyond kFarthest, a triangle uses a vertex that there is not, or there is no triangle.
[[nodiscard]] Scene make_scene(std::span<const glm::dvec3> positions,
                               std::span<const glm::uvec3> triangles);

/// All of them as one, one behind the other, with their normals; parts without a name get their
/// scene's. Texture coordinates, tangents, labels and assets are left out. Throws SettingsError for
/// more elements than kMostElements.
[[nodiscard]] Scene join(std::span<const Scene> scenes);

/// Throws InputError as make_scene does, but takes a scene without triangles.
void check_scene(const Scene& scene);

/// Largest coordinate, either way: the size of the box is then a double too.
inline constexpr double kFarthest = 1e300;

/// Vertices and triangles that a scene may have, each.
inline constexpr std::uint32_t kMostElements = 0x7fffffff;

}  // namespace surfelao
