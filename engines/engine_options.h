/// engine_options.h: what is asked, in the words of each engine.
///
/// Internal to engines/.
#pragma once

#include "engines/engine.h"
#include "reference/rays.h"
#include "tree/disks/disks.h"
#include "tree/masks/masks.h"

#include <optional>
#include <span>
#include <vector>

namespace surfelao {

/// Throws std::runtime_error where the processor lacks the instructions asked for.
[[nodiscard]] MaskKernelSet kernel_set_of(Instructions instructions);
[[nodiscard]] RayScene::Isa isa_of(Instructions instructions);

[[nodiscard]] MaskOptions mask_options(const EngineChoice& choice, const SolveSettings& settings);
[[nodiscard]] DiskOptions disk_options(const SolveSettings& settings);
[[nodiscard]] RayOptions ray_options(const SolveSettings& settings);

/// The last of DiskResult::residuals.
[[nodiscard]] std::optional<double> residual_of(const std::vector<double>& residuals);

/// Throws InputError for the first that no engine can answer.
void check_receivers(std::span<const Receiver> receivers);

}  // namespace surfelao
