#include "tests/stability/engines.h"

#include "gpu/context.h"
#include "gpu/gpu_disks.h"
#include "gpu/gpu_masks.h"
#include "reference/rays.h"
#include "surfels/surfel.h"
#include "surfels/topology.h"
#include "tree/disks/disks.h"
#include "tree/masks/masks.h"

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

enum class Where { cpu, gpu };

/// Software, so that the table is the same everywhere; one for each thread, current in it.
const GlContext& software_gpu()
{
    thread_local const GlContext context = GlContext::create(GlBackend::osmesa);
    context.make_current();
    return context;
}

/// Figures of the disk engine's own design: closed smooth bodies 0.005 to 0.025 RMS; the worst
/// receiver is not promised, five times the RMS is what its tails show.
Engine disks(const char* name, Where where, float opening, Bound bound)
{
    return {name, bound, true, true,
            [where, opening](const Geometry& geometry, std::span<const Receiver> receivers,
                             const Definition& definition) {
                DiskOptions options;
                options.definition = definition;
                options.opening = opening;
                const SurfelCloud cloud = surfels_of(geometry);
                const Octree octree =
                    build_octree(cloud.surfels, sides_of(cloud, analyse_topology(geometry)));
                return where == Where::cpu
                           ? solve_disks(octree, receivers, options).occlusion
                           : solve_disks_gpu(software_gpu(), octree, receivers, options).occlusion;
            }};
}

/// One bit per direction. The bounds are the measured RMS of the worst cases plus a fifth; the
/// worst receiver has about four times that. Worst cases: draft a square pit along the raster's
/// axes (0.024) and a sphere from inside (0.030, a thirtieth of it allowed: cracks that are not
/// filled), good and best a soup of triangles (0.013, 0.011).
Engine masks(const char* name, Where where, float quality, Bound bound)
{
    return {name, bound, false, where == Where::gpu,
            [where, quality](const Geometry& geometry, std::span<const Receiver> receivers,
                             const Definition& definition) {
                MaskOptions options;
                options.definition = definition;
                options.quality = quality;
                const std::shared_ptr<const MaskTree> tree = build_mask_tree(geometry);
                return where == Where::cpu
                           ? solve_masks(*tree, receivers, options)
                           : solve_masks_gpu(software_gpu(), *tree, receivers, options);
            }};
}

}  // namespace

std::vector<Engine> all_engines()
{
    constexpr Bound kMasksDraft{0.031, 0.115}, kMasksGood{0.016, 0.07}, kMasksBest{0.0135, 0.055};
    constexpr Bound kDisksDraft{0.05, 0.25}, kDisksGood{0.03, 0.15}, kDisksBest{0.024, 0.15};
    return {
        rays("rays 4096", RayScene::Build::robust, 4096),
        rays("rays 256", RayScene::Build::fast, 256),
        masks("masks draft", Where::cpu, MaskOptions::kDraft, kMasksDraft),
        masks("masks good", Where::cpu, MaskOptions::kGood, kMasksGood),
        masks("masks best", Where::cpu, MaskOptions::kBest, kMasksBest),
        disks("disks draft", Where::cpu, kDraftOpening, kDisksDraft),
        disks("disks good", Where::cpu, kGoodOpening, kDisksGood),
        disks("disks best", Where::cpu, kBestOpening, kDisksBest),
        masks("GPU m. draft", Where::gpu, MaskOptions::kDraft, kMasksDraft),
        masks("GPU m. good", Where::gpu, MaskOptions::kGood, kMasksGood),
        masks("GPU m. best", Where::gpu, MaskOptions::kBest, kMasksBest),
        disks("GPU d. good", Where::gpu, kGoodOpening, kDisksGood),
    };
}

}  // namespace surfelao::stability
