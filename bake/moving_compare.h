/// moving_compare.h: engines over the frames of an animation: how wrong, how steady, how long.
///
/// All answer at the same places, the samples that values at vertices are fitted to
/// (moving_world.h), in scenes that they keep from frame to frame (engines/moving.h). What is right
/// is told by many rays at some of these places.
#pragma once

#include "bake/bake.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

/// Places at which errors are taken, evenly over all, and rays for each of them.
inline constexpr std::uint64_t kMovingSample = 2000;
inline constexpr std::uint32_t kMovingRays = 1024;

/// Rays of the opponent: what is traced where pictures move.
inline constexpr std::uint32_t kOpponentRays = 16;

struct MovingCompareSettings {
    std::filesystem::path input;
    std::vector<double> seconds = {};             ///< of the frames; two at least
    std::vector<EngineSettings> candidates = {};  ///< on the CPU
    DistanceLimit max_distance = {};
    Kernel kernel = Kernel::cosine;
    std::optional<GroundPlane> ground = {};
    TargetSettings target = {};
    PartChoice parts = {};
    ReadOptions reading = {};
    std::uint64_t sample = kMovingSample;
    std::uint32_t reference_rays = kMovingRays;
};

/// Over all frames.
struct MovingRow {
    EngineSettings engine;
    /// Each answer is the mean of those at the places on triangles that share a vertex with its
    /// own, of the same body and on the same side of an edge: what rays are smoothed by.
    bool is_smoothed = false;
    double rmse = 0.0, bias = 0.0, p95 = 0.0, max = 0.0;  ///< of occlusion, at the places
    /// What changes from one frame to the next on body 0 less what the reference changes there.
    double flicker_rms = 0.0, flicker_max = 0.0;
    /// The largest change where the reference does not change at all.
    double untouched_max = 0.0;
    /// Medians over the frames but the first, in milliseconds; solve is with the smoothing.
    double place_ms = 0.0, tree_ms = 0.0, solve_ms = 0.0, fit_ms = 0.0;
    double solved = 0.0;  ///< mean of the receivers that were answered anew
    std::vector<double> rmse_by_frame = {};

    [[nodiscard]] double total_ms() const { return place_ms + tree_ms + solve_ms; }
};

struct MovingComparison {
    MovingCompareSettings settings;
    std::string animation;
    std::uint64_t vertices = 0, triangles = 0, receivers = 0;
    std::uint32_t bodies = 0;
    std::uint64_t points = 0, still_points = 0, untouched = 0;  ///< the last: of all frames
    double pose_ms = 0.0;                                       ///< median
    int threads = 0;
    std::vector<MovingRow> rows;
};

/// The candidates, and rays as the opponent: kOpponentRays of them, with and without smoothing
/// (of VertexValues::fit), and four times as many. Throws as bake_frames(); Cancelled.
[[nodiscard]] MovingComparison compare_frames(const MovingCompareSettings& settings,
                                              const StageProgress& progress = {});

[[nodiscard]] std::string json_of(const MovingComparison& comparison);
[[nodiscard]] std::string csv_of(const MovingComparison& comparison);
[[nodiscard]] std::string table_of(const MovingComparison& comparison);

}  // namespace surfelao
