/// grid_sources.h: where the grids of a picture's objects come from: files, or the animation whose
/// moving parts get theirs here and now.
#pragma once

#include "bake/error_search.h"
#include "bake/grid_target.h"
#include "pixels/grid_world.h"

#include <filesystem>
#include <span>
#include <string>

namespace surfelao {

/// A grid's file and whose it is; without a node: the one part that was baked, as
/// its text tells (bake --at grid --receivers NODE).
struct GridFile {
    std::string node;
    std::filesystem::path path;
};

/// input: the scene's file; reading: as the picture's. Throws as read_grid(), read_scene() and
/// Motion(), and InputError for a file that names no node where none is given.
[[nodiscard]] GridSources read_grids(const std::filesystem::path& input, const ReadOptions& reading,
                                     std::span<const GridFile> files);

/// Share of GridSettings::extent that the grid of each of several moving parts has: what every one
/// leaves out beyond its box adds up. Robot of 11 parts, walking, 32 cells: RMSE .057 at .03, .043
/// at .01, .026 at .005, .027 at .002, where the cells grow too large.
inline constexpr double kMovingShare = 1.0 / 6.0;

/// One grid for each body of the animation (Motion::bodies) that moves as one piece; what is
/// deformed belongs to the rest. Each has kMovingShare of the extent. Throws as bake_grid(),
/// read_scene() and Motion(), InputError where nothing moves so. progress: "grids".
[[nodiscard]] GridSources bake_moving_grids(const std::filesystem::path& input,
                                            const ReadOptions& reading,
                                            const GridSettings& settings,
                                            const EngineSettings& engine,
                                            const StageProgress& progress = {});

}  // namespace surfelao
