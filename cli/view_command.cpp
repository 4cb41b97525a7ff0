#include "bake/statistics.h"
#include "cli/commands.h"
#include "cli/engine_options.h"
#include "cli/interrupt.h"
#include "cli/view_options.h"
#include "engines/engine.h"
#include "engines/threads.h"
#include "image/image_file.h"
#include "surfels/errors.h"
#include "viewer/window.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

namespace surfelao {
namespace {

struct ViewCommandOptions {
    std::string input;
    std::string camera;
    ShowOptions show;
    EngineOptions engine;
    MeasureOptions measure;
    std::optional<int> threads;
};

/// Who can be chosen in the window, in this order.
struct Choice {
    Engine engine;
    Device device;
};

std::vector<Choice> choices()
{
    std::vector<Choice> all;
    for (const Engine engine : {Engine::masks, Engine::disks, Engine::rays}) {
        for (const Device device : {Device::cpu, Device::gpu}) {
            if (runs_on(engine, device))
                all.push_back({engine, device});
        }
    }
    return all;
}

Solved solve(const Model& model, const SessionSettings& settings, const Progress& progress)
{
    EngineSettings engine;
    engine.engine = choices()[settings.engine].engine;
    engine.device = choices()[settings.engine].device;
    engine.definition = definition_of(settings);
    engine.quality = settings.quality;
    engine.passes = settings.passes;
    engine.strength = settings.strength;
    engine.rays = static_cast<std::uint32_t>(settings.rays);
    const Prepared prepared = prepare(model.geometry, engine);
    Solution solution = surfelao::solve(prepared, model.receivers, engine, progress);
    return {std::move(solution.occlusion), prepared.seconds().surfels + prepared.seconds().tree,
            solution.seconds};
}

Services services()
{
    Services all;
    for (const Choice& choice : choices())
        all.engines.push_back(
            {.name = name_of(choice.engine) + (choice.device == Device::gpu ? " on GPU" : ""),
             .least_quality = least_quality(choice.engine),
             .most_quality = most_quality(choice.engine),
             .has_disk_options = choice.engine == Engine::disks,
             .has_rays = choice.engine == Engine::rays});
    all.solve = solve;
    all.measure = [](std::span<const Occlusion> answer, std::span<const Occlusion> reference) {
        const ErrorStatistics error = error_statistics(answer, reference);
        return ErrorFigures{error.rmse, error.bias, error.p95, error.max};
    };
    return all;
}

int run(const ViewCommandOptions& options)
{
    std::optional<ThreadLimit> limit;
    if (options.threads)
        limit.emplace(*options.threads);
    WindowOptions window;
    window.input = options.input;
    window.up = up_axis_of(options.show);
    window.camera = options.camera;
    window.panel.view = view_options_of(options.show);
    window.panel.reference_rays = static_cast<int>(options.show.reference_rays);
    if (options.show.environment)
        window.environment = read_image(*options.show.environment);
    if (!options.input.empty() && !std::filesystem::exists(options.input))
        throw InputError(options.input + ": no such file");

    const EngineSettings engine = settings_of(options.engine);
    SessionSettings& settings = window.panel.settings;
    const std::vector<Choice> known = choices();
    while (known[settings.engine].engine != engine.engine ||
           known[settings.engine].device != engine.device)
        ++settings.engine;
    settings.quality =
        std::clamp(engine.quality, least_quality(engine.engine), most_quality(engine.engine));
    settings.passes = engine.passes;
    settings.strength = engine.strength;
    settings.rays = static_cast<int>(engine.rays);
    const DistanceLimit distance = distance_limit_of(options.measure);
    if (std::isfinite(distance.value)) {
        settings.max_distance_percent = static_cast<float>(distance.value);
        settings.smooth_falloff = distance.falloff == Falloff::smooth;
    }
    window.keep_open = [] { return caught_signal() == 0; };
    show_window(window, services());
    if (caught_signal() != 0)
        return kKilledBy + caught_signal();
    return kDone;
}

}  // namespace

void add_view_command(CLI::App& app, Work& work)
{
    const auto options = std::make_shared<ViewCommandOptions>();
    CLI::App* command = app.add_subcommand(
        "view", "A window: orbit, engines, settings, display modes, comparison with rays");
    command
        ->add_option("IN", options->input,
                     "Mesh file: .obj .ply .off .stl .gltf .glb; without one, drop files on the "
                     "window")
        ->type_name("");
    command
        ->add_option("--camera", options->camera,
                     "Where from, as for render: azimuth=30,elevation=18,distance=1,fov=35")
        ->type_name("WHERE");
    add_show_options(*command, options->show);
    add_engine_options(*command, options->engine);
    add_measure_options(*command, options->measure);
    add_thread_option(*command, options->threads);
    command->callback([options, &work] {
        static_cast<void>(settings_of(options->engine));
        static_cast<void>(view_options_of(options->show));
        const DistanceLimit distance = distance_limit_of(options->measure);
        if (std::isfinite(distance.value) && !distance.percent)
            throw UsageError("--max-distance of a window is in % of the diagonal (10%).");
        if (kernel_of(options->measure) != Kernel::cosine)
            throw UsageError("--kernel bunnell is not for a window: compare and bake know it.");
        work = [options] { return run(*options); };
    });
}

}  // namespace surfelao
