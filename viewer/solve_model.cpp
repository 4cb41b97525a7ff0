#include "viewer/solve_model.h"

#include <span>
#include <utility>
#include <vector>

namespace surfelao {
namespace {

std::span<const Receiver> vertices_of(const Model& model)
{
    return std::span(model.receivers).first(model.geometry.positions.size());
}

std::span<const Receiver> ground_of(const Model& model)
{
    return std::span(model.receivers).subspan(model.geometry.positions.size());
}

}  // namespace

Solution solve_model(const Prepared& prepared, const Model& model, const SolveSettings& settings,
                     bool with_ground, const Progress& progress)
{
    if (!with_ground) {
        Solution solution = solve(prepared, vertices_of(model), settings, progress);
        for (const Receiver& receiver : ground_of(model))
            solution.occlusion.push_back({0.0f, receiver.normal});
        return solution;
    }
    const std::span<const Receiver> lists[] = {vertices_of(model), ground_of(model)};
    std::vector<Solution> both = solve_lists(prepared, lists, settings, progress);
    both[0].occlusion.insert(both[0].occlusion.end(), both[1].occlusion.begin(),
                             both[1].occlusion.end());
    return std::move(both[0]);
}

ModelOnDevice solve_model_on_device(const Prepared& prepared, const Model& model,
                                    const SolveSettings& settings, const Progress& progress)
{
    const double share = static_cast<double>(model.geometry.positions.size()) /
                         static_cast<double>(model.receivers.size());
    Progress of_vertices, of_ground;
    if (progress) {
        of_vertices = [&](double done) { return progress(share * done); };
        of_ground = [&](double done) { return progress(share + (1.0 - share) * done); };
    }
    ModelOnDevice found;
    found.vertices = std::make_shared<const DeviceSolution>(
        solve_on_device(prepared, vertices_of(model), settings, of_vertices));
    Solution ground = solve(prepared, ground_of(model), settings, of_ground);
    found.ground = std::move(ground.occlusion);
    found.seconds = found.vertices->seconds + ground.seconds;
    return found;
}

}  // namespace surfelao
