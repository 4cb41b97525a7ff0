#include "gpu/gpu_masks.h"

#include "gpu/draw.h"
#include "gpu/receiver_grid.h"
#include "gpu/rows.h"
#include "tree/masks/kernel.h"
#include "tree/masks/limits.h"
#include "tree/masks/raster.h"
#include "tree/masks/tree.h"
#include "tree/receiver_group.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace surfelao {
namespace {

/// Groups that are computed together: their masks take 71 MB, the sums 17 MB.
constexpr std::size_t kBatchGroups = 16384;

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
          moments_(context, TexelFormat::rgba32f, std::span<const glm::vec4>(raster_moments())),
          empty_(context)
    {
    }

    std::vector<Occlusion> solve(std::span<const Receiver> receivers, std::span<const float> limits,
                                 const Progress& progress)
    {
        const std::vector<Receiver> turned = in_mask_frame(receivers);
        const std::vector<ReceiverGroup> groups = group_receivers(turned);
        ProgressMeter meter(progress, groups.size() * limits.size() * kMaskFaces * kHalves);
        std::vector<glm::vec4> sums(receivers.size());
        for (std::size_t first = 0; first < groups.size(); first += kBatchGroups) {
            const auto batch =
                std::span(groups).subspan(first, std::min(kBatchGroups, groups.size() - first));
            Batch work(context_, batch);
            for (const float limit : limits) {
                const std::vector<glm::vec4> values = solve_batch(work, limit, meter);
                for (std::size_t slot = 0; slot < batch.size() * kGroupSize; ++slot) {
                    const ReceiverGroup& group = batch[slot / kGroupSize];
                    if (slot % kGroupSize < group.count)
                        sums[group.receiver[slot % kGroupSize]] += values[slot];
                }
            }
        }
        std::vector<Occlusion> result;
        result.reserve(receivers.size());
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            // a row vector times a rotation: turned back
            const glm::vec3 bent = glm::vec3(sums[i]) * kMaskFrame;
            result.push_back({sums[i].w / static_cast<float>(limits.size()),
                              bent_normal_of(bent, receivers[i].normal)});
        }
        return result;
    }

private:
    /// What all walks of one batch use.
    struct Batch {
        Batch(const GlContext& context, std::span<const ReceiverGroup> groups)
            : group_texels(upload_groups(context, groups)),
              halves{ReceiverGrid(context, groups, half_values()),
                     ReceiverGrid(context, groups, half_values())},
              sums(context, {.width = halves[0].rect().width,
                             .height = halves[0].rect().height,
                             .colors = std::vector<TexelFormat>(4, TexelFormat::rgba32f)}),
              rows(make_rows(context, groups.size() * kGroupSize, {TexelFormat::rgba32f}))
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
        Framebuffer rows;  ///< the answers
    };

    /// Per slot: bent normal of any length in the mask frame, occlusion.
    std::vector<glm::vec4> solve_batch(Batch& batch, float limit, ProgressMeter& meter)
    {
        const ReceiverGrid& grid = batch.halves[0];
        for (std::size_t i = 0; i < 4; ++i)
            batch.sums.clear_color(glm::vec4(0.0f), i);

        Program& walk = context_.program("fullscreen.vert", "masks_walk.frag");
        walk.set("u_nodes", nodes_);
        walk.set("u_node_count", static_cast<int>(node_count_));
        walk.set("u_groups", batch.group_texels);
        walk.set("u_share", settings_.share_leaf);
        walk.set("u_cluster", settings_.cluster);
        walk.set("u_cluster_limit", settings_.cluster_limit);
        walk.set("u_graze", settings_.graze);
        walk.set("u_one_sided", settings_.one_sided ? 1 : 0);
        walk.set("u_max_distance", std::min(limit, std::numeric_limits<float>::max()));
        walk.set("u_exact_radius", settings_.exact_radius > 0.0f ? 0.0f : -1.0f);
        walk.set("u_step_limit", kStepLimit);
        Program& worth = context_.program("fullscreen.vert", "masks_face.frag");
        worth.set("u_fill", settings_.fill ? 1 : 0);
        worth.set("u_moments", moments_);
        worth.set("u_receivers", grid.receivers());
        worth.set("u_slot_count", grid.slot_count());
        worth.set("u_blocks_per_row", grid.blocks_per_row());
        for (int face = 0; face < kMaskFaces; ++face) {
            walk.set("u_face", axes_of_face(face));
            worth.set("u_face", axes_of_face(face));
            walk.set("u_half", 0);
            batch.halves[0].compute(walk, static_cast<std::uint32_t>(node_count_), meter);
            walk.set("u_half", 1);
            batch.halves[1].compute(walk, static_cast<std::uint32_t>(node_count_), meter,
                                    [&](const Rect& piece) {
                                        for (std::size_t i = 0; i < kHalfOutputs.size(); ++i) {
                                            const std::string output = kHalfOutputs[i];
                                            worth.set("u_low_" + output, batch.halves[0].value(i));
                                            worth.set("u_high_" + output, batch.halves[1].value(i));
                                        }
                                        draw_fullscreen(batch.sums, worth, empty_,
                                                        {.blend = Blend::add, .scissor = piece});
                                    });
        }

        Program& answer = context_.program("fullscreen.vert", "masks_result.frag");
        const char* const inputs[] = {"u_share", "u_bent", "u_bent_filled", "u_bent_closed"};
        for (std::size_t i = 0; i < std::size(inputs); ++i)
            answer.set(inputs[i], batch.sums.color(i));
        answer.set("u_close", settings_.close);
        answer.set("u_slot_count", grid.slot_count());
        answer.set("u_blocks_per_row", grid.blocks_per_row());
        draw_fullscreen(batch.rows, answer, empty_);
        return batch.rows.read_color(batch.rows.rect());
    }

    const GlContext& context_;
    MaskSettings settings_;
    std::size_t node_count_;
    TextureBuffer nodes_;
    TextureBuffer moments_;
    VertexArray empty_;
};

}  // namespace

std::vector<Occlusion> solve_masks_gpu(const GlContext& context, const MaskTree& tree,
                                       std::span<const Receiver> receivers,
                                       const MaskOptions& options, const Progress& progress)
{
    return Solver(context, tree, options)
        .solve(receivers, distance_limits(options.definition), progress);
}

}  // namespace surfelao
