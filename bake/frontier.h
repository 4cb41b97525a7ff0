/// frontier.h: the whole speed-against-error curve of every engine and of Embree, over many scenes.
///
/// Ratios are Embree's time over ours for the same job at equal error beyond the floor
/// (surface_error.h), each side interpolated inside its own family (statistics.h: time_at). Where a
/// family does not reach an error the ratio is extrapolated: marked, and left out of the summary.
/// Where the coarsest setting of either side is already more exact than asked, its time counts as
/// it is: nobody has anything cheaper, ours by its qualities, Embree with one ray a receiver.
#pragma once

#include "bake/compare.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

struct FrontierSettings {
    std::vector<std::filesystem::path> inputs;
    std::vector<Engine> engines;  ///< the first one is the one that the summary is about
    CompareSettings compare;      ///< input, candidates and rays are set by the frontier
};

/// What is counted on both sides.
enum class Cost {
    solve,  ///< solving and fitting
    build,  ///< and the engine's own structures
    file,  ///< and reading the file, cleaning its geometry and making the target, the same for both
};

/// Errors beyond the floor at which ratios are stated.
inline constexpr double kTargets[] = {0.010, 0.005};

struct ReportPicture {
    std::string caption;
    std::string png;
    bool is_error = false;  ///< in error_color(), full at kFullColorError; else visibility as grey
};

/// One scene: its comparison, or why there is none.
struct FrontierScene {
    std::filesystem::path input;
    std::optional<Comparison> comparison;  ///< without its scene and geometry: counts and rows only
    std::string error;
    std::vector<ReportPicture> pictures;
};

/// Over the scenes where both sides reach the error: whether these stand for all says
/// stands_for_all().
struct RatioSummary {
    std::size_t scenes = 0;    ///< that count
    std::size_t left_out = 0;  ///< extrapolated, or without a curve
    double median = 0.0, low_quartile = 0.0, high_quartile = 0.0, worst = 0.0, best = 0.0;
};

struct Frontier {
    std::vector<Engine> engines;
    std::vector<FrontierScene> scenes;
};

/// A scene that fails is kept with its error and does not stop the others. Throws Cancelled.
[[nodiscard]] Frontier frontier(const FrontierSettings& settings,
                                const StageProgress& progress = {});

/// One comparison as the frontier of one scene, with pictures; takes its scene and geometry away.
[[nodiscard]] FrontierScene frontier_scene(Comparison comparison);

/// Empty where either side has no curve.
[[nodiscard]] std::optional<EmbreeRatio> ratio_at(const Comparison& comparison, Engine engine,
                                                  double beyond, Cost cost);

/// scenes = 0 and zeros where no ratio counts.
[[nodiscard]] RatioSummary summary_of(const Frontier& frontier, Engine engine, double beyond,
                                      Cost cost);

/// Whether two of three scenes count at least. Where fewer do they are mostly the easy ones, and
/// reports say on how many an error is reached, without a median.
[[nodiscard]] bool stands_for_all(const RatioSummary& summary);

/// "7 of 9"
[[nodiscard]] std::string scenes_text(const RatioSummary& summary);

/// Seconds of a row's job as they are counted.
[[nodiscard]] double seconds_of(const Comparison& comparison, const CompareRow& row, Cost cost);

/// Keys summary{at_010{median_ratio, worst_ratio, best_ratio, quartiles, scenes, left_out}, at_005,
/// with_builds{at_010, at_005}, with_files{...}}, summary_of_engines{NAME{...}}, scenes[...].
/// Ratios are null where !stands_for_all().
[[nodiscard]] std::string json_of(const Frontier& frontier);
[[nodiscard]] std::string csv_of(const Frontier& frontier);
[[nodiscard]] std::string table_of(const Frontier& frontier);

/// A page of its own: machine and run, summary, and of each scene plots of the error beyond the
/// floor against the time of solving and of the whole job, rows, pictures, worst points.
/// Marked as a result of `compare` (files/maker_mark.h).
[[nodiscard]] std::string html_of(const Frontier& frontier);

}  // namespace surfelao
