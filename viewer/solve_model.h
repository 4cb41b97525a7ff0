/// solve_model.h: the answers that a picture of a model needs.
///
/// The vertices are solved alone, so that equal settings give them the very bytes that bake() gives
/// them: engines share work among the receivers of one list. The ground is a list of its own.
#pragma once

#include "engines/engine.h"
#include "reference/reference_cache.h"
#include "viewer/model.h"

namespace surfelao {

/// Model::answer_count() answers; a ground that is not wanted is open. prepared: of this model's
/// geometry. seconds: with the fit. Throws as solve().
[[nodiscard]] Solution solve_model(const Prepared& prepared, const Model& model,
                                   const SolveSettings& settings, bool with_ground = true,
                                   const Progress& progress = {});

/// The witness's values, likewise: what solve_model() would find with perfect answers. Throws as
/// trace_reference().
[[nodiscard]] Reference reference_of(const Model& model, const ReferenceOptions& options,
                                     const Progress& progress = {});

}  // namespace surfelao
