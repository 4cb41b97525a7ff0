/// solve_model.h: the answers that a picture of a model needs, and what they are worth.
///
/// The vertices are solved alone, so that equal settings give them the very bytes that bake() gives
/// them: engines share work among the receivers of one list. The ground is a list of its own, and
/// so are the points of the surface at which errors are told.
#pragma once

#include "bake/statistics.h"
#include "bake/surface_error.h"
#include "engines/engine.h"
#include "viewer/model.h"

#include <cstdint>
#include <span>
#include <vector>

namespace surfelao {

/// What is solved.
struct SolveWith {
    bool vertices = true;  ///< else they are open
    bool ground = true;    ///< else it is open
    bool points = false;   ///< Model::points
};

struct ModelAnswer {
    std::vector<Occlusion> values;     ///< Model::answer_count()
    std::vector<Occlusion> at_points;  ///< one per Model::points, where they were asked for
    double seconds = 0.0;              ///< with the fit
};

/// The rough answer's settings; the same ones where the engine has none rougher.
[[nodiscard]] EngineSettings draft_of(EngineSettings settings);

/// What occludes in the model, for an engine. Throws as prepare() of engines/engine.h.
[[nodiscard]] Prepared prepare(const Model& model, const EngineChoice& choice);

/// prepared: of this model. Throws as solve().
[[nodiscard]] ModelAnswer solve_model(const Prepared& prepared, const Model& model,
                                      const SolveSettings& settings, const SolveWith& with = {},
                                      const Progress& progress = {});

/// The witness's values: what solve_model() would find with perfect answers.
struct ModelReference {
    std::vector<Occlusion> values;  ///< Model::answer_count()
    bool from_cache = false;
};

/// rays: a receiver, an even number. Throws as trace_reference().
[[nodiscard]] ModelReference reference_of(const Model& model, const Definition& definition,
                                          std::uint32_t rays, const Progress& progress = {});

/// The same with what errors are measured by.
struct ModelTruth {
    ModelReference reference;
    SurfaceTruth truth;  ///< at those of Model::points that are well-defined
    Floor floor;
};

/// Of a cloud the reference alone, without points of a surface.
/// rays: a point of the surface and of the ground; receivers of the fit may get fewer
/// (find_floor). Throws as trace_reference().
[[nodiscard]] ModelTruth truth_of(const Model& model, const Definition& definition,
                                  std::uint32_t rays, const Progress& progress = {});

/// As bake/surface_error.h defines them.
struct ModelError {
    ErrorStatistics seen;
    double floor = 0.0;
    double solve = 0.0;
    std::uint64_t left_out = 0;  ///< points that have no well-defined answer
};

/// values: Model::answer_count(); at_points: one per Model::points.
[[nodiscard]] ModelError error_of(const Model& model, const ModelTruth& truth,
                                  std::span<const Occlusion> values,
                                  std::span<const Occlusion> at_points);

}  // namespace surfelao
