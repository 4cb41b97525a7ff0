/// compare.h: one scene by several engines and by rays: how long, how wrong.
///
/// All engines do the same job. Values at the vertices: build, solve the target's receivers
/// (vertex_target.h), fit. Or a map (map_bake.h): raster, build, solve the texels, fill. They run
/// in one process on the same threads, one after the other in rounds, and the median of the rounds
/// counts: a busy machine then slows all of them alike. What takes less than 50 ms is repeated
/// within a round, for threads need a millisecond to wake. The opponent is Embree in its strongest
/// mode (reference/rays.h) at the same receivers with the same fit or fill. Choosing the receivers
/// is the same for all, and no part of who is faster.
///
/// Errors are taken at points all over the surface (surface_error.h says what seen error, solve
/// error, floor and beyond are). Points without a well-defined answer (reference/well_defined.h)
/// are left out, for there nobody is right or wrong, and counted; so are, of maps, those inside of
/// bodies, whose texels take what surrounds them (hidden_texels.h).
///
/// Who is faster is asked at equal *beyond*: nobody is below the floor, and near it the seen errors
/// of all are alike. By Pythagoras beyond is sqrt(seen^2 - floor^2), with far less noise.
#pragma once

#include "bake/bake.h"
#include "bake/statistics.h"
#include "bake/vertex_target.h"
#include "engines/engine.h"
#include "surfels/scene.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

struct CompareSettings {
    std::filesystem::path input;
    std::vector<EngineSettings> candidates;  ///< their definition is made from the members below
    std::vector<std::uint32_t> rays = {1, 4, 16, 64, 256};  ///< rows of the opponent
    DistanceLimit max_distance;
    Kernel kernel = Kernel::cosine;
    std::optional<GroundPlane> ground = {};
    TargetSettings target;
    PartChoice parts = {};                 ///< who occludes, who is asked
    std::optional<TexelSettings> texels;   ///< a map; empty: values at the vertices
    std::optional<double> subdivide = {};  ///< as BakeSettings::subdivide: one mesh for all
    std::uint32_t reference_rays = 4096;   ///< an even number
    std::uint64_t sample = 0;              ///< points of the surface; 0 = kSurfacePoints
    int rounds = 3;                        ///< >= 1
    bool use_cache = true;                 ///< of references
    ReadOptions reading = {};              ///< of the input
    Instructions instructions = Instructions::all;  ///< of the candidates and the opponent
};

/// Opponent's time over ours at our error beyond the floor: above 1 we are faster.
struct EmbreeRatio {
    double ratio = 0.0;
    bool extrapolated = false;
};

/// A surface point at which what is seen is most wrong.
struct WorstPoint {
    std::uint64_t triangle = 0;  ///< index in the scene; of a cloud that of the point
    glm::dvec3 position{0.0};    ///< the file's units
    float displayed = 0.0f;
    float reference = 0.0f;
};

struct CompareRow {
    EngineSettings settings;
    int rounds = 0;         ///< times it ran
    double raster_s = 0.0;  ///< median seconds; of maps
    double build_s = 0.0;
    double solve_s = 0.0;
    double fit_s = 0.0;                ///< from answers to values at vertices
    double fill_s = 0.0;               ///< from answers to a map
    double us_per_receiver = 0.0;      ///< of solving
    ErrorStatistics seen;              ///< what is displayed; of maps no bent normals
    ErrorStatistics solve;             ///< the engine's own answers at the same points
    double beyond = 0.0;               ///< RMS: what of `seen` is not the floor's
    std::optional<EmbreeRatio> ratio;  ///< of solving and fitting or filling; rows of the opponent
                                       ///< have none
    std::optional<EmbreeRatio> ratio_with_builds;  ///< with builds on both sides
    std::vector<WorstPoint> worst;                 ///< up to 5, worst first
    std::vector<float> errors;  ///< candidates: per vertex, or per texel and page: occlusion less
                                ///< the floor's
};

struct Comparison {
    std::filesystem::path input;
    std::shared_ptr<const Mesh> mesh;          ///< of a cloud: point_mesh() (point_target.h)
    std::shared_ptr<const PointTarget> cloud;  ///< null: a mesh
    TargetSettings target;
    std::optional<TexelSettings> texels;  ///< empty: values at the vertices
    std::optional<double> subdivide;
    MapSize page;  ///< of a map: the size of each page
    std::uint64_t pages = 0;
    std::optional<std::uint32_t> uv_set;  ///< the file's coordinates; empty: new ones
    std::vector<float> reference;  ///< as CompareRow::errors: occlusion of the floor's values
    std::optional<PointReport> points_report;  ///< of a cloud
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    std::uint64_t dropped_triangles = 0;
    std::uint64_t receivers = 0;  ///< that every engine solves
    int threads = 0;
    int rounds = 0;
    std::string ground;   ///< where it lies, "y = -0.25"; empty: there is none
    double read_s = 0.0;  ///< file, clean geometry, subdivision and target, for a map its layout:
                          ///< everyone's
    std::uint32_t reference_rays = 0;
    double reference_noise = 0.0;
    bool reference_from_cache = false;
    std::uint64_t points = 0;       ///< of the surface that count
    std::uint64_t ill_defined = 0;  ///< left out: they have no answer of their own
    std::uint64_t hidden = 0;       ///< of maps left out: inside of bodies, where nobody looks
    ErrorStatistics floor;
    std::uint32_t floor_rays = 0;  ///< per receiver
    double floor_noise = 0.0;      ///< taken out of floor and beyond
    std::vector<CompareRow> rows;  ///< candidates, then the opponent
};

/// When a candidate is more exact than the opponent's last row, one row of four times as many rays
/// is added, so that the ratio needs no extrapolation. That row runs once. Throws InputError,
/// Cancelled.
[[nodiscard]] Comparison compare(const CompareSettings& settings,
                                 const StageProgress& progress = {});

/// The same of a scene at hand, which is told in messages by its name; settings.input is empty.
[[nodiscard]] Comparison compare(Scene scene, const CompareSettings& settings,
                                 const StageProgress& progress = {});

/// The row that pictures show: the first candidate at `good`, else the first row.
[[nodiscard]] const CompareRow& shown_row(const Comparison& comparison);

/// Whether the row is ray tracing, the opponent.
[[nodiscard]] bool is_opponent(const CompareRow& row);

/// Seconds of the job: solving and fitting or filling, with or without building.
[[nodiscard]] double job_seconds(const CompareRow& row, bool with_build);

/// sqrt(seen^2 - floor^2), 0 where that is below 0: what `beyond` is but for noise.
[[nodiscard]] double beyond_by_squares(const Comparison& comparison, const CompareRow& row);

/// Keys input, vertices, triangles, receivers, threads, rounds, target{..., subdivide, texels},
/// reference{rays, noise, points, ill_defined, ...}, floor{rmse, ..., rays, noise}, rows[{engine,
/// setting, rounds, raster_s, build_s, solve_s, fit_s, fill_s, us_per_receiver, seen{rmse, bias,
/// p95, max, ...}, solve{the same}, beyond, beyond_by_squares, embree_ratio, ...}].
[[nodiscard]] std::string json_of(const Comparison& comparison);

/// One line of names, then one line per row.
[[nodiscard]] std::string csv_of(const Comparison& comparison);

/// The aligned table for people.
[[nodiscard]] std::string table_of(const Comparison& comparison);

/// Of values at vertices: the scene as binary PLY (coordinates as double) with the row's errors as
/// colour (error_color of image/color_map.h, full at kFullColorError) and as property `error`;
/// marked as a result of `compare` (files/maker_mark.h).
void write_difference(const std::filesystem::path& path, const Comparison& comparison,
                      const CompareRow& row);

}  // namespace surfelao
