/// shown_error.h: how wrong a picture of differences is, over what is seen in it.
#pragma once

#include "bake/statistics.h"
#include "image/legend.h"
#include "viewer/view_options.h"

#include <glm/vec4.hpp>

#include <span>
#include <string>

namespace surfelao {

/// pixels: occlusion and that by rays in red and green; those of alpha 0 are left out. Without
/// bent normals.
[[nodiscard]] ErrorStatistics shown_error(std::span<const glm::vec4> pixels);

/// rounded_scale() of what 95 % of the pixels do not exceed.
[[nodiscard]] float fitting_scale(const ErrorStatistics& error);

/// "RMSE 0.0041  BIAS +0.0003": the note of a legend.
[[nodiscard]] std::string note_of(const ErrorStatistics& error);

/// Without a note.
[[nodiscard]] Legend difference_legend(const ViewOptions& options);

}  // namespace surfelao
