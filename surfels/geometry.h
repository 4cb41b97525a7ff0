/// geometry.h: the scene as every engine sees it: floats in one unit frame, clean, welded.
///
/// The frame is centred on the bounding box of all triangles and scaled by its diagonal, in double
/// precision, so that every length and every epsilon in the engines is a share of the diagonal and
/// neither a far offset (1e6) nor a tiny unit (1e-6) costs digits.
#pragma once

#include "surfels/scene.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace surfelao {

/// world = centre + diagonal * unit
struct Frame {
    glm::dvec3 centre{0.0};
    double diagonal = 1.0;  ///< > 0; 1 where all triangles lie in one point
};

/// World space. Empty where low is above high.
struct Box {
    glm::dvec3 low{std::numeric_limits<double>::max()};
    glm::dvec3 high{-std::numeric_limits<double>::max()};

    void include(glm::dvec3 place)
    {
        low = glm::min(low, place);
        high = glm::max(high, place);
    }
};

/// Of an empty box the frame is the world itself.
[[nodiscard]] Frame frame_of(const Box& box);

/// Of all triangles but those left out (GeometryScope).
[[nodiscard]] Box box_of(const Scene& scene, const std::vector<bool>& left_out = {});

/// How much of a scene is looked at, and within what.
struct GeometryScope {
    std::optional<Frame> frame = {};  ///< of a larger world; empty: of the scene by itself
    std::vector<bool> left_out = {};  ///< scene triangles that are not there; empty: all are
};

/// Invariants: all values finite; every triangle has an area > 0 in float arithmetic; |normal| is 1
/// or 0; vertices at one and the same world position, and those that differ from it by float noise
/// only (weld.h), have the same `welded` entry.
struct Geometry {
    Frame frame;
    std::vector<glm::vec3> positions;   ///< one per scene vertex, unit frame
    std::vector<glm::vec3> normals;     ///< one per scene vertex; zero where no triangle gives one
    std::vector<glm::uvec3> triangles;  ///< into positions; those without area are left out
    std::vector<std::uint32_t> welded;  ///< one per vertex: lowest vertex index at this place
    std::vector<float> areas;           ///< a third of the adjacent triangles, summed over welded
                                        ///< vertices, at the lowest vertex; 0 elsewhere. Of several
                                        ///< triangles over the same three positions one counts:
                                        ///< doubled faces occlude no more than single ones
    std::uint64_t dropped_triangles = 0;  ///< scene triangles without area
    std::vector<std::uint32_t> kept;      ///< per triangle, its index in the scene; empty where
                                          ///< none is dropped or left out

    /// The index in the scene of a triangle.
    [[nodiscard]] std::size_t scene_triangle(std::size_t triangle) const
    {
        return kept.empty() ? triangle : kept[triangle];
    }
};

/// A triangle counts as having no area when twice its area is at most this share of its longest
/// edge squared (in double: relative rounding of float files is 6e-8, of the computation 1e-16), or
/// when its area is 0 after rounding to the unit frame.
inline constexpr double kZeroAreaRatio = 1e-12;

/// The normal of a vertex is the area-weighted mean of the triangles around its *position* (seams
/// in the file do not split it). Where that sum cancels (two sheets back to back) it is the mean
/// over the vertex's own triangles, then the normal of its largest triangle. A position that only
/// dropped triangles use takes the normal of the nearest neighbour along them. A vertex that no
/// triangle uses takes the normal of its position; where nothing else stands there it has none
/// (zero).
///
/// O(n) expected; equal input gives equal bytes. A scene without triangles is allowed; throws
/// InputError as check_scene does.
[[nodiscard]] Geometry make_geometry(const Scene& scene, const GeometryScope& scope = {});

/// Of all its triangles, in world space.
[[nodiscard]] Box box_of(const Geometry& geometry);

/// Of each triangle, in the unit frame.
[[nodiscard]] std::vector<double> triangle_areas(const Geometry& geometry);

}  // namespace surfelao
