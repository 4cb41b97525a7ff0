/// model_map.h: a model's map, baked to be shown.
#pragma once

#include "atlas/layout.h"
#include "atlas/layout_facts.h"
#include "image/map.h"
#include "viewer/base_paint.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace surfelao {

/// Where a model's map lies, with what a picture tells of it.
struct ModelLayout {
    MapLayout layout;
    LayoutFacts facts;
    std::optional<std::uint32_t> uv_set = {};  ///< the file's; empty: new ones
};

/// One per page of the layout, all of its size: bytes as in files (MapDepth::byte).
struct ModelMap {
    std::vector<Map> visibility;  ///< one channel
    std::vector<Map> bent;        ///< three: MapBake::bent
};

/// Of surfaces that nothing occludes.
[[nodiscard]] ModelMap open_map(const MapLayout& layout);

/// "1024 x 1024 texels, 3 pages, 39 charts, 512 texels per unit"
[[nodiscard]] std::string text_of(const ModelLayout& layout);

/// What a model is drawn with besides values at its vertices; null where there is none.
struct SurfaceData {
    const ModelLayout* layout = nullptr;  ///< then the map stands in for the vertices' values
    const ModelMap* map = nullptr;
    const ModelMap* reference = nullptr;  ///< without one the map stands in for it
    const BasePaint* paint = nullptr;     ///< for Colors::textured: without one white
};

/// What density is shown hottest: the median is in the middle of the scale. > 0
[[nodiscard]] float most_density(const LayoutFacts& facts);

}  // namespace surfelao
