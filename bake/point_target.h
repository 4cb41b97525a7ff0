/// point_target.h: a cloud of points ready to be baked, shown and measured, and values at its
/// points that say how wrong they are.
///
/// The error is that against rays on the same squares: what the engine adds. How far the squares
/// are from the surface that was scanned nobody knows who has the points alone; docs/clouds.md
/// tells it of surfaces that are known.
#pragma once

#include "bake/occluders.h"
#include "bake/vertex_bake.h"
#include "bake/vertex_target.h"
#include "bake/world.h"
#include "engines/engine.h"
#include "surfels/point_cloud.h"
#include "surfels/scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// How normals got their side.
enum class Orientation { file, viewpoint, openness, up };

struct PointTarget {
    PointCloud cloud;
    Geometry squares;  ///< of the cloud, made before its sides were found: they have none
    Offset offset;
    Orientation orientation = Orientation::openness;
    double seconds = 0.0;  ///< neighbours, and the two solves of orient() where they were needed
};

/// What a report tells of a cloud.
struct PointReport {
    std::uint64_t occluders = 0;
    double spacing = 0.0;  ///< PointCloud::spacing
    std::optional<double> thinned_to;
    double noise = 0.0;  ///< PointCloud::noise
    bool is_flattened = false;
    Orientation orientation = Orientation::openness;
    PointCounts counts;
};

/// Receivers that are solved at once, next to each other in space: what bounds the memory of
/// solving, whatever the cloud's size.
inline constexpr std::size_t kBandPoints = std::size_t{1} << 22;

/// Throws SettingsError where settings are for points and the scene has faces, or the other way
/// round.
void check_target(const Scene& scene, const TargetSettings& settings, const PartChoice& parts);

/// scene: without triangles. Stages "points" and "orient". O(n log n), and two solves at draft
/// where neither the file nor a viewpoint tells where the outside is. masks: gets what these solves
/// were prepared with, if there were any. Throws as make_point_cloud(), solve() and offset_of(),
/// Cancelled.
[[nodiscard]] PointTarget make_point_target(const Scene& scene, const TargetSettings& settings,
                                            const StageProgress& progress = {},
                                            std::optional<Prepared>* masks = nullptr);

/// The points as vertices without a triangle, for what shows vertices: their areas are the points',
/// and the squares occlude.
/// Those without a normal are drawn facing up.
[[nodiscard]] Mesh point_mesh(Scene scene, const std::shared_ptr<const PointTarget>& target);

/// As ground_of() of engines/engine.h: below all squares.
[[nodiscard]] std::optional<Ground> ground_below(const PointTarget& target,
                                                 const std::optional<GroundPlane>& plane);

[[nodiscard]] PointReport report_of(const PointTarget& target);
[[nodiscard]] std::string name_of(Orientation orientation);

/// What the user should know of the points, as bake/notes.h. Weak votes are told where they are
/// more than kNotableWeak of all.
[[nodiscard]] std::vector<std::string> point_notes(const PointTarget& target);

inline constexpr double kNotableWeak = 0.01;

/// One answer per point, band by band. prepared: of the target's cloud. Throws as solve().
[[nodiscard]] Solution solve_points(const Prepared& prepared, const PointTarget& target,
                                    const SolveSettings& settings, const Progress& progress = {});

/// As bake_vertices() and bake_to_error(), without a fit. ready: what is prepared of the target
/// already, or null.
[[nodiscard]] VertexBake bake_points(const PointTarget& target, const EngineSettings& engine,
                                     std::uint32_t check, const StageProgress& progress = {},
                                     const Prepared* ready = nullptr);
[[nodiscard]] VertexBake bake_points_to_error(const PointTarget& target,
                                              const EngineSettings& engine, double error,
                                              std::uint32_t check,
                                              const StageProgress& progress = {},
                                              const Prepared* ready = nullptr);

}  // namespace surfelao
