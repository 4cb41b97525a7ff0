/// face_places.h: where the faces of a mesh lie in a map, for the writers of OBJ and PLY.
#pragma once

#include "files/mesh_source.h"

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// A face as it is written.
struct PlacedFace {
    std::span<const std::uint32_t> corners;  ///< by their numbers in the file's face
    std::span<const std::uint32_t> places;   ///< of each, into UvSet::values; empty: it has none
};

/// Whether faces of more than three corners may stay.
enum class FaceShape { polygons, triangles };

/// Goes through the faces of a scene: the source's polygons, else its triangles (for_each_face).
class FacePlaces {
public:
    /// Both must outlive it; the places fit the scene (write_scene_with_map).
    FacePlaces(const Scene& scene, const UvSet& uvs, FaceShape shape);

    /// The next face: in one, where that may be and each of its corners has one place, else its
    /// triangles. A corner
    /// that has none beside others that have one stands with one of these. Good until the next
    /// call. O(corners), and once more what it takes to cut a polygon.
    [[nodiscard]] std::span<const PlacedFace> next();

private:
    void add(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> places);

    const Scene& scene_;
    const UvSet& uvs_;
    FaceShape shape_;
    const Polygons* polygons_;
    std::size_t face_ = 0;
    std::size_t corner_ = 0;    ///< of all polygons
    std::size_t triangle_ = 0;  ///< of the scene
    std::vector<glm::uvec3> cut_;
    std::vector<std::uint32_t> whole_;  ///< a place for each corner
    std::vector<std::uint32_t> corners_, places_;
    std::vector<PlacedFace> faces_;
};

}  // namespace surfelao
