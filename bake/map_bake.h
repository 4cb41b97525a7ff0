/// map_bake.h: from a mesh and its places in a map to the occlusion at every texel.
///
/// Texels are receivers (surfels/texels.h), solved band by band, page by page: memory follows the
/// band, not the map. Engines that make groups of receivers are asked at few of them where
/// occlusion hardly changes (sparse_texels.h). Where sheets lie on each other a texel
/// holds their mean, and how far they differ is told. Texels that nothing covers, or what nobody
/// sees (hidden_texels.h), take what lies beyond the seam (atlas/seams.h) or surrounds them
/// (image/map.h), so that filters and mip levels fetch no emptiness. Then both sides of smooth
/// seams are made to show the same. At last, where the answer steps from a texel to the next, the
/// surface is asked more closely and texels get the values that show it best (texel_fit.h); bent
/// normals, and maps more than kMostTexels / kFitSide wide, stay as they are.
#pragma once

#include "atlas/layout.h"
#include "atlas/seams.h"
#include "bake/vertex_bake.h"
#include "engines/engine.h"
#include "image/map.h"
#include "surfels/surface.h"
#include "surfels/texels.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace surfelao {

class HighDetail;

/// From a direction in the world to what a map of a page holds at a point of the surface: of unit
/// length, or zero.
using BentEncoder =
    std::function<glm::vec3(std::size_t page, const SurfacePoint& point, glm::vec3 direction)>;

struct MapSettings {
    std::uint32_t padding = 4;  ///< texels around what is covered that take their neighbours' mean
    BentEncoder bent = {};      ///< bent normals too, in this space (bent_space.h)
    bool joins_bent = true;     ///< across seams; not in tangent space, which is another there
    MapDepth depth = MapDepth::byte;
    bool half_is_whole = true;           ///< what 16 bits are in the file (image/map.h)
    std::uint32_t check = kCheckPoints;  ///< as BakeSettings::check
};

/// Texels of a band: receivers, answers and what engines need of them take some 100 bytes each.
/// Those that are asked shall lie close to each other (2^17: engine at 4,096^2 takes 1.3 times as
/// long, for its bands are narrow strips over many charts).
inline constexpr std::uint64_t kBandTexels = std::uint64_t{1} << 20;

struct MapSeconds {
    double raster = 0.0;  ///< which texels and samples, and where each is asked
    double surfels = 0.0;
    double tree = 0.0;
    double solve = 0.0;
    double fill = 0.0;  ///< hidden texels, seams, what nothing covers, and steps
    double check = 0.0;
};

struct MapBake {
    EngineSettings engine;  ///< who answered
    /// Per page of the layout, one channel, 1 = open; rounded as the file will be.
    std::vector<Map> visibility;
    std::vector<Map> bent;             ///< three channels, (n + 1) / 2; or empty
    std::optional<StatedError> error;  ///< of what is displayed: fetched between texels
    std::uint64_t receivers = 0;       ///< points that were asked
    std::uint64_t covered = 0;         ///< texels that show the surface
    std::uint64_t overlapping = 0;     ///< texels with several sheets
    std::uint64_t hidden = 0;  ///< of the covered ones: inside of a body, filled as if not covered
    std::uint64_t seams = 0, smooth_seams = 0;  ///< edges of the surface
    SeamJump jump;                              ///< at the smooth ones, before rounding
    double mean_occlusion = 0.0;                ///< over covered texels
    double spread = 0.0;  ///< of these: RMS difference of the sheets' occlusion to their mean
    std::uint64_t flat_triangles = 0;     ///< that show no texel
    std::uint64_t outside_triangles = 0;  ///< that reach out of the map
    std::uint64_t misses = 0;             ///< texels' points that met nothing of the high detail
    std::uint64_t surfels = 0;
    std::optional<double> residual;  ///< of the disk engine's correction
    std::vector<Trial> trials;       ///< of bake_map_to_error()
    bool is_met = false;             ///< of bake_map_to_error()
    MapSeconds seconds;              ///< of several trials the sums
};

/// high: what lies over the mesh is asked in place of the mesh, and what occludes is it alone
/// (high_to_low.h); `engine.definition` and `offset` are then in its frame. occluders: in that
/// frame; null: the high detail, else what occludes the mesh. Throws as MapRaster,
/// prepare() and solve(), and Cancelled where progress says so.
[[nodiscard]] MapBake bake_map(const Mesh& mesh, const MapLayout& layout,
                               const MapSettings& settings, const EngineSettings& engine,
                               const Offset& offset, const StageProgress& progress = {},
                               const HighDetail* high = nullptr, Occluders* occluders = nullptr);

/// By the cheapest setting whose displayed error is below `error` with its whole interval, as
/// bake_to_error() does at vertices; engine: definition and instructions are taken. Where more
/// exactness changes nothing, for the texels are too large, it is masks at good, and is_met false.
/// settings.check >= 1.
[[nodiscard]] MapBake bake_map_to_error(const Mesh& mesh, const MapLayout& layout,
                                        const MapSettings& settings, const EngineSettings& engine,
                                        const Offset& offset, double error,
                                        const StageProgress& progress = {},
                                        const HighDetail* high = nullptr,
                                        Occluders* occluders = nullptr);

}  // namespace surfelao
