#include "gpu/gpu_masks.h"

#include "gpu/answers.h"
#include "gpu/draw.h"
#include "gpu/receiver_grid.h"
#include "gpu/rows.h"
#include "tree/masks/kernel.h"
#include "tree/masks/limits.h"
#include "tree/masks/raster.h"
#include "tree/masks/tree.h"
#include "tree/receiver_groups.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace surfelao {
namespace {

/// Groups that are computed together: their masks take 71 MB, the sums 17 MB. Their slots fill
/// whole rows.
constexpr std::size_t kBatchGroups = 16384;
static_assert(kBatchGroups * kGroupSize % kRowTexels == 0);

/// Nodes that a receiver looks at in one draw; see disks_gather.frag.
constexpr int kStepLimit = 8192;

/// What one walk draws: rows 0 to 7 or 8 to 15 of a face. A whole face and what of it sheets have
/// set would be more outputs than a device must have.
constexpr int kHalves = 2;
constexpr std::array<const char*, 4> kHalfOutputs = {"words0", "words1", "sheets0", "sheets1"};

/// The tree in preorder, kMaskFirstChild replaced by the node after the subtree.
std::vector<MaskNode> in_preorder(const MaskTree& tree)
{
    std::vector<MaskNode> nodes;
    nodes.reserve(tree.nodes.size());
    struct Visit {
        std::uint32_t node;     ///< in the tree
        std::uint32_t written;  ///< where it went, once its children are done
        bool done;
    };
    std::vector<Visit> stack;
    if (!tree.nodes.empty())
        stack.push_back({0, 0, false});
    while (!stack.empty()) {
        const Visit visit = stack.back();
        stack.pop_back();
        if (visit.done) {
            std::uint32_t& links = nodes[visit.written].links;
            links = (links & ~kMaskFirstChild) | static_cast<std::uint32_t>(nodes.size());
            continue;
        }
        const auto written = static_cast<std::uint32_t>(nodes.size());
        const MaskNode& node = nodes.emplace_back(tree.nodes[visit.node]);
        stack.push_back({visit.node, written, true});
        const std::uint32_t first_child = node.links & kMaskFirstChild;
        if (first_child != 0) {
            stack.push_back({first_child + 1, 0, false});
            stack.push_back({first_child, 0, false});
        }
    }
    return nodes;
}

/// From the mask frame to the axes of a face, +x -x +y -y +z -z, as in tree/masks/raster.h.
glm::mat3 axes_of_face(int face)
{
    const int axis = face / 2;
    glm::mat3 rows(0.0f);
    rows[0][axis] = face % 2 == 0 ? 1.0f : -1.0f;
    rows[1][(axis + 1) % 3] = 1.0f;
    rows[2][(axis + 2) % 3] = 1.0f;
    return glm::transpose(rows);
}

/// MaskRaster's moments in the order of masks_face.frag.
std::vector<glm::vec4> raster_moments()
{
    const MaskRaster& raster = mask_raster();
    std::vector<glm::vec4> texels;
    for (int byte = 0; byte < kMaskFaceBytes; ++byte) {
        for (int half = 0; half < 2; ++half) {
            const auto first = [&](int m, int part) { return raster.first[m][part][byte]; };
            const auto second = [&](int m) { return raster.second[m][half][byte]; };
            const int low = 2 * half, high = low + 1;
            texels.emplace_back(first(0, low), first(1, low), first(2, low), second(0));
            texels.emplace_back(first(0, high), first(1, high), first(2, high), second(1));
            texels.emplace_back(second(2), second(3), second(4), second(5));
        }
    }
    return texels;
}

/// As masks_answer.frag reads them: the normal's bits and the slot.
TextureBuffer upload_asked(const GlContext& context, std::span<const Receiver> receivers,
                           const ReceiverGroups& groups)
{
    const std::vector<std::uint32_t> slots = slots_of_receivers(groups, receivers.size());
    std::vector<glm::uvec4> texels(padded_to_rows(receivers.size()), glm::uvec4(kNoSlot));
    for (std::size_t i = 0; i < receivers.size(); ++i)
        texels[i] = glm::uvec4(glm::floatBitsToUint(receivers[i].normal), slots[i]);
    return TextureBuffer(context, TexelFormat::rgba32ui, std::span<const glm::uvec4>(texels));
}

}  // namespace

struct GpuMasks::Impl {
    const GlContext& context;
    std::size_t node_count;
    TextureBuffer nodes;
    TextureBuffer moments;
    VertexArray empty;

    Impl(const GlContext& in, const MaskTree& tree)
        : context(in),
          node_count(tree.nodes.size()),
          nodes(in, TexelFormat::rgba32ui, std::span<const MaskNode>(in_preorder(tree))),
          moments(in, TexelFormat::rgba32f, std::span<const glm::vec4>(raster_moments())),
          empty(in)
    {
    }
};

namespace {

/// As masks_face.frag and masks_result.frag read them, one per slot of the leaves.
TextureBuffer upload_skies(const GlContext& context, const MaskSkies& skies, float limit,
                           const ReceiverGroups& groups, std::span<const std::uint32_t> leaves)
{
    std::vector<glm::vec2> texels;
    for (const std::uint32_t leaf : leaves) {
        for (std::size_t i = groups.groups[leaf].begin; i < groups.groups[leaf].end; ++i) {
            const MaskSkies::Sky sky = skies.at(limit, groups.order[i]);
            texels.emplace_back(sky.share, sky.above);
        }
    }
    return TextureBuffer(context, TexelFormat::rg32f, std::span<const glm::vec2>(texels));
}

class Solver {
public:
    Solver(const GpuMasks::Impl& scene, const MaskOptions& options)
        : scene_(scene), definition_(options.definition), settings_(mask_settings(options))
    {
    }

    TextureBuffer solve(std::span<const Receiver> receivers, const Progress& progress)
    {
        const MaskLimits& limits = settings_.limits;
        const ReceiverGroups groups = group_receivers(receivers, kMaskFrame);
        const std::span<const std::uint32_t> leaves(groups.leaves);
        const MaskSkies skies(definition_, receivers);
        ProgressMeter meter(progress, leaves.size() * limits.count * kMaskFaces * kHalves);
        const Framebuffer sums =
            make_rows(scene_.context, leaves.size() * kGroupSize, {TexelFormat::rgba32f});
        sums.clear_color(glm::vec4(0.0f));
        for (std::size_t first = 0; first < leaves.size(); first += kBatchGroups) {
            const auto batch = leaves.subspan(first, std::min(kBatchGroups, leaves.size() - first));
            Batch work(scene_.context, groups, batch);
            for (unsigned k = 0; k < limits.count; ++k) {
                std::optional<TextureBuffer> sky;
                if (definition_.ground)
                    sky = upload_skies(scene_.context, skies, limits.distance[k], groups, batch);
                solve_batch(work, k, sky, first * kGroupSize, sums, meter);
            }
        }

        const Framebuffer rows =
            make_rows(scene_.context, receivers.size(), {TexelFormat::rgba32f});
        const TextureBuffer asked = upload_asked(scene_.context, receivers, groups);
        Program& answer = scene_.context.program("fullscreen.vert", "masks_answer.frag");
        answer.set("u_sums", sums.color());
        answer.set("u_receivers", asked);
        answer.set("u_turn_back", glm::transpose(kMaskFrame));
        draw_fullscreen(rows, answer, scene_.empty);
        TextureBuffer answers = answers_of_rows(scene_.context, rows, receivers.size());
        scene_.context.finish("computing occlusion");
        return answers;
    }

private:
    /// What all walks of one batch use.
    struct Batch {
        Batch(const GlContext& context, const ReceiverGroups& groups,
              std::span<const std::uint32_t> leaves)
            : group_texels(upload_groups(context, groups, leaves)),
              halves{ReceiverGrid(context, groups, leaves, half_values()),
                     ReceiverGrid(context, groups, leaves, half_values())},
              sums(context, {.width = halves[0].rect().width,
                             .height = halves[0].rect().height,
                             .colors = std::vector<TexelFormat>(4, TexelFormat::rgba32f)})
        {
        }

        static std::vector<GridValue> half_values()
        {
            std::vector<GridValue> values;
            for (const char* output : kHalfOutputs)
                values.push_back({std::string("u_") + output, TexelFormat::rgba32ui});
            return values;
        }

        TextureBuffer group_texels;
        std::array<ReceiverGrid, kHalves> halves;
        Framebuffer sums;  ///< shares; bent normals as drawn, filled, closed
    };

    /// Adds, per slot from `first_slot` on, bent normal of any length in the mask frame, occlusion,
    /// within the k-th limit, by its weight. skies: with a ground.
    void solve_batch(Batch& batch, unsigned k, const std::optional<TextureBuffer>& skies,
                     std::size_t first_slot, const Framebuffer& sums, ProgressMeter& meter)
    {
        const float limit = settings_.limits.distance[k];
        const std::vector<std::string> defined = {skies ? "GROUND 1" : "GROUND 0"};
        const ReceiverGrid& grid = batch.halves[0];
        for (std::size_t i = 0; i < 4; ++i)
            batch.sums.clear_color(glm::vec4(0.0f), i);

        Program& walk = scene_.context.program("fullscreen.vert", "masks_walk.frag");
        walk.set("u_nodes", scene_.nodes);
        walk.set("u_node_count", static_cast<int>(scene_.node_count));
        walk.set("u_groups", batch.group_texels);
        walk.set("u_share", settings_.share_leaf);
        walk.set("u_cluster", settings_.cluster);
        walk.set("u_cluster_limit", settings_.cluster_limit);
        walk.set("u_crossing", settings_.crossing);
        walk.set("u_graze", settings_.graze);
        walk.set("u_one_sided", settings_.one_sided ? 1 : 0);
        walk.set("u_max_distance", std::min(limit, std::numeric_limits<float>::max()));
        walk.set("u_exact_radius", settings_.exact_radius > 0.0f ? 0.0f : -1.0f);
        walk.set("u_step_limit", kStepLimit);
        Program& worth = scene_.context.program("fullscreen.vert", "masks_face.frag", defined);
        if (skies) {
            worth.set("u_skies", *skies);
            worth.set("u_max_distance", std::min(limit, std::numeric_limits<float>::max()));
        }
        worth.set("u_fill", settings_.fill ? 1 : 0);
        worth.set("u_moments", scene_.moments);
        worth.set("u_receivers", grid.receivers());
        worth.set("u_slot_count", grid.slot_count());
        worth.set("u_blocks_per_row", grid.blocks_per_row());
        for (int face = 0; face < kMaskFaces; ++face) {
            walk.set("u_face", axes_of_face(face));
            worth.set("u_face", axes_of_face(face));
            if (skies)
                worth.set("u_up", axes_of_face(face) * kMaskFrame * definition_.ground->up);
            walk.set("u_half", 0);
            batch.halves[0].compute(walk, static_cast<std::uint32_t>(scene_.node_count), meter);
            walk.set("u_half", 1);
            batch.halves[1].compute(walk, static_cast<std::uint32_t>(scene_.node_count), meter,
                                    [&](const Rect& piece) {
                                        for (std::size_t i = 0; i < kHalfOutputs.size(); ++i) {
                                            const std::string output = kHalfOutputs[i];
                                            worth.set("u_low_" + output, batch.halves[0].value(i));
                                            worth.set("u_high_" + output, batch.halves[1].value(i));
                                        }
                                        draw_fullscreen(batch.sums, worth, scene_.empty,
                                                        {.blend = Blend::add, .scissor = piece});
                                    });
        }

        Program& answer = scene_.context.program("fullscreen.vert", "masks_result.frag", defined);
        if (skies)
            answer.set("u_skies", *skies);
        const char* const inputs[] = {"u_share", "u_bent", "u_bent_filled", "u_bent_closed"};
        for (std::size_t i = 0; i < std::size(inputs); ++i)
            answer.set(inputs[i], batch.sums.color(i));
        answer.set("u_close", settings_.close);
        answer.set("u_fill_from", settings_.fill ? settings_.fill_from : 1.0f);
        answer.set("u_weight", settings_.limits.weight[k]);
        answer.set("u_slot_count", grid.slot_count());
        answer.set("u_blocks_per_row", grid.blocks_per_row());
        const auto slots = static_cast<std::size_t>(grid.slot_count());
        const Rect rows = {0, static_cast<int>(first_slot / kRowTexels), kRowTexels,
                           static_cast<int>(padded_to_rows(slots) / kRowTexels)};
        answer.set("u_first_slot", static_cast<int>(first_slot));
        draw_fullscreen(sums, answer, scene_.empty, {.blend = Blend::add, .scissor = rows});
    }

    const GpuMasks::Impl& scene_;
    Definition definition_;
    MaskSettings settings_;
};

}  // namespace

GpuMasks::GpuMasks(const GlContext& context, const MaskTree& tree)
    : impl_(std::make_unique<Impl>(context, tree))
{
}
GpuMasks::~GpuMasks() = default;
GpuMasks::GpuMasks(GpuMasks&&) noexcept = default;
GpuMasks& GpuMasks::operator=(GpuMasks&&) noexcept = default;

TextureBuffer GpuMasks::solve(std::span<const Receiver> receivers, const MaskOptions& options,
                              const Progress& progress) const
{
    return Solver(*impl_, options).solve(receivers, progress);
}

}  // namespace surfelao
