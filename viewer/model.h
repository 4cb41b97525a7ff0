/// model.h: a scene made ready to be drawn and solved: the same for the window and for a file.
///
/// Under the scene lies a square of receivers only: it is shaded by the scene, but shades nothing,
/// so that no number of the scene changes because a picture is taken. Where a ground is asked for
/// that occludes, the square lies in it.
#pragma once

#include "bake/point_target.h"
#include "bake/vertex_target.h"
#include "engines/engine.h"
#include "pixels/camera.h"
#include "surfels/geometry.h"
#include "surfels/receiver.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// A square of (kGroundCells + 1)^2 receivers in rows along `axis_x`, row by row along `axis_y`,
/// facing the sky.
inline constexpr int kGroundCells = 96;
inline constexpr int kGroundReceivers = (kGroundCells + 1) * (kGroundCells + 1);
struct ShadowSquare {
    glm::vec3 corner{0.0f};  ///< of the first receiver; unit frame
    glm::vec3 axis_x{0.0f};  ///< to the last receiver of the first row
    glm::vec3 axis_y{0.0f};  ///< to the first receiver of the last row
    glm::vec3 up{0.0f};      ///< unit length
};

/// Points at which the window tells errors (bake/surface_error.h): their RMSE is right to a
/// fiftieth or so of itself, and they cost little beside any model.
inline constexpr std::uint64_t kModelPoints = 4000;

/// A disk that is drawn for a piece of the surface, with the values that lie there. Either a
/// surfel: three times the same vertex, in the plane of its normal. Or a place inside a large
/// triangle, in the triangle's plane and cut off at its edges.
struct Splat {
    glm::uvec3 vertices{0};
    std::uint32_t place = 0;  ///< shares of vertices y and z, each times 65535 in 16 bits, y low
};

/// Coarse triangles are covered by disks inside of them, none of them larger than this, so that
/// splats of a floor of two triangles are no larger than those of a scan. Unit frame.
inline constexpr float kLargestSplat = 0.01f;

struct Model {
    /// Of a cloud: its scene, and in its geometry and surface its points without a triangle.
    std::shared_ptr<const Mesh> mesh;
    std::shared_ptr<const PointTarget> cloud;    ///< null: a mesh
    TargetSettings settings;                     ///< that it was made with
    std::shared_ptr<const VertexTarget> target;  ///< of the mesh's vertices; null for a cloud
    std::vector<glm::vec3> seen;         ///< positions that triangles use: what a camera frames
    std::vector<std::uint32_t> surfels;  ///< vertices that are: surfels_at_vertices' order
    std::vector<float> levels;       ///< one per surfel: its leaf's depth in the octree, 0 = root
    std::vector<Splat> splats;       ///< they cover every triangle that has an area
    std::vector<float> splat_radii;  ///< one per splat
    std::optional<GroundPlane> ground_plane;  ///< that it was made with
    std::optional<Ground> occluding_ground;   ///< the same in the unit frame
    ShadowSquare ground;
    std::vector<Receiver> ground_receivers;
    /// kModelPoints, all over the surface; none without area, and none of a cloud
    std::vector<SurfacePoint> points;
    std::vector<Receiver> point_receivers;
    UpAxis up = UpAxis::y;

    const Geometry& geometry() const { return mesh->geometry; }
    const Geometry& occluding() const { return mesh->occluding(); }
    /// Values that a picture needs: one per vertex, then the ground's.
    std::size_t answer_count() const
    {
        return mesh->geometry.positions.size() + ground_receivers.size();
    }
};

/// O(n log n). mesh: made with settings.normals. largest_splat: triangles that need larger disks
/// at their corners are covered from inside; where that takes more than a few hundred thousand
/// disks, larger ones are allowed. Infinite: one splat per surfel, however large. ground: that
/// occludes, its up as `up` says. Throws as ground_of().
[[nodiscard]] Model make_model(Mesh mesh, UpAxis up, const TargetSettings& settings = {},
                               float largest_splat = kLargestSplat,
                               const std::optional<GroundPlane>& ground = {});

/// A cloud: each point is a surfel, drawn wide enough to meet its neighbours.
[[nodiscard]] Model make_cloud_model(Scene scene, UpAxis up, const TargetSettings& settings = {},
                                     const std::optional<GroundPlane>& ground = {});

/// What else a user says of a scene.
struct ModelChoice {
    PartChoice parts = {};
    std::optional<GroundPlane> ground = {};
    std::span<const Scene> others = {};  ///< PartChoice::occluders, read
    std::optional<Frame> frame = {};     ///< of meshes, in place of their own
};

/// Of a scene that was read, whichever it is. Throws as make_mesh() and make_point_target(), and
/// SettingsError as check_target() (bake/point_target.h).
[[nodiscard]] Model model_of(Scene scene, UpAxis up, const TargetSettings& settings,
                             const ModelChoice& choice = {});

/// The lowest and the highest level, at least 1 apart: what the ends of a colour scale stand for.
[[nodiscard]] glm::vec2 level_range(const Model& model);

/// For each vertex the least radius with which disks in the planes of its triangles leave no hole
/// in them: for every adjacent triangle, the distance from its corners to the point of it that is
/// farthest from all three.
///
///         C            No angle above 90 degrees: the circumradius  abc / (4 area).
///        / \           Obtuse at C: the bisectors of the short sides meet the long side c at
///      b/   \a         distance  b / (2 cos A)  from A  and  a / (2 cos B)  from B; the larger
///      /_____\         one counts, and no point of the triangle is farther from its corners.
///     A   c   B
///
/// On a square grid of spacing h this is h / sqrt(2), 1.25 times the radius of a disk of a surfel's
/// area. Triangles that need more than `most` do not count; 0 for vertices without triangles that
/// count. Shared by all vertices at one position. O(n).
[[nodiscard]] std::vector<float> covering_radii(
    const Geometry& geometry, float most = std::numeric_limits<float>::infinity());

}  // namespace surfelao
