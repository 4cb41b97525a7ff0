/// grid_world.h: a scene of objects with AO grids and of the rest, and what pixels of it are
/// answered:
///
///     occlusion = 1 - (1 - by the rest) (1 - by the object itself) visibility_at() of the others
///
/// The rest is what has no grid; an engine of the scene is asked about it, also from the surfaces
/// of objects. It is asked too what an object hides from its own surface: the cells of its grid are
/// too coarse to tell that at its creases.
#pragma once

#include "bake/occluders.h"
#include "bake/world.h"
#include "engines/engine.h"
#include "files/motion.h"
#include "pixels/grid_pass.h"
#include "pixels/placed_grid.h"
#include "surfels/progress.h"
#include "surfels/surface.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace surfelao {

/// A grid and whose it is.
struct NodeGrid {
    std::string node;  ///< of the scene, as a pattern of names (surfels/labels.h)
    /// Its units and axes are the world's of the scene file, as it stands without a moment.
    std::shared_ptr<const AoGrid> grid;
    std::vector<bool> triangles = {};  ///< of the scene; empty: those that the name means
};

/// All grids of a scene file, and what moves them.
struct GridSources {
    std::vector<NodeGrid> grids;
    std::shared_ptr<const Motion> motion;  ///< null: the scene is asked as it stands
};

/// The objects' surfaces.
struct GridSurfaces {
    std::vector<std::shared_ptr<const Geometry>> list;  ///< in the unit frame; numbered from 1 on
    std::vector<std::uint32_t> of_triangle;  ///< of the mesh's geometry: PlacedGrid::surface
};

class GridWorld {
public:
    /// Without surfaces no receiver is on one.
    GridWorld(std::vector<PlacedGrid> objects, std::shared_ptr<const Geometry> rest,
              GridSurfaces surfaces = {});
    GridWorld(const GridWorld&) = delete;
    GridWorld& operator=(const GridWorld&) = delete;

    [[nodiscard]] std::span<const PlacedGrid> objects() const { return objects_; }
    [[nodiscard]] const Geometry& rest() const { return *rest_; }  ///< unit frame; may be empty
    /// The numbers of the surfaces on which points of the mesh lie; 0: of the rest's.
    [[nodiscard]] std::vector<std::uint32_t> surfaces_at(
        std::span<const SurfacePoint> points) const;

    /// Builds the engines that answer for the rest and the objects' own surfaces, if that is not
    /// done yet.
    void prepare(const EngineChoice& choice);

    /// What the rest hides, and objects from their own surfaces. own: as surfaces_at(), or empty:
    /// on none. Throws as solve(); InputError for a ground with a limit of the distance where there
    /// is no rest. One thread at a time.
    [[nodiscard]] std::vector<Occlusion> solve(std::span<const Receiver> receivers,
                                               std::span<const std::uint32_t> own,
                                               const EngineSettings& engine,
                                               const Progress& progress = {});

private:
    void add_own(std::span<const Receiver> receivers, std::span<const std::uint32_t> own,
                 const EngineSettings& engine, std::span<Occlusion> answers);
    [[nodiscard]] std::vector<Occlusion> solve_rest(std::span<const Receiver> receivers,
                                                    const EngineSettings& engine,
                                                    const Progress& progress);

    std::vector<PlacedGrid> objects_;
    std::shared_ptr<const Geometry> rest_;
    GridSurfaces surfaces_;
    Occluders occluders_;
    std::vector<Occluders> own_occluders_;  ///< one per surface
};

/// Objects of a scene at a moment, placed from where their grids were made: by the poses of their
/// nodes. mesh: the scene at that moment; others, choice: with which it was made.
/// An object that is gone (a scale of zero) is left out. Throws InputError for a name that means
/// nothing in the scene, for two objects that have triangles in common, for one that does not move
/// as one piece or is sheared or unevenly scaled, and as read_scene().
[[nodiscard]] std::shared_ptr<GridWorld> grid_world_of(const Mesh& mesh,
                                                       std::span<const Scene> others,
                                                       const PartChoice& choice,
                                                       const GridSources& sources,
                                                       const std::optional<Moment>& moment = {});

/// Who answers at pixels with grids.
struct GridPixels {
    GridMerge merge = GridMerge::product;
    EngineSettings rest;               ///< who answers for the rest
    std::shared_ptr<GridWorld> world;  ///< null until the scene is read
    bool operator==(const GridPixels&) const = default;
};

/// What a picture's pixels see: what the grids hide is read on the device. own: as
/// GridWorld::solve(); receivers: of those of the drawn picture's pixels that are listed (column +
/// width * row from the bottom).
[[nodiscard]] std::vector<Occlusion> solve_with_grids(GridPass& pass, const GBuffer& drawing,
                                                      const GridPixels& settings,
                                                      std::span<const Receiver> receivers,
                                                      std::span<const std::uint32_t> own,
                                                      std::span<const std::uint32_t> pixels,
                                                      const Progress& progress = {});

/// Answers at any receivers. The bent normals are those of the rest and of the object itself.
[[nodiscard]] std::vector<Occlusion> solve_with_grids(const GridPixels& settings,
                                                      std::span<const Receiver> receivers,
                                                      std::span<const std::uint32_t> own = {},
                                                      const Progress& progress = {});

}  // namespace surfelao
