/// solve_map.h: the map that a picture of a model needs.
#pragma once

#include "bake/stated_error.h"
#include "bake/texel_layout.h"
#include "engines/engine.h"
#include "viewer/model.h"
#include "viewer/model_map.h"

#include <cstdint>
#include <optional>

namespace surfelao {

struct MapAnswer {
    ModelMap map;
    std::optional<StatedError> error;  ///< of what is displayed
    double seconds = 0.0;              ///< of texels, solving and filling
};

/// Where a map lies, with what is told of it. Throws as layout_for().
[[nodiscard]] ModelLayout layout_of(const Model& model, const TexelSettings& texels,
                                    const Progress& progress = {});

/// padding, check: as MapSettings. Throws as bake_map().
[[nodiscard]] MapAnswer solve_map(const Model& model, const MapLayout& layout,
                                  const EngineSettings& engine, std::uint32_t padding,
                                  std::uint32_t check = 0, const Progress& progress = {});

/// The same by ray casting at the same texels. rays: a texel, an even number.
[[nodiscard]] ModelMap reference_map(const Model& model, const MapLayout& layout,
                                     const Definition& definition, std::uint32_t rays,
                                     std::uint32_t padding, const Progress& progress = {});

}  // namespace surfelao
