/// cube_options.h: the options of cube maps, for `render`.
#pragma once

#include "pixels/cube_map.h"
#include "surfels/geometry.h"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace surfelao {

/// What was asked for: empty where an option was not given.
struct CubeOptions {
    std::vector<std::string> places;  ///< X:Y:Z in the file's units
    std::optional<std::string> placement;
    std::optional<int> size;
    std::optional<std::string> holes;
};

void add_cube_options(CLI::App& command, CubeOptions& options);

/// Throws UsageError for options of cube maps where there are none, and for what contradicts
/// itself.
void check_cube_options(const CubeOptions& options, bool at_cube_maps);

/// Where maps shall be.
struct CubePlan {
    std::vector<glm::vec3> centres;  ///< given; unit frame
    std::optional<int> automatic;    ///< place at most so many
    double covered = 0.0;            ///< one more at the camera where less of the picture is
};

/// Automatic unless places are given or another placement is named. Throws UsageError.
[[nodiscard]] CubePlan cube_plan_of(const CubeOptions& options, const Frame& frame);

}  // namespace surfelao
