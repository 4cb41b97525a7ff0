/// solve_model.h: the answers that a picture of a model needs.
#pragma once

#include "engines/engine.h"
#include "viewer/model.h"

namespace surfelao {

/// The vertices are solved alone, so that equal settings give them the very bytes that bake() gives
/// them: engines share work among the receivers of one call. The ground, when it is wanted, is a
/// call of its own; else it is open. One answer per receiver of the model; seconds are of both
/// calls, the residual is the vertices'. prepared: of this model's geometry. Throws as solve().
[[nodiscard]] Solution solve_model(const Prepared& prepared, const Model& model,
                                   const SolveSettings& settings, bool with_ground = true,
                                   const Progress& progress = {});

}  // namespace surfelao
