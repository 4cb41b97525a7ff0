#include "bake/engine.h"

#include "bake/text.h"
#include "bake/timing.h"
#include "gpu/context.h"
#include "gpu/gpu_disks.h"
#include "gpu/gpu_masks.h"
#include "reference/rays.h"
#include "reference/smoothing.h"
#include "surfels/errors.h"
#include "surfels/surfel.h"
#include "surfels/topology.h"
#include "tree/disks.h"
#include "tree/masks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace surfelao {
namespace {

/// Between the named qualities the opening changes geometrically.
float opening_at(float quality)
{
    return quality <= kGood ? kDraftOpening * std::pow(kGoodOpening / kDraftOpening, quality)
                            : kGoodOpening * std::pow(kBestOpening / kGoodOpening, quality - kGood);
}

/// Made at first use and kept: shaders take longer to compile than a small scene to solve. Never
/// destroyed: at exit the driver may be gone before.
const GlContext& gpu_context()
{
    static const GlContext* context = new GlContext(GlContext::create());
    context->make_current();
    return *context;
}

EngineResult run_disks(const Geometry& geometry, std::span<const Receiver> receivers,
                       const EngineSettings& settings, const Progress& progress)
{
    const GlContext* gpu = settings.device == Device::gpu ? &gpu_context() : nullptr;
    EngineResult result;
    Stopwatch watch;
    const SurfelCloud cloud = surfels_of(geometry);
    const std::vector<OccluderSide> sides = sides_of(cloud, analyse_topology(geometry));
    result.surfels = cloud.surfels.size();
    result.surfels_s = watch.lap();
    const Octree octree = build_octree(cloud.surfels, sides);
    result.tree_s = watch.lap();
    DiskOptions options;
    options.definition = settings.definition;
    options.opening = opening_at(settings.quality);
    options.passes = settings.passes;
    options.strength = settings.strength;
    DiskResult solved = gpu != nullptr ? solve_disks_gpu(*gpu, octree, receivers, options, progress)
                                       : solve_disks(octree, receivers, options, progress);
    result.occlusion = std::move(solved.occlusion);
    if (!solved.residuals.empty())
        result.residual = solved.residuals.back();
    result.solve_s = watch.lap();
    return result;
}

EngineResult run_masks(const Geometry& geometry, std::span<const Receiver> receivers,
                       const EngineSettings& settings, const Progress& progress)
{
    const GlContext* gpu = settings.device == Device::gpu ? &gpu_context() : nullptr;
    EngineResult result;
    MaskOptions options;
    options.definition = settings.definition;
    options.quality = settings.quality;
    if (settings.instructions == Instructions::avx2) {
        const std::vector<MaskKernelSet> available = available_mask_kernels();
        if (std::find(available.begin(), available.end(), MaskKernelSet::avx2) == available.end())
            throw std::runtime_error("this processor has no AVX2");
        options.kernel = MaskKernelSet::avx2;
    }
    Stopwatch watch;
    const std::shared_ptr<const MaskTree> tree = build_mask_tree(geometry);
    result.tree_s = watch.lap();
    result.occlusion = gpu != nullptr ? solve_masks_gpu(*gpu, *tree, receivers, options, progress)
                                      : solve_masks(*tree, receivers, options, progress);
    result.solve_s = watch.lap();
    return result;
}

EngineResult run_rays(const Geometry& geometry, std::span<const Receiver> receivers,
                      const EngineSettings& settings, const Progress& progress)
{
    EngineResult result;
    Stopwatch watch;
    const RayScene scene(
        geometry, RayScene::Build::fast,
        settings.instructions == Instructions::avx2 ? RayScene::Isa::avx2 : RayScene::Isa::best);
    result.tree_s = watch.lap();
    RayOptions options;
    options.definition = settings.definition;
    options.rays = settings.rays;
    result.occlusion = trace_occlusion(scene, receivers, options, progress);
    if (settings.smoothed)
        result.occlusion = smooth_occlusion(geometry, result.occlusion);
    result.solve_s = watch.lap();
    return result;
}

std::string name_of_quality(float quality)
{
    if (quality == kDraft)
        return "draft";
    if (quality == kGood)
        return "good";
    if (quality == kBest)
        return "best";
    return "quality " + exact(quality);
}

}  // namespace

EngineResult run_engine(const Geometry& geometry, std::span<const Receiver> receivers,
                        const EngineSettings& settings, const Progress& progress)
{
    switch (settings.engine) {
        case Engine::masks:
            return run_masks(geometry, receivers, settings, progress);
        case Engine::disks:
            return run_disks(geometry, receivers, settings, progress);
        case Engine::rays:
            return run_rays(geometry, receivers, settings, progress);
    }
    std::abort();
}

std::string name_of(Engine engine)
{
    switch (engine) {
        case Engine::masks:
            return "masks";
        case Engine::disks:
            return "disks";
        case Engine::rays:
            return "rays";
    }
    std::abort();
}

float least_quality(Engine engine)
{
    return engine == Engine::masks ? MaskOptions::kCoarsest : kDraft;
}

float most_quality(Engine engine)
{
    switch (engine) {
        case Engine::masks:
            return MaskOptions::kFinest;
        case Engine::disks:
            return kBest;
        case Engine::rays:
            return 0.0f;
    }
    std::abort();
}

bool knows_kernel(Engine engine, Kernel kernel)
{
    return kernel == Kernel::cosine || engine != Engine::masks;
}

bool runs_on(Engine engine, Device device)
{
    return device == Device::cpu || engine != Engine::rays;
}

std::string setting_of(const EngineSettings& settings)
{
    if (settings.engine != Engine::rays)
        return name_of_quality(settings.quality) +
               (settings.device == Device::gpu ? " on GPU" : "");
    return std::to_string(settings.rays) + (settings.rays == 1 ? " ray" : " rays") +
           (settings.smoothed ? ", smoothed" : "");
}

Definition definition_of(const DistanceLimit& limit, Kernel kernel, const Frame& frame)
{
    const double share = limit.percent ? limit.value / 100.0 : limit.value / frame.diagonal;
    Definition definition;
    definition.kernel = kernel;
    definition.max_distance = static_cast<float>(share);
    if (!std::isfinite(definition.max_distance))
        return definition;  // no limit, or one that nothing in the scene can reach
    if (!(definition.max_distance > 0.0f))
        throw InputError("the distance limit vanishes beside the scene's size of " +
                         std::to_string(frame.diagonal));
    definition.falloff = limit.falloff;
    return definition;
}

}  // namespace surfelao
