/// grid_target.h: from an object to the AO grid round it (grid/ao_grid.h).
///
/// At every cell occlusion is asked for hemispheres all around: cosine-weighted answers in sixteen
/// directions, of which least squares make the nine harmonics that they are sums of,
///
///     E(n) = sum A_l / pi c_lm Y_lm(n),   A = pi, 2 pi / 3, pi / 4
///
/// and those tell alpha and m. So any engine bakes grids, and a cell is one group of receivers.
///
/// Cells in the object would darken what lies beside it: they hold what is seen from the nearest
/// place of the surface, moved a little outwards, and as far as something is read beside them, what
/// makes that right (grid_fit.h). A cell is inside where most directions first meet the inner side
/// of a surface.
///
/// The box reaches, along each axis, to where a plane of the object's own size would hide eps of
/// the sphere: e_i = r_i + sqrt(A_i / (4 pi eps)), r half the object's size, A_i its box's face.
///
/// Based on:
///   Malmer, Malmer, Assarsson, Holzschuch. Fast Precomputed Ambient Occlusion for Proximity
///   Shadows. JGT 12(2). 2007
#pragma once

#include "bake/error_search.h"
#include "bake/stated_error.h"
#include "engines/engine.h"
#include "grid/ao_grid.h"
#include "image/map.h"
#include "reference/rays.h"
#include "surfels/geometry.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

struct GridSettings {
    int resolution = 32;   ///< cells along each axis: kLeastGrid to kMostGrid
    double extent = 0.03;  ///< eps, in (0, kMostExtent]
    bool uniform = false;  ///< cells everywhere as close; else closer about the object
    GridStore store = GridStore::cone;
    GridBorder border = GridBorder::fade;
    MapDepth depth = MapDepth::half;  ///< in the file
    bool operator==(const GridSettings&) const = default;
};

inline constexpr int kLeastGrid = 4, kMostGrid = 256;
inline constexpr double kMostExtent = 0.5;

/// Throws SettingsError where a member is out of its range.
void check_grid(const GridSettings& settings);
/// "resolution=32 extent=0.03 store=cone ...": for marks.
[[nodiscard]] std::string text_of(const GridSettings& settings);

/// Wall-clock seconds of each stage.
struct GridSeconds {
    double surfels = 0.0;  ///< what the engine makes of the object first
    double tree = 0.0;     ///< its hierarchy, and that of the rays that look for cells inside
    double solve = 0.0;    ///< hemispheres, and from them to cells
    double repair = 0.0;   ///< cells inside: which, and where to; their new hemispheres
    double check = 0.0;    ///< from the grid to its error
};

struct GridBake {
    AoGrid grid;
    EngineSettings engine;
    std::uint64_t surfels = 0;
    std::uint64_t receivers = 0;  ///< hemispheres that were asked, also between cells
    std::uint64_t inside = 0;     ///< cells that were moved out of the object
    glm::dvec3 lift{0.0};         ///< lift_of() the object
    std::optional<double> residual;
    std::optional<StatedError> error;  ///< at random places of the box outside the object
    GridSeconds seconds;
};

/// The grid round a box of the object, without values: cells, box, warp.
[[nodiscard]] AoGrid empty_grid(const Box& object, const GridSettings& settings);

/// How far along each axis a place on a sheet is to be moved along its normal before it is read, in
/// the object's units: to the first layer of cells that sees its side alone where the object is
/// thinner than its box allows for (kLeastThickness), else 0. The sheet lies in the middle of the
/// box, between two layers, and half of what each sees hides half of all from both sides.
[[nodiscard]] glm::dvec3 lift_of(const Box& object, const AoGrid& grid);

/// object: what occludes; its definition's lengths are in its frame. check: places of the statement
/// of error; 0: none. Hemispheres are solved in bands, so that memory does not grow with the cells
/// beyond the grid itself. Equal input gives equal bytes, whatever the number of threads. Throws as
/// prepare() and solve(), InputError for an object without triangles, Cancelled.
[[nodiscard]] GridBake bake_grid(const Geometry& object, const GridSettings& settings,
                                 const EngineSettings& engine, std::uint32_t check,
                                 const StageProgress& progress = {});

/// Places outside of the object, with normals of all directions, where a grid is measured: of two
/// one is anywhere in the box, the other in 1.2 times the object's own. Offsets are 0.
[[nodiscard]] std::vector<Receiver> places_about(const Geometry& object, const AoGrid& box,
                                                 const RayScene& scene, std::size_t count,
                                                 std::uint64_t seed);

/// What a grid tells of a receiver in the object's unit frame.
[[nodiscard]] float occlusion_at(const AoGrid& grid, const Frame& frame, const Receiver& receiver);

}  // namespace surfelao
