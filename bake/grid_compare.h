/// grid_compare.h: how wrong AO grids of one object are, by engine, quality and what cells hold,
/// all at the same places about it, against rays.
#pragma once

#include "bake/grid_target.h"
#include "bake/statistics.h"
#include "bake/world.h"
#include "engines/engine.h"
#include "files/scene_io.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace surfelao {

struct GridCompareSettings {
    std::filesystem::path input;
    std::vector<EngineSettings> candidates;  ///< their definition is made from max_distance
    DistanceLimit max_distance;
    PartChoice parts = {};
    GridSettings grid = {};               ///< of the candidates' rows; its store does not count
    std::uint32_t reference_rays = 4096;  ///< per place, an even number
    std::uint64_t places = 4000;
    int rounds = 3;  ///< times that a grid is baked; the median counts
    ReadOptions reading = {};
};

struct GridRow {
    EngineSettings engine;
    GridSettings grid;
    bool is_origin = false;  ///< the settings of Malmer et al., the same number of cells
    double build_s = 0.0;
    double solve_s = 0.0;
    double repair_s = 0.0;
    std::uint64_t inside = 0;
    std::uint64_t receivers = 0;
    std::uint64_t bytes = 0;  ///< of the cells, as they stand in a file
    ErrorStatistics error;    ///< of what is read; no bent normals
};

struct GridComparison {
    std::filesystem::path input;
    std::uint64_t triangles = 0;
    Box box;  ///< in which the places lie: that of the candidates' grids
    std::uint64_t places = 0;
    double rms_occlusion = 0.0;  ///< there
    std::uint32_t reference_rays = 0;
    double reference_noise = 0.0;  ///< taken out of the errors
    int threads = 0;
    int rounds = 0;
    std::vector<GridRow> rows;  ///< each candidate as cones and as harmonics, then the origin's
};

/// Throws InputError, SettingsError, Cancelled.
[[nodiscard]] GridComparison compare_grids(const GridCompareSettings& settings,
                                           const StageProgress& progress = {});

/// The same of a geometry that is at hand; input is its name.
[[nodiscard]] GridComparison compare_grids(const Geometry& object,
                                           const GridCompareSettings& settings,
                                           const StageProgress& progress = {});

[[nodiscard]] std::string json_of(const GridComparison& comparison);
[[nodiscard]] std::string csv_of(const GridComparison& comparison);
[[nodiscard]] std::string table_of(const GridComparison& comparison);

}  // namespace surfelao
