/// cell.h: what a picture shows, as a cell of a table: where values lie, and how they are found.
#pragma once

#include "bake/grid_target.h"
#include "gpu/screen_space.h"
#include "viewer/session.h"
#include "viewer/view_options.h"

#include <map>
#include <optional>
#include <string>

namespace surfelao {

enum class Where {
    vertices,  ///< of a cloud: its points
    texels,
    pixels,
    cube_maps,  ///< texels of cube maps, which pixels read
    grid,       ///< cells of an AO grid round the model, or round each part that moves, likewise
};

struct Cell {
    /// Values at vertices or in a map. At pixels they are shown while the camera moves, and always
    /// on the ground.
    SessionSettings settings;
    bool at_pixels = false;
    bool from_maps = false;            ///< at pixels: read from cube maps
    std::optional<GridSettings> grid;  ///< at pixels: read from an AO grid
    std::optional<ScreenSettings>
        screen;  ///< at pixels or in maps: who answers in the engine's place
    /// Such methods see that much more beyond each edge of the picture, as a share of its height.
    float guard = 0.0f;
    bool operator==(const Cell&) const = default;
};

/// Of a map and of a grid, where values lie there.
struct WhereSettings {
    TexelSettings texels;
    GridSettings grid;
};

[[nodiscard]] Where where_of(const Cell& cell);
/// How stays what it is where that can be.
void set_where(Cell& cell, Where where, const WhereSettings& settings);

/// Sets who solves. Each engine keeps its own quality, and is `good` at first. qualities: of the
/// engines that are not chosen.
void choose_engine(Cell& cell, Engine engine, Device device, std::map<Engine, float>& qualities);

/// Whether the picture has a radius of its own at every pixel.
[[nodiscard]] bool has_radius(const Cell& cell);
/// The same, but visibility where the cell has nothing of these colours.
[[nodiscard]] ViewOptions options_for(const Cell& cell, ViewOptions options);

/// "vertices", "texels", "points", "pixels", "cube maps", "AO grid"
[[nodiscard]] std::string name_of(Where where, bool is_cloud);
/// "masks", "masks on GPU", "gtao", "horizon"
[[nodiscard]] std::string how_of(const Cell& cell);

/// "masks", "masks on GPU"
[[nodiscard]] std::string name_of(const EngineChoice& choice);

}  // namespace surfelao
