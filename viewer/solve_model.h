/// solve_model.h: the answers that a picture of a model needs.
///
/// The vertices are solved alone, so that equal settings give them the very bytes that bake() gives
/// them: engines share work among the receivers of one list. The ground is a list of its own.
#pragma once

#include "engines/device_solution.h"
#include "engines/engine.h"
#include "viewer/model.h"

#include <memory>
#include <vector>

namespace surfelao {

/// One answer per receiver of the model; a ground that is not wanted is open. prepared: of this
/// model's geometry. Throws as solve().
[[nodiscard]] Solution solve_model(const Prepared& prepared, const Model& model,
                                   const SolveSettings& settings, bool with_ground = true,
                                   const Progress& progress = {});

/// Answers for whoever draws them where they were found.
struct ModelOnDevice {
    std::shared_ptr<const DeviceSolution> vertices;
    std::vector<Occlusion> ground;  ///< few: they have come back
    double seconds = 0.0;           ///< of both lists
};

/// The same answers. Throws as solve_on_device().
[[nodiscard]] ModelOnDevice solve_model_on_device(const Prepared& prepared, const Model& model,
                                                  const SolveSettings& settings,
                                                  const Progress& progress = {});

}  // namespace surfelao
