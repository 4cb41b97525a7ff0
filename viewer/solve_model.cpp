#include "viewer/solve_model.h"

#include <cstddef>
#include <span>
#include <utility>

namespace surfelao {
namespace {

/// The two calls' receivers, and what each may tell of its progress.
struct Calls {
    Calls(const Model& model, const Progress& progress)
    {
        const std::span<const Receiver> receivers = model.receivers;
        const std::size_t vertex_count = model.geometry.positions.size();
        vertices = receivers.first(vertex_count);
        ground = receivers.subspan(vertex_count);
        if (!progress)
            return;
        const double share =
            static_cast<double>(vertex_count) / static_cast<double>(receivers.size());
        vertex_progress = [=](double done) { return progress(share * done); };
        ground_progress = [=](double done) { return progress(share + (1.0 - share) * done); };
    }
    std::span<const Receiver> vertices, ground;
    Progress vertex_progress, ground_progress;
};

}  // namespace

Solution solve_model(const Prepared& prepared, const Model& model, const SolveSettings& settings,
                     bool with_ground, const Progress& progress)
{
    const Calls calls(model, progress);
    if (!with_ground) {
        Solution solution = solve(prepared, calls.vertices, settings, progress);
        for (const Receiver& receiver : calls.ground)
            solution.occlusion.push_back({0.0f, receiver.normal});
        return solution;
    }
    Solution solution = solve(prepared, calls.vertices, settings, calls.vertex_progress);
    const Solution ground = solve(prepared, calls.ground, settings, calls.ground_progress);
    solution.occlusion.insert(solution.occlusion.end(), ground.occlusion.begin(),
                              ground.occlusion.end());
    solution.seconds += ground.seconds;
    return solution;
}

ModelOnDevice solve_model_on_device(const Prepared& prepared, const Model& model,
                                    const SolveSettings& settings, const Progress& progress)
{
    const Calls calls(model, progress);
    ModelOnDevice found;
    found.vertices = std::make_shared<const DeviceSolution>(
        solve_on_device(prepared, calls.vertices, settings, calls.vertex_progress));
    Solution ground = solve(prepared, calls.ground, settings, calls.ground_progress);
    found.ground = std::move(ground.occlusion);
    found.seconds = found.vertices->seconds + ground.seconds;
    return found;
}

}  // namespace surfelao
