#include "tests/stability/engines.h"

#include "engines/engine.h"
#include "gpu/context.h"
#include "reference/rays.h"

#include <cmath>
#include <memory>

namespace surfelao::stability {
namespace {

/// An answer of rays depends on the receiver and its index alone.
constexpr std::size_t kRepeatedRays = 64;

/// A net is never worse than independent directions: RMS at most 0.5 n^-1/2, and the worst of a
/// thousand receivers four times that. Without engine.h, for a seed that is not the witness's.
Engine rays(const char* name, RayScene::Build build, std::uint32_t count)
{
    const double rms = 0.5 / std::sqrt(count);
    const auto prepare = [build](const Geometry& geometry) -> Solver {
        return [scene = std::make_shared<const RayScene>(geometry, build)](
                   std::span<const Receiver> receivers, const SolveSettings& settings) {
            RayOptions options;
            options.definition = settings.definition;
            options.rays = settings.rays;
            options.seed = 1;
            return trace_occlusion(*scene, receivers, options);
        };
    };
    return {name,    {rms, 4.0 * rms}, false, false,        name,
            prepare, {.rays = count},  false, kRepeatedRays};
}

/// Software, so that the table is the same everywhere; one for each thread.
const GlContext& software_gpu()
{
    thread_local const GlContext context = GlContext::create(GlBackend::osmesa);
    return context;
}

std::function<Solver(const Geometry&)> preparing(surfelao::Engine engine, Device device)
{
    return [engine, device](const Geometry& geometry) -> Solver {
        EngineChoice choice = {.engine = engine, .device = device};
        if (device == Device::gpu)
            choice.context = &software_gpu();
        return [prepared = std::make_shared<const Prepared>(surfelao::prepare(geometry, choice))](
                   std::span<const Receiver> receivers, const SolveSettings& settings) {
            return surfelao::solve(*prepared, receivers, settings).occlusion;
        };
    };
}

/// Figures of the disk engine's own design: closed smooth bodies 0.005 to 0.025 RMS; the worst
/// receiver is not promised, five times the RMS is what its tails show.
Engine disks(const char* name, Device device, float quality, Bound bound)
{
    return {name,
            bound,
            true,
            true,
            device == Device::cpu ? "disks" : "GPU disks",
            preparing(surfelao::Engine::disks, device),
            {.quality = quality},
            device == Device::gpu};
}

/// One bit per direction. The bounds are the measured RMS of the worst cases plus a fifth; the
/// worst receiver has about four times that. Worst cases: draft a square pit along the raster's
/// axes (0.024) and a sphere from inside (0.030, a thirtieth of it allowed: cracks that are not
/// filled), good and best a soup of triangles (0.013, 0.011).
Engine masks(const char* name, Device device, float quality, Bound bound)
{
    return {name,
            bound,
            false,
            device == Device::gpu,
            device == Device::cpu ? "masks" : "GPU masks",
            preparing(surfelao::Engine::masks, device),
            {.quality = quality},
            device == Device::gpu};
}

}  // namespace

std::vector<Engine> all_engines()
{
    constexpr Bound kMasksDraft{0.031, 0.115}, kMasksGood{0.016, 0.07}, kMasksBest{0.0135, 0.055};
    constexpr Bound kDisksDraft{0.05, 0.25}, kDisksGood{0.03, 0.15}, kDisksBest{0.024, 0.15};
    return {
        rays("rays 4096", RayScene::Build::robust, 4096),
        rays("rays 256", RayScene::Build::fast, 256),
        masks("masks draft", Device::cpu, kDraft, kMasksDraft),
        masks("masks good", Device::cpu, kGood, kMasksGood),
        masks("masks best", Device::cpu, kBest, kMasksBest),
        disks("disks draft", Device::cpu, kDraft, kDisksDraft),
        disks("disks good", Device::cpu, kGood, kDisksGood),
        disks("disks best", Device::cpu, kBest, kDisksBest),
        masks("GPU m. draft", Device::gpu, kDraft, kMasksDraft),
        masks("GPU m. good", Device::gpu, kGood, kMasksGood),
        masks("GPU m. best", Device::gpu, kBest, kMasksBest),
        disks("GPU d. good", Device::gpu, kGood, kDisksGood),
    };
}

}  // namespace surfelao::stability
