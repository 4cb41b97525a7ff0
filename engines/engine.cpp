#include "engines/engine.h"

#include "gpu/context.h"
#include "gpu/gpu_disks.h"
#include "gpu/gpu_masks.h"
#include "reference/rays.h"
#include "surfels/errors.h"
#include "surfels/number_text.h"
#include "surfels/stopwatch.h"
#include "surfels/surfel.h"
#include "surfels/topology.h"
#include "tree/disks/disks.h"
#include "tree/masks/masks.h"

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

MaskKernelSet kernel_set_of(Instructions instructions)
{
    if (instructions == Instructions::all)
        return MaskKernelSet::best;
    const std::vector<MaskKernelSet> available = available_mask_kernels();
    if (std::find(available.begin(), available.end(), MaskKernelSet::avx2) == available.end())
        throw std::runtime_error("this processor has no AVX2");
    return MaskKernelSet::avx2;
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

struct Prepared::Impl {
    EngineChoice choice;
    PrepareSeconds seconds;
    std::uint64_t surfel_count = 0;
    std::shared_ptr<const MaskTree> masks;
    std::optional<Octree> disks;
    std::optional<RayScene> rays;
    std::optional<GlContext> own_context;

    const GlContext* context() const { return own_context ? &*own_context : choice.context; }
};

Prepared::Prepared(std::unique_ptr<const Impl> impl) : impl_(std::move(impl))
{
}
Prepared::~Prepared() = default;
Prepared::Prepared(Prepared&&) noexcept = default;
Prepared& Prepared::operator=(Prepared&&) noexcept = default;

const EngineChoice& Prepared::choice() const
{
    return impl_->choice;
}

const PrepareSeconds& Prepared::seconds() const
{
    return impl_->seconds;
}

std::uint64_t Prepared::surfel_count() const
{
    return impl_->surfel_count;
}

Prepared prepare(const Geometry& geometry, const EngineChoice& choice)
{
    auto impl = std::make_unique<Prepared::Impl>();
    impl->choice = choice;
    if (!runs_on(choice.engine, choice.device))
        throw SettingsError(name_of(choice.engine) + " do not run on the GPU");
    if (choice.device == Device::gpu && choice.context == nullptr)
        impl->own_context.emplace(GlContext::create());
    Stopwatch watch;
    switch (choice.engine) {
        case Engine::masks:
            static_cast<void>(kernel_set_of(choice.instructions));
            impl->masks = build_mask_tree(geometry);
            break;
        case Engine::disks: {
            const SurfelCloud cloud = surfels_of(geometry);
            const std::vector<OccluderSide> sides = sides_of(cloud, analyse_topology(geometry));
            impl->surfel_count = cloud.surfels.size();
            impl->seconds.surfels = watch.lap();
            impl->disks = build_octree(cloud.surfels, sides);
            break;
        }
        case Engine::rays:
            impl->rays.emplace(geometry, RayScene::Build::fast,
                               choice.instructions == Instructions::avx2 ? RayScene::Isa::avx2
                                                                         : RayScene::Isa::best);
            break;
    }
    impl->seconds.tree = watch.lap();
    return Prepared(std::move(impl));
}

Solution solve(const Prepared& prepared, std::span<const Receiver> receivers,
               const SolveSettings& settings, const Progress& progress)
{
    const Prepared::Impl& impl = prepared.impl();
    check_settings(impl.choice, settings);
    const GlContext* gpu = impl.choice.device == Device::gpu ? impl.context() : nullptr;
    if (gpu != nullptr)
        gpu->make_current();
    Stopwatch watch;
    Solution solution;
    switch (impl.choice.engine) {
        case Engine::masks: {
            MaskOptions options;
            options.definition = settings.definition;
            options.quality = settings.quality;
            options.kernel = kernel_set_of(impl.choice.instructions);
            solution.occlusion =
                gpu != nullptr ? solve_masks_gpu(*gpu, *impl.masks, receivers, options, progress)
                               : solve_masks(*impl.masks, receivers, options, progress);
            break;
        }
        case Engine::disks: {
            DiskOptions options;
            options.definition = settings.definition;
            options.opening = opening_at(settings.quality);
            options.passes = settings.passes;
            options.strength = settings.strength;
            DiskResult solved =
                gpu != nullptr ? solve_disks_gpu(*gpu, *impl.disks, receivers, options, progress)
                               : solve_disks(*impl.disks, receivers, options, progress);
            solution.occlusion = std::move(solved.occlusion);
            if (!solved.residuals.empty())
                solution.residual = solved.residuals.back();
            break;
        }
        case Engine::rays: {
            RayOptions options;
            options.definition = settings.definition;
            options.rays = settings.rays;
            solution.occlusion = trace_occlusion(*impl.rays, receivers, options, progress);
            break;
        }
    }
    solution.seconds = watch.lap();
    return solution;
}

void check_settings(const EngineChoice& choice, const SolveSettings& settings)
{
    const auto must = [](bool holds, const std::string& what) {
        if (!holds)
            throw SettingsError(what);
    };
    const Definition& definition = settings.definition;
    must(definition.max_distance > 0.0f, "max_distance must be above 0");
    must(definition.offset > 0.0f && std::isfinite(definition.offset), "offset must be above 0");
    must(definition.falloff == Falloff::none || std::isfinite(definition.max_distance),
         "a falloff needs a max_distance");
    must(knows_kernel(choice.engine, definition.kernel),
         name_of(choice.engine) + " do not know this kernel");
    if (choice.engine == Engine::rays) {
        must(settings.rays >= 1 && settings.rays <= kMostRays,
             "rays must be between 1 and " + std::to_string(kMostRays));
        return;
    }
    must(settings.quality >= least_quality(choice.engine) &&
             settings.quality <= most_quality(choice.engine),
         "quality of " + name_of(choice.engine) + " must be between " +
             exact(least_quality(choice.engine)) + " and " + exact(most_quality(choice.engine)));
    if (choice.engine == Engine::disks) {
        must(settings.passes >= 1, "passes must be at least 1");
        must(settings.strength >= 0.0f && std::isfinite(settings.strength),
             "strength must be 0 or more");
    }
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
    return std::to_string(settings.rays) + (settings.rays == 1 ? " ray" : " rays");
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
