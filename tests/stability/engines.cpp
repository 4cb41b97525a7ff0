#include "tests/stability/engines.h"

#include "reference/rays.h"
#include "surfels/surfel.h"
#include "surfels/topology.h"
#include "tree/disks.h"
#include "tree/masks.h"

#include <cmath>

namespace surfelao::stability {
namespace {

/// A net is never worse than independent directions: RMS at most 0.5 n^-1/2, and the worst of a
/// thousand receivers four times that.
Engine rays(const char* name, RayScene::Build build, std::uint32_t count)
{
    const double rms = 0.5 / std::sqrt(count);
    return {name,
            {rms, 4.0 * rms},
            false,
            [build, count](const Geometry& geometry, std::span<const Receiver> receivers,
                           const Definition& definition) {
                RayOptions options;
                options.definition = definition;
                options.rays = count;
                options.seed = 1;  // not the seed of the witness
                return trace_occlusion(RayScene(geometry, build), receivers, options);
            }};
}

/// Figures of the disk engine's own design: closed smooth bodies 0.005 to 0.025 RMS; the worst
/// receiver is not promised, five times the RMS is what its tails show.
Engine disks(const char* name, float opening, Bound bound)
{
    return {name, bound, true,
            [opening](const Geometry& geometry, std::span<const Receiver> receivers,
                      const Definition& definition) {
                const Topology topology = analyse_topology(geometry);
                std::vector<OccluderSide> sides;
                for (std::size_t v = 0; v < geometry.areas.size(); ++v) {
                    if (geometry.areas[v] > 0.0f)
                        sides.push_back(topology.sides[v]);
                }
                DiskOptions options;
                options.definition = definition;
                options.opening = opening;
                return solve_disks(build_octree(surfels_at_vertices(geometry), sides), receivers,
                                   options)
                    .occlusion;
            }};
}

/// One bit per direction. The bounds are the measured RMS of the worst cases plus a fifth; the
/// worst receiver has up to six times that. Worst cases: draft a closed sphere (0.043), good a
/// closed sphere (0.015), best a square pit along the raster's axes (0.014).
Engine masks(const char* name, float quality, Bound bound)
{
    return {name, bound, false,
            [quality](const Geometry& geometry, std::span<const Receiver> receivers,
                      const Definition& definition) {
                MaskOptions options;
                options.definition = definition;
                options.quality = quality;
                return solve_masks(*build_mask_tree(geometry), receivers, options);
            }};
}

}  // namespace

std::vector<Engine> all_engines()
{
    return {
        rays("rays 4096", RayScene::Build::robust, 4096),
        rays("rays 256", RayScene::Build::fast, 256),
        masks("masks draft", MaskOptions::kDraft, {0.05, 0.15}),
        masks("masks good", MaskOptions::kGood, {0.018, 0.1}),
        masks("masks best", MaskOptions::kBest, {0.018, 0.06}),
        disks("disks draft", kDraftOpening, {0.05, 0.25}),
        disks("disks good", kGoodOpening, {0.03, 0.15}),
        disks("disks best", kBestOpening, {0.03, 0.15}),
    };
}

}  // namespace surfelao::stability
