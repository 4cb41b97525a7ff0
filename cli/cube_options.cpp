#include "cli/cube_options.h"

#include "cli/commands.h"
#include "cli/engine_options.h"
#include "cli/value_checks.h"
#include "pixels/cube_placement.h"

#include <CLI/CLI.hpp>

#include <charconv>
#include <string_view>

namespace surfelao {
namespace {

constexpr int kMostAutomatic = 1024;

/// "auto" or "auto:N"
int most_of(const std::string& placement)
{
    if (placement == "auto")
        return kMostPlacedMaps;
    constexpr std::string_view kAuto = "auto:";
    int most = 0;
    const std::string_view digits = std::string_view(placement).substr(
        placement.starts_with(kAuto) ? kAuto.size() : placement.size());
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), most);
    if (error != std::errc() || end != digits.data() + digits.size() || most < 1 ||
        most > kMostAutomatic)
        throw UsageError("--cubemaps: \"" + placement + "\" is not auto, auto:N with 1 to " +
                         std::to_string(kMostAutomatic) + " maps, or camera.");
    return most;
}

}  // namespace

void add_cube_options(CLI::App& command, CubeOptions& options)
{
    constexpr const char* kGroup = "Cube maps (--at cubemaps)";
    command
        .add_option("--cubemap", options.places,
                    "A map there, in the file's units; may be given again")
        ->allow_extra_args(false)
        ->type_name("X:Y:Z")
        ->group(kGroup);
    command
        .add_option(
            "--cubemaps", options.placement,
            "Where maps are put: auto = so that few see most of the surface, N at most, and "
            "one at the camera where less than 98 % of the picture is covered; camera = "
            "that one alone, where it is less than 75 %")
        ->type_name("auto[:N]|camera")
        ->default_str("auto")
        ->group(kGroup);
    command.add_option("--cubemap-size", options.size, "Texels along the edge of a face")
        ->check(whole_from(kLeastCubeSize, kMostCubeSize))
        ->type_name("N")
        ->default_str(std::to_string(kCubeSize))
        ->group(kGroup);
    command
        .add_option(
            "--holes", options.holes,
            "Pixels that no map sees: solve = ask the engine there; white = leave them open")
        ->check(one_of({"solve", "white"}))
        ->type_name("solve|white")
        ->default_str("solve")
        ->group(kGroup);
}

void check_cube_options(const CubeOptions& options, bool at_cube_maps)
{
    if (!at_cube_maps &&
        (!options.places.empty() || options.placement || options.size || options.holes))
        throw UsageError(
            "--cubemap, --cubemaps, --cubemap-size and --holes are for --at cubemaps.");
    static_cast<void>(cube_plan_of(options, Frame()));
}

CubePlan cube_plan_of(const CubeOptions& options, const Frame& frame)
{
    CubePlan plan;
    for (const std::string& text : options.places)
        plan.centres.push_back((place_of(text, "--cubemap") - frame.centre) / frame.diagonal);
    if (options.placement == "camera") {
        plan.covered = kCoveredEnough;
    } else if (options.placement || options.places.empty()) {
        plan.automatic = most_of(options.placement.value_or("auto"));
        plan.covered = kCoveredWell;
    }
    return plan;
}

}  // namespace surfelao
