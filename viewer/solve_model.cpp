#include "viewer/solve_model.h"

#include "surfels/stopwatch.h"

#include <span>
#include <utility>
#include <vector>

namespace surfelao {

Solution solve_model(const Prepared& prepared, const Model& model, const SolveSettings& settings,
                     bool with_ground, const Progress& progress)
{
    const std::span<const Receiver> asked = model.target->receivers();
    std::vector<Solution> found;
    if (with_ground) {
        const std::span<const Receiver> lists[] = {asked, model.ground_receivers};
        found = solve_lists(prepared, lists, settings, progress);
    } else {
        found.push_back(solve(prepared, asked, settings, progress));
        found.emplace_back();
        for (const Receiver& receiver : model.ground_receivers)
            found.back().occlusion.push_back({0.0f, receiver.normal});
    }
    Stopwatch watch;
    Solution solution = std::move(found[0]);
    solution.occlusion = model.target->values(solution.occlusion);
    solution.occlusion.insert(solution.occlusion.end(), found[1].occlusion.begin(),
                              found[1].occlusion.end());
    solution.seconds += watch.lap();
    return solution;
}

Reference reference_of(const Model& model, const ReferenceOptions& options,
                       const Progress& progress)
{
    const std::span<const Receiver> asked = model.target->receivers();
    std::vector<Receiver> receivers(asked.begin(), asked.end());
    receivers.insert(receivers.end(), model.ground_receivers.begin(), model.ground_receivers.end());
    Reference reference = trace_reference(model.geometry(), receivers, options, progress);
    const std::span<const Occlusion> traced = reference.occlusion;
    std::vector<Occlusion> values = model.target->values(traced.first(asked.size()));
    values.insert(values.end(), traced.begin() + static_cast<std::ptrdiff_t>(asked.size()),
                  traced.end());
    reference.occlusion = std::move(values);
    return reference;
}

}  // namespace surfelao
