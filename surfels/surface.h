/// surface.h: the surface as it is shaded: normals at the corners of its triangles, and the places
/// from which occlusion is asked.
///
/// A *surface point* is a triangle and barycentric weights. Its geometric normal is the triangle's,
/// its shading normal the interpolated corner normals. A *wedge* is what corners of one vertex with
/// one normal have in common (Hoppe. Efficient Implementation of Progressive Meshes. 1998): a
/// vertex on a smooth surface has one, a vertex shared over a hard edge has one for each side.
#pragma once

#include "surfels/geometry.h"
#include "surfels/receiver.h"
#include "surfels/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// Where corner normals come from.
enum class NormalSource {
    automatic,  ///< the file's where they are usable, else smooth
    file,       ///< the file's whichever way they point, else smooth
    smooth,     ///< the mean over the faces around, within the crease angle
    flat,       ///< the face's own
    up,         ///< clouds of points alone: one direction for all (point_cloud.h)
};

struct NormalSettings {
    NormalSource source = NormalSource::automatic;
    float crease = 40.0f;  ///< degrees, 0 to 180: faces that meet at more are not smoothed together
    bool operator==(const NormalSettings&) const = default;
};

/// Throws SettingsError where the crease is out of its range.
void check_normals(const NormalSettings& settings);

/// Invariants: normals are of unit length, or zero for vertices that no triangle gives one; every
/// corner's wedge belongs to the corner's vertex. The first wedges are the vertices' own, in their
/// order; what further wedges a vertex has comes after all of those.
struct Surface {
    std::vector<glm::vec3> normals;             ///< per wedge
    std::vector<std::uint32_t> extra_vertices;  ///< of the wedges beyond one per vertex
    std::uint64_t corners_from_file = 0;        ///< corners that took the file's normal
    std::uint64_t replaced_corners = 0;         ///< the file's was not usable: no direction, or on
                                                ///< the other side of the face
    /// What corners() returns; empty where every corner has its vertex' own wedge: large smooth
    /// meshes need the memory.
    std::vector<glm::uvec3> split_corners;

    /// Per triangle of the Geometry: its wedges.
    [[nodiscard]] const std::vector<glm::uvec3>& corners(const Geometry& geometry) const
    {
        return split_corners.empty() ? geometry.triangles : split_corners;
    }
    [[nodiscard]] std::size_t vertex_count() const
    {
        return normals.size() - extra_vertices.size();
    }
    [[nodiscard]] std::uint32_t vertex_of(std::uint32_t wedge) const
    {
        return wedge < vertex_count() ? wedge : extra_vertices[wedge - vertex_count()];
    }
};

/// Corner normals. smooth: the mean of the faces around the corner's *place* (Geometry::welded: no
/// seam of the file splits it) whose normals are within the crease angle of the corner's own face,
/// weighted by their angles there (Thuermer, Wuethrich. Computing Vertex Normals from Polygonal
/// Facets. 1998): of all usual weights the one that does not depend on how polygons are cut into
/// triangles. Where the mean cancels, the face's own.
///
/// geometry: made of the scene. O(n), and O(k^2) for a place of k faces up to 64, O(64 k) beyond.
/// Equal input gives equal bytes.
[[nodiscard]] Surface make_surface(const Scene& scene, const Geometry& geometry,
                                   const NormalSettings& settings = {});

/// Wedges of one vertex are alike when their normals agree to this cosine (a tenth of a degree).
inline constexpr float kSameNormal = 0.9999985f;

struct SurfacePoint {
    std::uint32_t triangle = 0;
    glm::vec2 at{0.0f};  ///< weights of its second and third corner, >= 0; the first has the rest
};

/// How far receivers stand off the surface, in diagonals. Empty: the local offset of their
/// triangle, kOffsetShare of its size, the root of twice its area, but at least kLeastOffset and at
/// most kMostOffset.
/// A value, > 0 and finite, is taken everywhere.
using Offset = std::optional<float>;

/// A hundredth of a triangle stays below what is to be seen between surfaces as far apart as its
/// own size, and is above the bend of the interpolated surface.
/// (Of its lowest height instead, points on slivers come so near to their neighbours that the masks
/// err: wingnut's largest solve error 1.0 instead of .025, boat's .8 instead of .016.)
inline constexpr float kOffsetShare = 0.01f;
/// Eight roundings of a float at the rim of the unit frame (2^-24 each).
inline constexpr float kLeastOffset = 5e-7f;
inline constexpr float kMostOffset = 1e-4f;

[[nodiscard]] float offset_at(const Geometry& geometry, std::uint32_t triangle,
                              const Offset& offset = {});

/// The receivers of surface points: off the geometric surface, on the side of the shading normal.
/// O(points).
[[nodiscard]] std::vector<Receiver> receivers_at(const Geometry& geometry, const Surface& surface,
                                                 std::span<const SurfacePoint> points,
                                                 const Offset& offset = {});
/// The same, into memory for as many.
void receivers_at(const Geometry& geometry, const Surface& surface,
                  std::span<const SurfacePoint> points, const Offset& offset,
                  std::span<Receiver> receivers);

/// One receiver per wedge. A wedge that goes all round its vertex is asked there. One that ends at
/// a hard edge or a border is asked just inside of its middle triangle, kInset offsets from the
/// vertex: at the very edge it would stand in the plane of the next face, or of a floor that it
/// touches, where there is no answer. O(n).
[[nodiscard]] std::vector<Receiver> receivers_at_wedges(const Geometry& geometry,
                                                        const Surface& surface,
                                                        const Offset& offset = {});

inline constexpr float kInset = 4.0f;

/// The angle of each wedge at its vertex, summed over its corners: what it weighs where a vertex
/// has one value for all its wedges. Radians. O(n).
[[nodiscard]] std::vector<float> angles_of_wedges(const Geometry& geometry, const Surface& surface);

/// A scene whose vertices are nobody's (Scene::free_vertices) with a vertex for each side of every
/// hard edge: wedges of one vertex whose normals differ by more than half the crease angle part.
/// The first keeps the vertex; the others' come behind all that there are. surface: of the scene.
[[nodiscard]] Scene split_at_creases(const Scene& scene, const Geometry& geometry,
                                     const Surface& surface, const NormalSettings& settings);

/// A scene with its clean geometry and its shaded surface: what all jobs begin with.
struct Mesh {
    Scene scene;        ///< of free vertices: split at creases
    Geometry geometry;  ///< what is asked, and what occludes it unless `occluders` are there
    Surface surface;
    std::shared_ptr<const Geometry> occluders = {};  ///< in the frame of the geometry
    std::vector<bool> unbaked = {};  ///< scene triangles of which nothing is asked; empty: none

    [[nodiscard]] const Geometry& occluding() const { return occluders ? *occluders : geometry; }
};

/// Throws as make_geometry and make_surface, and InputError for a scene without triangles.
[[nodiscard]] Mesh make_mesh(Scene scene, const NormalSettings& settings = {},
                             const GeometryScope& scope = {});

/// Takes from the mesh's geometry and surface all triangles but those for which `wanted` says so,
/// by their number in the scene; the others are Mesh::unbaked. What is kept has the normals that it
/// had among the others; wedges that no wanted triangle uses have none any more, so that nothing is
/// asked there. O(n).
void keep_triangles(Mesh& mesh, const std::function<bool(std::size_t triangle)>& wanted);

/// Whether two normals at one place count as one smooth surface: within half the crease angle.
[[nodiscard]] bool are_smooth(glm::vec3 a, glm::vec3 b, const NormalSettings& settings);

}  // namespace surfelao
