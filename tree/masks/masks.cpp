#include "tree/masks/masks.h"

#include "surfels/errors.h"
#include "tree/masks/constants.h"
#include "tree/masks/kernel.h"
#include "tree/masks/limits.h"
#include "tree/masks/raster.h"
#include "tree/masks/tree.h"
#include "tree/receiver_groups.h"

#include <glm/geometric.hpp>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string>

namespace surfelao {

namespace {

/// 64-byte aligned zeros: lanes beyond the end are loaded, though never used.
template <typename T>
T* allocate_zeros(std::size_t count)
{
    const std::size_t bytes = (count * sizeof(T) + 63) / 64 * 64;
    void* data = std::aligned_alloc(64, bytes);
    if (data == nullptr)
        throw std::bad_alloc();
    return static_cast<T*>(std::memset(data, 0, bytes));
}

}  // namespace

void reserve(MaskBuffer<std::uint32_t>& buffer, std::size_t count)
{
    if (count <= buffer.capacity)
        return;
    const std::size_t capacity = std::max<std::size_t>(2 * buffer.capacity, count + kMaskListSlack);
    auto* data = allocate_zeros<std::uint32_t>(capacity);
    std::copy_n(buffer.data, buffer.count, data);
    const std::size_t kept = buffer.count;
    release(buffer);
    buffer = {data, kept, capacity};
}
void release(MaskBuffer<std::uint32_t>& buffer)
{
    std::free(buffer.data);
    buffer = {};
}

namespace {

const MaskKernel* kernel_of(MaskKernelSet set)
{
    switch (set) {
        case MaskKernelSet::best:
            return kernel_of(available_mask_kernels().front());
#if defined(__x86_64__)
        case MaskKernelSet::avx512:
            return &kMaskKernelAvx512;
        case MaskKernelSet::avx2:
            return &kMaskKernelAvx2;
#endif
        default:
            return &kMaskKernelPortable;
    }
}

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
    if (const auto& ground = options.definition.ground) {
        const glm::vec3 up = kMaskFrame * ground->up;
        settings.has_ground = true;
        for (int k = 0; k < 3; ++k)
            settings.ground_up[k] = up[k];
        settings.ground_height = ground->height;
    }
    // within a limit a body's far side may be missing
    settings.one_sided = !options.exact && std::isinf(options.definition.max_distance);
    if (options.exact)
        return settings;
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

namespace {

/// Buffers of one thread: one list of nodes per level of the group tree on the way down.
struct Workspace {
    MaskScratch scratch;
    std::vector<MaskBuffer<std::uint32_t>> lists;

    Workspace() = default;
    Workspace(const Workspace&) = delete;
    Workspace& operator=(const Workspace&) = delete;
    ~Workspace()
    {
        release(scratch.frontier);
        release(scratch.sheets);
        release(scratch.rectangles);
        release(scratch.triangles);
        for (MaskBuffer<std::uint32_t>& list : lists)
            release(list);
    }
};

class Solver {
public:
    Solver(const MaskTree& tree, std::span<const Receiver> receivers, const MaskOptions& options,
           const Progress& progress)
        : kernel_(*kernel_of(options.kernel)),
          world_{reinterpret_cast<const float*>(tree.nodes.data()), &mask_raster(),
                 mask_settings(options)},
          has_triangles_(!tree.nodes.empty()),
          receivers_(receivers),
          groups_(group_receivers(receivers, kMaskFrame)),
          limits_(distance_limits(options.definition)),
          skies_(options.definition, receivers),
          progress_(progress, groups_.order.size() * limits_.size()),
          answers_(receivers.size())
    {
    }

    std::vector<Occlusion> run()
    {
        if (!groups_.groups.empty()) {
            for (const float limit : limits_) {
                world_.settings.max_distance = limit;
                const std::uint32_t root = 0;
                visit(0, &root, has_triangles_ ? 1 : 0, MaskShared{}, 0);
            }
        }
        const float weight = 1.0f / static_cast<float>(limits_.size());
        tbb::parallel_for(std::size_t{0}, answers_.size(), [&](std::size_t i) {
            Occlusion& answer = answers_[i];
            answer.occlusion *= weight;
            // a row vector times a rotation: turned back
            answer.bent_normal =
                bent_normal_of(answer.bent_normal * kMaskFrame, receivers_[i].normal);
        });
        return std::move(answers_);
    }

private:
    void visit(std::uint32_t index, const std::uint32_t* in, std::size_t in_count,
               const MaskShared& from_above, std::size_t level)
    {
        const ReceiverGroup& group = groups_.groups[index];
        if (group.first_child == 0) {
            solve_leaf(group, in, in_count, from_above);
            return;
        }
        MaskShared shared = from_above;
        const auto visit_child = [&](std::uint32_t child, const std::uint32_t* list,
                                     std::size_t count) {
            visit(group.first_child + child, list, count, shared, level + 1);
        };
        Workspace& workspace = workspaces_.local();
        if (group.end - group.begin > kMaskParallelReceivers) {
            // a thread that waits may take up other groups meanwhile: this list is nobody else's
            MaskBuffer<std::uint32_t> list;
            kernel_.descend(world_, group, in, in_count, list, shared, workspace.scratch);
            const std::vector<std::uint32_t> kept(list.data, list.data + list.count);
            release(list);
            tbb::parallel_invoke([&] { visit_child(0, kept.data(), kept.size()); },
                                 [&] { visit_child(1, kept.data(), kept.size()); });
        } else {
            if (workspace.lists.size() <= level)
                workspace.lists.resize(level + 1);
            kernel_.descend(world_, group, in, in_count, workspace.lists[level], shared,
                            workspace.scratch);
            const MaskBuffer<std::uint32_t> list = workspace.lists[level];
            visit_child(0, list.data, list.count);
            visit_child(1, list.data, list.count);
        }
    }

    void solve_leaf(const ReceiverGroup& group, const std::uint32_t* in, std::size_t in_count,
                    const MaskShared& from_above)
    {
        MaskReceivers columns{};
        columns.count = group.end - group.begin;
        for (std::size_t k = 0; k < 3; ++k) {
            std::copy_n(&groups_.position[k][group.begin], columns.count, columns.position[k]);
            std::copy_n(&groups_.normal[k][group.begin], columns.count, columns.normal[k]);
        }
        for (std::uint32_t i = 0; i < columns.count; ++i) {
            const MaskSkies::Sky sky =
                skies_.at(world_.settings.max_distance, groups_.order[group.begin + i]);
            columns.sky[i] = sky.share;
            columns.above[i] = sky.above;
        }
        MaskAnswers found{};
        kernel_.solve(world_, group, in, in_count, from_above, columns, found,
                      workspaces_.local().scratch);
        for (std::uint32_t i = 0; i < columns.count; ++i) {
            const std::uint32_t index = groups_.order[group.begin + i];
            answers_[index].occlusion += found.occlusion[i];
            answers_[index].bent_normal +=
                glm::vec3(found.bent[0][i], found.bent[1][i], found.bent[2][i]);
        }
        progress_.add(columns.count);
    }

    const MaskKernel& kernel_;
    MaskWorld world_;
    bool has_triangles_;
    std::span<const Receiver> receivers_;
    ReceiverGroups groups_;
    std::vector<float> limits_;
    MaskSkies skies_;
    ProgressMeter progress_;
    std::vector<Occlusion> answers_;
    tbb::enumerable_thread_specific<Workspace> workspaces_;
};

}  // namespace

std::vector<MaskKernelSet> available_mask_kernels()
{
    std::vector<MaskKernelSet> sets;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512vnni"))
        sets.push_back(MaskKernelSet::avx512);
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        sets.push_back(MaskKernelSet::avx2);
#endif
    sets.push_back(MaskKernelSet::portable);
    return sets;
}

std::string_view name_of(MaskKernelSet kernel)
{
    return kernel_of(kernel)->name;
}

std::vector<Occlusion> solve_masks(const MaskTree& tree, std::span<const Receiver> receivers,
                                   const MaskOptions& options, const Progress& progress)
{
    const std::vector<MaskKernelSet> sets = available_mask_kernels();
    if (options.kernel != MaskKernelSet::best &&
        std::ranges::find(sets, options.kernel) == sets.end())
        throw SettingsError("masks: this processor has no " + std::string(name_of(options.kernel)));
    return Solver(tree, receivers, options, progress).run();
}

}  // namespace surfelao
