/// point_cloud.h: points of a scanner as a surface: squares that occlude, receivers on them.
///
///     PointCloud cloud = make_point_cloud(scene, settings);
///     if (cloud.is_unoriented)
///         orient(cloud, answers on the one side, answers on the other);
///     const Geometry squares = squares_of(cloud);
///
/// Each point stands for the area that it has among its neighbours, pi r^2 with r = d / sqrt(k + 1)
/// where k + 1 points, itself one of them, lie within d. It occludes as a flat square about it,
/// across its normal, kSquareShare times as wide as one of that area, so that there is no hole
/// between it and the next. It is asked kLift r above it: what lies nearer is the noise of the
/// samples, or the square of a neighbour.
///
/// Where the points scatter about their surface, all are moved onto the planes through their
/// neighbours. Points far off all others do not occlude; they are asked like all.
///
/// Based on:
///   Hoppe, DeRose, Duchamp, McDonald, Stuetzle. Surface Reconstruction from Unorganized Points.
///     1992: normals from the covariance of neighbours
///   Ritschel, Engelhardt, Grosch, Seidel, Kautz, Dachsbacher. Micro-Rendering for Scalable,
///     Parallel Final Gathering. 2009: points of a surface as what occludes
#pragma once

#include "surfels/geometry.h"
#include "surfels/occlusion.h"
#include "surfels/raw_vector.h"
#include "surfels/receiver.h"
#include "surfels/scene.h"
#include "surfels/surface.h"
#include "surfels/surfel.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

struct PointSettings {
    /// automatic: the file's, else fitted to the neighbours; file: the file's, which must be there;
    /// smooth: fitted whatever the file has; up: squares as with automatic, but everywhere the
    /// hemisphere about `up` is asked, so that 1 - occlusion is the sky view factor. A cloud has no
    /// flat ones.
    NormalSource normals = NormalSource::automatic;
    /// All normals are turned to it. Empty: those that are fitted to Scene::viewpoint, where there
    /// is one.
    std::optional<glm::dvec3> viewpoint = {};
    glm::vec3 up{0.0f, 0.0f, 1.0f};  ///< unit length
    /// One point of each cube of this size occludes; the scene's units, > 0. Empty: all do, but
    /// for so many that kMostOccluders are left.
    std::optional<double> spacing = {};
};

inline constexpr std::uint64_t kMostOccluders = 20'000'000;

/// Neighbours by which areas are told, by which normals are, and by which points are moved.
inline constexpr std::uint32_t kAreaNeighbours = 12, kNormalNeighbours = 16, kPlaneNeighbours = 24;
/// Points scatter where their noise is above this, in r. Of the family's scenes sampled without
/// noise nine in ten are below .11, and with noise of .3 spacings, .53 r, all are above .45.
inline constexpr float kScatter = 0.2f;
/// Half a square's side over that of a square of the point's area; the second where the radii of
/// neighbours differ by more than kUneven: of the family's vertices as points, the error is 2 %
/// less by it.
inline constexpr float kSquareShare = 1.25f, kUnevenShare = 1.6f;
inline constexpr float kUneven = 2.0f;
/// Receivers stand so many r above their squares. Over the family errors are alike, to 5 %, for
/// squares of 1.15 to 1.4 and lifts of .8 to 1.25; at a lift of 1 points in hollows lie below the
/// corners of their neighbours' squares, and the largest error on scans is twice as large.
inline constexpr float kLift = 1.1f;
/// Occlusion by which one side must be more open than the other.
inline constexpr float kWeakVote = 0.1f;
/// Votes of neighbours count in so many rounds for all, then in so many more for those that are
/// still weak, which so take the side of the strong ones around them: of the points of a skull .3 %
/// instead of .7 % are turned inward; over the family the error is the same to .3 %.
inline constexpr int kVoteRounds = 2, kWeakVoteRounds = 62;
/// Of a million points of a skull each eighth turns .056 % inward, each fourth .032 %, each
/// sixteenth .13 %; with noise the same, of smoother bodies none. Each fourth takes .13 s more
/// of 2.7.
inline constexpr std::size_t kMostVoters = 125'000;
/// Sine of the angle over a point's plane from which on a neighbour has no vote: it may stand on
/// the other side of a thin sheet, and its normal the other way. Over the family's choosing half,
/// clean and noisy, the error is .0493 and .0590 with it, .0500 and .0593 without (.0495 and .0591
/// at .71); of a skull's points .13 % instead of .29 % are turned inward.
inline constexpr float kSteepest = 0.5f;
/// An outlier's r is above so many times the median of its neighbours'.
inline constexpr float kOutlier = 4.0f;

/// How many of the scene's points.
struct PointCounts {
    std::uint64_t from_file = 0;       ///< have a normal of the file
    std::uint64_t without_normal = 0;  ///< neither the file nor the neighbours give one: open, and
                                       ///< they do not occlude
    std::uint64_t duplicates = 0;      ///< stand where another one does: asked, but occlude once
    std::uint64_t thinned = 0;         ///< stand in a cube with another one, which occludes for it
    std::uint64_t outliers = 0;        ///< far off all others
    std::uint64_t uneven = 0;          ///< among points of other density
    std::uint64_t weak = 0;            ///< orient(): either side is as open, to kWeakVote
};

/// Invariants: all finite, normals of unit length or zero, one of each per point of the scene.
struct PointCloud {
    Frame frame;                       ///< of the points' box
    std::vector<glm::vec3> positions;  ///< unit frame; moved where they scatter
    std::vector<glm::vec3> normals;    ///< zero: none
    std::optional<glm::vec3> asked;    ///< the direction about which all points are asked; empty:
                                       ///< their normals
    std::vector<float> radii;          ///< r above, unit frame; 0 for a point without neighbours
    std::vector<std::uint8_t> is_uneven;   ///< kUnevenShare instead of kSquareShare
    std::vector<std::uint32_t> occluders;  ///< points that occlude, along a Morton curve
    std::vector<std::uint32_t> order;      ///< all points along it
    double spacing = 0.0;  ///< between occluders, in the scene's units: the root of the median area
    std::optional<double> thinned_to;  ///< the size of the cubes, where there are any
    PointCounts counts;
    float noise = 0.0f;          ///< median standard deviation about the surface, in r; where
                                 ///< there are many points, of each n-th
    bool is_flattened = false;   ///< moved onto planes, since that is above kScatter
    bool is_unoriented = false;  ///< the normals' signs are arbitrary
    /// While it is unoriented, along `order`: the nearest points of each, as places in `order`;
    /// kNobody where there are fewer.
    RawVector<std::array<std::uint32_t, kAreaNeighbours>> neighbours;

    static constexpr std::uint32_t kNobody = 0xffffffff;
};

/// scene: without triangles; its normals are one per point or none. O(n log n), all cores, 250
/// bytes a point. Equal input gives equal bytes. Throws SettingsError for flat normals, a spacing
/// that is not above 0 or a viewpoint that is not finite; InputError for normals of the file where
/// there are none, and for a spacing that vanishes beside the cloud.
[[nodiscard]] PointCloud make_point_cloud(const Scene& scene, const PointSettings& settings = {});

/// What occludes: two triangles per occluder, 2 i and 2 i + 1 of the i-th. O(n).
[[nodiscard]] Geometry squares_of(const PointCloud& cloud);

/// The same for the disk engine: one disk per occluder, of the point's own area. O(n).
[[nodiscard]] std::vector<Surfel> disks_of(const PointCloud& cloud);

/// Where occlusion is asked for points of the scene. offset: in place of kLift r. O(points).
[[nodiscard]] std::vector<Receiver> receivers_at(const PointCloud& cloud,
                                                 std::span<const std::uint32_t> points,
                                                 const Offset& offset = {});

/// A receiver in front of the square becomes the one as far behind it.
[[nodiscard]] Receiver turned_round(const Receiver& receiver);

/// Occluders that are asked which of their sides is more open: all, or of more than kMostVoters
/// each n-th along the curve.
[[nodiscard]] std::vector<std::uint32_t> voters_of(const PointCloud& cloud);

/// Turns the normals to where it is more open: the outside of a closed scan. front: occlusion at
/// receivers_at() the voters; back: at turned_round() of these; both one per voter. Each point goes
/// with its neighbours' majority, twice over, each of them counting by how much more open its side
/// is. The others go with the voters around them. O(n).
void orient(PointCloud& cloud, std::span<const std::uint32_t> voters,
            std::span<const Occlusion> front, std::span<const Occlusion> back);

}  // namespace surfelao
