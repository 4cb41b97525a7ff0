#include "viewer/solve_model.h"

#include <cstddef>
#include <span>

namespace surfelao {
namespace {

Progress part_of(const Progress& progress, double from, double to)
{
    if (!progress)
        return {};
    return [=](double done) { return progress(from + (to - from) * done); };
}

}  // namespace

Solution solve_model(const Prepared& prepared, const Model& model, const SolveSettings& settings,
                     bool with_ground, const Progress& progress)
{
    const std::span<const Receiver> receivers = model.receivers;
    const std::size_t vertex_count = model.geometry.positions.size();
    if (!with_ground) {
        Solution solution = solve(prepared, receivers.first(vertex_count), settings, progress);
        for (const Receiver& receiver : receivers.subspan(vertex_count))
            solution.occlusion.push_back({0.0f, receiver.normal});
        return solution;
    }
    const double vertex_share =
        static_cast<double>(vertex_count) / static_cast<double>(receivers.size());
    Solution solution = solve(prepared, receivers.first(vertex_count), settings,
                              part_of(progress, 0.0, vertex_share));
    const Solution ground = solve(prepared, receivers.subspan(vertex_count), settings,
                                  part_of(progress, vertex_share, 1.0));
    solution.occlusion.insert(solution.occlusion.end(), ground.occlusion.begin(),
                              ground.occlusion.end());
    solution.seconds += ground.seconds;
    return solution;
}

}  // namespace surfelao
