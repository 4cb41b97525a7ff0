#include "engines/engine_options.h"

#include "surfels/errors.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace surfelao {
namespace {

/// Between the named qualities the opening changes geometrically.
float opening_at(float quality)
{
    return quality <= kGood ? kDraftOpening * std::pow(kGoodOpening / kDraftOpening, quality)
                            : kGoodOpening * std::pow(kBestOpening / kGoodOpening, quality - kGood);
}

}  // namespace

MaskKernelSet kernel_set_of(Instructions instructions)
{
    if (instructions == Instructions::all)
        return MaskKernelSet::best;
    const std::vector<MaskKernelSet> available = available_mask_kernels();
    if (std::find(available.begin(), available.end(), MaskKernelSet::avx2) == available.end())
        throw std::runtime_error("this processor has no AVX2");
    return MaskKernelSet::avx2;
}

RayScene::Isa isa_of(Instructions instructions)
{
    return instructions == Instructions::avx2 ? RayScene::Isa::avx2 : RayScene::Isa::best;
}

MaskOptions mask_options(const EngineChoice& choice, const SolveSettings& settings)
{
    MaskOptions options;
    options.definition = settings.definition;
    options.quality = settings.quality;
    options.share = settings.share;
    options.kernel = kernel_set_of(choice.instructions);
    return options;
}

DiskOptions disk_options(const SolveSettings& settings)
{
    DiskOptions options;
    options.definition = settings.definition;
    options.opening = opening_at(settings.quality);
    options.passes = settings.passes;
    options.strength = settings.strength;
    options.share = settings.share;
    return options;
}

std::optional<double> residual_of(const std::vector<double>& residuals)
{
    return residuals.empty() ? std::nullopt : std::optional(residuals.back());
}

RayOptions ray_options(const SolveSettings& settings)
{
    RayOptions options;
    options.definition = settings.definition;
    options.rays = settings.rays;
    options.seed = settings.seed;
    options.share = settings.share;
    return options;
}

void check_receivers(std::span<const Receiver> receivers)
{
    const auto fits = [](const Receiver& receiver) {
        const glm::vec3 p = glm::abs(receiver.position);
        const float length2 = glm::dot(receiver.normal, receiver.normal);
        return p.x <= kFarthestReceiver && p.y <= kFarthestReceiver && p.z <= kFarthestReceiver &&
               (std::abs(length2 - 1.0f) <= 2.0f * kUnitLength || length2 == 0.0f);
    };
    constexpr std::size_t kGrain = 16384;
    const bool all_fit = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, receivers.size(), kGrain), true,
        [&](const tbb::blocked_range<std::size_t>& range, bool all) {
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                all &= fits(receivers[i]);
            return all;
        },
        std::logical_and<bool>());
    if (all_fit)
        return;
    const auto wrong = std::ranges::find_if_not(receivers, fits);
    throw InputError("receiver " + std::to_string(wrong - receivers.begin()) +
                     ": its position must be finite and within a million diagonals, its normal of "
                     "length 1, or zero");
}

}  // namespace surfelao
