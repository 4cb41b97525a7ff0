#include "tree/masks/masks.h"

#include "surfels/errors.h"
#include "tree/masks/constants.h"
#include "tree/masks/kernel.h"
#include "tree/masks/limits.h"
#include "tree/masks/raster.h"
#include "tree/masks/solver.h"
#include "tree/masks/tree.h"
#include "tree/part.h"
#include "tree/receiver_groups.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace surfelao {

namespace {

static_assert(static_cast<float>(kMaskFamily[0].quality) == MaskOptions::kCoarsest);
static_assert(static_cast<float>(kMaskFamily[std::size(kMaskFamily) - 1].quality) ==
              MaskOptions::kFinest);

float between(float a, float b, float t)
{
    return a * std::pow(b / a, t);
}

}  // namespace

MaskSettings mask_settings(const MaskOptions& options)
{
    check_definition(options.definition);
    require(options.quality >= MaskOptions::kCoarsest && options.quality <= MaskOptions::kFinest,
            "quality of masks must be between -1 and 4");
    require(options.definition.kernel == Kernel::cosine, "masks know the cosine kernel only");
    const std::vector<MaskKernelSet> kernels = available_mask_kernels();
    require(options.kernel == MaskKernelSet::best ||
                std::ranges::find(kernels, options.kernel) != kernels.end(),
            "this processor has no kernel " + std::string(name_of(options.kernel)));
    MaskSettings settings{};
    settings.fill = !options.exact;
    settings.rows = options.quality < kMaskFineFrom && !options.exact ? kMaskCoarseRows : kMaskRows;
    settings.limits = distance_limits(options.definition);
    if (const auto& ground = options.definition.ground) {
        const glm::vec3 up = kMaskFrame * ground->up;
        settings.has_ground = true;
        for (int k = 0; k < 3; ++k)
            settings.ground_up[k] = up[k];
        settings.ground_height = ground->height;
    }
    // within a limit a body's far side may be missing, and what stands behind a crack
    const bool is_limited = std::isfinite(options.definition.max_distance);
    settings.one_sided = !options.exact && !is_limited;
    settings.fill_from = is_limited ? kMaskLimitedFillFrom : kMaskFillFrom;
    settings.crossing = options.definition.falloff == Falloff::none ? kMaskCrossing : 1.0f;
    if (options.exact) {
        settings.limits.uncut = 0.0f;
        return settings;
    }
    settings.exact_radius = std::numeric_limits<float>::min();
    const float place = options.quality - MaskOptions::kCoarsest;
    const auto i = std::min(static_cast<std::size_t>(place), std::size(kMaskFamily) - 2);
    const float t = place - static_cast<float>(i);
    const MaskFamilyPoint &a = kMaskFamily[i], &b = kMaskFamily[i + 1];
    settings.cluster = between(a.cluster, b.cluster, t);
    settings.cluster_limit = std::max(settings.cluster, kMaskRelaxedCluster);
    settings.share_leaf = between(a.share_leaf, b.share_leaf, t);
    settings.share_inner = between(a.share_inner, b.share_inner, t);
    settings.graze = between(a.graze, b.graze, t);
    settings.close = std::clamp(settings.cluster / kMaskNarrowCracks - 1.0f, 0.0f, 1.0f);
    return settings;
}

std::vector<Occlusion> solve_masks(const MaskNode* nodes, std::span<const std::uint32_t> roots,
                                   std::span<const Receiver> receivers, const MaskOptions& options,
                                   const Progress& progress, const ForgetReceivers& forget)
{
    MaskSolver solver(options);
    std::vector<Occlusion> answers;
    const bool forgets = forget && !options.definition.ground;
    const ReceiverGroups groups = forgets ? group_receivers(receivers, kMaskFrame, answers, forget)
                                          : group_receivers(receivers, kMaskFrame);
    answers.resize(receivers.size());
    if (forgets)
        receivers = {};
    const MaskSkies skies(options.definition, receivers);
    const std::vector<std::uint8_t> wanted = leaves_of(options.share, groups);
    for (std::size_t leaf = 0; leaf < wanted.size(); ++leaf) {
        const ReceiverGroup& group = groups.groups[groups.leaves[leaf]];
        for (std::uint32_t i = group.begin; wanted[leaf] == 0 && i < group.end; ++i)
            answers[groups.order[i]] = kUnsolved;
    }
    ProgressMeter meter(progress, wanted.size() / options.share.count);
    solver.solve({nodes, roots, receivers, groups, skies, wanted}, meter, answers);
    return answers;
}

std::vector<Occlusion> solve_masks(const MaskTree& tree, std::span<const Receiver> receivers,
                                   const MaskOptions& options, const Progress& progress,
                                   const ForgetReceivers& forget)
{
    const std::uint32_t root = 0;
    return solve_masks(tree.nodes.data(), {&root, tree.nodes.empty() ? 0u : 1u}, receivers, options,
                       progress, forget);
}

}  // namespace surfelao
