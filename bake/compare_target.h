/// compare_target.h: what all engines of a comparison make of one mesh, the same job for each:
/// values at its vertices, or a map. Internal to bake/.
#pragma once

#include "bake/bake.h"
#include "bake/surface_error.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace surfelao {

/// Seconds of one job. What a target does not need is 0.
struct JobSeconds {
    double raster = 0.0;  ///< a map's texels: which, and where each is asked
    double build = 0.0;   ///< the engine's own structures
    double solve = 0.0;
    double fit = 0.0;   ///< of answers, values at vertices
    double fill = 0.0;  ///< of answers, a map
};

/// What came of one job.
struct JobResult {
    JobSeconds seconds;
    /// Of a job that is judged; one per point of the truth in each of the first two.
    std::vector<Occlusion> displayed;
    std::vector<Occlusion> answers;  ///< the engine's own
    std::vector<float> occlusion;    ///< per vertex, or per texel and page: what it holds
};

class CompareTarget {
public:
    virtual ~CompareTarget() = default;

    [[nodiscard]] virtual std::uint64_t receivers() const = 0;

    /// Whether something is displayed at a triangle at all: where nothing is, nobody is right or
    /// wrong.
    [[nodiscard]] virtual bool shows(std::uint32_t triangle) const = 0;

    /// What exact answers would display. settings: those of the truth.
    [[nodiscard]] virtual Floor floor(const SurfaceTruth& truth, const TruthSettings& settings,
                                      const Progress& progress) const = 0;

    /// truth: the job is judged; null: only its seconds count.
    [[nodiscard]] virtual JobResult run(const EngineSettings& engine, const SurfaceTruth* truth,
                                        const Progress& progress) const = 0;
};

/// mesh: made with settings.normals.
[[nodiscard]] std::unique_ptr<const CompareTarget> vertices_to_compare(
    std::shared_ptr<const Mesh> mesh, const TargetSettings& settings);

/// settings: its offset counts. Bent normals are not part of the job.
[[nodiscard]] std::unique_ptr<const CompareTarget> map_to_compare(std::shared_ptr<const Mesh> mesh,
                                                                  MapLayout layout,
                                                                  std::uint32_t padding,
                                                                  const TargetSettings& settings);

}  // namespace surfelao
