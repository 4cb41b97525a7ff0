#include "gpu/gpu_masks.h"

#include "gpu/draw.h"
#include "gpu/receiver_grid.h"
#include "gpu/rows.h"
#include "tree/mask_kernel.h"
#include "tree/mask_raster.h"
#include "tree/mask_tree.h"
#include "tree/receiver_group.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace surfelao {
namespace {

/// Groups that are computed together: their masks take 4.5 MB in each of two targets.
constexpr std::size_t kBatchGroups = 4096;

/// Nodes that a receiver looks at in one draw; see disks_gather.frag.
constexpr int kStepLimit = 8192;

/// The tree in preorder, links replaced by the node after the subtree; open_radius -0 tells a
/// triangle from an exact rectangle.
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
            nodes[visit.written].links = static_cast<std::uint32_t>(nodes.size());
            continue;
        }
        const auto written = static_cast<std::uint32_t>(nodes.size());
        MaskNode& node = nodes.emplace_back(tree.nodes[visit.node]);
        stack.push_back({visit.node, written, true});
        const std::uint32_t first_child = node.links & ~kMaskSheet;
        if (first_child == 0) {
            node.open_radius = -0.0f;
        } else {
            stack.push_back({first_child + 1, 0, false});
            stack.push_back({first_child, 0, false});
        }
    }
    return nodes;
}

/// From the mask frame to the axes of a face, +x -x +y -y +z -z, as in mask_raster.h.
glm::mat3 axes_of_face(int face)
{
    const int axis = face / 2;
    glm::mat3 rows(0.0f);
    rows[0][axis] = face % 2 == 0 ? 1.0f : -1.0f;
    rows[1][(axis + 1) % 3] = 1.0f;
    rows[2][(axis + 2) % 3] = 1.0f;
    return glm::transpose(rows);
}

std::vector<Receiver> in_mask_frame(std::span<const Receiver> receivers)
{
    std::vector<Receiver> turned;
    turned.reserve(receivers.size());
    for (const Receiver& receiver : receivers)
        turned.push_back({kMaskFrame * receiver.position, kMaskFrame * receiver.normal});
    return turned;
}

class Solver {
public:
    Solver(const GlContext& context, const MaskTree& tree, const MaskOptions& options)
        : context_(context),
          settings_(mask_settings(options)),
          node_count_(tree.nodes.size()),
          nodes_(context, TexelFormat::rgba32ui, std::span<const MaskNode>(in_preorder(tree))),
          first_(context, TexelFormat::rgba32ui, std::as_bytes(std::span(mask_raster().sum1))),
          second_(context, TexelFormat::rgba32ui, std::as_bytes(std::span(mask_raster().sum2))),
          empty_(context)
    {
    }

    std::vector<Occlusion> solve(std::span<const Receiver> receivers, const Progress& progress)
    {
        const std::vector<Receiver> turned = in_mask_frame(receivers);
        const std::vector<ReceiverGroup> groups = group_receivers(turned);
        ProgressMeter meter(progress, groups.size() * kMaskFaces);
        std::vector<Occlusion> result(receivers.size());
        for (std::size_t first = 0; first < groups.size(); first += kBatchGroups) {
            const auto batch =
                std::span(groups).subspan(first, std::min(kBatchGroups, groups.size() - first));
            const std::vector<glm::vec4> values = solve_batch(batch, meter);
            for (std::size_t slot = 0; slot < batch.size() * kGroupSize; ++slot) {
                const ReceiverGroup& group = batch[slot / kGroupSize];
                if (slot % kGroupSize >= group.count)
                    continue;
                const std::uint32_t receiver = group.receiver[slot % kGroupSize];
                // a row vector times a rotation: turned back
                const glm::vec3 bent = glm::vec3(values[slot]) * kMaskFrame;
                result[receiver] = {values[slot].w,
                                    bent_normal_of(bent, receivers[receiver].normal)};
            }
        }
        return result;
    }

private:
    /// Per slot: bent normal of any length in the mask frame, occlusion.
    std::vector<glm::vec4> solve_batch(std::span<const ReceiverGroup> groups, ProgressMeter& meter)
    {
        std::vector<GridValue> words;
        for (const char* sampler : {"u_words0", "u_words1", "u_words2", "u_words3"})
            words.push_back({sampler, TexelFormat::rgba32ui});
        ReceiverGrid grid(context_, groups, words);
        const TextureBuffer group_texels = upload_groups(context_, groups);
        const Framebuffer sums(context_,
                               {.width = grid.rect().width,
                                .height = grid.rect().height,
                                .colors = std::vector<TexelFormat>(2, TexelFormat::rgba32f)});
        for (std::size_t i = 0; i < 2; ++i)
            sums.clear_color(glm::vec4(0.0f), i);

        Program& walk = context_.program("fullscreen.vert", "masks_walk.frag");
        walk.set("u_nodes", nodes_);
        walk.set("u_node_count", static_cast<int>(node_count_));
        walk.set("u_groups", group_texels);
        walk.set("u_share", settings_.share_leaf);
        walk.set("u_cluster", settings_.cluster);
        walk.set("u_cluster_limit", settings_.cluster_limit);
        walk.set("u_exact_radius", settings_.exact_radius > 0.0f ? 0.0f : -1.0f);
        walk.set("u_step_limit", kStepLimit);
        Program& worth = context_.program("fullscreen.vert", "masks_face.frag");
        worth.set("u_first", first_);
        worth.set("u_second", second_);
        worth.set("u_receivers", grid.receivers());
        worth.set("u_slot_count", grid.slot_count());
        worth.set("u_blocks_per_row", grid.blocks_per_row());
        for (int face = 0; face < kMaskFaces; ++face) {
            walk.set("u_face", axes_of_face(face));
            worth.set("u_face", axes_of_face(face));
            grid.compute(
                walk, static_cast<std::uint32_t>(node_count_), meter, [&](const Rect& piece) {
                    for (std::size_t i = 0; i < words.size(); ++i)
                        worth.set(words[i].sampler, grid.value(i));
                    draw_fullscreen(sums, worth, empty_, {.blend = Blend::add, .scissor = piece});
                });
        }

        Program& answer = context_.program("fullscreen.vert", "masks_result.frag");
        answer.set("u_share", sums.color(0));
        answer.set("u_bent", sums.color(1));
        answer.set("u_slot_count", grid.slot_count());
        answer.set("u_blocks_per_row", grid.blocks_per_row());
        const Framebuffer rows =
            make_rows(context_, groups.size() * kGroupSize, {TexelFormat::rgba32f});
        draw_fullscreen(rows, answer, empty_);
        return rows.read_color(rows.rect());
    }

    const GlContext& context_;
    MaskSettings settings_;
    std::size_t node_count_;
    TextureBuffer nodes_;
    TextureBuffer first_, second_;  ///< MaskRaster's sums
    VertexArray empty_;
};

}  // namespace

std::vector<Occlusion> solve_masks_gpu(const GlContext& context, const MaskTree& tree,
                                       std::span<const Receiver> receivers,
                                       const MaskOptions& options, const Progress& progress)
{
    if (std::isfinite(options.definition.max_distance))
        throw std::invalid_argument("masks on the GPU know no distance limit");
    return Solver(context, tree, options).solve(receivers, progress);
}

}  // namespace surfelao
