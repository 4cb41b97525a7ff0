/// mesh_source.h: what the readers and writers of OBJ, PLY, OFF and STL share: polygons in, Scene
/// out, and back.
#pragma once

#include "surfels/scene.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfelao {

/// Polygons one after the other.
struct Polygons {
    std::vector<std::uint32_t> corners;  ///< vertex indices of all polygons
    std::vector<std::uint32_t> sizes;  ///< corners of each polygon, >= 3; empty: all are triangles
    std::uint64_t small_count = 0;     ///< faces of fewer corners, which were passed over

    [[nodiscard]] std::size_t count() const
    {
        return sizes.empty() ? corners.size() / 3 : sizes.size();
    }
};

inline constexpr std::uint32_t kNoValue = 0xffffffff;
static_assert(kNoValue == CornerNormals::kNone && kNoValue == UvSet::kNone);

/// What corners of polygons have beside their vertex, as the file gives it; no values: nothing.
template <class Value>
struct PolygonValues {
    std::vector<Value> values;
    /// One for each of Polygons::corners, into values or kNoValue. Empty: the values are those of
    /// the vertices.
    std::vector<std::uint32_t> corners;

    /// For the corner of this number; those between the last one that has any and it have none.
    void set(std::size_t corner, std::uint32_t value)
    {
        corners.resize(corner, kNoValue);
        corners.push_back(value);
    }
    /// After close_polygon(): as many corners as there are.
    void close(const Polygons& polygons)
    {
        if (!corners.empty())
            corners.resize(polygons.corners.size(), kNoValue);
    }
};

struct PolygonCorners {
    PolygonValues<glm::vec3> normals;
    PolygonValues<glm::dvec2> uvs;  ///< as UvSet has them: v runs down
};

/// A polygon of `size` corners has just been appended to polygons.corners: one of fewer than three
/// is taken back and counted.
void close_polygon(Polygons& polygons, std::uint32_t size);

/// Appends those of a file's next lines.
void append(Polygons& polygons, const Polygons& more);

/// What the writers need beyond the Scene. The readers of OBJ and PLY derive from it and keep the
/// file itself.
class MeshSource : public SourceAsset {
public:
    Polygons polygons;             ///< empty when the file's faces are the scene's triangles
    std::filesystem::path folder;  ///< where the files lie that it names
};

/// The largest coordinate that a reader accepts: squares and sums of it stay inside a double.
inline constexpr double kLargestCoordinate = 1e100;

/// Adds "3 faces REST" to the notes (Scene::notes) where the count is not 0. The noun is as
/// count_text() takes it.
void add_note(std::vector<std::string>& notes, std::uint64_t count, const std::string& noun,
              const std::string& rest);

/// Makes the scene of a file whose vertices and polygons are known; leaves polygons with more than
/// three corners in `source`. Normals and texture coordinates that are numbered as the vertices are
/// become those of the vertices. A vertex without a place (a coordinate that is not finite or
/// beyond kLargestCoordinate) which no polygon uses stands where the first corner of all stands.
/// Notes count such vertices and the polygons that were passed over. Throws InputError when a
/// polygon uses a vertex out of range or without a place, there is no polygon, or there are more
/// vertices, normals, texture coordinates or triangles than 32 bits count; the numbers of normals
/// and texture coordinates must be in range.
[[nodiscard]] Scene make_mesh_scene(std::string_view file_name, std::vector<glm::dvec3> positions,
                                    Polygons polygons, std::shared_ptr<MeshSource> source,
                                    PolygonCorners given = {});

/// The same for what may be a cloud: where there is no polygon at all, not even a small one, a
/// scene without triangles (scene.h). Its normals are those of the vertices (zero: a vertex has
/// none), empty where none has one. A note counts points without a place (Scene::placeless) and,
/// where others have one, without a normal. Throws InputError where no point has a place.
[[nodiscard]] Scene make_scene_of(std::string_view file_name, std::vector<glm::dvec3> positions,
                                  Polygons polygons, std::shared_ptr<MeshSource> source,
                                  PolygonCorners given = {});

/// What a file gives as the place of its scanner: none where it is not finite, and none at the
/// origin, which programs write that know no place.
[[nodiscard]] std::optional<glm::dvec3> as_viewpoint(const glm::dvec3& place);

/// Calls visit(corners) with a span of the vertex indices of each face, in the file's order: the
/// source's polygons where it has them, else the scene's triangles.
template <class Visit>
void for_each_face(const Scene& scene, const Visit& visit);

/// How many times for_each_face calls.
[[nodiscard]] std::size_t face_count(const Scene& scene);

/// The most corners of a face.
[[nodiscard]] std::size_t longest_face(const Scene& scene);

// ------------------------------------------------------------------------------------------------

/// The source's polygons, or null where the triangles are the faces.
[[nodiscard]] const Polygons* source_polygons(const Scene& scene);

template <class Visit>
void for_each_face(const Scene& scene, const Visit& visit)
{
    const Polygons* polygons = source_polygons(scene);
    if (!polygons) {
        for (const glm::uvec3& triangle : scene.triangles)
            visit(std::span<const std::uint32_t>(&triangle.x, 3));
        return;
    }
    std::size_t first = 0;
    for (const std::uint32_t size : polygons->sizes) {
        visit(std::span<const std::uint32_t>(&polygons->corners[first], size));
        first += size;
    }
}

}  // namespace surfelao
