/// memory.h: receivers on bodies of a forest, and what was found for them.
///
/// Each body's receivers are asked in the body's own space, where they and the body's own tree
/// never move: they are grouped once, and the masks of what the body covers of its own sky are
/// kept. In a frame only the other bodies are drawn, as they stand before it.
///
/// Which bodies a group looks at depends on where all stand now and on nothing before: those that
/// together cover no more of any of its receivers' hemispheres than the tolerance are left out. So
/// a group whose bodies have not moved has the answers of an earlier frame, to the byte, and small
/// errors cannot add up.
///
/// Internal to the mask engine; engines/moving.h is its door.
#pragma once

#include "surfels/occlusion.h"
#include "surfels/progress.h"
#include "surfels/receiver.h"
#include "tree/masks/forest.h"
#include "tree/masks/limits.h"
#include "tree/masks/solver.h"
#include "tree/receiver_groups.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace surfelao {

struct MaskFrame {
    double place = 0.0;        ///< seconds: the forest to where it stands before the receivers
    std::uint64_t solved = 0;  ///< receivers that were answered anew
    float bound = 0.0f;        ///< what the bodies that are left out cover at most
};

/// What a ball may cover of the cosine-weighted hemisphere of any receiver of a group at most,
/// where nothing beyond `limit` counts. In [0, 1]: 0 where it lies below all horizons. A ball of
/// radius b at the distance d covers (b / d)^2 where it is faced; near the horizon, at most its
/// solid angle times the largest sine of elevation over pi.
[[nodiscard]] float most_covered(const ReceiverGroup& group, const MaskBall& ball, float limit);

class MaskMemory {
public:
    /// forest: must outlive it. keep_most: bytes that kept masks may take; the receivers of bodies
    /// beyond are answered without. Throws as solve_masks.
    MaskMemory(const MaskForest& forest, std::span<const Receiver> at_rest,
               std::span<const std::uint32_t> body_of_receiver, const MaskOptions& options,
               float tolerance, std::size_t keep_most = kMaskKeepMost);

    /// Those of a body have changed.
    void deform(std::uint32_t body, std::span<const Receiver> at_rest);

    /// Where the forest stands. Writes the answers that may have changed; those of hidden bodies
    /// stay. After an exception the next call answers all. Throws Cancelled.
    MaskFrame solve(std::span<Occlusion> answers, const Progress& progress);

private:
    /// The receivers of one body, in its own space.
    struct OfBody {
        std::uint32_t body = 0;
        std::vector<std::uint32_t> index;  ///< of all receivers
        std::vector<Receiver> receivers;
        ReceiverGroups groups;
        MaskBall ball;                    ///< about all groups
        std::vector<std::uint8_t> share;  ///< of the leaf groups
        bool may_keep = false;
        RawVector<MaskKept> kept;
        std::optional<float> kept_within;  ///< the largest distance; none: nothing is kept
        std::vector<std::uint64_t> seen;   ///< bodies that a leaf group looks at: bits
        std::vector<Occlusion> answers;
        bool is_new = true;  ///< not answered since it was grouped
        // of this frame
        std::vector<MaskBall> balls;       ///< of the bodies, as they stand before it
        std::vector<std::uint8_t> wanted;  ///< leaf groups
    };

    void group(OfBody& of, std::span<const Receiver> at_rest);
    [[nodiscard]] bool is_moved(std::uint32_t body) const;
    [[nodiscard]] bool is_kept(const OfBody& of) const;
    [[nodiscard]] bool is_to_keep(const OfBody& of) const;
    [[nodiscard]] Definition definition_of(const OfBody& of) const;
    float look_around(const OfBody& of, const ReceiverGroup& group, float limit,
                      std::uint64_t* seen) const;
    float find_wanted(OfBody& of);
    [[nodiscard]] MaskLeafRoots leaf_roots_of(const OfBody& of) const;
    const MaskNode* nodes_before(const OfBody& of, bool with_own);
    void solve(OfBody& of, MaskFrame& frame, ProgressMeter& meter);
    std::uint64_t write_answers(const OfBody& of, std::span<Occlusion> answers) const;

    const MaskForest& forest_;
    MaskOptions options_;
    float tolerance_;
    MaskSolver solver_;
    std::size_t words_;  ///< of 64 bodies each
    std::vector<OfBody> of_bodies_;
    RawVector<MaskNode> before_;           ///< the forest before one body
    std::vector<std::uint64_t> versions_;  ///< of the bodies, as they were answered
    bool all_ = true;                      ///< are to be answered
};

}  // namespace surfelao
