#include "cli/commands.h"
#include "cli/compare_options.h"

namespace surfelao {
namespace {

std::vector<std::string> engines_of_grids(const CompareOptions& options)
{
    return options.engines.empty() ? std::vector<std::string>{"masks"} : options.engines;
}

}  // namespace

GridCompareSettings grid_compare_settings(const CompareOptions& options)
{
    GridCompareSettings settings;
    settings.input = options.inputs.front();
    settings.max_distance = distance_limit_of(options.measure);
    settings.parts = part_choice_of(options.parts);
    settings.grid = *grid_settings_of(options.grid, options.texels);
    settings.reference_rays = options.reference_rays.value_or(settings.reference_rays);
    settings.places = options.sample.value_or(settings.places);
    settings.rounds = options.rounds.value_or(kRounds);
    settings.reading = options.reading;
    for (const std::string& engine : engines_of_grids(options)) {
        for (const std::string& device : options.devices) {
            for (const std::string& quality : qualities_of(options)) {
                EngineSettings& candidate = settings.candidates.emplace_back();
                candidate.engine = engine_of(engine);
                candidate.device = device_of(device);
                candidate.quality = quality_of(quality, candidate.engine);
                candidate.instructions = options.avx2 ? Instructions::avx2 : Instructions::all;
            }
        }
    }
    return settings;
}

void check_grid_table(const CompareOptions& options)
{
    if (!grid_settings_of(options.grid, options.texels))
        return;
    if (options.inputs.size() > 1 || options.frontier || options.output || options.subdivide ||
        !options.parts.occluders.empty())
        throw UsageError(
            "--at grid is for one file; --frontier, -o, --subdivide and --occluders do not go "
            "with it.");
    check_about_an_object(options.measure, options.surface);
    static_cast<void>(texel_settings_of(options.texels, ""));  // maps have no say there
    static_cast<void>(grid_compare_settings(options));
}

}  // namespace surfelao
