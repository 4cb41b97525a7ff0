/// solver.h: groups of receivers against the nodes of one tree or of several.
///
/// Internal to the mask engine: solve_masks, forests and receivers with a memory share it.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/raw_vector.h"
#include "surfels/receiver.h"
#include "tree/masks/kernel.h"
#include "tree/masks/limits.h"
#include "tree/masks/masks.h"
#include "tree/masks/tree.h"
#include "tree/receiver_groups.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace surfelao {

/// The kernel of a set; never null.
[[nodiscard]] const MaskKernel* kernel_of(MaskKernelSet set);

/// Lists of roots, one per leaf group.
struct MaskLeafRoots {
    std::vector<std::uint32_t> begin;  ///< leaves + 1 of them, into roots
    std::vector<std::uint32_t> roots;

    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t leaf) const
    {
        return std::span(roots).subspan(begin[leaf], begin[leaf + 1] - begin[leaf]);
    }
};

/// What is asked.
struct MaskQuestion {
    const MaskNode* nodes;
    std::span<const std::uint32_t> roots;  ///< of the trees that all groups see
    std::span<const Receiver> receivers;   ///< empty: their normals stand in the answers, no ground
    const ReceiverGroups& groups;          ///< of these receivers, in the mask frame
    const MaskSkies& skies;                ///< of these receivers
    std::span<const std::uint8_t> wanted;  ///< one per leaf group: whether it is asked
    const MaskLeafRoots* leaf_roots =
        nullptr;  ///< what each leaf group sees besides; null: nothing
};

class MaskSolver {
public:
    /// Throws as solve_masks.
    explicit MaskSolver(const MaskOptions& options);
    ~MaskSolver();

    /// The same options, but for another limit and ground.
    void ask(const Definition& definition);

    [[nodiscard]] const MaskSettings& settings() const { return settings_; }

    /// Writes the answers of the receivers of the leaf groups that are wanted. meter: counts leaf
    /// groups.
    void solve(const MaskQuestion& question, ProgressMeter& meter, std::span<Occlusion> answers);

    /// The same in two steps: what of the roots that all groups see, without a ground, and the
    /// rest. kept: limits times leaf groups, leaf groups of one limit side by side.
    void keep(const MaskQuestion& question, ProgressMeter& meter, std::span<MaskKept> kept);
    void solve_kept(const MaskQuestion& question, std::span<const MaskKept> kept,
                    ProgressMeter& meter, std::span<Occlusion> answers);

private:
    template <class AtLeaf>
    class Descent;
    struct Workspaces;

    [[nodiscard]] MaskWorld world_of(const MaskQuestion& question) const;

    MaskOptions options_;
    MaskSettings settings_;
    const MaskKernel& kernel_;
    std::unique_ptr<Workspaces> workspaces_;  ///< each thread's own
};

/// As solve_masks of masks.h, of the trees at these roots.
[[nodiscard]] std::vector<Occlusion> solve_masks(const MaskNode* nodes,
                                                 std::span<const std::uint32_t> roots,
                                                 std::span<const Receiver> receivers,
                                                 const MaskOptions& options,
                                                 const Progress& progress,
                                                 const ForgetReceivers& forget = {});

/// One per leaf group: whether it is one of the share.
[[nodiscard]] std::vector<std::uint8_t> leaves_of(const Share& share, const ReceiverGroups& groups);

}  // namespace surfelao
