/// compare.h: one scene by several engines and by rays: how long, how wrong.
///
/// All engines run in one process on the same threads, one after the other in rounds, and the
/// median of the rounds counts: a busy machine then slows all of them alike. What takes less than
/// 50 ms is repeated within a round, for threads need a millisecond to wake. The opponent is Embree
/// in its strongest mode (reference/rays.h).
///
/// Errors are taken over the vertices that have a normal and a well-defined answer
/// (reference/well_defined.h): elsewhere nobody is judged. Both kinds left out are counted.
#pragma once

#include "bake/bake.h"
#include "bake/statistics.h"
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
    std::vector<std::uint32_t> rays = {4, 16, 64, 256};  ///< rows of the opponent
    std::vector<std::uint32_t> smoothed_rays;            ///< rows of few rays made smooth
    DistanceLimit max_distance;
    Kernel kernel = Kernel::cosine;
    TargetSettings target;
    std::uint32_t reference_rays = 4096;  ///< an even number
    std::uint64_t sample = 0;             ///< receivers that are judged, evenly spread; 0 = all
    int rounds = 3;                       ///< >= 1
    bool use_cache = true;                ///< of references
    Instructions instructions = Instructions::all;  ///< of the candidates and the opponent
};

/// Opponent's time over ours at our error: above 1 we are faster.
struct EmbreeRatio {
    double ratio = 0.0;
    bool extrapolated = false;
};

struct WorstVertex {
    std::uint64_t vertex = 0;  ///< index in the scene
    glm::dvec3 position{0.0};  ///< the file's units
    float occlusion = 0.0f;
    float reference = 0.0f;
};

struct CompareRow {
    EngineSettings settings;
    bool smoothed = false;  ///< rays: one smoothing step afterwards (reference/smoothing.h)
    int rounds = 0;         ///< times it ran
    double build_s = 0.0;   ///< median seconds
    double solve_s = 0.0;
    double us_per_vertex = 0.0;  ///< of solving
    ErrorStatistics error;
    std::optional<EmbreeRatio> solve_ratio;  ///< rows of the opponent have none
    std::optional<EmbreeRatio> total_ratio;  ///< with builds on both sides
    std::vector<WorstVertex> worst;          ///< up to 5, worst first
    std::vector<float>
        errors;  ///< candidates: answer - reference, one per vertex; NaN where not judged
};

struct Comparison {
    std::filesystem::path input;
    std::shared_ptr<const Mesh> mesh;
    std::vector<float> reference;  ///< occlusion, one per vertex; NaN where not judged
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    std::uint64_t dropped_triangles = 0;
    int threads = 0;
    int rounds = 0;
    double read_s = 0.0;  ///< file and clean geometry: everyone's
    std::uint32_t reference_rays = 0;
    double reference_noise = 0.0;
    bool reference_from_cache = false;
    std::uint64_t judged = 0;          ///< receivers that count
    std::uint64_t ill_defined = 0;     ///< left out: they have no answer of their own
    std::uint64_t without_normal = 0;  ///< left out
    std::vector<CompareRow> rows;      ///< candidates, then the opponent, then smoothed rays
};

/// When a candidate is more exact than the opponent's last row, one row of four times as many rays
/// is added, so that the ratio needs no extrapolation. That row runs once. Throws InputError,
/// Cancelled.
[[nodiscard]] Comparison compare(const CompareSettings& settings,
                                 const StageProgress& progress = {});

/// The row that pictures show: the first candidate at `good`, else the first row.
[[nodiscard]] const CompareRow& shown_row(const Comparison& comparison);

/// As for its engine: "good", "64 rays", and "64 rays, smoothed".
[[nodiscard]] std::string setting_of(const CompareRow& row);

/// Whether the row is plain ray tracing, the opponent.
[[nodiscard]] bool is_opponent(const CompareRow& row);

/// The opponent's rows as a family of (error, seconds), with or without builds.
[[nodiscard]] std::vector<CurvePoint> embree_curve(const Comparison& comparison, bool with_builds);

/// Keys input, vertices, triangles, threads, rounds, reference{rays, noise, ...},
/// rows[{engine, setting, rounds, build_s, solve_s, us_per_vertex, rmse, bias, p95, max,
/// embree_ratio,
/// ...}].
[[nodiscard]] std::string json_of(const Comparison& comparison);

/// One line of names, then one line per row.
[[nodiscard]] std::string csv_of(const Comparison& comparison);

/// The aligned table for people.
[[nodiscard]] std::string table_of(const Comparison& comparison);

/// The scene as binary PLY (coordinates as double) with the row's error as colour (error_color of
/// image/color_map.h, full at kFullColorError; not judged = NaN) and as property `error`; marked as
/// a result of `compare` (files/maker_mark.h).
void write_difference(const std::filesystem::path& path, const Comparison& comparison,
                      const CompareRow& row);

}  // namespace surfelao
