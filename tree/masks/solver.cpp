#include "tree/masks/solver.h"

#include "surfels/for_all.h"
#include "tree/masks/constants.h"
#include "tree/masks/raster.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

namespace surfelao {
namespace {

/// Buffers of one thread: one list of nodes per level of the group tree on the way down.
struct MaskWorkspace {
    MaskScratch scratch;
    std::vector<MaskBuffer<std::uint32_t>> lists;
    std::vector<std::uint32_t> roots;

    MaskWorkspace() = default;
    MaskWorkspace(const MaskWorkspace&) = delete;
    MaskWorkspace& operator=(const MaskWorkspace&) = delete;
    ~MaskWorkspace()
    {
        release(scratch.frontier);
        release(scratch.sheets);
        release(scratch.rectangles);
        release(scratch.triangles);
        for (MaskBuffer<std::uint32_t>& list : lists)
            release(list);
    }
};

/// Leaf k holds the receivers from kGroupSize k on.
std::size_t leaf_of(const ReceiverGroup& group)
{
    return group.begin / kGroupSize;
}

MaskReceivers columns_of(const MaskQuestion& question, const ReceiverGroup& group,
                         const MaskLimits& limits)
{
    MaskReceivers columns{};
    columns.count = group.end - group.begin;
    for (std::size_t k = 0; k < 3; ++k) {
        std::copy_n(&question.groups.position[k][group.begin], columns.count, columns.position[k]);
        std::copy_n(&question.groups.normal[k][group.begin], columns.count, columns.normal[k]);
    }
    for (std::uint32_t i = 0; i < columns.count; ++i) {
        for (unsigned k = 0; k < limits.count; ++k) {
            const MaskSkies::Sky sky =
                question.skies.at(limits.distance[k], question.groups.order[group.begin + i]);
            columns.sky[k][i] = sky.share;
            columns.above[i] = sky.above;
        }
    }
    return columns;
}

/// The receivers' own order, and their own frame: a row vector times a rotation turns back.
void write(const MaskQuestion& question, const ReceiverGroup& group, const MaskAnswers& found,
           std::span<Occlusion> answers)
{
    for (std::uint32_t i = 0; i < group.end - group.begin; ++i) {
        const std::uint32_t index = question.groups.order[group.begin + i];
        const glm::vec3 bent(found.bent[0][i], found.bent[1][i], found.bent[2][i]);
        const glm::vec3 normal = question.receivers.empty() ? answers[index].bent_normal
                                                            : question.receivers[index].normal;
        answers[index] = {found.occlusion[i], bent_normal_of(bent * kMaskFrame, normal)};
    }
}

/// Calls work(group) for each leaf group that is wanted, on all threads.
template <class Work>
void for_wanted(const MaskQuestion& question, const Work& work)
{
    for_tasks(question.groups.leaves.size(), [&](std::size_t leaf) {
        if (question.wanted[leaf] != 0)
            work(question.groups.groups[question.groups.leaves[leaf]]);
    });
}

}  // namespace

struct MaskSolver::Workspaces {
    tbb::enumerable_thread_specific<MaskWorkspace> of_threads;
};

/// The way from the root group down to the leaf groups that are wanted.
/// at_leaf(group, in, in_count, from_above, workspace).
template <class AtLeaf>
class MaskSolver::Descent {
public:
    Descent(MaskSolver& solver, const MaskQuestion& question, const MaskWorld& world,
            const AtLeaf& at_leaf)
        : solver_(solver), question_(question), world_(world), at_leaf_(at_leaf)
    {
        wanted_before_.reserve(question.wanted.size() + 1);
        std::uint32_t count = 0;
        for (const std::uint8_t wanted : question.wanted) {
            wanted_before_.push_back(count);
            count += wanted != 0 ? 1 : 0;
        }
        wanted_before_.push_back(count);
    }

    void run()
    {
        if (!question_.groups.groups.empty())
            visit(0, question_.roots.data(), question_.roots.size(), MaskShared{}, 0);
    }

private:
    bool is_wanted(const ReceiverGroup& group) const
    {
        const std::size_t end = (group.end + kGroupSize - 1) / kGroupSize;
        return wanted_before_[end] != wanted_before_[leaf_of(group)];
    }

    void visit(std::uint32_t index, const std::uint32_t* in, std::size_t in_count,
               const MaskShared& from_above, std::size_t level)
    {
        const ReceiverGroup& group = question_.groups.groups[index];
        if (!is_wanted(group))
            return;
        MaskWorkspace& workspace = solver_.workspaces_->of_threads.local();
        if (group.first_child == 0) {
            at_leaf_(group, in, in_count, from_above, workspace);
            return;
        }
        const auto visit_child = [&](std::uint32_t child, const std::uint32_t* list,
                                     std::size_t count, const MaskShared& shared) {
            visit(group.first_child + child, list, count, shared, level + 1);
        };
        if (group.end - group.begin <= kMaskLeastSharing) {
            visit_child(0, in, in_count, from_above);
            visit_child(1, in, in_count, from_above);
            return;
        }
        MaskShared shared;
        copy(from_above, world_.settings.limits.count, shared);
        if (group.end - group.begin > kMaskParallelReceivers) {
            // a thread that waits may take up other groups meanwhile: this list is nobody else's
            MaskBuffer<std::uint32_t> list;
            solver_.kernel_.descend(world_, group, in, in_count, list, shared, workspace.scratch);
            const std::vector<std::uint32_t> kept(list.data, list.data + list.count);
            release(list);
            do_both([&] { visit_child(0, kept.data(), kept.size(), shared); },
                    [&] { visit_child(1, kept.data(), kept.size(), shared); });
        } else {
            if (workspace.lists.size() <= level)
                workspace.lists.resize(level + 1);
            solver_.kernel_.descend(world_, group, in, in_count, workspace.lists[level], shared,
                                    workspace.scratch);
            const MaskBuffer<std::uint32_t> list = workspace.lists[level];
            visit_child(0, list.data, list.count, shared);
            visit_child(1, list.data, list.count, shared);
        }
    }

    MaskSolver& solver_;
    const MaskQuestion& question_;
    const MaskWorld& world_;
    const AtLeaf& at_leaf_;
    std::vector<std::uint32_t> wanted_before_;  ///< leaf groups
};

MaskSolver::MaskSolver(const MaskOptions& options)
    : options_(options),
      settings_(mask_settings(options)),
      kernel_(*kernel_of(options.kernel)),
      workspaces_(std::make_unique<Workspaces>())
{
}

MaskSolver::~MaskSolver() = default;

void MaskSolver::ask(const Definition& definition)
{
    options_.definition = definition;
    settings_ = mask_settings(options_);
}

MaskWorld MaskSolver::world_of(const MaskQuestion& question) const
{
    return {reinterpret_cast<const float*>(question.nodes), &mask_raster(settings_.rows),
            settings_};
}

void MaskSolver::solve(const MaskQuestion& question, ProgressMeter& meter,
                       std::span<Occlusion> answers)
{
    const MaskWorld world = world_of(question);
    const auto at_leaf = [&](const ReceiverGroup& group, const std::uint32_t* in,
                             std::size_t in_count, const MaskShared& from_above,
                             MaskWorkspace& workspace) {
        if (question.leaf_roots != nullptr) {
            const auto more = question.leaf_roots->of(leaf_of(group));
            workspace.roots.assign(in, in + in_count);
            workspace.roots.insert(workspace.roots.end(), more.begin(), more.end());
            in = workspace.roots.data();
            in_count = workspace.roots.size();
        }
        const MaskReceivers columns = columns_of(question, group, settings_.limits);
        MaskAnswers found{};
        kernel_.solve(world, group, in, in_count, from_above, columns, found, workspace.scratch);
        write(question, group, found, answers);
        meter.add(1);
    };
    Descent(*this, question, world, at_leaf).run();
}

void MaskSolver::keep(const MaskQuestion& question, ProgressMeter& meter, std::span<MaskKept> kept)
{
    MaskWorld world = world_of(question);
    world.settings.has_ground = false;  // it may move about the receivers
    const std::size_t leaves = question.groups.leaves.size();
    const auto at_leaf = [&](const ReceiverGroup& group, const std::uint32_t* in,
                             std::size_t in_count, const MaskShared& from_above,
                             MaskWorkspace& workspace) {
        kernel_.keep(world, group, in, in_count, from_above,
                     columns_of(question, group, settings_.limits), &kept[leaf_of(group)], leaves,
                     workspace.scratch);
        meter.add(1);
    };
    Descent(*this, question, world, at_leaf).run();
}

void MaskSolver::solve_kept(const MaskQuestion& question, std::span<const MaskKept> kept,
                            ProgressMeter& meter, std::span<Occlusion> answers)
{
    const MaskWorld world = world_of(question);
    const std::size_t leaves = question.groups.leaves.size();
    for_wanted(question, [&](const ReceiverGroup& group) {
        const std::size_t leaf = leaf_of(group);
        const auto roots = question.leaf_roots->of(leaf);
        MaskAnswers found{};
        kernel_.solve_kept(world, group, roots.data(), roots.size(), &kept[leaf], leaves,
                           columns_of(question, group, settings_.limits), found,
                           workspaces_->of_threads.local().scratch);
        write(question, group, found, answers);
        meter.add(1);
    });
}

std::vector<std::uint8_t> leaves_of(const Share& share, const ReceiverGroups& groups)
{
    std::vector<std::uint8_t> wanted(groups.leaves.size(), 0);
    const ShareRange range = range_of(share, wanted.size());
    std::fill(wanted.begin() + static_cast<std::ptrdiff_t>(range.begin),
              wanted.begin() + static_cast<std::ptrdiff_t>(range.end), std::uint8_t{1});
    return wanted;
}

}  // namespace surfelao
